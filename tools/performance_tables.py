#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Updates the tables of docs/performance.md from the JSON files of the benchmarks. Needs Python's standard library only.

    tools/performance_tables.py out/benchmarks docs/performance.md

A table is between <!-- table: NAME --> and <!-- end -->. Tables without a JSON file stay unchanged.
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
CROWDS = ["crowd_swap", "crowd_400", "crowd_different", "crowd_cubes", "crowd_coupled"]


def number(value, digits=3):
    """Formats a number with that many significant digits, without exponent from 1e-4 on."""
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


def tolerance(row):
    return f"{row['tolerance']:.0e}" if row["tolerance"] else "-"


def beam_row(row):
    counts = "-" if not row["same_model"] else "yes" if row["counts"] else "no"
    residual = row["residual_worst"]
    return [f"{row['tets']:,}", f"{row['young_modulus_pa']:.0e}", METHODS[row["method"]], tolerance(row),
            number(row["ms_median"]), number(row["ms_cpu_median"]), number(row["ms_worst"]), f"{row['iterations_mean']:.1f}",
            "-" if residual is None else f"{residual:.0e}", percent(row["tip_error_worst"]), counts,
            number(1e3 * row["setup_s"]), number(row["memory_mb"]), number(row["ratio_to_bullet"]),
            number(row["ratio_to_bullet_cpu"] or None)]


def beam(document):
    heads = ["tets", "E [Pa]", "method", "tolerance", "median ms", "CPU ms", "worst ms", "iterations", "residual",
             "tip error", "counts", "set-up ms", "MB", "x Bullet, medians", "x Bullet, CPU"]
    return table(heads, [beam_row(row) for row in document["results"]])


def curve(document):
    heads = ["method", "tolerance", "median ms", "CPU ms", "iterations", "residual", "tip error"]
    rows = [[METHODS[row["method"]], tolerance(row) if row["tolerance"] or row["method"] != "bullet" else "default",
             number(row["ms_median"]), number(row["ms_cpu_median"]), f"{row['iterations_mean']:.1f}", f"{row['residual_worst']:.0e}",
             f"{row['tip_error_worst']:.0e}"] for row in document["results"]]
    return table(heads, rows)


def kernels(document):
    heads = ["tets", "kernel", "best us", "median us", "ns/tet", "GB/s", "GFLOP/s"]
    rows = [[f"{row['tets']:,}", row["kernel"], number(row["us_best"]), number(row["us_median"]),
             number(row["ns_per_tet"]), number(row["gb_per_s"]) if row["gb_per_s"] else "-",
             number(row["gflop_per_s"]) if row["gflop_per_s"] else "-"] for row in document["kernels"]]
    return table(heads, rows)


def solves(document):
    heads = ["tets", "packed factor MB", "read bandwidth GB/s", "one solve pair / two reads, alternately",
             "of the best, each for itself", "16 right-hand sides / one"]
    rows = [[f"{row['tets']:,}", number(row["factor_mb"]), number(row["read_gb_per_s"]),
             f"{row['pair_over_two_reads']:.2f}", f"{row['pair_over_best_reads']:.2f}",
             f"{row['sixteen_over_one']:.2f}"] for row in document["solves"]]
    return table(heads, rows)


def compliance(document):
    c = document["compliance"]
    return table(["nodes touched", "of a block of", "newly touched, ms", "touched before, ms", "peak GFLOP/s"],
                 [[c["touched"], f"{c['tets']:,} tets", f"{number(c['ms_new_best'])} (median {number(c['ms_new_median'])})",
                   f"{number(c['ms_known_best'])} (median {number(c['ms_known_median'])})",
                   number(document["peak_gflop_per_s"])]])


def scaling(document):
    heads = ["tets", "set-up ms", "order", "order ms", "numeric ms", "factor MB", "fill", "all MB", "iterations", "median ms",
             "CPU ms", "worst ms", "residual"]
    rows = [[f"{row['tets']:,}", number(row["setup_ms"]), row["ordering"], number(row["order_ms"]),
             number(row["tree_ms"] + row["numeric_ms"]), number(row["factor_mb"]), number(row["fill"]),
             number(row["memory_mb"]), f"{row['iterations_mean']:.1f}", number(row["ms_median"]), number(row["ms_cpu_median"]),
             number(row["ms_worst"]), f"{row['residual_worst']:.1e}"] for row in document["results"]]
    p = document["exponents"]
    growth = ["grows as n^p, p", number(p["setup"]), "", number(p["order"]), number(p["numeric"]), number(p["factor_mb"]),
              "", "", "", "", number(p["step"]), "", ""]
    return table(heads, rows + [growth])


def factors(document):
    heads = ["matrix", "factor", "order by", "order ms", "numeric ms", "one solve ms", "16 solves ms", "fill", "MB", "residual"]
    return table(heads, [[row["matrix"], row["factor"], row["ordering"] or "-", number(row["order_ms"]),
                          number(row["numeric_ms"]), number(row["solve_ms"]), number(row["sixteen_ms"]),
                          number(row["fill"]), number(row["factor_mb"]), f"{row['residual']:.0e}"]
                         for row in document["factors"]])


def first_steps(document):
    heads = ["body", "tets", "mesh ms", "factor ms", "first step ms", "all ms"]
    return table(heads, [[row["matrix"], f"{row['tets']:,}", number(row["mesh_ms"]), number(row["model_ms"]), number(row["step_ms"]),
                          number(row["mesh_ms"] + row["model_ms"] + row["step_ms"])] for row in document["first_steps"]])


def fill(document):
    heads = ["mesh", "tets", "free nodes", "AMD", "METIS", "Eigen", "chosen"]
    return table(heads, [[row["mesh"], f"{row['tets']:,}", f"{row['free_nodes']:,}", number(row["amd"] or None),
                          number(row["metis"] or None), number(row["eigen"] or None), row["chosen"]]
                         for row in document["fill"]])


def contact(document):
    heads = ["scene", "tets", "variant", "method", "points", "median ms", "worst ms", "CPU ms", "free ms", "contact ms",
             "deepest mm", "x Bullet"]
    rows = [[row["scene"], f"{row['tets']:,}", row["variant"], row["method"], row["contacts"],
             number(row["ms_median"]), number(row["ms_worst"]), number(row["ms_cpu_median"]), number(row["ms_free_median"]),
             number(row["ms_contact_median"]),
             "failed" if row["stopped_in_step"] else number(1e3 * row["penetration_worst_m"]),
             number(row["ratio_to_bullet"])] for row in document["results"]]
    return table(heads, rows)


def copies(document):
    heads = ["bodies", "tets", "factor MB", "stale", "iterations a step", "together ms", "one by one ms", "ratio", "bits"]
    return table(heads, [[row["bodies"], f"{row['tets']:,}", number(row["factor_mb"]), f"{row['stale']:.0f}",
                          f"{row['iterations_mean']:.2f}", number(row["ms_together_median"]), number(row["ms_alone_median"]),
                          f"{row['ratio']:.2f}", "same" if row["same_bits"] else "DIFFERENT"] for row in document["results"]])


def crowd_rows(document):
    kind = ("different " if document["different"] else "identical ") + ("cubes" if document["cubes"] else "balls")
    name = f"{document['bodies']} {kind}, {document['balls']} rigid"
    way = (f"{'coupled' if document['coupled'] else 'swap'}, {document['contact_tolerance']:.0e}, "
           f"{document['threads']} thread{'s' if document['threads'] > 1 else ''}")
    return [[name, way, row["phase"], number(row["ms_median"]), number(row["ms_worst"]), number(row["ms_free_median"]),
             number(row["ms_contact_median"]), number(row["ms_rest_median"]), f"{row['contacts_mean']:.0f}",
             f"{row['sweeps_mean']:.0f}", f"{row['corrective_iterations_mean']:.0f}", row["asleep"],
             number(1e3 * row["penetration_worst_m"])] for row in document["results"]]


def crowd(*documents):
    heads = ["bodies", "way", "phase", "median ms", "worst ms", "free ms", "contact ms", "rest ms", "points", "sweeps",
             "corr. iterations", "asleep", "deepest mm"]
    return table(heads, [row for document in documents for row in crowd_rows(document)])


def machine(*documents):
    """Table of the machine: common values once, and the range of loads."""
    names = ["cpu", "logical_cores", "threads", "vectors", "factors", "compiler", "build_type", "bulletfem", "commit", "bullet"]
    rows = []
    for name in names:
        values = sorted({d["machine"][name] for d in documents if name in d["machine"]})
        if values:
            rows.append([name.replace("_", " "), ", ".join(values)])
    loads = sorted(float(d["machine"]["load_before"]) for d in documents)
    rows.append(["load before each program (1 minute)", f"{loads[0]:.1f} to {loads[-1]:.1f}"])
    return table(["", ""], rows)


# Table, its function, and the files from which it is made; missing ones of several files are skipped.
TABLES = [
    ("machine", machine, ["beam", "curve", "kernels", "factors", "scaling", "contact", "copies", *CROWDS]),
    ("beam", beam, ["beam"]),
    ("curve", curve, ["curve"]),
    ("kernels", kernels, ["kernels"]),
    ("solves", solves, ["kernels"]),
    ("compliance", compliance, ["kernels"]),
    ("factors", factors, ["factors"]),
    ("first_steps", first_steps, ["factors"]),
    ("fill", fill, ["factors"]),
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
        if documents:
            page = renew(page, name, make(*documents))
    with open(options.page, "w", encoding="utf-8") as file:
        file.write(page)


if __name__ == "__main__":
    main()
