#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Writes BulletFEM::runtime as one header and one source file, which a program compiles with its own sources. Needs
Python's standard library only.

    tools/amalgamate.py <folder>     writes bullet_fem_runtime.h and bullet_fem_runtime.cpp there

The program includes the header in place of bullet_fem/..., compiles the source with Bullet's, Eigen's, Highway's and
xxHash's headers, and links Bullet. Kernels are compiled for the compiler's target instruction set
(HWY_COMPILE_ONLY_SCALAR: without vectors); BULLETFEM_WITH_TBB enables threads and requires oneTBB.

Local names that two source files share would collide in one file: the file's number is appended to them.
"""
import argparse
import itertools
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FLOORS = ("common", "mesh", "elements", "factor", "body", "solve", "batch", "step", "contact", "cage", "baked")
FOLDERS = [os.path.join("fem", floor) for floor in FLOORS] + ["bullet_bridge", "plugin"]
# Sources left out of BulletFEM::runtime: AMD and METIS, and readers of files.
LEFT_OUT = {"ordering_libraries.cpp", "btFemFileHelpers.cpp", "btFemUrdf.cpp"}
HEADERS = ("include/bullet_fem/fem/", "include/bullet_fem/bullet_bridge/", "include/bullet_fem/btFem")
INCLUDE = re.compile(r'^#include "([^"]+)"')
# Lines by which Highway includes a file again for each instruction set.
OF_OTHER_TARGETS = re.compile(r"^#(undef|define) HWY_TARGET_INCLUDE|^#include <hwy/foreach_target.h>")
DECLARED = [re.compile(pattern) for pattern in (
    r"^(?:class|struct|enum class|enum|union)(?: alignas\(\d+\)| \[\[\w+\]\])? (\w+)",
    r"^using (\w+) =",
    r"^(?:inline |static |constexpr |const )*[\w:<>,&* ]+?[ &*](\w+)(?:\[\w*\])? ?(?:=|\{|;|$)",
    r"^(?!return|else|if|for|while|switch|using|#)(?:\[\[\w+\]\] )*[\w:<>,&*\[\] ]+?[ &*](\w+)\(")]


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def files_below(folder, ending):
    for top, folders, names in os.walk(os.path.join(ROOT, folder)):
        folders.sort()
        for name in sorted(names):
            if name.endswith(ending) and name not in LEFT_OUT:
                yield os.path.relpath(os.path.join(top, name), ROOT)


def resolve(name):
    for candidate in (name, os.path.join("include", name)):
        if os.path.isfile(os.path.join(ROOT, candidate)):
            return candidate
    return None


def declared_by(line):
    """Names of types and constants, and names of functions, declared in a line at namespace scope."""
    for pattern in DECLARED:
        match = pattern.match(line)
        if match:
            further = re.findall(r", (k\w+) =", line) if line.startswith("constexpr") else []
            names = {match[1], *further}
            return (set(), names) if pattern is DECLARED[-1] else (names, set())
    return set(), set()


def own_names(text):
    """Local names of a source file (anonymous namespaces, namespaces of instruction sets), as by declared_by."""
    values, functions, depth = set(), set(), 0
    for line in text.split("\n"):
        if re.match(r"^namespace( HWY_NAMESPACE)?\s*\{?$", line):
            depth += 1
        elif depth and re.match(r"^\}  // namespace( HWY_NAMESPACE)?$", line):
            depth -= 1
        elif (depth or line.startswith("static ")) and re.match(r"\w|\[", line):
            of_values, of_functions = declared_by(line)
            values |= of_values
            functions |= of_functions
    return values - {"hn"}, functions


def names_of_headers():
    """Names in all headers except those of kernels, as by declared_by."""
    values, functions = set(), set()
    for path in itertools.chain.from_iterable(files_below(folder, ".h") for folder in FOLDERS + ["include/bullet_fem"]):
        if not path.endswith("-inl.h"):
            for line in read(path).split("\n"):
                if re.match(r"\w|\[", line):
                    of_values, of_functions = declared_by(line)
                    values |= of_values
                    functions |= of_functions
    return values, functions


def renamed(text, names, suffix):
    """Appends the suffix to these names, except for members and qualified names."""
    lines = text.split("\n")
    for name in sorted(names):
        pattern = re.compile(rf'(?<![\w.])(?<!->)(?<!::){name}\b')
        lines = [line if line.startswith("#include") else pattern.sub(f"{name}_{suffix}", line) for line in lines]
    return "\n".join(lines)


class Amalgam:
    def __init__(self):
        self.m_done = set()
        # Names of each file that also occur elsewhere. Functions that overload one of a header keep their name. Kernels
        # of a folder share headers, whose names belong to the folder.
        self.m_of_file, self.m_of_folder = {}, {}
        header_values, header_functions = names_of_headers()
        own, owners = {}, {}
        for folder in FOLDERS:
            for path in [*files_below(folder, ".cpp"), *files_below(folder, "-inl.h")]:
                values, functions = own[path] = own_names(read(path))
                for name in values | functions:
                    owners.setdefault(name, set()).add(folder if path.endswith("-inl.h") else path)
        for path, (values, functions) in own.items():
            meets = {name for name in values | functions if len(owners[name]) > 1} | (values & header_values)
            meets -= functions & header_functions
            if path.endswith("-inl.h"):
                self.m_of_folder.setdefault(os.path.dirname(path), set()).update(meets)
            else:
                self.m_of_file[path] = meets

    def expand(self, path, lines, text=None):
        """Appends the file; each of the project's headers is expanded at its first include."""
        self.m_done.add(path)
        text = text or read(path)
        folder = os.path.dirname(path)
        text = renamed(text, self.m_of_folder.get(folder, ()), os.path.basename(folder))
        for line in text.rstrip("\n").split("\n"):
            match = INCLUDE.match(line)
            target = resolve(match[1]) if match else None
            if target:
                if target not in self.m_done:
                    self.expand(target, lines)
            elif line != "#pragma once" and not OF_OTHER_TARGETS.match(line):
                lines.append(line)

    def header(self):
        lines = ["// SPDX-License-Identifier: Zlib", "// BulletFEM::runtime in one header; made by tools/amalgamate.py.",
                 "#pragma once", ""]
        for path in files_below("include/bullet_fem", ".h"):
            if path.startswith(HEADERS) and path not in self.m_done:
                self.expand(path, lines)
        return "\n".join(lines) + "\n"

    def source(self):
        lines = ["// SPDX-License-Identifier: Zlib", "// BulletFEM::runtime in one source file; made by tools/amalgamate.py.",
                 "#ifndef HWY_COMPILE_ONLY_SCALAR", "#define HWY_COMPILE_ONLY_STATIC", "#endif",
                 '#include "bullet_fem_runtime.h"', ""]
        for number, path in enumerate(path for folder in FOLDERS for path in files_below(folder, ".cpp")):
            of_folder = self.m_of_folder.get(os.path.dirname(path), set())
            text = renamed(read(path), self.m_of_file[path] - of_folder, number)
            lines.append(f"// {path}")
            self.expand(path, lines, text)
            for macro in re.findall(r"^#define (\w+)", text, re.MULTILINE):
                if not macro.startswith(("HWY_", "XXH_")):
                    lines.append(f"#undef {macro}")
        return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    folder = parser.parse_args().folder
    os.makedirs(folder, exist_ok=True)
    amalgam = Amalgam()
    for ending, text in (("h", amalgam.header()), ("cpp", amalgam.source())):
        path = os.path.join(folder, "bullet_fem_runtime." + ending)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        print(f"{path}: {text.count(chr(10))} lines, {len(text) // 1024} KiB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
