# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""pybullet of tools/pybullet: examples, saved states, contact forces."""
import json
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

from conftest import G

HERE = pathlib.Path(__file__).parent
EXAMPLES = ("ball", "torus", "anchor", "add_remove_objects")
CLOTH = EXAMPLES[2:]
BALL = dict(simFileName="ball.vtk", mass=4, useNeoHookean=1, NeoHookeanMu=3000, NeoHookeanLambda=6000, NeoHookeanDamping=0.01,
            frictionCoeff=0.5, collisionMargin=0.001)


def run(example, steps, tmp_path, unchanged=False):
    """Bodies after an example of Bullet's checkout, by our pybullet or by Bullet's own."""
    bullet = os.environ.get("BULLETFEM_BULLET_SOURCE")
    search = os.environ.get("PYBULLET_UNCHANGED") if unchanged else os.environ["PYTHONPATH"]
    if not bullet or not search:
        pytest.skip("BULLETFEM_BULLET_SOURCE does not name a checkout of Bullet")
    file = pathlib.Path(bullet) / "examples" / "pybullet" / "examples" / f"deformable_{example}.py"
    output = tmp_path / f"{example}{unchanged}.json"
    done = subprocess.run([sys.executable, HERE / "run_example.py", file, str(steps), output], env={**os.environ, "PYTHONPATH": search},
                          cwd=bullet, capture_output=True, text=True)  # its folder data has ball.obj
    assert done.returncode == 0, done.stderr
    return json.loads(output.read_text())["bodies"]


def values(body):
    return np.array([[float.fromhex(value) for value in point] for point in body["values"][:1 if not body["soft"] else None]])


@pytest.mark.parametrize("example", EXAMPLES)
def test_examples_run_unedited(pybullet, example, tmp_path):
    for body in run(example, 600, tmp_path):
        points = values(body)
        assert np.isfinite(points).all() and np.abs(points).max() < 10
        assert points[:, 2].min() > -2.05  # the plane is at -2


@pytest.mark.parametrize("example", CLOTH)
def test_cloth_has_bullets_bits(pybullet, example, tmp_path):
    assert run(example, 200, tmp_path) == run(example, 200, tmp_path, unchanged=True)


def positions(pybullet, body):
    return np.array(pybullet.getMeshData(body, -1, flags=pybullet.MESH_DATA_SIMULATION_MESH)[1])


def test_restored_states_continue_to_the_bit(pybullet):
    ball = pybullet.loadSoftBody("ball.vtk", basePosition=[0, 0, 0.5], scale=0.3, **BALL)
    box = pybullet.loadURDF("cube_small.urdf", [0.1, 0.05, 1])

    def run_on():
        for _ in range(150):
            pybullet.stepSimulation()
        return positions(pybullet, ball), pybullet.getBasePositionAndOrientation(box), pybullet.getBaseVelocity(box)

    run_on()
    state = pybullet.saveState()
    first = run_on()
    for _ in range(2):
        pybullet.restoreState(state)
        again = run_on()
        assert np.array_equal(again[0], first[0]) and again[1:] == first[1:]
    pybullet.loadURDF("cube_small.urdf", [2, 0, 1])
    before = pybullet.getBasePositionAndOrientation(box)
    with pytest.raises(pybullet.error):
        pybullet.restoreState(state)
    assert pybullet.getBasePositionAndOrientation(box) == before  # nothing changed
    pybullet.removeState(state)


def test_contact_points_have_the_forces_of_a_resting_ball(pybullet):
    ball = pybullet.loadSoftBody("ball.vtk", basePosition=[0, 0, 0.3], scale=0.3, **BALL)
    for _ in range(1500):
        pybullet.stepSimulation()
    points = pybullet.getContactPoints(bodyA=ball)
    assert points
    if points[0][9] == 1:
        pytest.skip("pybullet of this Bullet has no contact forces of deformables: they came after 3.25")
    force = sum(point[9] * np.array(point[7]) for point in points)
    assert np.allclose(force, [0, 0, 4 * G], atol=0.01 * 4 * G)
    for point in points:
        along, across = np.array(point[11]), np.array(point[13])
        assert np.allclose([along @ along, across @ across, along @ across], [1, 1, 0], atol=1e-9)


def test_a_panda_lifts_a_soft_ball(pybullet, tmp_path):
    output = tmp_path / "panda.json"
    subprocess.run([sys.executable, HERE / "panda.py", output], check=True)
    result = json.loads(output.read_text())
    assert result["lifted"] > 0.1 and result["slip"] < 0.002
    assert all(0.7 < extent < 1.3 for extent in result["extent"])


def test_pybullet_and_bulletfem_work_in_one_process(pybullet):
    """Both have a Bullet in double precision, and export nothing but their initialization."""
    bulletfem = pytest.importorskip("bulletfem", reason="the module bulletfem is not in PYTHONPATH")
    ball = pybullet.loadSoftBody("ball.vtk", basePosition=[0, 0, 0.5], scale=0.3, **BALL)
    world = bulletfem.World()
    world.add_rigid_body(bulletfem.Shape.plane())
    cube = world.add_soft_body(bulletfem.Mesh.box((0.2,) * 3, (2,) * 3, (0, 0.1, 0)), bulletfem.Material.rubber())
    for _ in range(100):
        pybullet.stepSimulation()
        world.step()
    assert 0 < positions(pybullet, ball)[:, 2].min() < 0.2 and abs(cube.positions[:, 1].min()) < 0.01


def test_windows_are_refused(pybullet, capfd):
    assert pybullet.connect(pybullet.GUI) == -1
    assert "use pybullet.DIRECT" in capfd.readouterr().out
