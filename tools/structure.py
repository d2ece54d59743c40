#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Prints the structure of the source tree by its includes; --check fails if it deviates from docs/architecture.md. Needs
Python's standard library only.

    tools/structure.py             rooms, arrows between them, arrows back, mutual rooms, loose files, knots, longest files
                                   and functions, largest classes
    tools/structure.py --check     also exits with 1 if a limit is exceeded or a room has a forbidden include

A room is a folder with its public headers. A unit is a header with the source file of its name. A knot is a cycle: a
set of units that reach each other by includes. An arrow from one room to another means that it includes it; it goes back
if its target is above its source. Rooms not named in FLOORS are not checked. Functions of a class are those declared in
it, including private ones; members are its variables.
"""
import argparse
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SOURCES = ("fem", "bullet_bridge", "plugin", "io", "tools", "demos", "benchmarks", "python", "include")


def ladder(top, rooms):
    """Floors, each with all those below it, which it may include."""
    paths = [f"{top}/{room}" for room in rooms]
    return [(path, paths[:at]) for at, path in enumerate(paths)]


# Folders bottom-up. A folder may include those before it on its line, and those named after the colon.
FLOORS = ladder("fem", ["common", "laws", "mesh", "elements", "factor", "body", "solve", "batch", "step", "contact",
                       "contact/compliance", "contact/constraints", "contact/solver"]) + [
    ("fem/fracture", ["fem/step", "fem/batch", "fem/solve", "fem/body", "fem/factor", "fem/elements", "fem/mesh", "fem/laws", "fem/common"]),
    ("fem/cage", ["fem/mesh", "fem/laws", "fem/common"]),
    ("fem/baked", ["fem/cage", "fem/factor", "fem/elements", "fem/mesh", "fem/laws", "fem/common"]),
] + ladder("bullet_bridge", ["geometry", "geometry/surface", "geometry/shapes", "body", "rigid", "joints", "contact",
                             "contact/soft", "contact/rigid", "contact/cloth", "snapshot"]
) + ladder("plugin", ["public", "record", "registry", "setup", "joints", "dispatch", "helpers", "stages", "snapshot",
                      "coupling", "queries", "world"]
) + ladder("io", ["public", "text", "surface", "frames", "tet"])
# Layers bottom-up by top folder; `fem` stands for its public headers and fem/common.
LAYERS = {
    "fem": ["fem"],
    "io": ["io", "fem"],
    "bullet_bridge": ["bullet_bridge", "fem"],
    "plugin": ["plugin", "bullet_bridge", "io", "fem"],
    "tools": ["tools", "plugin", "io", "fem"],
    "demos": ["demos", "tools", "plugin", "io", "fem"],
    "python": ["python", "tools", "plugin", "io", "fem"],
    "benchmarks": ["benchmarks", "tools", "plugin", "bullet_bridge", "io", "fem"],
}
MOST_LINES_OF_FILE = 400
MOST_LINES_OF_FUNCTION = 60
MOST_UNITS_OF_KNOT = {"fem": 3}
MOST_UNITS_OF_OTHER_KNOT = 4
HAVE_NO_LOOSE_SOURCES = ("fem", "bullet_bridge", "plugin", "io")  # all their source files are in subfolders
MOST_FUNCTIONS_OF_CLASS = 20
MOST_MEMBERS_OF_CLASS = 15  # of a class with functions; plain structs are not limited
EXCUSED_CLASSES = "docs/architecture.md"  # the table below "Larger classes" gives reasons: | `Class` | ... |


def source_files():
    for top in SOURCES:
        for folder, folders, names in os.walk(os.path.join(ROOT, top)):
            folders.sort()
            for name in sorted(names):
                path = os.path.relpath(os.path.join(folder, name), ROOT)
                if name.endswith((".h", ".cpp")) and not is_forwarder(path):
                    yield path


def is_forwarder(path):
    """True of the old name of a header that has moved."""
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return "// Moved; this name goes with the next version." in file.read()


def room_of(path):
    """Folder of a file; a public header belongs to the folder of its source file."""
    folder = os.path.dirname(path)
    if folder in ("include/bullet_fem", "include/bullet_fem/io"):
        return {"include/bullet_fem": "plugin", "include/bullet_fem/io": "io"}[folder] + "/public"
    return re.sub(r"^include/bullet_fem/", "", folder)


def unit_of(path):
    """Path without include/bullet_fem and extension, which a public header and its source file share."""
    name = re.sub(r"(-inl)?\.(h|cpp)$", "", path)
    return re.sub(r"^include/bullet_fem/", "", name)


def resolve(name, files):
    for candidate in (name, "include/" + name):
        if candidate in files:
            return candidate
    return None


def includes(files):
    """Pairs of files: (including file, included file)."""
    found = set(files)
    for path in files:
        with open(os.path.join(ROOT, path), encoding="utf-8") as file:
            for name in re.findall(r'^#include "([^"]+)"', file.read(), re.MULTILINE):
                target = resolve(name, found)
                if target:
                    yield path, target


def unit_graph(pairs):
    """Includes between units; a source file elsewhere belongs to the unit of its public header."""
    by_name = {}
    graph = {}
    for path, target in pairs:
        for one in (path, target):
            by_name.setdefault(unit_of(one), one)
        a, b = unit_of(path), unit_of(target)
        graph.setdefault(a, set())
        graph.setdefault(b, set())
        if a != b:
            graph[a].add(b)
    return graph


def merge_public(graph):
    """Joins source files with public headers at other paths: plugin/x.cpp and btFemX.h are one unit."""
    headers = {os.path.basename(unit): unit for unit in graph if "/" not in unit}
    rename = {unit: headers[os.path.basename(unit)] for unit in graph
              if "/" in unit and unit.startswith("plugin/") and os.path.basename(unit) in headers}
    merged = {}
    for unit, targets in graph.items():
        name = rename.get(unit, unit)
        merged.setdefault(name, set()).update(rename.get(t, t) for t in targets)
    for unit in merged:
        merged[unit].discard(unit)
    return merged


def knots(graph):
    """Strongly connected components of more than one unit [Tarjan 1972]."""
    index, low, on_stack, stack, result = {}, {}, set(), [], []
    for root in sorted(graph):
        if root in index:
            continue
        work = [(root, iter(sorted(graph[root])))]
        index[root] = low[root] = len(index)
        stack.append(root)
        on_stack.add(root)
        while work:
            unit, targets = work[-1]
            for target in targets:
                if target not in index:
                    index[target] = low[target] = len(index)
                    stack.append(target)
                    on_stack.add(target)
                    work.append((target, iter(sorted(graph[target]))))
                    break
                if target in on_stack:
                    low[unit] = min(low[unit], index[target])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[unit])
                if low[unit] == index[unit]:
                    component = []
                    while True:
                        component.append(stack.pop())
                        on_stack.discard(component[-1])
                        if component[-1] == unit:
                            break
                    if len(component) > 1:
                        result.append(sorted(component))
    return sorted(result, key=len, reverse=True)


def top_of(unit):
    top = unit.split("/")[0]
    return top if "/" in unit else "plugin"


def function_lengths(path):
    """First line and length of each function: bodies with a brace in the first column or after a member's head."""
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        lines = file.read().split("\n")
    for number, line in enumerate(lines):
        if line != "{" or number == 0 or re.match(r"(namespace|struct|class|enum|extern)\b", lines[number - 1]):
            continue
        if re.search(r"[=:,]\s*$", lines[number - 1]) or not re.search(r"\)|const$", lines[number - 1]):
            continue
        for end in range(number, len(lines)):
            if lines[end].startswith("}"):
                yield number, end - number + 1
                break


def without_comments(text):
    text = re.sub(r"/\*.*?\*/|//[^\n]*|^[ \t]*#[^\n]*", "", text, flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"\"(\\.|[^\"\\])*\"|'(\\.|[^'\\])'", "0", text)


def declarations(text, start):
    """Declarations of the class whose body begins at `start`, without bodies of functions and nested classes."""
    found, current, depth = [], "", 1
    for c in text[start:]:
        depth += (c == "{") - (c == "}")
        if depth == 0:
            return found
        if c == ";" and depth == 1 or c == "}" and depth == 1 and "(" in current:
            found.append(current)
            current = ""
        elif depth == 1 or c == "{" and depth == 2:
            current += c


def classes(path):
    """Name, number of functions and number of members of each class in a file."""
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        text = without_comments(file.read())
    head = re.compile(r"\b(?:class|struct)\s+(?:BULLETFEM_API\s+|alignas\([^)]*\)\s+)*(\w+)(?:\s+final)?\s*(?::[^;{(]*)?\{")
    nothing = re.compile(r"(using|friend|static_assert|typedef|enum|struct|class|union|(static\s+)?constexpr|template\s*<[^>]*>\s*"
                         r"(struct|class))\b")
    for match in head.finditer(text):
        functions = members = 0
        for one in declarations(text, match.end()):
            one = re.sub(r"\b(public|private|protected)\s*:|\[\[.*?\]\]", "", one).strip()
            if not one or nothing.match(one):
                continue
            plain = re.sub(r"<[^<>]*>", "", re.sub(r"<[^<>]*>", "", re.split(r"[{=]", one)[0]))
            if "(" in plain or "operator" in one:
                functions += 1
            else:
                members += max(1, len(re.findall(r"\bm_\w+", re.sub(r"=[^,]*", "", one))))
        yield match[1], functions, members


def judge_classes(files):
    """Prints the ten largest classes, and returns the faults."""
    with open(os.path.join(ROOT, EXCUSED_CLASSES), encoding="utf-8") as file:
        excused = set(re.findall(r"^\| `(\w+)` \|", file.read().split("### Larger classes")[-1], re.MULTILINE))
    found = [(max(functions / MOST_FUNCTIONS_OF_CLASS, members / MOST_MEMBERS_OF_CLASS), name, functions, members, path)
             for path in files if path.split("/")[0] != "benchmarks" for name, functions, members in classes(path)
             if functions > 1]
    too_large = {name for size, name, *_ in found if size > 1}
    print(f"classes: {len(found)} with functions, {len(too_large)} of more than {MOST_FUNCTIONS_OF_CLASS} functions or "
          f"{MOST_MEMBERS_OF_CLASS} members")
    for _, name, functions, members, path in sorted(found, reverse=True)[:10]:
        print(f"{functions:5d} functions, {members:2d} members  {name}  {path}")
    for size, name, functions, members, path in found:
        if size > 1 and name not in excused:
            yield (f"{path}: {name} has {functions} functions and {members} members; {MOST_FUNCTIONS_OF_CLASS} and "
                   f"{MOST_MEMBERS_OF_CLASS} are the most, or {EXCUSED_CLASSES} says why")
    for name in sorted(excused - too_large):
        yield f"{EXCUSED_CLASSES} excuses {name}, which is no longer too large"


def judge_rooms(arrows):
    """Includes that FLOORS and LAYERS forbid, with the reason."""
    floors = dict(FLOORS)
    for (a, b), files in sorted(arrows.items()):
        top_a, top_b = a.split("/")[0], b.split("/")[0]
        if top_a == top_b and a in floors and b in floors and b not in floors[a]:
            yield f"{a} -> {b}: not a floor below it ({files[0][0]} includes {files[0][1]})"
        if top_b not in LAYERS.get(top_a, [top_b]) and not all(target.startswith("include/") for _, target in files):
            yield f"{a} -> {b}: not a layer below it ({files[0][0]} includes {files[0][1]})"
        if top_b == "fem" and top_a not in ("fem", "benchmarks"):
            for path, target in files:
                if not target.startswith(("include/", "fem/common/")):
                    yield f"{a} -> {b}: {path} includes the private {target}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--check", action="store_true", help="exit code 1 if a limit is exceeded")
    options = parser.parse_args()
    files = list(source_files())
    pairs = [(a, b) for a, b in includes(files)]
    arrows = {}
    for path, target in pairs:
        a, b = room_of(path), room_of(target)
        if a != b:
            arrows.setdefault((a, b), []).append((path, target))
    rooms = sorted({room_of(path) for path in files})
    faults = list(judge_rooms(arrows))

    for top in ("fem", "bullet_bridge", "plugin", "io"):
        own = [room for room in rooms if room.split("/")[0] == top]
        inner = [arrow for arrow in arrows if arrow[0] in own and arrow[1] in own]
        mutual = sorted({tuple(sorted(arrow)) for arrow in inner if (arrow[1], arrow[0]) in arrows})
        print(f"{top}: {len(own)} rooms, {len(inner)} arrows, {len(mutual)} mutual")
        for room in own:
            targets = sorted(b for a, b in inner if a == room)
            print(f"    {room} -> {', '.join(t.split('/', 1)[-1] for t in targets) or '-'}")
        if mutual:
            faults.append(f"mutual rooms: {mutual}")
        loose = [path for path in files if os.path.dirname(path) == top]
        print(f"    loose: {len(loose)} files")
        if loose and top in HAVE_NO_LOOSE_SOURCES:
            faults.append(f"{loose[0]} stands in no room of {top}")
        for a, b in mutual:
            print(f"    mutual: {a} and {b}")
    order = [name for name, _ in FLOORS]
    back = [(a, b) for a, b in arrows if a in order and b in order and a.split("/")[0] == b.split("/")[0]
            and b not in dict(FLOORS)[a]]
    print(f"arrows back: {len(back)}")

    found = knots(merge_public(unit_graph(pairs)))
    print(f"knots of units: {len(found)}")
    for knot in found:
        print(f"    {len(knot)}: {', '.join(knot)}")
        limit = min(MOST_UNITS_OF_KNOT.get(top_of(unit), MOST_UNITS_OF_OTHER_KNOT) for unit in knot)
        if len(knot) > limit:
            faults.append(f"a knot of {len(knot)} units; {limit} is the most: {', '.join(knot)}")

    lengths = [(sum(1 for _ in open(os.path.join(ROOT, path), encoding="utf-8")), path) for path in files]
    for lines, path in sorted(lengths, reverse=True)[:3]:
        print(f"{lines:5d} lines  {path}")
    faults += [f"{path} has {lines} lines; {MOST_LINES_OF_FILE} is the most"
               for lines, path in lengths if lines > MOST_LINES_OF_FILE]
    functions = [(length, path, start) for path in files if not path.startswith("benchmarks/")  # tables of cases
                 for start, length in function_lengths(path)]
    for length, path, start in sorted(functions, reverse=True)[:3]:
        print(f"{length:5d} lines  {path}:{start}")
    faults += [f"{path}:{start} is a function of {length} lines; {MOST_LINES_OF_FUNCTION} is the most"
               for length, path, start in functions if length > MOST_LINES_OF_FUNCTION]

    faults += judge_classes(files)

    for fault in faults:
        print("fault:", fault)
    if options.check and faults:
        sys.exit(1)


if __name__ == "__main__":
    main()
