# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Forks, other interpreters, and another extension with Bullet in single precision."""
import os
import subprocess
import sys
import textwrap


import pytest



SCENE = """
import os, sys, threading, time
import bulletfem as bf
def scene(**settings):
    world = bf.World(**settings)
    world.add_rigid_body(bf.Shape.plane())
    world.add_soft_body(bf.Mesh.box((.4, .4, .4), (10, 10, 10), (0, .05, 0)), bf.Material.rubber())
    return world
def wait(child):
    start = time.time()
    while time.time() - start < 60:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status)
        time.sleep(.01)
    os.kill(child, 9)
    return "hangs"
"""


def run(code):
    done = subprocess.run([sys.executable, "-c", SCENE + textwrap.dedent(code)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout.strip()


def test_worlds_work_in_a_forked_process():
    assert run("""
        a, b = scene(), scene()
        a.step(20), b.step(20)
        child = os.fork()
        if child == 0:
            a.step(20), scene().step(2)
            os._exit(hash(a.soft_bodies[0].positions.tobytes()) % 100)
        code = wait(child)
        print("ok" if code != "hangs" else code)
        """) == "ok"


@pytest.mark.parametrize("threads", [1, 2])
def test_forked_worlds_give_equal_bits(threads):
    assert run(f"""
        a = scene(threads={threads})
        a.step(20)
        read, write = os.pipe()
        child = os.fork()
        a.step(20)
        bits = a.soft_bodies[0].positions.tobytes()
        if child == 0:
            os.write(write, bits)
            os._exit(0)
        assert wait(child) == 0
        print(os.read(read, len(bits)) == bits)
        """) == "True"


def test_fork_while_a_thread_steps_names_spawn():
    assert run("""
        a, b = scene(), scene()
        threading.Thread(target=lambda: a.step(400), daemon=True).start()
        time.sleep(.05)
        child = os.fork()
        if child == 0:
            refused = 0
            for use in (lambda: a.step(), lambda: a.contacts, lambda: b.step(), lambda: scene()):
                try:
                    use()
                except RuntimeError as error:
                    refused += "spawn" in str(error)
            del a, b
            os._exit(refused)
        print(wait(child))
        os._exit(0)
        """).endswith("4")


def test_fork_with_factors_in_the_background_names_spawn():
    assert run("""
        a = scene(refactoring="background")
        child = os.fork()
        if child == 0:
            try:
                a.step()
            except RuntimeError as error:
                os._exit(7 if "spawn" in str(error) else 1)
            os._exit(2)
        print(wait(child))
        """) == "7"


def test_fork_in_a_callback_is_no_loss():
    assert run("""
        a = scene()
        codes = []
        def after(world):
            if world.steps != 3:
                return
            child = os.fork()
            if child == 0:
                world.soft_bodies[0].positions
                os._exit(5)
            codes.append(wait(child))
        a.step(5, after=after)
        print(codes)
        """) == "[5]"


def test_import_is_fast():
    code = "import numpy, time; t = time.perf_counter(); import bulletfem; print(time.perf_counter() - t)"
    best = min(float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout)
               for _ in range(5))
    assert best < 0.5  # [s]; 0.05 on an idle machine


def test_only_the_initialization_is_exported():
    from bulletfem import _core
    names = subprocess.run(["nm", "-D", "--defined-only", _core.__file__], capture_output=True, text=True, check=True)
    assert [line.split()[-1] for line in names.stdout.splitlines()] == ["PyInit__core"]


FOREIGN = """
#include <LinearMath/btTransform.h>
extern "C" __attribute__((visibility("default"))) float use() { return btTransform::getIdentity().getOrigin().x(); }
"""


@pytest.fixture(scope="module")
def foreign(tmp_path_factory):
    """A library with Bullet in single precision, as pybullet is one."""
    folder = tmp_path_factory.mktemp("foreign")
    (folder / "foreign.cpp").write_text(FOREIGN)
    library = folder / "foreign.so"
    subprocess.run(["g++", "-shared", "-fPIC", "-O0", "-isystem", "/usr/include/bullet", folder / "foreign.cpp", "-o", library],
                   check=True)
    return library


@pytest.mark.skipif(not os.path.isdir("/usr/include/bullet"), reason="needs Debian's libbullet-dev")
@pytest.mark.skipif(sys.platform != "linux", reason="unique symbols are GNU's")
@pytest.mark.parametrize("used", [True, False])
def test_bullet_in_single_precision_is_found_at_import(foreign, used):
    code = f"""
        import ctypes
        library = ctypes.CDLL({str(foreign)!r})
        if {used}:
            library.use()
        try:
            import bulletfem
        except (ImportError, RuntimeError) as error:
            print(error)
        """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True)
    assert "single precision" in done.stdout and "separate processes" in done.stdout, done.stderr


@pytest.mark.skipif(not os.path.isdir("/usr/include/bullet"), reason="needs Debian's libbullet-dev")
def test_bullet_in_single_precision_is_found_at_a_world(foreign):
    code = f"""
        import bulletfem, ctypes
        ctypes.CDLL({str(foreign)!r}).use()
        try:
            world = bulletfem.World()
            world.add_rigid_body(bulletfem.Shape.plane())
            world.add_soft_body(bulletfem.Mesh.box((.4, .4, .4), (2, 2, 2), (0, .01, 0)))
            world.step(100)
            print("works", world.soft_bodies[0].positions.min() > -.01)
        except RuntimeError as error:
            print("refused", "single precision" in str(error))
        """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True)
    assert done.stdout.strip() in ("works True", "refused True"), done.stdout + done.stderr


