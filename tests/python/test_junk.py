# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Every call of the module with unusable arguments: it raises an exception or does its work, and the world goes on."""
import inspect
import itertools

import numpy as np
import pytest

import bulletfem as bf
from conftest import cube_mesh

JUNK = [None, -1, 2**40, float("nan"), 1e300, "x", b"\0" * 100, [], [[0, 1, 2]], np.full((2, 3), np.nan), np.zeros((3, 3), object),
        np.zeros(4, ">i4"), {"a": 1}, object()]
REFUSALS = (TypeError, ValueError, IndexError, KeyError, RuntimeError, AttributeError)
# Calls that write files of the name that they get, and those that work for long if they get a large number.
LEFT_OUT = {"step", "rollout", "save", "bake", "Batch", "SqueezeAndLift"}


def scene():
    world = bf.World("multibody")
    world.add_rigid_body(bf.Shape.plane(), name="ground")
    cube = world.add_soft_body(cube_mesh(low=0.001), bf.Material.rubber(), name="cube")
    box = world.add_rigid_body(bf.Shape.box((0.2, 0.2, 0.2)), 1, position=(1, 0.1, 0))
    hinge = world.add_hinge(box, None, (0, 0, 0), (0, 1, 0))
    world.step(3)
    return world, [world, cube, box, hinge, cube.report, bf.Material(), bf.Mesh.box((1, 1, 1), (1, 1, 1)), bf.Shape.sphere(1),
                   bf.Batch(lambda: heap(), 2)]


def heap():
    world = bf.World()
    world.add_rigid_body(bf.Shape.plane(), name="ground")
    world.add_soft_body(cube_mesh(low=0.001), name="cube")
    return world


def calls(things):
    """Methods of the things, setters of their properties, constructors and makers of classes."""
    for thing in things:
        for name, member in vars(type(thing)).items():
            if name.startswith("_") or name in LEFT_OUT:
                continue
            if isinstance(member, property):
                yield f"{type(thing).__name__}.{name} =", lambda value, t=thing, n=name: setattr(t, n, value)
            elif callable(getattr(thing, name, None)):
                yield f"{type(thing).__name__}.{name}", getattr(thing, name)
    for name in bf.__all__:
        if inspect.isclass(getattr(bf, name)) and name not in LEFT_OUT:
            yield name, getattr(bf, name)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_junk_is_refused_or_borne(count):
    world, things = scene()
    tried = 0
    for name, call in calls(things):
        for values in itertools.product(JUNK, repeat=count) if count == 1 else zip(*(JUNK[k:] + JUNK[:k] for k in range(count))):
            tried += 1
            try:
                call(*values)
            except REFUSALS as refusal:
                assert str(refusal), name
            except Exception as other:  # another class: name the call
                pytest.fail(f"{name}{values} raises {other!r}")
    assert tried > 1000
    world.step(3)
    for body in world.soft_bodies:
        assert np.isfinite(body.positions).all()


def test_none_is_no_object():
    """Methods and properties of the extension's classes, called with None in place of the object."""
    from bulletfem import _core

    tried = 0
    for cls in [value for value in vars(_core).values() if inspect.isclass(value)]:
        for name, member in vars(cls).items():
            call = member.fget if isinstance(member, property) else getattr(cls, name)
            if name.startswith("__") and name != "__len__" or not callable(call) or isinstance(vars(cls)[name], staticmethod):
                continue
            tried += 1
            with pytest.raises(REFUSALS):
                call(None)
    assert tried > 150
