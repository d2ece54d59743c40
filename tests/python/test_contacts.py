# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
import numpy as np
import pytest

import bulletfem as bf
from conftest import G, cube_mesh


def test_contacts_have_indices_of_bodies(cube):
    world = cube.world
    world.step(100)
    rows = cube.contacts
    assert rows.dtype == bf.contact_dtype and len(rows) > 0
    assert set(rows["body"]) == {cube.index}
    assert set(rows["other"]) == {world["ground"].index}
    assert np.allclose(rows["normal"], (0, 1, 0))
    assert np.allclose(rows["impulse"], rows["normal"] * rows["normal_impulse"][:, None] + rows["friction_impulse"])
    assert np.isclose(rows["normal_impulse"].sum() / world.step_size, cube.mass * G, rtol=1e-3)
    assert np.array_equal(world.contacts, rows)


def test_weights_of_contacts_give_their_points(cube):
    cube.world.step(100)
    for row in cube.contacts:
        count = row["node_count"]
        assert np.isclose(row["weights"][:count].sum(), 1)
        point = row["weights"][:count] @ cube.positions[row["nodes"][:count]]
        assert np.allclose(point, row["point"], atol=1e-3)


def test_contacts_with_a_removed_body_have_index_minus_one(cube):
    world = cube.world
    world.step(100)
    world.remove(world["ground"])
    for _ in range(20):  # one would get the address of a deleted body
        world.add_rigid_body(bf.Shape.sphere(0.01), position=(5, 5, 5))
    assert set(cube.contacts["other"]) <= {-1}
    world.step(2)
    assert len(cube.contacts) == 0


def test_touches_begin_last_and_end(world):
    ground = world.add_rigid_body(bf.Shape.plane())
    body = world.add_soft_body(cube_mesh(low=0.002), bf.Material.rubber())
    states = []
    for _ in range(30):
        world.step()
        states += body.touches["state"].tolist()
    assert states[0] == 0 and 1 in states
    assert set(body.touches["other"]) == {ground.index}
    body.transform((0, 1, 0))
    world.step()
    assert world.touches["state"].tolist() == [2]


def test_soft_bodies_press_each_other(world):
    world.add_rigid_body(bf.Shape.plane())
    lower = world.add_soft_body(cube_mesh(low=0.0005), bf.Material.rubber())
    upper = world.add_soft_body(cube_mesh(low=0.401), bf.Material.rubber())
    world.step(300)
    weight = upper.mass * G
    assert np.allclose(upper.contact_force(lower), (0, weight, 0), atol=0.01 * weight)
    assert np.allclose(lower.contact_force(upper), (0, -weight, 0), atol=0.01 * weight)


def test_masks_keep_bodies_apart(world):
    world.add_rigid_body(bf.Shape.plane(), group=2, mask=2)
    body = world.add_soft_body(cube_mesh(low=0.01), bf.Material.rubber(), group=1, mask=1)
    world.step(60)
    assert body.positions[:, 1].max() < -1


def test_contact_force_wants_a_body_of_the_world(cube):
    other = bf.World().add_rigid_body(bf.Shape.plane())
    with pytest.raises(ValueError, match="another world"):
        cube.contact_force(other)
    with pytest.raises(TypeError):
        cube.contact_force("ground")


def test_friction_holds_on_a_slope():
    def slide(friction):
        angle = np.radians(20)
        world = bf.World(gravity=(G * np.sin(angle), -G * np.cos(angle), 0))
        world.add_rigid_body(bf.Shape.plane(), friction=1)
        body = world.add_soft_body(cube_mesh(low=0.0005), bf.Material.rubber(), friction=friction)
        world.step(120)
        return body.velocities[:, 0].mean()

    assert abs(slide(0.5)) < 1e-2
    assert slide(0.2) > 0.5


def test_rays_hit_soft_and_rigid_bodies(cube):
    world = cube.world
    hit = world.ray_test((0.05, 2, 0.02), (0.05, -1, 0.02))
    assert hit["body"] == cube.index and np.allclose(hit["normal"], (0, 1, 0))
    assert np.allclose(hit["weights"] @ cube.positions[hit["nodes"]], hit["point"])
    below = world.ray_test((2, 2, 0), (2, -1, 0))
    assert below["body"] == world["ground"].index and np.isclose(below["fraction"], 2 / 3)
    assert world.ray_test((2, 2, 0), (2, 1, 0)) is None
    assert cube.ray_test((2, 2, 0), (2, -1, 0)) is None
    with pytest.raises(ValueError, match="length"):
        world.ray_test((0, 0, 0), (0, 0, 0))
