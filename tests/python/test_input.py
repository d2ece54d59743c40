# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Bad input raises exceptions with our messages."""
import re

import numpy as np
import pytest

import bulletfem as bf
from conftest import cube_mesh

CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
TET = np.array([[0, 1, 2, 3]])

BAD_POSITIONS = [
    (CORNERS.astype(complex), TypeError, "complex128"),
    (CORNERS.astype(object), TypeError, "object"),
    (CORNERS.astype(">f8"), TypeError, "byte order"),
    (CORNERS.astype(str), TypeError, "<U"),
    (CORNERS.astype(bool), TypeError, "bool"),
    (CORNERS[:, :2], ValueError, r"shape \(4, 2\)"),
    (CORNERS.ravel(), ValueError, r"shape \(12,\)"),
    (CORNERS[None], ValueError, r"shape \(1, 4, 3\)"),
    (np.where(CORNERS == 1, np.nan, 0), ValueError, "nan"),
    (np.where(CORNERS == 1, np.inf, 0), ValueError, "inf"),
    (CORNERS * 1e7, ValueError, "1e"),
    ("abc", TypeError, "positions"),
    (None, TypeError, "positions"),
    ([[0, 0, 0], [1, 0]], TypeError, "positions"),
    ({"a": 1}, TypeError, "positions"),
]

BAD_TETS = [
    (TET.astype(float), TypeError, "float64"),
    (TET + 0.5, TypeError, "float64"),
    (TET.astype(complex), TypeError, "complex128"),
    (TET.astype(object), TypeError, "object"),
    (TET.astype(">i4"), TypeError, "byte order"),
    (TET.astype(np.uint64), TypeError, "uint64"),
    (TET.astype(bool), TypeError, "bool"),
    (TET[:, :3], ValueError, "shape"),
    (TET + 1, IndexError, r"has 4 at 3"),
    (TET - 1, IndexError, r"has -1 at 0"),
    (TET * 2**33, IndexError, "must be in"),
]


@pytest.mark.parametrize("positions,kind,text", BAD_POSITIONS)
def test_bad_positions_are_refused(positions, kind, text):
    with pytest.raises(kind, match=text):
        bf.Mesh(positions, TET)


@pytest.mark.parametrize("tets,kind,text", BAD_TETS)
def test_bad_indices_are_refused(tets, kind, text):
    with pytest.raises(kind, match=text):
        bf.Mesh(CORNERS, tets)


@pytest.mark.parametrize("kind", [np.float32, np.float16, np.int8, np.int64, np.uint16])
def test_other_real_types_are_taken(kind):
    mesh = bf.Mesh(CORNERS.astype(kind), TET.astype(np.uint8))
    assert mesh.positions.dtype == np.float64
    assert np.array_equal(mesh.positions, CORNERS)


def test_lists_and_strided_arrays_are_taken():
    strided = np.zeros((4, 6))
    strided[:, ::2] = CORNERS
    assert np.array_equal(bf.Mesh(strided[:, ::2], TET.tolist()).positions, CORNERS)
    assert np.array_equal(bf.Mesh(np.asfortranarray(CORNERS), TET).positions, CORNERS)


@pytest.mark.parametrize("tets", [np.zeros((0, 4), int), [], [[0, 1, 2, 2]], [[0, 1, 2, 3], [0, 1, 2, 3]]])
def test_unusable_meshes_are_refused(tets):
    with pytest.raises(ValueError):
        bf.Mesh(CORNERS, tets)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -1.0, 1e300])
def test_numbers_out_of_range_are_refused(world, value):
    with pytest.raises(ValueError, match="mass is"):
        world.add_rigid_body(bf.Shape.sphere(1), value)


@pytest.mark.parametrize("value", ["1", None, 1j, np.complex64(1), np.bool_(True), np.ones(1), np.array(1.0), [1], object()])
def test_other_objects_are_no_numbers(world, value):
    with pytest.raises(TypeError, match="mass is .*: it must be a real number"):
        world.add_rigid_body(bf.Shape.sphere(1), value)


def test_numpy_scalars_are_numbers(world):
    assert world.add_rigid_body(bf.Shape.sphere(np.float32(0.5)), np.int64(2)).mass == 2


@pytest.mark.parametrize("orientation", [(0, 0, 0, 0), (0, 0, 1), (0, 0, 0, np.nan)])
def test_bad_quaternions_are_refused(world, orientation):
    with pytest.raises(ValueError, match="orientation"):
        world.add_rigid_body(bf.Shape.sphere(1), orientation=orientation)


def test_quaternions_are_normalized(world):
    body = world.add_rigid_body(bf.Shape.sphere(1), orientation=(0, 0, 2, 2))
    assert np.allclose(body.orientation, [0, 0, np.sqrt(0.5), np.sqrt(0.5)])


@pytest.mark.parametrize("text", ["monolithic", "", "COUPLED"])
def test_unknown_kinds_of_worlds_are_refused(text):
    with pytest.raises(ValueError, match="coupled"):
        bf.World(text)


@pytest.mark.parametrize(
    "values", [{"step": 0}, {"step": 2}, {"tolerance": 1}, {"threads": -1}, {"threads": 1000}, {"max_contacts": 0},
               {"refactoring": "x"}, {"gravity": (0, 0)}, {"gravity": (0, 0, np.nan)}, {"contact_damping": 2}])
def test_settings_out_of_range_are_refused(values):
    with pytest.raises(ValueError):
        bf.World(**values)


def test_objects_of_wrong_classes_are_refused(world):
    with pytest.raises(TypeError, match="mesh is 3"):
        world.add_soft_body(3)
    with pytest.raises(TypeError, match="material is 'rubber'"):
        world.add_soft_body(cube_mesh(), "rubber")
    with pytest.raises(TypeError):
        world.add_rigid_body("box")
    with pytest.raises(TypeError):
        world.remove(world)


@pytest.mark.parametrize("name", ["SoftBody", "RigidBody", "Joint", "StepReport", "Shape", "BakedBody"])
def test_classes_without_constructor_are_not_made(name):
    with pytest.raises(TypeError, match="No constructor"):
        getattr(bf, name)()


def test_messages_have_no_pointers(world):
    with pytest.raises(ValueError) as error:
        world.add_soft_body(cube_mesh(), position=(1, 2))
    assert not re.search("0x[0-9a-f]+", str(error.value))
