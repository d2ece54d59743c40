#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Doxygen's filter for documents: prints a Markdown file with a label after each heading and links to these labels.
Doxygen labels headings by their number, GitHub by their words; these labels are the file's name and GitHub's words."""
import os
import re
import sys

LINK = re.compile(r"\]\(([\w./-]*\.md)?#([\w-]+)\)")


def label_of(path, words):
    """GitHub's anchor, prefixed with the file's name because one site has all files."""
    anchor = re.sub(r"[^\w\- ]", "", words.strip().lower()).replace(" ", "-")
    return f"{os.path.splitext(os.path.basename(path))[0].lower()}-{anchor}"


def main():
    path = sys.argv[1]
    in_code, labels = False, set()
    with open(path, encoding="utf-8") as file:
        for line in file.read().split("\n"):
            if line.lstrip().startswith("```"):
                in_code = not in_code
            heading = None if in_code else re.match(r"#{2,4} (.*)$", line)
            if heading:
                label = label_of(path, heading[1])
                if label not in labels:  # for repeated headings GitHub's link leads to the first
                    labels.add(label)
                    line += f" {{#{label}}}"
            elif not in_code:
                line = LINK.sub(lambda m: f"](#{label_of(m[1] or path, m[2])})", line)
            print(line)
    return 0


if __name__ == "__main__":
    sys.exit(main())
