# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
import numpy as np
import pytest

import bulletfem as bf
from conftest import G, cube_mesh


def stretched(strain=0.01):
    """A bar along x that is pulled by its ends; Poisson's ratio 0 makes its stress uniform."""
    world = bf.World(gravity=(0, 0, 0), numerical_damping=1)
    material = bf.Material(young_modulus=1e6, poisson_ratio=0)
    bar = world.add_soft_body(bf.Mesh.box((1, 0.2, 0.2), (10, 2, 2)), material)
    x = bar.positions
    ends = np.flatnonzero((x[:, 0] == 0) | (x[:, 0] == 1))
    bar.set_targets(ends, x[ends] * (1 + strain, 1, 1))
    world.step(200)
    return bar


def test_stress_is_that_of_a_bar():
    bar = stretched()
    expected = np.diag([1e4, 0, 0])
    assert bar.stress.shape == (bar.tet_count, 3, 3)
    assert np.allclose(bar.stress, expected, atol=50)
    assert np.allclose(bar.get_node_stress(), expected, atol=50)
    assert np.allclose(bar.von_mises, 1e4, atol=50)
    assert np.array_equal(bar.stress, bar.stress.transpose(0, 2, 1))


def test_initial_stress_is_added(floating):
    stress = np.tile(np.diag([1e3, 2e3, 3e3]), (floating.tet_count, 1, 1))
    stress[:, 0, 1] = stress[:, 1, 0] = 500
    floating.set_initial_stress(stress)
    floating.world.step()
    assert np.all(floating.von_mises > 0)
    floating.set_initial_stress(None)


@pytest.mark.parametrize("spoil", [lambda s: s[1:], lambda s: s[:, :2], lambda s: s * np.nan,
                                   lambda s: s + np.triu(np.ones((3, 3)), 1)])
def test_unsuitable_initial_stress_is_refused(floating, spoil):
    with pytest.raises(ValueError, match="stress"):
        floating.set_initial_stress(spoil(np.zeros((floating.tet_count, 3, 3))))


def test_clay_yields():
    world = bf.World()
    world.add_rigid_body(bf.Shape.plane())
    body = world.add_soft_body(cube_mesh(3, low=0.5), bf.Material.clay())
    assert not body.get_plastic_strain().any()
    world.step(60)
    assert body.get_plastic_strain().max() > 0


def test_contact_forces_carry_the_weight(cube):
    cube.world.step(200)
    ground = cube.world["ground"]
    weight = cube.mass * G
    assert np.allclose(cube.contact_force(ground), (0, weight, 0), atol=1e-3 * weight)
    assert np.allclose(cube.get_contact_forces().sum(axis=0), (0, weight, 0), atol=1e-3 * weight)
