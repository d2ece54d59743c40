# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Conan 2: conan create tools/ports/conan, in the source tree. Bullet's recipe has one precision per package; the option
double_precision selects it."""
import os

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")


class BulletFemRecipe(ConanFile):
    name = "bulletfem"
    version = "0.2.0"
    license = "Zlib"
    description = "Corotational finite-element soft bodies for the Bullet physics engine"
    settings = "os", "compiler", "build_type", "arch"
    options = {"double_precision": [True, False], "with_threads": [True, False], "with_io": [True, False]}
    default_options = {"double_precision": False, "with_threads": True, "with_io": False}
    package_type = "static-library"

    def configure(self):
        self.options["bullet3"].double_precision = self.options.double_precision

    def requirements(self):
        self.requires("bullet3/3.25", transitive_headers=True, transitive_libs=True)
        self.requires("eigen/3.4.0")
        self.requires("highway/1.0.3")
        self.requires("xxhash/0.8.1")
        if self.options.with_threads:
            self.requires("onetbb/2021.10.0")
        if self.options.with_io:
            for reference in ("assimp/5.2.2", "tinyxml2/9.0.0", "zlib/1.2.13", "nlohmann_json/3.11.2", "tinygltf/2.5.0"):
                self.requires(reference)

    def layout(self):
        cmake_layout(self)

    def export_sources(self):
        for folder in ("cmake", "fem", "bullet_bridge", "plugin", "io", "include", "tools"):
            copy(self, "*", os.path.join(SOURCE, folder), os.path.join(self.export_sources_folder, folder))
        for name in ("CMakeLists.txt", "LICENSE", "THIRD_PARTY.md"):
            copy(self, name, SOURCE, self.export_sources_folder)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        double = bool(self.options.double_precision)
        variables = {"BULLETFEM_PRECISIONS": "float64" if double else "float",
                     "BULLETFEM_BULLET": self.dependencies["bullet3"].package_folder.replace("\\", "/"),
                     "BULLETFEM_WITH_TBB": bool(self.options.with_threads), "BULLETFEM_BUILD_IO": bool(self.options.with_io),
                     "BULLETFEM_WITH_SUITESPARSE": False, "BULLETFEM_WITH_METIS": False}
        for part in ("TESTS", "DEMOS", "TOOLS", "BENCHMARKS", "PICTURES"):
            variables[f"BULLETFEM_BUILD_{part}"] = False
        toolchain.variables.update(variables)
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        # BulletFEM's own configuration defines all targets.
        self.cpp_info.builddirs.append(os.path.join("lib", "cmake", "BulletFEM"))
        self.cpp_info.set_property("cmake_find_mode", "none")
