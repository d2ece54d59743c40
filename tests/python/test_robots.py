# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Robots of URDF files."""
import numpy as np
import pytest

import bulletfem as bf
from conftest import G


def write_mesh(path, mesh):
    """A Medit file."""
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(mesh.positions))]
    lines += [" ".join(map(repr, map(float, p))) + " 0" for p in mesh.positions]
    lines += ["Tetrahedra", str(len(mesh.tets))]
    lines += [" ".join(str(node + 1) for node in tet) + " 0" for tet in mesh.tets]
    path.write_text("\n".join(lines + ["End", ""]))


def multibody_world():
    return bf.World("multibody", gravity=(0, 0, -G), step=1 / 120)


PENDULUM = """<robot name="pendulum">
  <link name="post"/>
  <link name="rod">
    <inertial><origin xyz="0 0 -0.5"/><mass value="2"/><inertia ixx="0.2" iyy="0.2" izz="0.01"/></inertial>
    <collision><origin xyz="0 0 -0.5"/><geometry><cylinder radius="0.02" length="1"/></geometry></collision>
  </link>
  <joint name="hinge" type="{kind}"><parent link="post"/><child link="rod"/><axis xyz="0 1 0"/>
    <limit lower="-0.5" upper="0.5" effort="50" velocity="3"/><dynamics damping="{damping}"/></joint>
</robot>"""


def pendulum(tmp_path, world, kind="continuous", damping=0, **settings):
    (tmp_path / "pendulum.urdf").write_text(PENDULUM.format(kind=kind, damping=damping))
    return world.add_robot(tmp_path / "pendulum.urdf", **settings)


def test_pendulums_swing_by_mass_and_inertia(tmp_path):
    world = bf.World("multibody", gravity=(0, 0, -G), step=1 / 1000)
    robot = pendulum(tmp_path, world)
    robot.joint_positions = [0.05]
    assert robot.links == ["post", "rod"] and robot.joints == ["hinge"]
    angles = []
    world.step(2000, after=lambda _: angles.append(robot.joint_positions[0]))
    crossings = np.flatnonzero(np.diff(np.sign(angles)))
    period = 2 * np.diff(crossings).mean() / 1000
    assert np.isclose(period, 2 * np.pi * np.sqrt((0.2 + 2 * 0.5**2) / (2 * G * 0.5)), rtol=5e-3)


def test_inertias_have_axes_of_their_own(tmp_path):
    """A tensor that is turned by 90 degrees about z, in a frame that turns it back."""
    text = PENDULUM.format(kind="continuous", damping=0)
    turned = text.replace('xyz="0 0 -0.5"/><mass', 'xyz="0 0 -0.5" rpy="0 0 1.5707963267948966"/><mass')
    turned = turned.replace('ixx="0.2" iyy="0.2"', 'ixx="0.2" iyy="0.05"')
    plain = text.replace('ixx="0.2" iyy="0.2"', 'ixx="0.05" iyy="0.2"')
    angles = []
    for content in (turned, plain):
        world = multibody_world()
        (tmp_path / "robot.urdf").write_text(content)
        robot = world.add_robot(tmp_path / "robot.urdf")
        robot.joint_positions = [0.3]
        world.step(60)
        angles.append(robot.joint_positions[0])
    assert np.isclose(*angles, rtol=1e-6)


def test_links_have_the_frames_of_the_file(tmp_path):
    world = multibody_world()
    half = np.sqrt(0.5)
    robot = pendulum(tmp_path, world, position=(1, 2, 3), orientation=(0, 0, half, half))
    for link in robot.links:
        position, orientation = robot.link_pose(link)
        assert np.allclose(position, (1, 2, 3)) and np.allclose(orientation, (0, 0, half, half))
    robot.joint_positions = [0.4]
    position, orientation = robot.link_pose("rod")
    assert np.allclose(position, (1, 2, 3)) and np.isclose(2 * np.arccos(abs(orientation @ (0, 0, half, half))), 0.4)


def test_limits_damping_and_motors_act(tmp_path):
    world = multibody_world()
    robot = pendulum(tmp_path, world, kind="revolute", damping=0.5)
    robot.set_motor("hinge", position=0.3)
    world.step(240)
    assert np.isclose(robot.joint_positions[0], 0.3, atol=1e-3)
    # 2 g 0.5 sin 0.3 about the hinge, by the right-hand rule about y.
    assert np.isclose(robot.motor_forces[0], 2 * G * 0.5 * np.sin(0.3), rtol=0.01)
    robot.set_motor("hinge", velocity=2, max_force=100)
    world.step(30)
    assert robot.joint_positions[0] < 0.51  # its limit
    robot.set_motor("hinge", velocity=0, max_force=0)
    world.step(1200)
    assert abs(robot.joint_positions[0]) < 0.02  # exp(-damping t / 2 I) of .5


def test_weak_motors_yield(tmp_path):
    world = multibody_world()
    robot = pendulum(tmp_path, world, damping=2)
    robot.set_motor("hinge", position=1.5, max_force=2)
    world.step(1200)
    assert np.isclose(robot.joint_positions[0], np.arcsin(2 / (2 * G * 0.5)), rtol=0.01)
    assert np.isclose(robot.motor_forces[0], 2, rtol=0.01)


LINK = """<link name="{name}"><inertial><mass value="{mass}"/><inertia ixx="1e-3" iyy="1e-3" izz="1e-3"/></inertial>
  {shape}</link>"""
FINGER = '<collision><geometry><box size="0.01 0.04 0.08"/></geometry></collision>'
SLIDER = """<joint name="{name}" type="prismatic"><parent link="{parent}"/><child link="{child}"/>
  <origin xyz="{place}"/><axis xyz="{axis}"/><limit lower="0" upper="{upper}" effort="100"/></joint>"""
TIP = """<deformable name="{side}_tip"><inertial><mass value="0.02"/></inertial><friction value="1"/>
  <corotated mu="4e4" lambda="6e4" damping="0.01"/><visual filename="{side}.mesh"/>
  <attach link="{side}" box="{low} -1 -1 {high} 1 1"/></deformable>"""


def write_gripper(folder):
    """Two fingers with soft tips on a palm that rises, around x = 0."""
    parts = ['<robot name="gripper"><link name="rail"/>', LINK.format(name="palm", mass=1, shape="")]
    parts.append(SLIDER.format(name="lift", parent="rail", child="palm", place="0 0 0", axis="0 0 1", upper=1))
    for side, sign in (("left", -1), ("right", 1)):
        parts.append(LINK.format(name=side, mass=0.2, shape=FINGER))
        parts.append(SLIDER.format(name=f"close_{side}", parent="palm", child=side, place=f"{sign * 0.085} 0 0.05",
                                   axis=f"{-sign} 0 0", upper=0.05))
        low, high = sorted((-sign * 0.004, -sign * 0.006))
        parts.append(TIP.format(side=side, low=low, high=high))
        tip = bf.Mesh.box((0.02, 0.04, 0.04), (2, 4, 4), (sign * 0.07 - 0.01, -0.02, 0.03))
        write_mesh(folder / f"{side}.mesh", tip)
    (folder / "gripper.urdf").write_text("\n".join(parts + ["<transmission/></robot>"]))
    return folder / "gripper.urdf"


def gripper_scene(path):
    world = multibody_world()
    world.add_rigid_body(bf.Shape.plane((0, 0, 1)), name="ground")
    material = bf.Material(young_modulus=5e4, poisson_ratio=0.4, density=300)
    cube = bf.Mesh.box((0.08,) * 3, (4,) * 3, (-0.04, -0.04, 0.001))
    world.add_soft_body(cube, material, name="cube", friction=1)
    return world, world.add_robot(path, name="hand")


def lift(world, robot, steps=240):
    robot.set_motor("lift", position=0, max_force=200)
    for side in ("left", "right"):
        robot.set_motor(f"close_{side}", velocity=0.1, max_force=4)
    world.step(steps)
    robot.set_motor("lift", position=0.2, max_force=200, max_velocity=0.1)


def test_grippers_with_soft_tips_lift_and_hold(tmp_path):
    world, robot = gripper_scene(write_gripper(tmp_path))
    cube, tips = world["cube"], robot.soft_bodies
    assert [tip.name for tip in tips] == ["hand.left_tip", "hand.right_tip"]
    assert any("transmission" in note for note in robot.notes)
    assert np.isclose(tips[0].masses.sum(), 0.02)
    lift(world, robot)
    world.step(300)
    start = cube.positions[:, 2].mean()
    assert start > 0.2
    world.step(600)  # 5 s
    assert abs(cube.positions[:, 2].mean() - start) < 1e-3
    forces = [cube.contact_force(tip) for tip in tips]
    weight = cube.masses.sum() * G
    assert np.isclose(sum(force[2] for force in forces), weight, rtol=0.01)
    for force, sign in zip(forces, (1, -1)):
        assert np.isclose(sign * force[0], 4, rtol=0.01)
    held = weight + (1.4 + sum(tip.masses.sum() for tip in tips)) * G
    assert np.isclose(robot.motor_forces[0], held, rtol=0.01)


@pytest.mark.skipif(not bf.has_pictures, reason="built without pictures")
def test_robots_are_drawn(tmp_path):
    """A finger of .08 m between eye and target fills the middle of the picture."""
    world, robot = gripper_scene(write_gripper(tmp_path))
    view = dict(width=64, height=64, eye=(-0.6, 0, 0.05), target=(-0.085, 0, 0.05))
    finger = world.render(**view)[32, 32]
    robot.joint_positions = [0.5, 0, 0]
    assert not np.array_equal(world.render(**view)[32, 32], finger)


def test_robots_are_part_of_the_state(tmp_path):
    path = write_gripper(tmp_path)
    world, robot = gripper_scene(path)
    other, again = gripper_scene(path)
    lift(world, robot, 120)
    world.step(60)
    state = world.save_state()
    lift(other, again, 0)  # motors are settings
    other.restore_state(state)
    for _ in range(40):
        world.step()
        other.step()
        assert np.array_equal(world["cube"].positions, other["cube"].positions)
        assert np.array_equal(robot.joint_positions, again.joint_positions)


def test_files_and_worlds_that_do_not_serve_are_refused(tmp_path):
    path = write_gripper(tmp_path)
    for kind in ("coupled", "swap"):
        with pytest.raises(ValueError, match="multibody"):
            bf.World(kind).add_robot(path)
    world = multibody_world()
    with pytest.raises(RuntimeError, match="no such file"):
        world.add_robot(tmp_path / "none.urdf")
    bad = tmp_path / "bad.urdf"
    bad.write_text(PENDULUM.format(kind="continuous", damping=0).replace('<mass value="2"/>', ""))
    with pytest.raises(ValueError, match="without mass"):
        world.add_robot(bad)
    with pytest.raises(ValueError, match="base has no mass"):
        world.add_robot(path, fixed_base=False)
    bad.write_text(path.read_text().replace('box="0.004 -1 -1 0.006', 'box="5 -1 -1 6'))
    with pytest.raises(ValueError, match="holds no node"):
        world.add_robot(bad)
    assert not world.soft_bodies
    world.step()


@pytest.mark.parametrize("call, error", [
    (lambda r: r.set_motor("elbow", velocity=1), IndexError),
    (lambda r: r.link_pose("elbow"), IndexError),
    (lambda r: r.set_motor("hinge", velocity=np.nan), ValueError),
    (lambda r: r.set_motor("hinge", velocity=1, max_force=-1), ValueError),
    (lambda r: r.set_motor("hinge", position=1, gain=2), ValueError),
    (lambda r: r.set_motor("hinge", velocity="fast"), TypeError),
    (lambda r: setattr(r, "joint_positions", [0, 0]), ValueError),
    (lambda r: setattr(r, "joint_positions", [np.inf]), ValueError),
])
def test_bad_input_is_refused(tmp_path, call, error):
    robot = pendulum(tmp_path, multibody_world())
    with pytest.raises(error):
        call(robot)
    robot.world.step()
