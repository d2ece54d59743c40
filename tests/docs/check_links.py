#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Every relative link and anchor of the documents resolves, and every path of the source tree that they name exists.

    check_links.py [--root <source tree>]

Paths in backticks count if they begin with a folder of FOLDERS. They may lack .h or .cpp, name a public header without
include/bullet_fem/, and hold * and {a,b}. Anchors are those that GitHub makes of headings. Standard library only.
"""
import argparse
import glob
import os
import re
import sys
import urllib.parse

sys.dont_write_bytecode = True
import markdown_files  # noqa: E402, beside this file

FOLDERS = ("fem/", "plugin/", "bullet_bridge/", "io/", "tools/", "tests/", "include/", "demos/", "cmake/", "benchmarks/",
           "docs/")
INLINE_CODE = re.compile(r"(?<!`)(`+)(?!`)((?:(?!\n\s*\n).)+?)(?<!`)\1(?!`)", re.DOTALL)
LINK = re.compile(r"\]\(\s*<?([^()\s<>]*(?:\([^()\s]*\)[^()\s<>]*)*)>?(?:\s+(?:\"[^\"]*\"|'[^']*'))?\s*\)")
REFERENCE = re.compile(r"^ {0,3}\[([^\]]+)\]:[ \t]*<?(\S+?)>?(?:\s|$)", re.MULTILINE)
HTML = re.compile(r"<(?:a|img|source)\b[^>]*?\b(?:href|src|srcset)=[\"']([^\"']+)[\"']", re.IGNORECASE)
NAMED = re.compile(r"<[a-z]+\b[^>]*?\b(?:id|name)=[\"']([^\"']+)[\"']", re.IGNORECASE)
OUTSIDE = re.compile(r"^([a-z][a-z0-9+.-]*:|//)", re.IGNORECASE)


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def blanked(text, pattern):
    """The text with spaces for what matches, line breaks kept."""
    return pattern.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)


def slug(heading):
    """GitHub's anchor of a heading: its text, in small letters, without punctuation, with hyphens for spaces."""
    code = []

    def keep(match):
        code.append(match[2])
        return f"\0{len(code) - 1}\0"

    text = INLINE_CODE.sub(keep, heading)
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", "", text)
    text = re.sub(r"\[([^\]]*)\](?:\([^)]*\)|\[[^\]]*\])", r"\1", text)
    text = re.sub(r"<[^>]+>", "", text)
    text = re.sub(r"(\*{1,3})(?=\S)(.+?)(?<=\S)\1", r"\2", text)
    text = re.sub(r"(?<!\w)(_{1,3})(?=\S)(.+?)(?<=\S)\1(?!\w)", r"\2", text)
    text = re.sub(r"\0(\d+)\0", lambda match: code[int(match[1])], text)
    text = re.sub(r"[^\w\- ]", "", text.strip().lower())
    return text.replace(" ", "-")


def anchors(prose):
    """All anchors of a document, given without its code blocks."""
    found, taken = set(NAMED.findall(prose)), {}
    lines = prose.split("\n")
    for number, line in enumerate(lines):
        heading = re.match(r"^ {0,3}#{1,6}[ \t]+(.*?)(?:[ \t]+#+)?[ \t]*$", line)
        text = heading[1] if heading else None
        if text is None and re.match(r"^ {0,3}(=+|-+)[ \t]*$", line) and number > 0 and lines[number - 1].strip():
            text = lines[number - 1].strip()
        if text is None:
            continue
        name = slug(text)
        while name in taken:  # the second of a name gets -1 behind it, the third -2
            taken[name] += 1
            candidate = f"{name}-{taken[name]}"
            if candidate not in taken:
                name = candidate
                break
        taken[name] = 0
        found.add(name)
    return found


class Checker:
    def __init__(self, root):
        self.root = os.path.realpath(root)
        self.documents = markdown_files.documents(self.root)
        self.prose = {}
        self.anchors = {}
        self.faults = []
        self.links = self.paths = 0
        for document in self.documents:
            self.load(document)

    def load(self, document):
        if document not in self.prose:
            _, self.prose[document] = markdown_files.split(document, markdown_files.read(self.root, document))
            self.anchors[document] = anchors(self.prose[document])

    def fault(self, document, line, text):
        self.faults.append(f"{document}:{line}: {text}")

    def check_link(self, document, line, link):
        if not link:
            self.fault(document, line, "a link to nothing")
            return
        if OUTSIDE.match(link):
            return
        self.links += 1
        path, _, anchor = urllib.parse.unquote(link).partition("#")
        if path.startswith("/"):
            target = os.path.normpath(path.lstrip("/"))
        elif path:
            target = os.path.normpath(os.path.join(os.path.dirname(document), path))
        else:
            target = document
        if target.startswith(".."):
            self.fault(document, line, f"{link} leaves the source tree")
        elif not os.path.exists(os.path.join(self.root, target)):
            self.fault(document, line, f"{link}: there is no {target}")
        elif anchor and target.endswith(".md"):
            self.load(target)
            if anchor not in self.anchors[target]:
                near = [name for name in sorted(self.anchors[target]) if name.split("-")[0] == anchor.split("-")[0]]
                hint = f"; it has #{', #'.join(near)}" if near else ""
                self.fault(document, line, f"{link}: {target} has no heading of the anchor #{anchor}{hint}")

    def exists(self, path):
        for prefix in ("", "include/bullet_fem/"):
            for ending in ("", ".h", ".cpp", "-inl.h"):
                if glob.glob(os.path.join(glob.escape(self.root), prefix + path + ending)):
                    return True
        return False

    def check_code(self, document, line, code):
        for word in code.split():
            word = re.sub(r"(::.*|#.*|:\d+(-\d+)?)$", "", word.strip("\"'()[],;")).rstrip(".,:;")
            if not word.startswith(FOLDERS) or re.search(r"[<>$]|\.\.\.|…", word):
                continue
            self.paths += 1
            for path in braces(word):
                if not self.exists(path):
                    self.fault(document, line, f"`{word}`: there is no {path}")

    def check(self, document):
        prose = blanked(self.prose[document], re.compile(r"<!--.*?-->", re.DOTALL))
        for match in INLINE_CODE.finditer(prose):
            self.check_code(document, line_of(prose, match.start()), match[2])
        prose = blanked(prose, INLINE_CODE)
        defined = {match[1].lower() for match in REFERENCE.finditer(prose)}
        for pattern in (LINK, HTML):
            for match in pattern.finditer(prose):
                self.check_link(document, line_of(prose, match.start()), match[1])
        for match in REFERENCE.finditer(prose):
            self.check_link(document, line_of(prose, match.start()), match[2])
        for match in re.finditer(r"\][ ]?\[([^\]]+)\]", prose):
            if match[1].lower() not in defined:
                self.fault(document, line_of(prose, match.start()), f"[{match[1]}] is nowhere defined")


def braces(word):
    """a{b,c}d is abd and acd."""
    match = re.search(r"\{([^{}]*)\}", word)
    if not match:
        return [word]
    return [path for choice in match[1].split(",")
            for path in braces(word[:match.start()] + choice.strip() + word[match.end():])]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--root", default=os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
    checker = Checker(parser.parse_args().root)
    for document in checker.documents:
        checker.check(document)
    for fault in checker.faults:
        print(fault)
    print(f"{len(checker.documents)} documents, {checker.links} links within them, {checker.paths} paths: "
          f"{len(checker.faults)} faults")
    sys.exit(1 if checker.faults or not checker.documents else 0)


if __name__ == "__main__":
    main()
