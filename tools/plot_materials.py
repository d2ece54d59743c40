#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Plots the curves measured by bulletfem_bench_materials and the corresponding formulas. Needs python3-matplotlib.

    bulletfem_bench_materials --json materials.json
    tools/plot_materials.py materials.json docs/materials.png
"""
import argparse
import json

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  the backend comes first

COLOURS = ["#34618f", "#c0392b", "#3a8f4d", "#7d5ba6"]
FIGURES = {  # figure: title, x, y, factor of x, of y
    "yield": ("Plasticity: pulled, pressed, let go", "strain [%]", "stress / yield stress", 100, 1e-3),
    "relaxation": ("Relaxation: held where it was sheared", "time [s]", "stress / first stress", 1, 1),
    "large strain": ("Large strain: pulled", "stretch", "stress / Young's modulus", 1, 1),
    "tip": ("Clamped bar, 4 cells across: tip / Timoshenko's", "Poisson's ratio", "tip / formula", 1, 1),
}


def draw(curves, figure, axes):
    title, x_name, y_name, x_factor, y_factor = FIGURES[figure]
    formula = "formula"
    for colour, curve in zip(COLOURS, curves):
        x = [x_factor * value for value in curve["x"]]
        axes.plot(x, [y_factor * value for value in curve["formula"]], color="black", linewidth=0.9, label=formula)
        axes.plot(x, [y_factor * value for value in curve["measured"]], color=colour, marker="o", markersize=3,
                  linewidth=1 if figure == "tip" else 0, label=curve["name"])
        formula = None  # one entry in the legend
    axes.set_title(title, fontsize=9)
    axes.set_xlabel(x_name, fontsize=8)
    axes.set_ylabel(y_name, fontsize=8)
    axes.tick_params(labelsize=7)
    axes.grid(color="#dddddd", linewidth=0.5)
    if figure == "tip":
        axes.set_ylim(0, 1.1)
    axes.legend(fontsize=7, frameon=False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("json", help="what bulletfem_bench_materials --json wrote")
    parser.add_argument("picture", help="the PNG file")
    arguments = parser.parse_args()
    with open(arguments.json, encoding="utf-8") as file:
        curves = json.load(file)["curves"]
    figures = [figure for figure in FIGURES if any(curve["figure"] == figure for curve in curves)]
    picture, axes = plt.subplots(2, 2, figsize=(9, 6.6), dpi=100)
    for figure, place in zip(figures, axes.flat):
        draw([curve for curve in curves if curve["figure"] == figure], figure, place)
    for place in axes.flat[len(figures):]:
        place.axis("off")
    picture.tight_layout()
    picture.savefig(arguments.picture)


if __name__ == "__main__":
    main()
