# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""What the tests of documents share: which documents there are, and their code blocks."""
import os
import re

FENCE = re.compile(r"^(?P<indent>[ \t]*(?:>[ \t]?)*)(?P<fence>`{3,}|~{3,})[ \t]*(?P<language>[\w+-]*)[^\n`]*$")
MARK = re.compile(r"^\s*<!--\s*snippet:\s*(.*?)\s*-->\s*$")


class Block:
    """A fenced block: `line` is that of its first line of code, `text` is without the indent of its fence."""

    def __init__(self, document, line, language, mark):
        self.document, self.line, self.language, self.mark = document, line, language, mark
        self.lines = []

    @property
    def text(self):
        return "".join(line + "\n" for line in self.lines)

    def place(self):
        return f"{self.document}:{self.line}"


def documents(root):
    """Paths from the root of those that there are."""
    found = [name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "THIRD_PARTY.md")
             if os.path.exists(os.path.join(root, name))]
    folder = os.path.join(root, "docs")
    if os.path.isdir(folder):
        found += sorted(f"docs/{name}" for name in os.listdir(folder) if name.endswith(".md"))
    return found


def read(root, document):
    with open(os.path.join(root, document), encoding="utf-8") as file:
        return file.read()


def without_indented_code(lines):
    """The lines, empty where they are code by their indent. What is indented in a list is none."""
    in_list = in_code = False
    result = []
    for number, line in enumerate(lines):
        before = lines[number - 1].strip() if number else ""
        indented = line.startswith(("    ", "\t"))
        if re.match(r"^ {0,3}([*+-]|\d+[.)])[ \t]", line):
            in_list = True
        elif line.strip() and not line.startswith((" ", "\t")) and not before:
            in_list = False
        in_code = not in_list and (in_code or not before) and (indented or not line.strip() and in_code)
        result.append("" if in_code else line)
    return result


def split(document, text):
    """The fenced blocks, and the text with empty lines for code, so that its lines keep their numbers."""
    blocks, prose = [], []
    block, fence, indent, mark = None, "", 0, ""
    for number, line in enumerate(text.split("\n"), 1):
        if block is not None:
            bare = line.strip().lstrip("> ")
            if bare.startswith(fence) and not bare.strip(fence[0]):
                blocks.append(block)
                block = None
            else:
                lead = len(line) - len(line.lstrip(" \t>"))
                block.lines.append(line[min(lead, indent):])
            prose.append("")
            continue
        opening = FENCE.match(line)
        if opening:
            fence, indent = opening["fence"], len(opening["indent"])
            block = Block(document, number + 1, opening["language"].lower(), mark)
            mark = ""
            prose.append("")
            continue
        found = MARK.match(line)
        if found:
            mark = found[1]
        elif line.strip():
            mark = ""
        prose.append(line)
    if block is not None:
        raise ValueError(f"{block.place()}: a code block is never closed")
    return blocks, "\n".join(without_indented_code(prose))
