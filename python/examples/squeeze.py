# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Two plates on motors squeeze a ball of jelly; prints its height and the force on it."""
import numpy as np

import bulletfem


def build() -> tuple[bulletfem.World, bulletfem.SoftBody, list[bulletfem.RigidBody]]:
    world = bulletfem.World(gravity=(0, 0, 0))
    ball = world.add_soft_body(bulletfem.Mesh.sphere(0.05, 8), bulletfem.Material.jelly(), name="ball")
    plates = []
    for side in (-1.0, 1.0):
        plate = world.add_rigid_body(bulletfem.Shape.box((0.2, 0.01, 0.2)), 0.2, position=(0, side * 0.06, 0))
        slider = world.add_slider(plate, None, (0, 1, 0))
        slider.set_motor(-side * 0.02, max_force=0.5)
        plates.append(plate)
    return world, ball, plates


def main() -> None:
    world, ball, plates = build()
    places = np.empty((ball.node_count, 3))
    for _ in range(6):
        world.step(10)
        ball.get_positions(out=places)
        force = ball.contact_force(plates[0])[1]
        print(f"{world.time:.2f} s: height {np.ptp(places[:, 1]):.4f} m, force {force:.3f} N")


if __name__ == "__main__":
    main()
