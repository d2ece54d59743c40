#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""The code blocks of README.md, CONTRIBUTING.md and docs/*.md are what they claim to be: C++ that compiles, CMake that
configures, shell that parses and whose options there are, and JSON.

    check_snippets.py --work <folder> --cxx <compiler> --bullet <include folder> [--bulletfem <program>]
        [--prefix <installation> --generator <name>] [--fragments] [document...]

A block behind the line <!-- snippet: fragment --> is left out; --fragments names those that pass all the same. A block of
C++ with main stands alone. Others are compiled as the body of a function, or outside of one, in a program that has what
snippet_names.h declares; their includes go to the top. CMake that makes or links targets is configured in a project with
the targets that it wants, against the installation. Standard library only.
"""
import argparse
import concurrent.futures
import glob
import json
import os
import re
import shlex
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
import markdown_files  # noqa: E402, beside this file

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
SCRIPT_FOLDERS = ("fem/", "plugin/", "bullet_bridge/", "io/", "tools/", "tests/", "demos/", "cmake/", "benchmarks/", ".ci/")


def run(command, folder):
    """Exit code and all that the command prints."""
    result = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            errors="replace", timeout=300, check=False)
    return result.returncode, result.stdout


def errors_of(text, most=12):
    """The lines of a compiler's or CMake's output that tell the errors, indented."""
    lines = [line for line in text.split("\n") if line.strip()]
    first = [number for number, line in enumerate(lines) if line.startswith("CMake Error")]
    if first:
        wanted = lines[first[0]:]
    else:
        wanted = [line for line in lines if "error" in line.lower()] or lines
    return "\n".join("    " + line for line in wanted[:most])


class Cpp:
    """Compiles blocks for their syntax and types alone."""

    def __init__(self, options):
        self.folder = os.path.join(options.work, "cpp")
        os.makedirs(self.folder)
        self.flags = [options.cxx, "-std=c++17", "-I", os.path.join(ROOT, "include"), "-I", ROOT]
        for include in options.bullet:
            self.flags += ["-isystem", include]
        public = sorted(glob.glob(os.path.join(ROOT, "include", "bullet_fem", "**", "*.h"), recursive=True))
        with open(os.path.join(self.folder, "public_headers.h"), "w", encoding="utf-8") as file:
            for path in public:
                file.write(f'#include "{os.path.relpath(path, os.path.join(ROOT, "include"))}"\n')
        self.names = os.path.join(self.folder, "snippet_names.h")
        shutil.copy(os.path.join(HERE, "snippet_names.h"), self.names)
        code, text = run(self.flags + ["-x", "c++-header", self.names, "-o", self.names + ".gch"], self.folder)
        if code:
            raise SystemExit(f"tests/docs/snippet_names.h does not compile:\n{text}")

    def tidy_up(self):
        os.remove(self.names + ".gch")  # a hundred megabytes

    def compile(self, name, source, with_names=True):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(source)
        names = ["-include", self.names] if with_names else []
        return run(self.flags + names + ["-fsyntax-only", path], self.folder)

    def check(self, block):
        stem = re.sub(r"\W", "_", block.place())
        lines = [f'#line {block.line} "{block.document}"'] + block.lines
        if re.search(r"^\s*(int|auto)\s+main\s*\(", block.text, re.MULTILINE):
            code, text = self.compile(stem + ".cpp", "\n".join(lines) + "\n", False)
            return errors_of(text) if code else None
        is_include = re.compile(r"^\s*#\s*include\b")
        top = [line if is_include.match(line) else "" for line in lines[1:]]
        rest = ["" if is_include.match(line) else line for line in lines[1:]]
        head = "\n".join([lines[0]] + top) + "\n"
        tail = "\n".join([lines[0]] + rest) + "\n"
        code, text = self.compile(stem + ".cpp", f"{head}void snippet()\n{{\n{tail}}}\n")
        if code:
            outside, _ = self.compile(stem + "_outside.cpp", f"{head}namespace snippet\n{{\n{tail}}}\n")
            if outside:
                return errors_of(text)
        return None


class Cmake:
    """Runs blocks, or configures them in a project."""
    PROJECT = re.compile(r"^\s*(find_package|target_\w+|set_target_properties|add_executable|add_library|add_subdirectory|"
                         r"project|FetchContent_\w+|install)\s*\(", re.MULTILINE)
    NEEDS_TARGET = re.compile(r"\b(?:target_\w+|set_target_properties)\s*\(\s*([A-Za-z_][\w-]*)")
    MAKES_TARGET = re.compile(r"\b(?:add_executable|add_library)\s*\(\s*([\w-]+)([^)]*)\)")

    def __init__(self, options):
        self.options = options
        self.folder = os.path.join(options.work, "cmake")
        os.makedirs(self.folder)

    def check(self, block):
        folder = os.path.join(self.folder, re.sub(r"\W", "_", block.place()))
        os.makedirs(folder)
        name = re.sub(r"\W", "_", block.document) + ".cmake"  # its lines have the numbers of the document
        text = "\n" * (block.line - 1) + block.text
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
        bare = re.sub(r"#.*", "", block.text)
        if not self.PROJECT.search(bare):
            code, output = run([self.options.cmake, "-P", name], folder)
            return errors_of(output) if code else None
        if not self.options.prefix:
            return "    this must be configured against an installation, and --prefix is not given"
        self.write_project(folder, name, bare)
        code, output = run([self.options.cmake, "-S", ".", "-B", "build", "-G", self.options.generator,
                            f"-DCMAKE_PREFIX_PATH={self.options.prefix}", f"-DCMAKE_CXX_COMPILER={self.options.cxx}",
                            f"-DFETCHCONTENT_SOURCE_DIR_BULLETFEM={ROOT}"], folder)
        return errors_of(re.sub(r"\n +", " ", output)) if code else None

    def write_project(self, folder, name, bare):
        made = dict(self.MAKES_TARGET.findall(bare))
        lines = []
        if not re.search(r"\bproject\s*\(", bare):
            lines += ["cmake_minimum_required(VERSION 3.25)", "project(Snippet LANGUAGES C CXX)"]
        brings = re.search(r"\b(FetchContent_MakeAvailable|add_subdirectory)\s*\(|find_package\s*\(\s*BulletFEM", bare)
        if not brings:
            lines.append("find_package(BulletFEM REQUIRED)")
        for target in sorted(set(self.NEEDS_TARGET.findall(bare)) - set(made)):
            lines.append(f"add_executable({target} main.cpp)")
        lines.append(f'include("{name}")')
        with open(os.path.join(folder, "CMakeLists.txt"), "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")
        for source in re.findall(r"[\w./-]+\.(?:cpp|cc|cxx)\b", " ".join(made.values())) + ["main.cpp"]:
            path = os.path.join(folder, source)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8") as file:
                file.write("int main() {}\n")
        for source in re.findall(r"\badd_subdirectory\s*\(\s*([\w./-]+)", bare):
            path = os.path.join(folder, source)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            os.symlink(ROOT, path)


class Shell:
    """Parses blocks; scripts, presets, cache variables and options of bulletfem that they name must be there."""

    def __init__(self, options):
        self.options = options
        self.help = {}
        self.folder = os.path.join(options.work, "sh")
        os.makedirs(self.folder)
        with open(os.path.join(ROOT, "CMakePresets.json"), encoding="utf-8") as file:
            presets = json.load(file)
        self.presets = {entry["name"] for kind in ("configurePresets", "buildPresets", "testPresets")
                        for entry in presets.get(kind, []) if not entry.get("hidden")}
        lists = [os.path.join(ROOT, "CMakeLists.txt")] + glob.glob(os.path.join(ROOT, "cmake", "*.cmake"))
        self.variables = set(re.findall(r"(?:option|set)\(\s*(BULLETFEM_\w+)",
                                        "".join(open(path, encoding="utf-8").read() for path in lists)))

    def check(self, block):
        path = os.path.join(self.folder, re.sub(r"\W", "_", block.place()) + ".sh")
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n" * (block.line - 1) + block.text)
        code, text = run(["bash", "-n", path], self.folder)
        if code:
            return errors_of(text)
        if "<<" in block.text:  # commands and what they read are not told apart
            return None
        faults = [f"    {fault}" for command in self.commands(block) for fault in self.judge(command)]
        return "\n".join(faults) or None

    @staticmethod
    def commands(block):
        """Each as its words."""
        text = block.text.replace("\\\n", " ").replace("\n", "\n;\n")  # a comment does not swallow the end of its command
        lexer = shlex.shlex(text, posix=True, punctuation_chars="();<>|&")
        lexer.whitespace_split = True
        lexer.commenters = "#"
        command = []
        try:
            for word in lexer:
                if re.fullmatch(r"[();<>|&]+", word):
                    if command:
                        yield command
                    command = []
                elif command or not re.fullmatch(r"\w+=.*", word):
                    command.append(word)
        except ValueError:
            return
        if command:
            yield command

    def judge(self, command):
        program, arguments = command[0], command[1:]
        if program.startswith("./"):
            program = program[2:]
        if program in ("sudo", "bash", "time", "exec") and arguments:
            yield from self.judge(arguments)
        elif program.startswith(SCRIPT_FOLDERS) and not os.path.exists(os.path.join(ROOT, program)):
            yield f"there is no {program}"
        elif program in ("cmake", "ctest"):
            yield from self.judge_cmake(arguments)
        elif os.path.basename(program) == "bulletfem" and self.options.bulletfem:
            yield from self.judge_bulletfem(arguments)

    def judge_cmake(self, arguments):
        for number, argument in enumerate(arguments):
            preset = argument[len("--preset="):] if argument.startswith("--preset=") else None
            if argument == "--preset" and number + 1 < len(arguments):
                preset = arguments[number + 1]
            if preset is not None and preset not in self.presets:
                yield f"CMakePresets.json has no preset {preset}"
            variable = re.match(r"-D(BULLETFEM_\w+)", argument)
            if variable and variable[1] not in self.variables:
                yield f"CMake has no option {variable[1]}"

    def judge_bulletfem(self, arguments):
        if not arguments or arguments[0].startswith("-"):
            command, options = [], arguments
        else:
            command, options = arguments[:1], arguments[1:]
        key = " ".join(command)
        if key not in self.help:
            code, text = run([self.options.bulletfem] + command + ["--help"], self.folder)
            known = set(re.findall(r"(?<![\w-])--?[A-Za-z][\w-]*", text))
            self.help[key] = known if code == 0 else None
        known = self.help[key]
        if known is None:
            yield f"bulletfem has no command {key}"
            return
        for option in options:
            name = option.split("=")[0]
            if re.match(r"--?[A-Za-z]", name) and name not in known:
                yield f"bulletfem {key} has no option {name}"


def check_json(block):
    try:
        json.loads(block.text)
    except json.JSONDecodeError as error:
        return f"    {block.document}:{block.line + error.lineno - 1}: {error.msg}"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--work", required=True, help="a folder of its own, which is emptied")
    parser.add_argument("--cxx", required=True)
    parser.add_argument("--bullet", required=True, action="append", help="folder of Bullet's headers, or another's")
    parser.add_argument("--cmake", default="cmake")
    parser.add_argument("--generator", default="Ninja")
    parser.add_argument("--prefix", help="an installation of BulletFEM")
    parser.add_argument("--bulletfem", help="the program bulletfem")
    parser.add_argument("--root", default=ROOT, help="where the documents are")
    parser.add_argument("--fragments", action="store_true", help="tell which fragments pass; they are no fault")
    parser.add_argument("documents", nargs="*")
    options = parser.parse_args()
    options.work = os.path.abspath(options.work)
    if options.bulletfem:
        options.bulletfem = os.path.abspath(options.bulletfem)
    shutil.rmtree(options.work, ignore_errors=True)
    os.makedirs(options.work)

    names = options.documents or [name for name in markdown_files.documents(options.root)
                                  if name in ("README.md", "CONTRIBUTING.md") or name.startswith("docs/")]
    blocks = [block for name in names for block in markdown_files.split(name, markdown_files.read(options.root, name))[0]]
    shell = Shell(options)
    cpp = Cpp(options)
    checks = {"cpp": cpp.check, "cmake": Cmake(options).check, "json": check_json, "sh": shell.check,
              "bash": shell.check}
    known = [block for block in blocks if block.language in checks]
    chosen = [block for block in known if (block.mark == "fragment") == options.fragments]
    faults = [f"{block.place()}: the mark \"snippet: {block.mark}\" is unknown; there is \"fragment\""
              for block in known if block.mark not in ("", "fragment")]

    with concurrent.futures.ThreadPoolExecutor(max_workers=min(4, os.cpu_count() or 1)) as pool:
        results = list(pool.map(lambda block: checks[block.language](block), chosen))
    cpp.tidy_up()
    if options.fragments:
        for block, result in zip(chosen, results):
            print(f"{block.place()}: this {block.language} {'need be no fragment' if result is None else 'is a fragment'}")
        return
    for block, result in zip(chosen, results):
        if result is not None:
            faults.append(f"{block.place()}: this {block.language} fails:\n{result}")
    for fault in faults:
        print(fault)
    for language in sorted(checks):
        all_of_it = [block for block in known if block.language == language]
        left_out = sum(block.mark == "fragment" for block in all_of_it)
        print(f"{language}: {len(all_of_it) - left_out} checked, {left_out} fragments left out")
    print(f"{len(faults)} faults")
    sys.exit(1 if faults or not chosen else 0)


if __name__ == "__main__":
    main()
