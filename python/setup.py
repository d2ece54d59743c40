# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Builds the extension bulletfem._core by CMake, for the interpreter that runs this script."""
import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = pathlib.Path(__file__).resolve().parent.parent
VERSION = re.search(r"project\(BulletFEM VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]


class CMakeBuild(build_ext):
    """BULLETFEM_CMAKE_ARGS adds arguments of CMake; CMAKE_BUILD_PARALLEL_LEVEL is the number of compilers at once."""

    def build_extension(self, extension):
        target = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve()
        build = pathlib.Path(self.build_temp).resolve()
        parts = ("TESTS", "SLOW_TESTS", "DEMOS", "TOOLS", "BENCHMARKS")
        subprocess.run(
            ["cmake", "-S", SOURCE, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DBULLETFEM_PYTHON=ON",
             "-DBULLETFEM_PRECISIONS=float64", "-DBULLETFEM_UNITY=8", "-DBULLETFEM_PRECOMPILE=OFF", f"-DPython_EXECUTABLE={sys.executable}",
             *(f"-DBULLETFEM_BUILD_{part}=OFF" for part in parts), *os.environ.get("BULLETFEM_CMAKE_ARGS", "").split()],
            check=True)
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
        subprocess.run(["cmake", "--build", build, "--target", "bulletfem_python", "--parallel", jobs], check=True)
        built = next((build / "python" / "bulletfem").glob("_core.*so"))
        target.parent.mkdir(parents=True, exist_ok=True)
        self.copy_file(str(built), str(target))


setup(version=VERSION, ext_modules=[Extension("bulletfem._core", sources=[])], cmdclass={"build_ext": CMakeBuild})
