# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Worlds and their bodies: names, removal, steps, callbacks and threads."""
import gc
import os
import signal
import threading
import time
import weakref

import numpy as np
import pytest

import bulletfem as bf
from conftest import cube_mesh


def heavy(kind="coupled", **settings):
    """A world whose step takes some milliseconds."""
    world = bf.World(kind, **settings)
    world.add_rigid_body(bf.Shape.plane())
    world.add_soft_body(cube_mesh(12), bf.Material.rubber())
    return world


@pytest.mark.parametrize("kind", ["coupled", "swap", "multibody"])
def test_bodies_rest_in_each_kind_of_world(kind):
    world = bf.World(kind)
    ground = world.add_rigid_body(bf.Shape.plane())
    body = world.add_soft_body(cube_mesh(low=0.001), bf.Material.rubber())
    plate = world.add_rigid_body(bf.Shape.box((0.4, 0.05, 0.4)), 5, position=(0, 0.43, 0))
    world.step(300)
    assert np.isclose(body.contact_force(ground)[1], (body.mass + 5) * 9.81, rtol=0.01)
    assert abs(plate.position[1] - 0.42) < 0.01


def test_time_counts_steps(world):
    assert world.steps == 0 and world.time == 0
    world.step(0)
    world.step(3)
    assert world.steps == 3
    assert np.isclose(world.time, 3 / 60) and np.isclose(world.step_size, 1 / 60)
    with pytest.raises(ValueError, match="n is -1"):
        world.step(-1)
    with pytest.raises(TypeError):
        world.step(1.0)


def test_steps_at_once_equal_single_ones():
    a, b = heavy(), heavy()
    a.step(10)
    for _ in range(10):
        b.step()
    assert np.array_equal(a.soft_bodies[0].positions, b.soft_bodies[0].positions)


def test_threads_give_equal_bits():
    results = []
    for threads in (1, 2, 3):
        world = heavy(threads=threads)
        world.step(30)
        results.append(world.soft_bodies[0].positions.tobytes())
    assert results[0] == results[1] == results[2]


def test_gravity_can_be_set(world):
    body = world.add_soft_body(cube_mesh())
    world.gravity = (0, 0, 2)
    assert np.array_equal(world.gravity, (0, 0, 2))
    world.step(60)
    assert np.allclose(body.velocities, (0, 0, 2), rtol=1e-6, atol=1e-9)


def test_names_and_indices_find_bodies(cube):
    world = cube.world
    assert world["cube"] == cube and cube.name == "cube"
    assert world.body(cube.index) == cube
    assert world.soft_bodies == [cube] and world.rigid_bodies == [world["ground"]]
    assert len({cube, world["cube"]}) == 1
    assert cube != world["ground"] and cube != 3
    with pytest.raises(KeyError, match="sphere"):
        world["sphere"]
    with pytest.raises(IndexError):
        world.body(5)
    with pytest.raises(ValueError, match="names must differ"):
        world.add_soft_body(cube_mesh(), name="cube")


def test_removed_bodies_raise(cube):
    world, ground = cube.world, cube.world["ground"]
    world.remove(cube)
    world.step(2)
    for use in (lambda: cube.positions, lambda: cube.wake(), lambda: cube.contacts, lambda: world.remove(cube),
                lambda: cube.set_material(bf.Material()), lambda: cube.name, lambda: cube.report):
        with pytest.raises(RuntimeError, match="SoftBody 1 was removed"):
            use()
    world.remove(ground)
    with pytest.raises(RuntimeError, match="RigidBody 0 was removed"):
        ground.position
    assert world.body(0) is None and world.soft_bodies == [] and world.rigid_bodies == []
    again = world.add_soft_body(cube_mesh(), name="cube")
    assert again.index == 2
    world.step(2)


def test_bodies_of_other_worlds_are_refused(cube):
    other = bf.World()
    rigid = other.add_rigid_body(bf.Shape.sphere(0.1), 1)
    soft = other.add_soft_body(cube_mesh())
    ground = cube.world["ground"]
    for use in (lambda: cube.world.remove(rigid), lambda: cube.anchor([0], rigid), lambda: cube.attach(0, soft, 0),
                lambda: cube.weld(soft), lambda: cube.world.add_hinge(rigid, None, (0, 0, 0), (0, 1, 0)),
                lambda: other.add_ball_joint(rigid, ground, (0, 0, 0)), lambda: cube.anchor_reaction(rigid)):
        with pytest.raises(ValueError, match="another world"):
            use()


def test_worlds_are_freed():
    world = bf.World()
    body = world.add_soft_body(cube_mesh())
    gone = weakref.finalize(world, lambda: None) if hasattr(world, "__weakref__") else None
    del world
    gc.collect()
    assert body.node_count == 27  # the body keeps its world
    assert gone is None or gone.alive


def test_after_is_called_behind_each_step(cube):
    times = []
    cube.world.step(5, after=lambda world: times.append(world.time))
    assert np.allclose(times, np.arange(1, 6) / 60)
    with pytest.raises(TypeError, match="after"):
        cube.world.step(1, after=3)


def test_after_may_change_the_world_but_not_step_it(free):
    body = free.add_soft_body(cube_mesh())

    def push(world):
        body.add_forces(np.outer(body.masses, (1.0, 0, 0)))
        with pytest.raises(RuntimeError, match="must not step"):
            world.step()

    free.step(61, after=push)
    assert np.allclose(body.velocities[:, 0], 1, rtol=1e-3)


def test_exception_of_after_ends_the_steps(cube):
    def fail(world):
        if world.steps == 3:
            raise KeyError("stop")

    with pytest.raises(KeyError, match="stop"):
        cube.world.step(10, after=fail)
    assert cube.world.steps == 3
    cube.world.step()


def test_interest_is_asked_within_steps(cube):
    asked = []

    def interest(body):
        asked.append((body.index, body.aabb.shape, body.positions.shape[1]))
        with pytest.raises(RuntimeError, match="callback"):
            body.wake()
        with pytest.raises(RuntimeError, match="callback"):
            body.world.step()
        return 0.0

    cube.world.set_interest(interest)
    cube.world.step(3)
    assert asked[0] == (cube.index, (2, 3), 3) and len(asked) == 3
    cube.world.set_interest(None)
    cube.world.step()
    assert len(asked) == 3


@pytest.mark.parametrize("result", ["much", None, 1j])
def test_interest_must_be_a_number(cube, result):
    cube.world.set_interest(lambda body: result)
    with pytest.raises(TypeError, match="interest"):
        cube.world.step(5)
    assert cube.world.steps == 1


def test_exception_of_interest_is_kept_until_the_step_is_over(cube):
    def fail(body):
        raise ZeroDivisionError("mine")

    cube.world.set_interest(fail)
    before = cube.positions
    with pytest.raises(ZeroDivisionError, match="mine"):
        cube.world.step(5)
    assert cube.world.steps == 1
    assert not np.array_equal(cube.positions, before)
    cube.world.set_interest(None)
    cube.world.step(2)


def test_steps_release_the_lock():
    world = heavy()
    world.step(2)
    count = 0
    done = threading.Event()

    def run():
        world.step(150)
        done.set()

    thread = threading.Thread(target=run)
    thread.start()
    while not done.is_set():
        count += 1
        time.sleep(0)
    thread.join()
    assert count > 10


def test_world_that_another_thread_steps_is_refused():
    world = heavy()
    body = world.soft_bodies[0]
    world.step(2)
    thread = threading.Thread(target=lambda: world.step(150))
    thread.start()
    refused = 0
    while thread.is_alive():
        for use in (lambda: body.positions, lambda: world.step(), lambda: world.contacts, lambda: world.remove(body),
                    lambda: world.add_soft_body(cube_mesh())):
            try:
                if thread.is_alive():
                    use()
            except RuntimeError as error:
                assert "another thread" in str(error)
                refused += 1
        if refused > 5:
            break
    thread.join()
    assert refused > 0
    assert np.isfinite(body.positions).all()


def test_worlds_of_two_threads_step_at_once():
    worlds = [heavy() for _ in range(2)]
    threads = [threading.Thread(target=world.step, args=(20,)) for world in worlds]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert np.array_equal(worlds[0].soft_bodies[0].positions, worlds[1].soft_bodies[0].positions)


def test_control_c_ends_the_steps():
    world = heavy()
    world.step(2)
    threading.Timer(0.05, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        world.step(100000)
    assert 2 < world.steps < 100000
    world.step()
