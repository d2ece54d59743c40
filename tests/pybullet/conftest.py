# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
import pathlib
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "pybullet"))


@pytest.fixture
def pybullet():
    """pybullet in a deformable world, on a plane."""
    module = pytest.importorskip("pybullet", reason="pybullet is not built: set BULLETFEM_BULLET_SOURCE to a checkout of Bullet")
    import pybullet_data

    module.connect(module.DIRECT)
    module.resetSimulation(module.RESET_USE_DEFORMABLE_WORLD)
    module.setAdditionalSearchPath(pybullet_data.getDataPath())
    module.setGravity(0, 0, -G)
    module.loadURDF("plane.urdf")
    yield module
    module.disconnect()


G = 9.81
