#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""check_ports.py <version>: checks that the ports for vcpkg and Conan parse, have the project's version, and use
options that its CMakeLists.txt defines."""
import ast
import json
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def main():
    version = sys.argv[1]
    failures = []
    port = json.loads(read("tools/ports/vcpkg/bulletfem/vcpkg.json"))
    recipe_text = read("tools/ports/conan/conanfile.py")
    recipe = {node.targets[0].id: ast.literal_eval(node.value) for cls in ast.parse(recipe_text).body
              if isinstance(cls, ast.ClassDef) for node in cls.body if isinstance(node, ast.Assign)}
    for name, found in (("vcpkg.json", port["version"]), ("conanfile.py", recipe["version"])):
        if found != version:
            failures.append(f"{name} has version {found}, not {version}")
    known = read("CMakeLists.txt") + read("cmake/BulletFEMPrecisions.cmake")
    portfile = read("tools/ports/vcpkg/bulletfem/portfile.cmake")
    for option in sorted(set(re.findall(r"BULLETFEM_[A-Z_]+", portfile + recipe_text)) - {"BULLETFEM_BUILD_"}):
        if not re.search(rf"(option|set)\({option}\b", known):
            failures.append(f"{option} is no option of the project")
    for feature in re.findall(r"^    (\w+) BULLETFEM_", portfile, re.MULTILINE):
        if feature not in port["features"]:
            failures.append(f"portfile.cmake has a feature {feature} that vcpkg.json has not")
    print("\n".join(failures) or "the ports agree with the project")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
