# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""A gripper of a URDF file, with soft finger tips, lifts a soft cube and holds it for 5 s. gripper.py film.gif films it
(where ffmpeg and the module's pictures are)."""
from __future__ import annotations

import pathlib
import subprocess
import sys
import tempfile

import bulletfem

LINK = """<link name="{name}"><inertial><mass value="{mass}"/><inertia ixx="1e-3" iyy="1e-3" izz="1e-3"/></inertial>
  <collision><origin xyz="{place}"/><geometry><box size="{size}"/></geometry></collision></link>"""
SLIDER = """<joint name="{name}" type="prismatic"><parent link="{parent}"/><child link="{child}"/>
  <origin xyz="{place}"/><axis xyz="{axis}"/><limit lower="0" upper="{upper}" effort="100"/></joint>"""
TIP = """<deformable name="{side}_tip"><inertial><mass value="0.02"/></inertial><friction value="1"/>
  <corotated mu="4e4" lambda="6e4" damping="0.01"/><visual filename="{side}.mesh"/>
  <attach link="{side}" box="{low} -1 -1 {high} 1 1"/></deformable>"""
FRAMES = 10  # of the film a second


def write_medit(path: pathlib.Path, mesh: bulletfem.Mesh) -> None:
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(mesh.positions))]
    lines += [f"{x} {y} {z} 0" for x, y, z in mesh.positions.tolist()]
    lines += ["Tetrahedra", str(len(mesh.tets))]
    lines += [" ".join(str(node + 1) for node in tet) + " 0" for tet in mesh.tets.tolist()]
    path.write_text("\n".join([*lines, "End", ""]))


def write_gripper(folder: pathlib.Path) -> pathlib.Path:
    """A palm that rises, with two fingers that close along x."""
    parts = ['<robot name="gripper"><link name="rail"/>']
    parts.append(LINK.format(name="palm", mass=1, place="0 0 0.11", size="0.22 0.06 0.02"))
    parts.append(SLIDER.format(name="lift", parent="rail", child="palm", place="0 0 0", axis="0 0 1", upper=1))
    for side, sign in (("left", -1), ("right", 1)):
        parts.append(LINK.format(name=side, mass=0.2, place="0 0 0", size="0.01 0.04 0.08"))
        parts.append(SLIDER.format(name=f"close_{side}", parent="palm", child=side, place=f"{sign * 0.085} 0 0.05", axis=f"{-sign} 0 0",
                                   upper=0.05))
        low, high = sorted((-sign * 0.004, -sign * 0.006))
        parts.append(TIP.format(side=side, low=low, high=high))
        write_medit(folder / f"{side}.mesh", bulletfem.Mesh.box((0.02, 0.04, 0.04), (2, 4, 4), (sign * 0.07 - 0.01, -0.02, 0.03)))
    path = folder / "gripper.urdf"
    path.write_text("\n".join([*parts, "</robot>"]))
    return path


class Film:
    """Writes a film by ffmpeg; without a path, nothing."""

    def __init__(self, path: str | None) -> None:
        scale = "split[a][b];[a]palettegen[p];[b][p]paletteuse"
        raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", "320x240", "-r", str(FRAMES), "-i", "-"]
        self.writer = subprocess.Popen(["ffmpeg", "-v", "error", "-y", *raw, "-vf", scale, path], stdin=subprocess.PIPE) if path else None

    def append(self, world: bulletfem.World) -> None:
        if self.writer and self.writer.stdin and world.steps % (120 // FRAMES) == 0:
            picture = world.render(320, 240, eye=(0.3, -0.75, 0.35), target=(0, 0, 0.18))
            self.writer.stdin.write(picture.tobytes())

    def finish(self) -> None:
        if self.writer:
            self.writer.communicate()


def main(film_path: str | None) -> None:
    world = bulletfem.World("multibody", gravity=(0, 0, -9.81), step=1 / 120)
    world.add_rigid_body(bulletfem.Shape.plane((0, 0, 1)), name="ground")
    material = bulletfem.Material(young_modulus=5e4, poisson_ratio=0.4, density=300)
    cube = world.add_soft_body(bulletfem.Mesh.box((0.08,) * 3, (4,) * 3, (-0.04, -0.04, 0.001)), material, friction=1)
    with tempfile.TemporaryDirectory() as folder:
        robot = world.add_robot(write_gripper(pathlib.Path(folder)), name="hand")
    film = Film(film_path)
    robot.set_motor("lift", position=0, max_force=200)
    for side in ("left", "right"):
        robot.set_motor(f"close_{side}", velocity=0.1, max_force=4)
    world.step(120, after=film.append)
    robot.set_motor("lift", position=0.2, max_force=200, max_velocity=0.1)
    world.step(300, after=film.append)
    start = cube.positions[:, 2].mean()
    world.step(600, after=film.append)
    film.finish()
    tips = robot.soft_bodies
    held = sum(cube.contact_force(tip)[2] for tip in tips)
    print(f"held at {start:.3f} m, sinks by {1000 * (start - cube.positions[:, 2].mean()):.2f} mm in 5 s")
    print(f"tips hold {held:.3f} N of {cube.mass * 9.81:.3f} N, the motor {robot.motor_forces[0]:.2f} N")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else None)
