# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Documentation, stubs, examples, and equality with C++."""
import importlib.util
import inspect
import os
import pathlib
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest

import bulletfem as bf
from conftest import ROOT, cube_mesh

PACKAGE = pathlib.Path(bf.__file__).parents[1]
EXAMPLES = sorted((ROOT / "python" / "examples").glob("*.py"))
ENVIRONMENT = dict(os.environ, PYTHONPATH=str(PACKAGE), MYPYPATH=str(PACKAGE))
QUANTITIES = r"position|velocit|force|stress|strain|mass|radius|height|size|gravity|friction|target|impulse|torque"


def members():
    for name in bf.__all__:
        thing = getattr(bf, name)
        if not inspect.isclass(thing):
            continue
        for member, value in vars(thing).items():
            if not member.startswith("_"):
                yield f"{name}.{member}", value


def test_everything_has_a_docstring():
    assert bf.__doc__
    for name in bf.__all__:
        if inspect.isclass(getattr(bf, name)):
            assert getattr(bf, name).__doc__, name
    missing = [name for name, value in members() if not (value.__doc__ or "").strip()]
    assert missing == []


def test_docstrings_of_quantities_have_units():
    without = [name for name, value in members()
               if re.search(QUANTITIES, name) and not re.search(r"\[|\(\w+,|quaternion|Material|handle|refused|sets|Removes", value.__doc__)]
    allowed = {"SoftBody.remove_spring", "SoftBody.set_material", "SoftBody.clear_targets"}
    assert set(without) <= allowed


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_run(example):
    done = subprocess.run([sys.executable, example], env=ENVIRONMENT, capture_output=True, text=True, timeout=1200)
    assert done.returncode == 0, done.stderr
    assert done.stdout


def test_document_runs(tmp_path):
    """The first example of README and of docs/python.md."""
    for document in ("README.md", "docs/python.md"):
        code = re.search(r"```python\n(.*?)```", (ROOT / document).read_text(), re.DOTALL)
        assert code, document
        (tmp_path / "example.py").write_text(code[1])
        done = subprocess.run([sys.executable, tmp_path / "example.py"], env=ENVIRONMENT, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr


def test_notebook_runs_and_prints_what_it_shows():
    for module in ("nbclient", "ipykernel"):
        if importlib.util.find_spec(module) is None:
            pytest.skip(f"there is no {module}: install python3-nbclient and python3-ipykernel")
    code = """if True:
        import sys, nbformat
        from nbclient import NotebookClient
        def text(notebook):
            return [o["text"] for cell in notebook.cells for o in cell.get("outputs", []) if o["output_type"] == "stream"]
        notebook = nbformat.read(sys.argv[1], 4)
        before = text(notebook)
        NotebookClient(notebook, kernel_name="python3", timeout=200).execute()
        assert before and text(notebook) == before, text(notebook)
        """
    done = subprocess.run([sys.executable, "-c", code, ROOT / "python" / "examples" / "fit.ipynb"], env=ENVIRONMENT, capture_output=True,
                          text=True)
    assert done.returncode == 0, done.stderr


def tool(name):
    """The tool of this interpreter's mypy."""
    path = shutil.which(name, path=f"/usr/bin:{os.environ['PATH']}")
    if not path:
        pytest.skip(f"there is no {name}: install mypy")
    return path


def test_stubs_agree_with_the_module():
    allowed = pathlib.Path(__file__).parent / "stubtest_allowed.txt"
    done = subprocess.run([tool("stubtest"), "bulletfem", "--allowlist", allowed], env=ENVIRONMENT, cwd=PACKAGE,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_examples_are_typed():
    done = subprocess.run([tool("mypy"), "--strict", "--cache-dir", os.devnull, *EXAMPLES], env=ENVIRONMENT, capture_output=True,
                          text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_bits_are_those_of_cpp():
    program = os.environ.get("BULLETFEM_PYTHON_TWIN")
    if not program:
        pytest.skip("BULLETFEM_PYTHON_TWIN does not name the program")
    done = subprocess.run([program], capture_output=True, text=True, check=True)
    expected = np.array([[float.fromhex(value) for value in line.split()] for line in done.stdout.splitlines()])
    world = bf.World()
    world.add_rigid_body(bf.Shape.plane(), friction=0.5)
    body = world.add_soft_body(cube_mesh(3, low=0.1), bf.Material.rubber())
    world.step(120)
    assert np.array_equal(body.positions, expected)
