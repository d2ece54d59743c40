# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Soft bodies of finite elements in Bullet's worlds, in double precision.

All quantities are in SI units. Vectors are arrays (3,), orientations quaternions (x, y, z, w). Arrays that are returned
are fresh, contiguous and of float64 or int32; those named *_view share the memory of Bullet's nodes.
"""
from __future__ import annotations

from typing import TYPE_CHECKING as _TYPE_CHECKING, Any as _Any

from ._core import (
    BakedBody,
    ElementMaterials,
    Joint,
    Material,
    Mesh,
    RigidBody,
    Robot,
    Shape,
    SoftBody,
    StepReport,
    World,
    __version__,
    contact_dtype,
    has_pictures,
    touch_dtype,
)
from ._batch import Batch
from ._fit import Fit, fit, map
from ._png import png as _png
from ._recipe import make, reduce as _reduce

if _TYPE_CHECKING:
    from ._environment import SqueezeAndLift


def __getattr__(name: str) -> _Any:
    """Imports the environment when it is first named, since gymnasium takes longer than this module."""
    if name != "SqueezeAndLift":
        raise AttributeError(f"module 'bulletfem' has no attribute {name!r}")
    from ._environment import SqueezeAndLift

    globals()[name] = SqueezeAndLift
    return SqueezeAndLift


def _repr_png_(self: World) -> bytes | None:
    """A picture of the world, for notebooks; None if the module was built without pictures."""
    return _png(self.render()) if has_pictures else None


setattr(World, "_repr_png_", _repr_png_)
setattr(World, "__reduce__", _reduce)

__all__ = [
    "BakedBody",
    "Batch",
    "ElementMaterials",
    "Fit",
    "Joint",
    "Material",
    "Mesh",
    "RigidBody",
    "Robot",
    "Shape",
    "SoftBody",
    "SqueezeAndLift",
    "StepReport",
    "World",
    "__version__",
    "contact_dtype",
    "fit",
    "has_pictures",
    "make",
    "map",
    "touch_dtype",
]
