#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Renews the tables of docs/performance.md from the JSON files of the benchmarks. Standard library only.

    tools/performance_tables.py out/benchmarks docs/performance.md

A table stands between <!-- table: NAME --> and <!-- end -->. Those without any of their rows in the JSON files are left
as they are.
"""
import argparse
import json
import math
import os
import re
import sys

METHODS = {
    "nodal": "nodal warp",
    "global": "global warp",
    "direct": "direct mode",
    "mass-spring": "Bullet mass-spring, 20 iterations",
    "bullet": "Bullet deformable",
}
CROWDS = ["crowd_swap", "crowd_400", "crowd_cubes"]


def number(value, digits=3):
    """A figure with that many significant digits, without exponent from a ten-thousandth on."""
    if value is None:
        return "-"
    if abs(value) < 1e-4:
        return f"{value:.0e}" if value else "0"
    decimals = digits - 1 - math.floor(math.log10(abs(value)))
    return f"{value:,.{max(decimals, 0)}f}"


def percent(value):
    return "-" if value is None else f"{100 * value:.4f} %"


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def whole(value):
    return f"{value:,}"


def method(row, default=""):
    """The method, with its tolerance if it has one."""
    text = f"{row['tolerance']:.0e}" if row["tolerance"] else default
    return METHODS[row["method"]] + (f", {text}" if text else "")


def chosen(rows, keys, wanted):
    """Those rows whose values of these keys are wanted: the page shows a selection, *.txt beside the JSON files all."""
    def rounded(value):
        return float(f"{value:.3g}") if isinstance(value, float) else value
    return [row for row in rows if tuple(rounded(row[key]) for key in keys) in wanted]


BEAM_ROWS = {(1536, 1e6, "nodal", 1e-3), (1536, 1e6, "bullet", 0), (12288, 1e6, "nodal", 1e-3), (12288, 1e6, "global", 1e-6),
             (12288, 1e6, "mass-spring", 0), (12288, 1e6, "bullet", 0), (12288, 1e7, "nodal", 1e-3), (12288, 1e7, "bullet", 0)}


def beam(document):
    heads = ["tets", "E [Pa]", "method, tolerance", "median ms", "worst ms", "tip error", "set-up ms", "MB", "x Bullet"]
    rows = []
    for row in chosen(document["results"], ["tets", "young_modulus_pa", "method", "tolerance"], BEAM_ROWS):
        outside = row["same_model"] and not row["counts"]
        rows.append([whole(row["tets"]), f"{row['young_modulus_pa']:.0e}", method(row), number(row["ms_median"]),
                     number(row["ms_worst"]), percent(row["tip_error_worst"]), number(1e3 * row["setup_s"]),
                     number(row["memory_mb"]), "not within bounds" if outside else number(row["ratio_to_bullet_cpu"] or None)])
    return heads, rows


CURVE_ROWS = {("nodal", 1e-3), ("nodal", 1e-4), ("nodal", 1e-6), ("direct", 0), ("bullet", 1e-2), ("bullet", 0)}


def curve(document):
    heads = ["method, tolerance", "median ms", "iterations", "tip error"]
    return heads, [[method(row, "default" if row["method"] == "bullet" else ""), number(row["ms_median"]),
                    f"{row['iterations_mean']:.1f}", f"{row['tip_error_worst']:.0e}"]
                   for row in chosen(document["results"], ["method", "tolerance"], CURVE_ROWS)]


def kernels(document):
    heads = ["kernel", "ns/tet", "GB/s", "GFLOP/s"]
    return heads, [[row["kernel"], number(row["ns_per_tet"]), number(row["gb_per_s"] or None), number(row["gflop_per_s"] or None)]
                   for row in chosen(document["kernels"], ["tets"], {(12288,)})]


SCALING_ROWS = {(1536,), (12288,), (24000,), (98304,), (192000,)}


def scaling(document):
    heads = ["tets", "set-up ms", "factor MB", "all MB", "iterations", "median ms", "worst ms"]
    rows = [[whole(row["tets"]), number(row["setup_ms"]), number(row["factor_mb"]), number(row["memory_mb"]),
             f"{row['iterations_mean']:.1f}", number(row["ms_median"]), number(row["ms_worst"])]
            for row in chosen(document["results"], ["tets"], SCALING_ROWS)]
    p = document["exponents"]
    growth = ["grows as n^p, p", number(p["setup"]), number(p["factor_mb"]), "", "", number(p["step"]), ""]
    return heads, rows + [growth] if rows else []


FACTOR_ROWS = {("cube 13182", name) for name in ("BulletFEM", "CHOLMOD supernodal", "Eigen SimplicialLLT")}


def factors(document):
    heads = ["factor", "order ms", "numeric ms", "one solve ms", "16 solves ms", "fill", "MB"]
    return heads, [[row["factor"], number(row["order_ms"]), number(row["numeric_ms"]), number(row["solve_ms"]),
                    number(row["sixteen_ms"]), number(row["fill"]), number(row["factor_mb"])]
                   for row in chosen(document["factors"], ["matrix", "factor"], FACTOR_ROWS)]


CONTACT_ROWS = {("block on static box", "~100", "fem"), ("block on static box", "~100", "bullet"),
                ("block on static box", "~100", "bullet/4"), ("ball meets cube, zero gravity", "ratio 1", "fem"),
                ("ball meets cube, zero gravity", "ratio 1", "bullet")}


def contact(document):
    heads = ["scene", "tets", "method", "median ms", "worst ms", "contact ms", "deepest mm", "x Bullet"]
    return heads, [[row["scene"], whole(row["tets"]), row["method"], number(row["ms_median"]), number(row["ms_worst"]),
                    number(row["ms_contact_median"]),
                    "failed" if row["stopped_in_step"] else number(1e3 * row["penetration_worst_m"]),
                    number(row["ratio_to_bullet"])]
                   for row in chosen(document["results"], ["scene", "variant", "method"], CONTACT_ROWS)]


def copies(document):
    heads = ["bodies", "tets", "together ms", "one by one ms", "ratio"]
    wanted = {(16, 1080, 1), (100, 1080, 1), (16, 10985, 1)}
    return heads, [[row["bodies"], whole(row["tets"]), number(row["ms_together_median"]), number(row["ms_alone_median"]),
                    f"{row['ratio']:.2f}" if row["same_bits"] else "DIFFERENT BITS"]
                   for row in chosen(document["results"], ["bodies", "tets", "stale"], wanted)]


# Bodies, cubes, phase; of the swap and identical bodies.
CROWD_ROWS = {(100, False, "falling"), (100, False, "awake"), (400, False, "awake"), (100, True, "awake")}


def crowd(*documents):
    heads = ["bodies, tolerance", "phase", "median ms", "worst ms", "free ms", "contact ms", "points", "deepest mm"]
    rows = []
    for document in documents:
        kind = "cubes" if document["cubes"] else "balls"
        name = f"{document['bodies']} {kind}, {document['balls']} rigid, {document['contact_tolerance']:.0e}"
        rows += [[name, row["phase"], number(row["ms_median"]), number(row["ms_worst"]), number(row["ms_free_median"]),
                  number(row["ms_contact_median"]), f"{row['contacts_mean']:.0f}", number(1e3 * row["penetration_worst_m"])]
                 for row in document["results"] if (document["bodies"], document["cubes"], row["phase"]) in CROWD_ROWS]
    return heads, rows


def machine(*documents):
    """What is the same for all, once; the load of each."""
    names = ["cpu", "vectors", "factors", "compiler", "commit", "bullet"]
    rows = []
    for name in names:
        values = sorted({re.sub(r"(OpenBLAS [\d.]+).*", r"\1", d["machine"][name]) for d in documents if name in d["machine"]})
        if values:
            rows.append([name, ", ".join(values)])
    loads = sorted(float(d["machine"]["load_before"]) for d in documents)
    rows.append(["load before each program (1 minute)", f"{loads[0]:.1f} to {loads[-1]:.1f}"])
    return ["", ""], rows


# Table, its function, the files it is made of; of several files those that are there.
TABLES = [
    ("machine", machine, ["beam", "curve", "kernels", "factors", "scaling", "contact", "copies", *CROWDS]),
    ("beam", beam, ["beam"]),
    ("curve", curve, ["curve"]),
    ("kernels", kernels, ["kernels"]),
    ("factors", factors, ["factors"]),
    ("scaling", scaling, ["scaling"]),
    ("contact", contact, ["contact"]),
    ("copies", copies, ["copies"]),
    ("crowd", crowd, CROWDS),
]


def load(folder, names):
    documents = []
    for name in names:
        path = os.path.join(folder, name + ".json")
        if os.path.exists(path) and os.path.getsize(path) > 0:
            with open(path, encoding="utf-8") as file:
                documents.append(json.load(file))
    return documents


def renew(page, name, text):
    pattern = re.compile(rf"(<!-- table: {name} -->\n).*?(<!-- end -->)", re.DOTALL)
    if not pattern.search(page):
        sys.exit(f"the page has no '<!-- table: {name} -->' ... '<!-- end -->': put both lines where the table belongs")
    return pattern.sub(lambda match: match.group(1) + text + "\n" + match.group(2), page, count=1)


def main():
    parser = argparse.ArgumentParser(description="Renews the tables of docs/performance.md.")
    parser.add_argument("folder", help="folder with the JSON files of the benchmarks")
    parser.add_argument("page", help="the Markdown page")
    options = parser.parse_args()
    with open(options.page, encoding="utf-8") as file:
        page = file.read()
    for name, make, files in TABLES:
        documents = load(options.folder, files)
        heads, rows = make(*documents) if documents else ([], [])
        if rows:
            page = renew(page, name, table(heads, rows))
    with open(options.page, "w", encoding="utf-8") as file:
        file.write(page)


if __name__ == "__main__":
    main()
