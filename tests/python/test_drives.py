# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Anchors, attachments, springs, targets, actuators, welds and splitting."""
import numpy as np
import pytest

import bulletfem as bf
from conftest import G, bottom_nodes, cube_mesh, top_nodes


def test_anchors_hang_a_body_on_a_rigid_one(world):
    bar = world.add_rigid_body(bf.Shape.box((0.5, 0.1, 0.5)), position=(0, 0.5, 0))
    body = world.add_soft_body(cube_mesh(), bf.Material.rubber())
    held = top_nodes(body)
    body.anchor(held, bar)
    world.step(200)
    weight = body.mass * G
    force, moment, count = body.anchor_reaction(bar)
    assert count == 9 and np.allclose(force, (0, weight, 0), atol=0.01 * weight)
    assert moment.shape == (3,)
    rows = body.holds
    assert set(rows["kind"]) == {0} and set(rows["other"]) == {bar.index}
    assert np.allclose(rows["impulse"].sum(axis=0) / world.step_size, force, atol=1e-9)
    body.unanchor(held[:4])
    world.step()
    assert len(body.holds) == 5
    body.unanchor()
    world.step(30)
    assert body.velocities[:, 1].max() < -1


def test_anchored_nodes_and_bad_influences_are_refused(world):
    bar = world.add_rigid_body(bf.Shape.box((0.5, 0.1, 0.5)), position=(0, 0.5, 0))
    body = world.add_soft_body(cube_mesh())
    body.anchor([20], bar)
    with pytest.raises(ValueError, match="node 20 has an anchor"):
        body.anchor([19, 20], bar)
    with pytest.raises(ValueError, match="influence"):
        body.anchor([1], bar, influence=0)
    with pytest.raises(IndexError, match="nodes has 27"):
        body.anchor([27], bar)


def test_anchored_bodies_collide_if_asked_or_free(free):
    def depth(collide, then_free):
        world = bf.World(gravity=(0, 0, 0))
        plate = world.add_rigid_body(bf.Shape.box((1, 0.1, 1)), position=(0, -0.2, 0))
        body = world.add_soft_body(cube_mesh(), bf.Material(young_modulus=1e5), velocity=(0, -1, 0))
        body.anchor([26], plate, collide=collide, influence=1e-6)
        if then_free:
            body.unanchor()
        world.step(30)
        return body.positions[:, 1].min()

    assert depth(False, False) < -0.3
    assert depth(True, False) > -0.2 and depth(False, True) > -0.2


def test_anchors_go_with_their_rigid_body(world):
    bar = world.add_rigid_body(bf.Shape.sphere(0.1), 1, position=(0, 0.5, 0))
    body = world.add_soft_body(cube_mesh())
    body.anchor(top_nodes(body), bar)
    world.step(5)
    world.remove(bar)
    world.step(5)
    assert len(body.holds) == 0


def test_attachments_tie_soft_bodies(free):
    a = free.add_soft_body(cube_mesh())
    b = free.add_soft_body(cube_mesh(low=0.5))
    pairs = list(zip(top_nodes(a), bottom_nodes(b)))
    handles = [a.attach(int(i), b, int(k)) for i, k in pairs]
    free.step(200)
    apart = a.positions[[i for i, _ in pairs]] - b.positions[[k for _, k in pairs]]
    assert np.abs(apart).max() < 1e-3
    for handle in handles:
        a.detach(handle)
    free.step()
    assert len(a.holds) == 0
    handle = a.attach_to_tet(26, b, 0, (0.25,) * 4)
    assert handle > 0
    with pytest.raises(ValueError, match="[Ww]eights"):
        a.attach_to_tet(26, b, 0, (0.5,) * 4)
    with pytest.raises(ValueError):
        a.attach(99, b, 0)
    with pytest.raises(TypeError):
        a.attach(1.5, b, 0)


def test_springs_pull(world):
    body = world.add_soft_body(cube_mesh(), bf.Material(stiffness_damping=0.05), position=(0, 0, 0))
    node = int(top_nodes(body)[4])
    spring = body.add_spring([node], body.positions[node], stiffness=1e4, damping=300)
    world.step(400)
    weight = body.mass * G
    assert np.isclose(body.positions[node][1], 0.4 - weight / 1e4, atol=0.005)
    assert np.allclose(body.anchor_reaction(None)[0][1], weight, rtol=0.02)
    body.set_spring_target(spring, (0, 1, 0))
    world.step(400)
    assert body.positions[node][1] > 0.8
    body.remove_spring(spring)
    world.step(20)
    assert body.velocities[:, 1].mean() < -2


@pytest.mark.parametrize("nodes,settings,kind", [
    ([], {}, ValueError), ([0, 1, 2, 3], {}, ValueError), ([99], {}, IndexError), ([0], {"weights": [0.5]}, ValueError),
    ([0, 1], {"weights": [1]}, ValueError), ([0], {"stiffness": -1}, ValueError), ([0], {"damping": np.nan}, ValueError)])
def test_unusable_springs_are_refused(floating, nodes, settings, kind):
    with pytest.raises(kind):
        floating.add_spring(nodes, (0, 0, 0), **settings)


def test_targets_lead_nodes(floating):
    nodes = top_nodes(floating)
    places = floating.positions[nodes] + (0, 0.05, 0)
    floating.set_targets(nodes, places)
    floating.world.step()
    assert np.allclose(floating.positions[nodes], places, atol=1e-9)
    floating.move_targets(nodes, (0, 0, 0), (0, 0, 0, 1))
    floating.world.step()
    assert np.allclose(floating.positions[nodes], places - (0, 0.05, 0), atol=1e-9)
    floating.clear_targets(nodes)
    with pytest.raises(ValueError, match="positions"):
        floating.set_targets(nodes, places[1:])
    with pytest.raises(IndexError):
        floating.clear_targets([99])


def test_expansion_grows_a_body(floating):
    handle = floating.add_expansion(strain=0.05)
    floating.world.step(200)
    assert np.allclose(np.ptp(floating.positions, axis=0), 0.42, rtol=2e-3)
    floating.set_expansion(handle, 0)
    floating.world.step(200)
    assert np.allclose(np.ptp(floating.positions, axis=0), 0.4, rtol=2e-3)
    report = floating.actuators[0]
    assert report["kind"] == "expansion" and report["handle"] == handle and report["strain"] == 0
    floating.remove_actuator(handle)
    assert floating.actuators == []


def test_fibres_shorten_a_bar(free):
    bar = free.add_soft_body(bf.Mesh.box((1, 0.2, 0.2), (10, 2, 2)), bf.Material(young_modulus=1e5, poisson_ratio=0))
    handle = bar.add_fibres((1, 0, 0), activation=1e4)
    free.step(300)
    assert np.isclose(np.ptp(bar.positions[:, 0]), 0.9, atol=0.01)
    assert np.allclose(bar.get_activation(), 1e4)
    bar.set_activation(handle, 0)
    bar.add_fibres(np.tile((0, 1.0, 0), (2, 1)), [0, 1], activation=10)
    with pytest.raises(ValueError):
        bar.add_fibres(np.tile((0, 1.0, 0), (3, 1)), [0, 1])
    with pytest.raises(ValueError, match="empty"):
        bar.add_fibres((1, 0, 0), [])


def test_cables_pull(free):
    bar = free.add_soft_body(bf.Mesh.box((1, 0.2, 0.2), (10, 2, 2)), bf.Material(young_modulus=1e5))
    nodes = np.flatnonzero(np.all(bar.positions[:, 1:] == 0, axis=1))
    handle = bar.add_cable(nodes, tension=50)
    free.step(200)
    report = bar.actuators[0]
    assert report["kind"] == "cable" and report["length"] < 1 and report["tension"] == 50
    bar.set_cable_tension(handle, 0)
    elastic = bar.add_cable(nodes, stiffness=100, rest_length=0.9)
    bar.set_cable_rest_length(elastic, 0.8)
    with pytest.raises(ValueError):
        bar.add_cable(nodes[:1], tension=1)
    with pytest.raises(ValueError, match="tension"):
        bar.set_cable_tension(handle, -1)


def hollow():
    """A cube with a cavity in its middle."""
    mesh = bf.Mesh.box((1, 1, 1), (5, 5, 5))
    middles = mesh.positions[mesh.tets].mean(axis=1)
    inside = np.all(np.abs(middles - 0.5) < 0.1, axis=1)
    kept = mesh.tets[~inside]
    used = np.unique(kept)
    return bf.Mesh(mesh.positions[used], np.searchsorted(used, kept))


def test_chambers_inflate(free):
    body = free.add_soft_body(hollow(), bf.Material(young_modulus=1e5))
    handle = body.add_chamber(pressure=0)
    free.step(2)
    before = body.actuators[0]["volume"]
    assert np.isclose(before, 0.2**3, rtol=1e-3)
    body.set_chamber_pressure(handle, 2e4)
    free.step(100)
    assert body.actuators[0]["volume"] > 1.05 * before and body.actuators[0]["pressure"] == 2e4
    body.seal_chamber(handle)
    body.set_chamber_gas(handle, 101325 * before)
    free.step(200)
    assert np.isclose(body.actuators[0]["volume"], before, rtol=0.05)
    with pytest.raises(IndexError, match="cavity is 1"):
        body.add_chamber(cavity=1)
    with pytest.raises(ValueError):
        body.add_chamber([[0, 1, 2]])


@pytest.mark.parametrize("use", [lambda b: b.set_activation(77, 0), lambda b: b.set_chamber_pressure(77, 0),
                                 lambda b: b.set_cable_tension(77, 0), lambda b: b.set_expansion(77, 0),
                                 lambda b: b.set_spring_target(77, (0, 0, 0)), lambda b: b.seal_chamber(77)])
def test_foreign_handles_are_refused(floating, use):
    with pytest.raises(ValueError):
        use(floating)


def test_pieces_are_welded_and_break(world):
    world.add_rigid_body(bf.Shape.plane())
    body = world.add_soft_body(cube_mesh(4), bf.Material.rubber(), name="cube")
    mass = body.mass
    labels = (body.positions[body.tets].mean(axis=1)[:, 1] > 0.2).astype(int)
    lower, upper = body.cut(labels, bf.Material.rubber())
    assert lower.name == "cube.0" and np.isclose(lower.mass + upper.mass, mass)
    with pytest.raises(RuntimeError, match="removed"):
        body.positions
    weld = upper.weld(lower, break_stress=2e3)
    world.step(30)
    report = upper.welds[0]
    assert report["handle"] == weld and report["other"] == lower.index and report["nodes"] == 25
    assert np.isclose(report["area"], 0.16)
    upper.velocities = np.tile((0, 5.0, 0), (upper.node_count, 1))
    world.step(30)
    assert upper.welds == [] and world.weld_breaks[-1]["left"] == 0
    assert world.weld_breaks[-1]["body"] == upper.index
    with pytest.raises(ValueError):
        upper.weld(lower)  # no common face any more


def test_voronoi_labels_and_bad_labels(floating):
    labels = floating.voronoi_labels(3, seed=2)
    assert labels.shape == (40,) and set(labels) <= {0, 1, 2}
    assert np.array_equal(labels, floating.voronoi_labels(3, seed=2))
    for bad, kind in ((labels[1:], ValueError), (labels.astype(float), TypeError)):
        with pytest.raises(kind):
            floating.cut(bad, bf.Material())
    for material in (None, "rubber"):
        with pytest.raises(TypeError, match="Material"):
            floating.cut(labels, material)
    floating.world.step()


def test_weak_bodies_split(free):
    bar = free.add_soft_body(bf.Mesh.box((1, 0.2, 0.2), (10, 2, 2)), bf.Material(young_modulus=1e5))
    bar.set_strength(2e3, max_cracks=10)
    x = bar.positions
    ends = np.flatnonzero((x[:, 0] == 0) | (x[:, 0] == 1))
    before = bar.node_count
    for k in range(60):
        bar.set_targets(ends, x[ends] * (1 + 0.002 * k, 1, 1))
        free.step()
    assert bar.node_count > before
    split = free.splits[0]
    assert split["body"] == bar.index and split["stress"] > 2e3 and split["area"] > 0
    assert bar.positions.shape == (bar.node_count, 3)
    with pytest.raises(ValueError, match="strength"):
        bar.positions_view
