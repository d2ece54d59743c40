# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""A rubber box comes to rest; its contact force settles at m g."""
import bulletfem

world = bulletfem.World(step=1 / 60)
ground = world.add_rigid_body(bulletfem.Shape.plane())
mesh = bulletfem.Mesh.box(size=(0.4, 0.4, 0.4), cells=(4, 4, 4), origin=(-0.2, 0.2, -0.2))
box = world.add_soft_body(mesh, bulletfem.Material.rubber())
for _ in range(6):
    world.step(10)
    top, force = box.positions[:, 1].max(), box.contact_force(ground)[1]
    print(f"top at {top:.3f} m, contact force {force:.1f} N")
print(f"m g = {box.mass * 9.81:.1f} N, largest von Mises stress {box.von_mises.max():.0f} Pa")
