# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
import pathlib

import numpy as np
import pytest

import bulletfem as bf

ROOT = pathlib.Path(__file__).resolve().parents[2]
G = 9.81


def cube_mesh(cells=2, edge=0.4, low=0.0):
    """A cube whose lower face is at height `low`."""
    return bf.Mesh.box((edge,) * 3, (cells,) * 3, (-edge / 2, low, -edge / 2))


@pytest.fixture
def world():
    return bf.World()


@pytest.fixture
def free():
    """A world without gravity."""
    return bf.World(gravity=(0, 0, 0))


@pytest.fixture
def cube(world):
    """A rubber cube on a plane."""
    world.add_rigid_body(bf.Shape.plane(), name="ground")
    return world.add_soft_body(cube_mesh(low=0.001), bf.Material.rubber(), name="cube")


@pytest.fixture
def floating(free):
    """A soft cube at rest without gravity."""
    return free.add_soft_body(cube_mesh(), bf.Material.rubber())


def top_nodes(body):
    y = body.positions[:, 1]
    return np.flatnonzero(y > y.max() - 1e-9)


def bottom_nodes(body):
    y = body.positions[:, 1]
    return np.flatnonzero(y < y.min() + 1e-9)
