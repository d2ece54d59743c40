#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Counts what CONTRIBUTING.md asks of comments and documents. Standard library only.

    tools/words.py             comments whose sentences begin with a relative clause, "likewise" and "the same", by folder;
                               words of the documents, named constants
    tools/words.py --check     exits with 1, too, if a count exceeds its limit
"""
import argparse
import collections
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
RELATIVE = ("What", "Of", "Where", "Who", "Whose", "Whatever")
PHRASES = ("likewise", "the same")
LIMIT = 20  # occurrences of each in all comments
LIBRARIES = ("fem", "bullet_bridge", "plugin", "io", "include")


def tracked(pattern):
    names = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n")
    return [name for name in names if re.search(pattern, name)]


def text_of(name):
    with open(os.path.join(ROOT, name), encoding="utf-8", errors="replace") as file:
        return file.read()


def comments(text):
    """Every block of comment lines as one text, and every comment behind code."""
    block = []
    for line in text.split("\n"):
        own = re.match(r"\s*///?<?\s?(.*)$", line)
        if own:
            block.append(own[1])
            continue
        if block:
            yield " ".join(block)
        block = []
        behind = re.search(r"\S.*?\s///?<?\s+(.*)$", line)
        if behind:
            yield behind[1]
    if block:
        yield " ".join(block)


def count(name):
    found = collections.Counter()
    for text in comments(text_of(name)):
        for word in RELATIVE:
            found[word] += len(re.findall(rf"(?:^|[.;:!?] ){word}\b", text))
        for phrase in PHRASES:
            found[phrase] += text.lower().count(phrase)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--check", action="store_true", help="exit code 1 if a count exceeds its limit")
    options = parser.parse_args()
    sources = tracked(r"\.(h|cpp)$")
    by_folder = collections.defaultdict(collections.Counter)
    for name in sources:
        by_folder[name.split("/")[0]].update(count(name))
    keys = RELATIVE + PHRASES
    print(f"{'comments':14s}", *(f"{key:>9s}" for key in keys))
    for folder, found in sorted(by_folder.items()):
        print(f"{folder:14s}", *(f"{found[key]:9d}" for key in keys))
    total = sum(by_folder.values(), collections.Counter())
    print(f"{'all':14s}", *(f"{total[key]:9d}" for key in keys))

    words = {name: len(text_of(name).split()) for name in tracked(r"\.md$")}
    print(f"documents: {sum(words.values())} words; {', '.join(f'{n} {w}' for w, n in sorted(((w, n) for n, w in words.items()), reverse=True)[:5])}")
    library = [name for name in sources if name.split("/")[0] in LIBRARIES]
    constants = sum(len(set(re.findall(r"\bconstexpr [\w:<>]+ (k[A-Z]\w*)\s*=", text_of(name)))) for name in library)
    print(f"libraries: {sum(text_of(name).count(chr(10)) for name in library)} lines, {constants} named constants")

    faults = [key for key in keys if total[key] > LIMIT]
    for key in faults:
        print(f"fault: comments have {key!r} {total[key]} times; {LIMIT} is the most")
    if options.check and faults:
        sys.exit(1)


if __name__ == "__main__":
    main()
