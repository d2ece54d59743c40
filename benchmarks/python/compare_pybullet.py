#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Table of docs/python.md: pybullet's examples and its Panda under our pybullet and Bullet's own.

compare_pybullet.py <checkout of Bullet> <build.py's --work>/stage <the same of --unchanged>/stage"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

TESTS = pathlib.Path(__file__).resolve().parents[2] / "tests" / "pybullet"
DATA = "examples/pybullet/gym/pybullet_data"
STEPS = {"ball": 3000, "torus": 1200, "anchor": 600, "add_remove_objects": 600}
MESHES = {"ball": ("ball.vtk", 0.5), "torus": ("torus.vtk", 1)}  # and its scale in the example


def read_vtk(path):
    """Nodes and tetrahedra."""
    words = path.read_text().split()
    start = words.index("POINTS")
    count = int(words[start + 1])
    nodes = np.array(words[start + 3:start + 3 + 3 * count], float).reshape(-1, 3)
    start = words.index("CELLS")
    count = int(words[start + 1])
    return nodes, np.array(words[start + 3:start + 3 + 5 * count], int).reshape(-1, 5)[:, 1:]


def volumes(nodes, tets):
    a, b, c, d = (nodes[tets[:, k]] for k in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def outcome(example, bullet, result):
    """Volume and inverted elements of the soft bodies."""
    if example not in MESHES:
        return "finite" if all(np.isfinite(float.fromhex(v)) for body in result["bodies"] for p in body["values"] for v in p) else "NaN"
    name, scale = MESHES[example]
    nodes, tets = read_vtk(bullet / DATA / name)
    rest = volumes(scale * nodes, tets)
    words = []
    for body in result["bodies"]:
        if body["soft"]:
            ratio = volumes(np.array([[float.fromhex(v) for v in p] for p in body["values"]]), tets) / rest
            words.append(f"volume {(ratio * np.abs(rest)).sum() / np.abs(rest).sum():.2f}, {(ratio <= 0).mean():.1%} inside out")
    return "; ".join(words)


def run(program, arguments, stage, cwd):
    """The JSON that a program writes, or why it has none."""
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "result.json"
        done = subprocess.run([sys.executable, TESTS / program, *arguments, output], env={**os.environ, "PYTHONPATH": str(stage)}, cwd=cwd,
                              capture_output=True, text=True)
        return json.loads(output.read_text()) if done.returncode == 0 else {"failed": done.returncode}


def main(bullet, *stages):
    print("| example, steps | ms a step, ours; Bullet's | after them, ours | Bullet's |\n|---|---|---|---|")
    for example, steps in STEPS.items():
        file = bullet / "examples" / "pybullet" / "examples" / f"deformable_{example}.py"
        results = [run("run_example.py", [file, str(steps)], stage.resolve(), bullet) for stage in stages]
        times = "; ".join("-" if "failed" in each else f"{each['milliseconds']:.2g}" for each in results)
        ends = [f"exit code {each['failed']}" if "failed" in each else outcome(example, bullet, each) for each in results]
        if "failed" not in results[0] and results[0]["bodies"] == results[1].get("bodies"):
            ends[0] += ", Bullet's bits"
        print(f"| `{example}`, {results[0].get('steps', steps)} | {times} | {ends[0]} | {ends[1]} |", flush=True)
    results = [run("panda.py", [], stage.resolve(), bullet) for stage in stages]
    ends = [f"lifts by {each['lifted']:.3f} m, slips by {1000 * each['slip']:.1f} mm, least extent {min(each['extent']):.2f}" for each in results]
    print(f"| Panda, 960 | {'; '.join(format(each['milliseconds'], '.2g') for each in results)} | {ends[0]} | {ends[1]} |")


if __name__ == "__main__":
    main(*(pathlib.Path(argument).resolve() for argument in sys.argv[1:]))
