#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Plots how balls rebound against modulus times step, with and without elastic rebound. Needs python3-matplotlib.

    bulletfem_bench_motion --cases rebound --json motion.json
    tools/plot_rebound.py motion.json docs/rebound_against_stiffness.png
"""
import argparse
import json

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  the backend comes first

METHODS = {  # method: name, colour
    "default": ("default settings", "#c0392b"),
    "Euler": ("m_elasticRebound = false", "#34618f"),
}
MARKERS = {1e5: "o", 1e6: "s", 1e7: "^"}  # modulus [Pa]


def draw(rows, axes):
    for young, marker in MARKERS.items():
        of_young = [row for row in rows if row["young"] == young]
        for method, (_, colour) in METHODS.items():
            points = sorted((young / row["steps_per_second"], row["value"]) for row in of_young
                            if row["method"] == method)
            axes.plot(*zip(*points), color=colour, marker=marker, markersize=5, linewidth=1)
        products = [young / row["steps_per_second"] for row in of_young]
        axes.plot([min(products), max(products)], [of_young[0]["reference"]] * 2, color="black", linewidth=1,
                  linestyle=":", marker=marker, markersize=5, fillstyle="none")
    for name, colour, style in [(*METHODS["default"], "-"), (*METHODS["Euler"], "-"), ("1/1920 s", "black", ":")]:
        axes.plot([], [], color=colour, linestyle=style, label=name)
    for young, marker in MARKERS.items():
        axes.plot([], [], color="gray", marker=marker, linestyle="", label=f"{young / 1e6:g} MPa")
    axes.set_xscale("log")
    axes.set_ylim(0, 1.1)
    axes.set_xlabel("Young's modulus times step [Pa s]", fontsize=8)
    axes.set_ylabel("speed after / before", fontsize=8)
    rates = [row["steps_per_second"] for row in rows]
    axes.set_title(f"Undamped ball of 0.5 m dropped from 1 m, steps of 1/{min(rates)} to 1/{max(rates)} s", fontsize=9)
    axes.tick_params(labelsize=7)
    axes.grid(True, which="major", linewidth=0.4, alpha=0.6)
    axes.legend(fontsize=7, loc="center left", bbox_to_anchor=(1, 0.5))


def main():
    parser = argparse.ArgumentParser(description="Draws rebounds against modulus times step.")
    parser.add_argument("figures", help="JSON file of bulletfem_bench_motion with the case rebound")
    parser.add_argument("picture", help="PNG to write")
    options = parser.parse_args()
    with open(options.figures, encoding="utf-8") as file:
        rows = [row for row in json.load(file)["results"] if row["case"] == "rebound"]
    figure, axes = plt.subplots(figsize=(8, 3.8), dpi=100)
    draw(rows, axes)
    figure.tight_layout()
    figure.savefig(options.picture)


if __name__ == "__main__":
    main()
