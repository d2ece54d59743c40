# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Batches of worlds, and the environment of them."""
import numpy as np
import pytest

import bulletfem as bf
from conftest import cube_mesh


def build(low=0.02, rubber=True, gravity=9.81):
    world = bf.World(gravity=(0, -gravity, 0))
    world.add_rigid_body(bf.Shape.plane(), name="ground")
    material = bf.Material.rubber() if rubber else bf.Material.jelly()
    world.add_soft_body(cube_mesh(low=low), material, name="cube")
    world.add_rigid_body(bf.Shape.box((0.2, 0.1, 0.2)), 1, position=(0, 0.6, 0), name="box")
    world.add_rigid_body(bf.Shape.box((0.1, 0.1, 0.1)), position=(2, 0, 0), kinematic=True, name="plate")
    return world


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_worlds_of_a_batch_have_the_bits_of_a_single_one(threads):
    alone = build()
    batch = bf.Batch(build, 4, threads=threads)
    assert len(batch) == 4 and batch.threads == threads
    places, speeds = batch.node_positions("cube"), batch.node_velocities(1)
    boxes = batch.rigid_positions("box")
    assert places.shape == (4, alone["cube"].node_count, 3) and boxes.shape == (4, 3)
    for _ in range(40):
        alone.step()
        batch.step()
        for k in range(4):
            assert np.array_equal(places[k], alone["cube"].positions)
            assert np.array_equal(speeds[k], alone["cube"].velocities)
            assert np.array_equal(boxes[k], alone["box"].position)
    assert batch.rigid_velocities("box").shape == (4, 3)
    assert [world.steps for world in batch.worlds] == [40] * 4


def test_arrays_are_memory_of_the_batch_and_read_only():
    batch = bf.Batch(build, 2)
    places = batch.node_positions("cube")
    assert np.shares_memory(places, batch.node_positions(1)) and not places.flags.writeable
    before = places.copy()
    batch.step(3)
    assert not np.array_equal(places, before)
    world = batch.worlds[1]
    world["cube"].positions = before[1] + 1
    assert not np.array_equal(places[1], before[1] + 1)
    batch.refresh()
    assert np.array_equal(places[1], before[1] + 1)
    with pytest.raises(ValueError):
        places[0, 0, 0] = 1
    del batch, world
    assert np.isfinite(places).all()  # the array keeps its batch


def test_masked_worlds_are_reset():
    batch = bf.Batch(build, 3, threads=2)
    places = batch.node_positions("cube")
    start = places.copy()
    batch.step(20)
    fallen = places.copy()
    batch.reset([False, True, False])
    assert np.array_equal(places[1], start[1]) and np.array_equal(places[0], fallen[0])
    assert [world.steps for world in batch.worlds] == [20, 0, 20]
    batch.step(20)
    assert np.array_equal(places[1], fallen[1])
    state = batch.worlds[1].save_state()
    batch.reset(states=state)
    assert np.array_equal(places, fallen[[1, 1, 1]])
    batch.reset(states=batch.save_states())
    batch.reset()
    assert np.array_equal(places, start)


def test_gravity_forces_and_places_differ_by_world():
    batch = bf.Batch(build, 2, low=1.0)
    gravity = np.array([[0, -9.81, 0], [3, 0, 0]])
    batch.set_gravity(gravity)
    batch.step(10)
    time = 10 / 60
    assert np.allclose(batch.node_velocities("cube").mean(axis=1), gravity * time, rtol=1e-6, atol=1e-9)
    batch.reset()
    batch.set_gravity(np.zeros((2, 3)))
    forces = np.zeros(batch.node_positions("cube").shape)
    forces[1, :, 0] = 6
    batch.add_forces("cube", forces)
    batch.step()
    mass = batch.worlds[0]["cube"].masses
    momentum = np.einsum("kni,n->ki", batch.node_velocities("cube"), mass)
    assert np.allclose(momentum, [[0, 0, 0], [6 * len(mass) / 60, 0, 0]], atol=1e-9)
    batch.move("plate", [[2, 1, 0], [3, 0, 0]])
    batch.step()
    assert np.array_equal(batch.rigid_positions("plate"), [[2, 1, 0], [3, 0, 0]])


def test_materials_differ_by_world():
    materials = [bf.Material(young_modulus=young, poisson_ratio=0.3, density=1000) for young in (2e4, 4e4, 8e4)]
    batch = bf.Batch(build, 3)
    batch.set_materials("cube", materials)
    path = batch.rollout(60, "cube", every=20)
    assert path.shape == (3, 3, batch.worlds[0]["cube"].node_count, 3)
    heights = np.ptp(path[-1, :, :, 1], axis=1)
    assert (np.diff(heights) > 0).all()  # the softest cube is pressed most
    batch.reset()
    assert np.array_equal(batch.rollout(60, "cube", every=20), path)
    alone = build()
    alone["cube"].set_material(materials[1])
    alone["cube"].refactor()
    alone.step(60)
    assert np.allclose(path[-1, 1], alone["cube"].positions, atol=1e-5)


def test_rollouts_call_before_each_step():
    batch = bf.Batch(build, 2, low=1.0, gravity=0)
    calls = []
    path = batch.rollout(4, "cube", every=2, before=calls.append)
    assert calls == [0, 1, 2, 3] and path.shape[:2] == (2, 2)
    with pytest.raises(ValueError, match="every"):
        batch.rollout(4, "cube", every=0)


def test_other_builders_are_refused():
    calls = []

    def growing():
        calls.append(0)
        world = build()
        if len(calls) > 1:
            world.add_rigid_body(bf.Shape.sphere(0.1), position=(9, 0, 0))
        return world

    with pytest.raises(ValueError, match="differ"):
        bf.Batch(growing, 2)
    one = build()
    with pytest.raises(ValueError, match="twice"):
        bf.Batch(lambda: one, 2)
    with pytest.raises(RuntimeError, match="must not build another"):
        bf.Batch(lambda: bf.Batch(build, 1), 1)
    with pytest.raises(ValueError, match="n is 0"):
        bf.Batch(build, 0)
    with pytest.raises(ValueError, match="threads"):
        bf.Batch(build, 1, threads=-1)
    bf.Batch(build, 1)  # the refusals left nothing behind


@pytest.mark.parametrize("call, error", [
    (lambda b: b.step(-1), ValueError),
    (lambda b: b.step(1.5), TypeError),
    (lambda b: b.node_positions("nobody"), KeyError),
    (lambda b: b.node_positions(99), IndexError),
    (lambda b: b.node_positions(1.0), TypeError),
    (lambda b: b.node_positions("box"), ValueError),
    (lambda b: b.rigid_positions("cube"), ValueError),
    (lambda b: b.set_gravity((0, 0, 0)), ValueError),
    (lambda b: b.set_gravity([[0, np.nan, 0]] * 2), ValueError),
    (lambda b: b.add_forces("cube", np.zeros((2, 3, 3))), ValueError),
    (lambda b: b.add_forces("cube", np.full((2, 27, 3), 1e20)), ValueError),
    (lambda b: b.add_forces("box", np.zeros((2, 1, 3))), (ValueError, RuntimeError)),
    (lambda b: b.move("box", np.zeros((2, 3))), ValueError),
    (lambda b: b.reset([True]), ValueError),
    (lambda b: b.reset([1, 0]), ValueError),
    (lambda b: b.reset(states=[b""]), ValueError),
    (lambda b: b.reset(states=b"nonsense"), ValueError),
    (lambda b: b.restore_states([1, 2]), TypeError),
    (lambda b: b.set_materials("cube", []), ValueError),
    (lambda b: b.contact_forces("box", "cube"), (ValueError, RuntimeError)),
])
def test_bad_input_is_refused(call, error):
    batch = bf.Batch(build, 2)
    with pytest.raises(error):
        call(batch)
    batch.step()


def test_environments_squeeze_and_lift():
    environment = bf.SqueezeAndLift(3, length=160)
    observations, _ = environment.reset(seed=1)
    assert observations.shape == (3, 5) and environment.single_action_space.shape == (2,)
    actions = np.zeros((3, 2))
    heights = []
    for k in range(140):
        actions[:, 0] = [0.5, 0.5, 0] if k < 16 else 0  # the third never closes
        actions[:, 1] = 0.6 if k >= 16 else 0
        observations, rewards, terminations, truncations, _ = environment.step(actions)
        heights.append(observations[:, 2])
        if terminations.any():
            break
    assert terminations.tolist() == [True, True, False] and not truncations.any()
    assert rewards[0] >= 1 and abs(rewards[2]) < 0.1
    assert np.array_equal(observations[0], observations[1])
    observations, rewards, terminations, _, _ = environment.step(actions)  # the next step resets
    assert rewards[0] == 0 and abs(observations[0, 2] - heights[0][0]) < 0.01 and not terminations.any()


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
def test_episodes_end_by_the_autoreset_mode(mode):
    environment = bf.SqueezeAndLift(2, length=3, autoreset_mode=mode)
    first, _ = environment.reset()
    actions = np.zeros((2, 2))
    for _ in range(2):
        assert not environment.step(actions)[3].any()
    observations, _, _, truncations, infos = environment.step(actions)
    assert truncations.all()
    if mode == "SameStep":
        assert np.array_equal(observations, first) and infos["_final_obs"].all()
        assert not np.array_equal(infos["final_obs"], first)
    elif mode == "NextStep":
        assert not np.array_equal(observations, first)
        observations, rewards, _, truncations, _ = environment.step(actions + 1)
        assert np.array_equal(observations, first) and not rewards.any() and not truncations.any()
    else:
        with pytest.raises(RuntimeError, match="reset_mask"):
            environment.step(actions)
        observations, _ = environment.reset(options={"reset_mask": np.array([True, True])})
        assert np.array_equal(observations, first)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
def test_gymnasium_takes_the_environment(mode):
    """Its own wrapper counts the rewards and lengths of episodes."""
    vector = pytest.importorskip("gymnasium.vector", reason="gymnasium is not installed")
    from gymnasium.wrappers.vector import RecordEpisodeStatistics

    environment = bf.SqueezeAndLift(2, length=3, autoreset_mode=vector.AutoresetMode(mode))
    assert isinstance(environment, vector.VectorEnv)
    counted = RecordEpisodeStatistics(environment)
    observations, _ = counted.reset(seed=1)
    assert observations in counted.observation_space
    for _ in range(3):
        observations, _, _, truncations, infos = counted.step(counted.action_space.sample())
        assert observations in counted.observation_space
    assert truncations.all() and infos["episode"]["l"].tolist() == [3, 3]
    if mode == "Disabled":
        counted.reset(options={"reset_mask": truncations})
    for _ in range(3 + (mode == "NextStep")):
        truncations = counted.step(counted.action_space.sample())[3]
    assert truncations.all() and list(counted.length_queue) == [3, 3, 3, 3]
    counted.close()


def test_unusable_environments_are_refused():
    for settings in ({"autoreset_mode": "Never"}, {"length": 0}, {"goal": 0}):
        with pytest.raises(ValueError):
            bf.SqueezeAndLift(1, **settings)
    with pytest.raises(ValueError, match="actions"):
        bf.SqueezeAndLift(2).step(np.zeros(2))
