# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Makes a wheel of a folder with the built extension pybullet and Bullet's packages."""
import os
import pathlib

from setuptools import Extension, find_packages, setup
from setuptools.command.build_ext import build_ext


class Built(build_ext):
    """The extension is there already."""

    def build_extension(self, extension):
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        self.copy_file(str(next(pathlib.Path.cwd().glob("pybullet.*so"))), str(target))


setup(name="pybullet", version=os.environ["PYBULLET_VERSION"], license="Zlib",
      description="pybullet of Bullet's source tree, whose tetrahedral soft bodies are BulletFEM's", packages=find_packages(),
      package_data={"": ["*"], "pybullet_data": ["**/*"]}, ext_modules=[Extension("pybullet", sources=[])], cmdclass={"build_ext": Built},
      zip_safe=False)
