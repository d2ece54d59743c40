# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""States as bytes, and worlds that are pickled."""
import pickle
import subprocess
import sys

import numpy as np
import pytest

import bulletfem as bf
from conftest import ROOT, cube_mesh


def heap(kind="coupled", boxes=3, gravity=9.81):
    """A soft cube under boxes that touch each other."""
    world = bf.World(kind, gravity=(0, -gravity, 0))
    world.add_rigid_body(bf.Shape.plane(), name="ground")
    world.add_soft_body(cube_mesh(low=0.001), bf.Material.rubber(), name="cube")
    for k in range(boxes):
        world.add_rigid_body(bf.Shape.box((0.2, 0.1, 0.2)), 1, position=(0.05 * k, 0.55 + 0.21 * k, 0.02), name=f"box{k}")
    return world


def bits(world):
    bodies = [body.positions.tobytes() + body.velocities.tobytes() for body in world.soft_bodies]
    return b"".join(bodies + [body.position.tobytes() + body.velocity.tobytes() for body in world.rigid_bodies])


def bits_of_steps(world, steps=40):
    result = []
    world.step(steps, after=lambda each: result.append(bits(each)))
    return result


@pytest.mark.parametrize("kind", ["coupled", "swap", "multibody"])
def test_restored_worlds_go_on_with_equal_bits(kind):
    world, twin, other = heap(kind), heap(kind), heap(kind)
    world.step(60)
    twin.step(60)
    state = world.save_state()
    expected = bits_of_steps(twin)
    assert bits_of_steps(world) == expected  # saving changes nothing
    world.restore_state(state)
    assert world.steps == 60 and world.save_state() == state
    assert bits_of_steps(world) == expected
    other.restore_state(state)
    assert other.steps == 60 and bits_of_steps(other) == expected


def test_made_worlds_are_pickled():
    world = bf.make(heap, kind="swap", boxes=2)
    world.step(50)
    data = pickle.dumps(world)
    again = pickle.loads(data)
    assert again.steps == 50 and len(again.rigid_bodies) == 3
    assert bits_of_steps(again) == bits_of_steps(world)
    assert pickle.loads(pickle.dumps(again)).steps == 90


CONTINUE = """
import pickle, sys, hashlib
sys.path[:0] = sys.argv[1:2]
from test_state import bits_of_steps
world = pickle.load(open(sys.argv[2], "rb"))
print(hashlib.sha256(b"".join(bits_of_steps(world))).hexdigest())
"""


@pytest.mark.parametrize("scene", [None, "scenes/press.json", "tower/tower.json"])
def test_pickles_go_on_with_equal_bits_in_another_process(tmp_path, scene):
    import hashlib
    world = bf.make(heap) if scene is None else bf.World.from_scene(ROOT / "demos" / scene)
    world.step(60)
    (tmp_path / "world").write_bytes(pickle.dumps(world))
    expected = hashlib.sha256(b"".join(bits_of_steps(world))).hexdigest()
    here = str(ROOT / "tests" / "python")
    command = [sys.executable, "-c", CONTINUE, here, str(tmp_path / "world")]
    assert subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip() == expected


def test_worlds_without_a_recipe_say_why_they_are_not_pickled(world):
    with pytest.raises(TypeError, match="bulletfem.make"):
        pickle.dumps(world)
    with pytest.raises(TypeError, match="must return a World"):
        bf.make(lambda: 3)


def test_other_worlds_are_refused():
    world = heap()
    world.step(3)
    before = bits(world)
    for other, message in ((heap(boxes=2), "objects"), (heap("swap", boxes=4), "objects")):
        other.step()
        with pytest.raises(ValueError, match=message):
            world.restore_state(other.save_state())
    other = heap()
    other["cube"].set_material(bf.Material.jelly())
    other.step()
    with pytest.raises(ValueError, match="material"):
        world.restore_state(other.save_state())
    assert bits(world) == before and world.steps == 3


@pytest.mark.parametrize("cut", [0, 7, 8, 30, 500])
def test_bad_bytes_are_refused(cut):
    world = heap()
    state = world.save_state()
    with pytest.raises(ValueError):
        world.restore_state(state[:cut])
    with pytest.raises(ValueError):
        world.restore_state(state[:cut] + bytes([state[cut] ^ 255]) + state[cut + 1:])
    world.restore_state(state)


@pytest.mark.parametrize("field, value, message", [(1, 12, "version 12"), (2, 4, "btScalar of 4 bytes"), (0, 0x04030201, "byte order")])
def test_states_of_other_versions_and_precisions_are_refused(field, value, message):
    """In Bullet's part, behind the count of steps (16 bytes) and a mark of 8: byte order, version, size of a btScalar."""
    world = heap()
    state = bytearray(world.save_state())
    at = 16 + 8 + 4 * field
    assert state[16:23] == b"BullFEM"
    state[at:at + 4] = value.to_bytes(4, sys.byteorder)
    with pytest.raises(ValueError, match=message):
        world.restore_state(bytes(state))


@pytest.mark.parametrize("state", [None, 3, "text", bytearray(100), np.zeros(100)])
def test_only_bytes_are_states(world, state):
    with pytest.raises(TypeError, match="save_state"):
        world.restore_state(state)


def test_states_are_refused_within_steps():
    world = heap()
    seen = []

    def interest(body):
        for call in (world.save_state, lambda: world.restore_state(b"")):
            try:
                call()
            except RuntimeError as error:
                seen.append(str(error))
        return 1

    world.set_interest(interest)
    world.step(2)
    assert seen and all("callback" in text for text in seen)
