#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""built.py <compiler> <standard> <Bullet> <precision> <system> <result>: prints the row, and writes it to the table of
docs/compatibility.md in place of a row that differs in the result alone. Scripts of this folder call it."""
import os
import sys

DOCUMENT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "compatibility.md")
BEGIN, END = "<!-- built: by tools/ci -->\n", "<!-- end of built -->\n"
HEAD = "| compiler | standard | Bullet | precision | system | result |\n|---|---|---|---|---|---|\n"


def cells_of(row):
    return [cell.strip() for cell in row.strip().strip("|").split("|")]


def main():
    cells = sys.argv[1:]
    if len(cells) != 6 or any("|" in cell for cell in cells):
        print(f"built.py: it takes six texts without |, not {cells}", file=sys.stderr)
        return 2
    with open(DOCUMENT, encoding="utf-8") as file:
        text = file.read()
    before, rest = text.split(BEGIN)
    table, after = rest.split(END)
    rows = {tuple(cells_of(row)[:5]): cells_of(row) for row in table[len(HEAD):].splitlines()}
    rows[tuple(cells[:5])] = cells
    lines = ["| " + " | ".join(row) + " |\n" for _, row in sorted(rows.items())]
    with open(DOCUMENT, "w", encoding="utf-8") as file:
        file.write(before + BEGIN + HEAD + "".join(lines) + END + after)
    print("  ".join(cells))
    return 0


if __name__ == "__main__":
    sys.exit(main())
