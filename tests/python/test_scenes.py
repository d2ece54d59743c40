# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Worlds of JSON scenes, and pictures."""
import json
import zlib

import numpy as np
import pytest

import bulletfem as bf
from conftest import ROOT

SCENES = ROOT / "demos" / "scenes"


def test_scenes_move():
    world = bf.World.from_scene(SCENES / "press.json")
    assert world.soft_bodies and world.rigid_bodies
    body = world.soft_bodies[0]
    before = body.positions
    world.step(30)
    assert world.steps == 30
    assert np.isfinite(body.positions).all() and not np.array_equal(body.positions, before)
    assert world[body.name] == body


def test_scenes_are_repeatable():
    bits = []
    for _ in range(2):
        world = bf.World.from_scene(SCENES / "beam.json")
        world.step(20)
        bits.append(world.soft_bodies[0].positions.tobytes())
    assert bits[0] == bits[1]


def test_bodies_join_scenes_but_do_not_leave_them():
    world = bf.World.from_scene(SCENES / "press.json")
    ball = world.add_soft_body(bf.Mesh.sphere(0.1, 6), bf.Material.rubber(), position=(3, 3, 0))
    box = world.add_rigid_body(bf.Shape.box((0.1, 0.1, 0.1)), 1, position=(5, 3, 0))
    world.step(5)
    assert ball.velocities[:, 1].mean() < 0 and box.velocity[1] < 0
    for body in (world.soft_bodies[0], world.rigid_bodies[0]):
        with pytest.raises(ValueError, match="scene"):
            world.remove(body)
    world.remove(ball)
    world.step()
    world.gravity = (0, 0, 0)
    assert np.array_equal(world.gravity, (0, 0, 0))


@pytest.mark.parametrize("text", ["{", "[]", '{"softBodies": 3}', '{"step": -1}'])
def test_bad_scenes_are_refused(tmp_path, text):
    (tmp_path / "bad.json").write_text(text)
    with pytest.raises(RuntimeError, match="bad.json"):
        bf.World.from_scene(tmp_path / "bad.json")


def test_missing_scenes_are_named():
    with pytest.raises(RuntimeError, match="missing.json"):
        bf.World.from_scene("missing.json")
    with pytest.raises(TypeError):
        bf.World.from_scene(3)


def test_views_of_bodies_that_split_are_refused(tmp_path):
    scene = {"softBodies": [{"name": "a", "mesh": {"box": [1, 1, 1], "tets": 200}, "fracture": {"tension": 1e5}}]}
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    body = bf.World.from_scene(tmp_path / "scene.json").soft_bodies[0]
    with pytest.raises(ValueError, match="strength"):
        body.positions_view


def rendered(world, *arguments, **settings):
    try:
        return world.render(*arguments, **settings)
    except RuntimeError as error:
        pytest.skip(str(error))


def test_pictures_show_bodies(cube):
    cube.world.add_rigid_body(bf.Shape.sphere(0.1), position=(0.5, 0.1, 0))
    image = rendered(cube.world, 160, 120, eye=(1, 1, 2), target=(0, 0.2, 0))
    assert image.shape == (120, 160, 3) and image.dtype == np.uint8
    assert image[60, 80].tolist() != image[2, 2].tolist()
    assert np.array_equal(image, cube.world.render(160, 120, eye=(1, 1, 2), target=(0, 0.2, 0)))
    assert not np.array_equal(image, cube.world.render(160, 120, eye=(1, 1, 2), target=(0, 0.2, 0), stress=True))
    assert cube.world.render(160, 120).shape == (120, 160, 3)


@pytest.mark.parametrize("settings", [{"width": 0}, {"height": 100000}, {"eye": (0, 0)}, {"eye": (1, 1, 1), "target": (1, 1, 1)}])
def test_unusable_pictures_are_refused(cube, settings):
    rendered(cube.world, 16, 16)
    with pytest.raises(ValueError):
        cube.world.render(**settings)


def test_an_empty_world_has_a_picture(world):
    assert rendered(world, 32, 32).shape == (32, 32, 3)


def test_notebooks_get_png_files(cube):
    rendered(cube.world, 16, 16)
    data = cube.world._repr_png_()
    assert data.startswith(b"\x89PNG") and b"IEND" in data


def test_png_files_keep_their_pixels():
    from bulletfem._png import png
    pixels = np.random.default_rng(1).integers(0, 256, (5, 7, 3), dtype=np.uint8)
    data = png(pixels)
    length = int.from_bytes(data[33:37], "big")
    rows = np.frombuffer(zlib.decompress(data[41:41 + length]), np.uint8).reshape(5, 22)
    assert not rows[:, 0].any() and np.array_equal(rows[:, 1:].reshape(5, 7, 3), pixels)
