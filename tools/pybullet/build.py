#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Builds pybullet with FEM bodies from a source tree of Bullet, and makes a wheel. README.md tells more."""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys

import insert

HERE = pathlib.Path(__file__).resolve().parent
PACKAGES = "examples/pybullet/gym"


def copy_tree(bullet: pathlib.Path, copy: pathlib.Path, unchanged: bool) -> None:
    """Copies what pybullet is built of, with our lines in its server. Files that are as before keep their time."""
    for folder in ("src", "Extras", "examples"):
        for source in sorted((bullet / folder).rglob("*")):
            name = source.relative_to(bullet)
            if source.is_dir() or name.is_relative_to(PACKAGES):
                continue
            data = source.read_bytes()
            if str(name) == insert.SERVER and not unchanged:
                data = insert.insert(data.decode(errors="surrogateescape"), insert.version_of(bullet)).encode(errors="surrogateescape")
            target = copy / name
            if not target.exists() or target.read_bytes() != data:
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(data)
    for source in bullet.iterdir():  # CMakeLists.txt, VERSION and files that it configures
        if source.is_file():
            shutil.copy2(source, copy)


def build(copy: pathlib.Path, folder: pathlib.Path, unchanged: bool) -> pathlib.Path:
    """Builds the extension, and returns its path."""
    subprocess.run(["cmake", "-S", HERE, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", f"-DBULLET_SOURCE={copy}",
                    f"-DPYBULLET_UNCHANGED={'ON' if unchanged else 'OFF'}", f"-DPython_EXECUTABLE={sys.executable}",
                    *os.environ.get("BULLETFEM_CMAKE_ARGS", "").split()], check=True)
    jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
    subprocess.run(["cmake", "--build", folder, "--target", "pybullet", "--parallel", jobs], check=True)
    return next(folder.glob("pybullet.*so"))


def make_wheel(bullet: pathlib.Path, extension: pathlib.Path, stage: pathlib.Path, output: pathlib.Path, unchanged: bool) -> None:
    """Makes a wheel of the extension and of Bullet's packages pybullet_data, pybullet_envs and so on."""
    shutil.rmtree(stage, ignore_errors=True)
    shutil.copytree(bullet / PACKAGES, stage)
    shutil.copy2(extension, stage)
    shutil.copy2(HERE / "wheel_setup.py", stage / "setup.py")
    version = re.search(r"version='([\d.]+)'", (bullet / "setup.py").read_text())
    if not version:
        raise SystemExit(f"setup.py of Bullet {insert.version_of(bullet)} has no version of pybullet")
    environment = {**os.environ, "PYBULLET_VERSION": version[1] + ("" if unchanged else "+bulletfem")}
    subprocess.run([sys.executable, "setup.py", "-q", "bdist_wheel", "--dist-dir", output.resolve()], cwd=stage, env=environment,
                   check=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bullet", type=pathlib.Path, help="a checkout of Bullet, which is only read")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("."), help="folder of the wheel (default: here)")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("build/pybullet"), help="folder to build in (default: %(default)s)")
    parser.add_argument("--unchanged", action="store_true", help="without our lines: Bullet's own pybullet, to compare with")
    arguments = parser.parse_args()
    work = arguments.work.resolve()
    version = insert.version_of(arguments.bullet)
    copy_tree(arguments.bullet, work / "bullet", arguments.unchanged)
    extension = build(work / "bullet", work / "build", arguments.unchanged)
    make_wheel(arguments.bullet, extension, work / "stage", arguments.output, arguments.unchanged)
    print(f"pybullet of Bullet {version} is in {arguments.output}")


if __name__ == "__main__":
    main()
