#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Plots error against time from the curve of bulletfem_bench_beam. Needs python3-matplotlib.

    bulletfem_bench_beam --curve --tets 12288 --young 1e6 --json curve.json
    tools/plot_error_against_time.py curve.json docs/error_against_time.png
"""
import argparse
import json

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  the backend comes first

STYLES = {  # method: name, colour, marker
    "nodal": ("BulletFEM, nodal warp", "#c0392b", "o"),
    "global": ("BulletFEM, global warp", "#e08e45", "s"),
    "direct": ("BulletFEM, direct mode", "#7d3c98", "D"),
    "bullet": ("Bullet deformable", "#34618f", "^"),
}
SMALLEST = 1e-10  # drawn in place of a zero error


def draw(rows, axes):
    for method, (name, colour, marker) in STYLES.items():
        points = [row for row in rows if row["method"] == method and row["tip_error_worst"] is not None]
        if not points:
            continue
        times = [row["ms_cpu_median"] for row in points]
        errors = [max(row["tip_error_worst"], SMALLEST) for row in points]
        axes.plot(times, errors, color=colour, marker=marker, markersize=5, linewidth=1.2, label=name)
        for row, x, y in zip(points, times, errors):
            if method in ("nodal", "bullet") and (row["tolerance"] or method == "bullet"):
                text = f"{row['tolerance']:.0e}" if row["tolerance"] else "default"
                axes.annotate(text, (x, y), textcoords="offset points", xytext=(5, 4), fontsize=6.5, color=colour)


def main():
    parser = argparse.ArgumentParser(description="Draws error against time.")
    parser.add_argument("curve", help="JSON file of bulletfem_bench_beam --curve")
    parser.add_argument("picture", help="PNG to write")
    options = parser.parse_args()
    with open(options.curve, encoding="utf-8") as file:
        document = json.load(file)
    rows = document["results"]
    figure, axes = plt.subplots(figsize=(7.2, 4.4), dpi=120)
    draw(rows, axes)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.margins(x=0.08)
    axes.set_xlabel("processor time of a step, median [ms]")
    axes.set_ylabel("worst tip error of all steps [-]")
    axes.set_title(f"Clamped beam, {rows[0]['tets']:,} tets, E = {rows[0]['young_modulus_pa']:.0e} Pa, "
                   f"{document['steps']} steps of 1/60 s, one thread", fontsize=9)
    axes.grid(True, which="major", linewidth=0.4, alpha=0.6)
    axes.legend(fontsize=8, loc="best")
    figure.tight_layout()
    figure.savefig(options.picture)


if __name__ == "__main__":
    main()
