#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""check_size.py <document> <lines> <bytes>: it has at most so many."""
import sys

path, most_lines, most_bytes = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
with open(path, "rb") as file:
    text = file.read()
lines = text.count(b"\n") + (not text.endswith(b"\n"))
print(f"{path}: {lines} lines of {most_lines} at most, {len(text)} bytes of {most_bytes} at most")
if lines > most_lines or len(text) > most_bytes:
    print("It is too long: move what not everybody must know to docs/.")
    sys.exit(1)
