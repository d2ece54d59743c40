# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Arrays of nodes: copies, arrays to fill and views."""
import gc

import numpy as np
import pytest

import bulletfem as bf
from conftest import G, cube_mesh

GETTERS = ["get_positions", "get_velocities", "get_stress", "get_node_stress", "get_von_mises", "get_node_von_mises",
           "get_plastic_strain", "get_activation", "get_contact_forces", "get_reaction_forces"]


@pytest.mark.parametrize("name", GETTERS)
def test_arrays_are_fresh_contiguous_float64_and_can_be_filled(cube, name):
    cube.world.step(40)
    get = getattr(cube, name)
    first, second = get(), get()
    assert first.dtype == np.float64 and first.flags.c_contiguous and first.flags.owndata and first.flags.writeable
    assert not np.shares_memory(first, second)
    out = np.full_like(first, np.nan)
    assert get(out=out) is out
    assert np.array_equal(out, first)


@pytest.mark.parametrize("name", GETTERS)
@pytest.mark.parametrize(
    "spoil,kind",
    [
        (lambda a: a.astype(np.float32), TypeError),
        (lambda a: a.astype(">f8"), TypeError),
        (lambda a: a.astype(complex), TypeError),
        (lambda a: a.tolist(), TypeError),
        (lambda a: np.zeros((len(a) + 1,) + a.shape[1:]), ValueError),
        (lambda a: np.zeros((len(a),) + a.shape[1:] + (1,)), ValueError),
        (lambda a: np.zeros((2 * len(a),) + a.shape[1:])[::2], ValueError),
        (lambda a: np.broadcast_to(0.0, a.shape), ValueError),
    ],
)
def test_unsuitable_arrays_to_fill_are_refused(floating, name, spoil, kind):
    get = getattr(floating, name)
    with pytest.raises(kind, match="out"):
        get(out=spoil(get()))


def test_read_only_array_to_fill_is_refused(floating):
    out = floating.positions
    out.flags.writeable = False
    with pytest.raises(ValueError, match="read-only"):
        floating.get_positions(out)


def test_view_shares_the_memory_of_the_nodes(floating):
    view = floating.positions_view
    assert np.array_equal(view, floating.positions)
    view[:, 0] += 1
    assert np.allclose(floating.positions[:, 0].min(), 0.8)
    floating.world.step(3)
    assert np.array_equal(view, floating.positions)
    floating.velocities_view[:] = (0, 1, 0)
    floating.world.step()
    assert np.allclose(floating.velocities, (0, 1, 0), atol=1e-6)


def test_view_keeps_the_world_alive(free):
    view = free.add_soft_body(cube_mesh()).positions_view
    before = view.copy()
    del free
    gc.collect()
    assert np.array_equal(view, before)
    view[0] = 1


def test_nodes_stay_while_a_view_lives(floating):
    view = floating.positions_view[2:5]
    world = floating.world
    for refused in (lambda: world.remove(floating), lambda: floating.set_strength(1e4),
                    lambda: floating.cut(np.zeros(floating.tet_count, int), bf.Material())):
        with pytest.raises(RuntimeError, match="view"):
            refused()
    del view
    floating.set_strength(1e9)
    with pytest.raises(ValueError, match="strength"):
        floating.positions_view
    world.remove(floating)


def test_positions_and_velocities_can_be_set(floating):
    moved = floating.positions + (0, 2, 0)
    floating.positions = moved
    floating.velocities = np.tile((1.0, 0, 0), (floating.node_count, 1))
    floating.world.step(30)
    assert np.allclose(floating.positions, moved + (0.5, 0, 0), atol=1e-6)


def test_unsuitable_positions_are_refused_and_change_nothing(floating):
    before = floating.positions
    for bad in (before[1:], before * np.nan, before * 1e9, before.astype(complex)):
        with pytest.raises((ValueError, TypeError), match="positions"):
            floating.positions = bad
    assert np.array_equal(floating.positions, before)


def test_values_of_views_that_are_not_finite_are_restored(floating):
    before = floating.positions
    floating.positions_view[3] = np.nan
    floating.world.step()
    assert np.all(np.isfinite(floating.positions))
    assert np.allclose(floating.positions, before, atol=1e-9)
    assert "values put back" in floating.report.flags


def test_forces_accelerate(floating):
    force = np.outer(floating.masses, (3.0, 0, 0))
    for _ in range(60):
        floating.add_forces(force)
        floating.world.step()
    assert np.allclose(floating.velocities, (3, 0, 0), atol=1e-3)


def test_masses_add_up(cube):
    assert np.isclose(cube.masses.sum(), cube.mass)
    assert np.isclose(cube.mass, 0.4**3 * 1100)


def test_falls_by_gravity(world):
    body = world.add_soft_body(cube_mesh())
    world.step(30)
    assert np.allclose(body.velocities, (0, -G * 0.5, 0), rtol=1e-6, atol=1e-9)


def test_pins_hold_and_react(world):
    body = world.add_soft_body(cube_mesh(), bf.Material.rubber())
    nodes = np.flatnonzero(body.positions[:, 1] == 0)
    mass = body.mass
    body.pin(nodes)
    assert np.array_equal(body.pins, nodes)
    before = body.positions[nodes]
    world.step(200)
    assert np.array_equal(body.positions[nodes], before)
    force, moment, count = body.reaction(about=(0, 0, 0))
    assert count == len(nodes)
    assert np.allclose(force, (0, mass * G, 0), rtol=1e-3, atol=1e-3 * mass * G)
    assert np.allclose(body.get_reaction_forces().sum(axis=0), force)
    assert body.reaction(nodes=nodes[:2])[2] == 2
    body.unpin(nodes)
    assert np.isclose(body.mass, mass)
    world.step(30)
    assert np.all(body.velocities[:, 1] < -1)


def test_shapes_of_meshes(floating):
    assert floating.tets.shape == (floating.tet_count, 4) and floating.tets.dtype == np.int32
    assert floating.faces.shape == (48, 3)
    corners = floating.positions[floating.faces]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    assert np.allclose(areas.sum(axis=0), 0, atol=1e-12)
    assert np.isclose((areas * corners.mean(axis=1)).sum() / 3, 0.4**3)
    assert floating.aabb.shape == (2, 3)
