#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Plots the results of bulletfem_bench_motion against the step size. Needs python3-matplotlib.

    bulletfem_bench_motion --json motion.json
    tools/plot_motion_against_step.py motion.json docs/motion_against_step.png
"""
import argparse
import json

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  the backend comes first

STYLES = {  # method: name, colour, marker
    "Euler": ("implicit Euler", "#34618f", "o"),
    "second order": ("second order", "#c0392b", "s"),
    "rigid": ("Bullet's rigid sphere", "#7f8c8d", "^"),
}
CASES = {  # case: title, axis label, whether relative to the reference
    "tip": ("Tip of a clamped beam, 10 MPa", "largest error / deflection", False),
    "swing": ("Swing of 1.7 Hz, undamped", "half-life of the amplitude [s]", False),
    "drop": ("Ball of 1 MPa dropped from 1 m", "speed after / before", False),
    "roll10": ("Ball rolling down 10 degrees", "speed / reference", True),
    "roll20": ("Ball rolling down 20 degrees", "speed / reference", True),
}
LONGEST = 1e4  # upper limit of half-lives drawn [s]
CURVE = {"tip", "swing"}  # logarithmic


def label(rate):
    return f"1/{rate}"


def draw(rows, case, axes):
    title, what, relative = CASES[case]
    rows = [row for row in rows if row["case"] == case]
    for method, (name, colour, marker) in STYLES.items():
        points = sorted((row["steps_per_second"], row) for row in rows if row["method"] == method)
        if not points:
            continue
        values = [LONGEST if row["value"] is None else min(row["value"], LONGEST) for _, row in points]
        if relative:
            values = [value / row["reference"] for value, (_, row) in zip(values, points)]
        axes.plot([1 / rate for rate, _ in points], values, color=colour, marker=marker, markersize=4.5, linewidth=1.2,
                  label=name)
    rates = sorted({row["steps_per_second"] for row in rows})
    axes.set_xscale("log")
    axes.set_xticks([1 / rate for rate in rates], [label(rate) for rate in rates], fontsize=7)
    axes.minorticks_off()
    if case in CURVE:
        axes.set_yscale("log")
    else:
        axes.set_ylim(bottom=0)
        reference = 1 if relative else rows[0]["reference"]
        axes.axhline(reference, color="black", linewidth=0.8, linestyle=":", label="reference")
    axes.set_title(title, fontsize=9)
    axes.set_ylabel(what, fontsize=8)
    axes.tick_params(axis="y", labelsize=7)
    axes.grid(True, which="major", linewidth=0.4, alpha=0.6)


def draw_cost(rows, axes):
    for case, line in (("tip", "-"), ("roll10", "--")):
        for method in ("Euler", "second order"):
            points = sorted((row["steps_per_second"], row["ms_cpu_median"]) for row in rows
                            if row["case"] == case and row["method"] == method)
            what = "beam" if case == "tip" else "ball"
            axes.plot([1 / rate for rate, _ in points], [time for _, time in points], color=STYLES[method][1],
                      linestyle=line, marker=STYLES[method][2], markersize=4.5, linewidth=1.2,
                      label=f"{what}, {STYLES[method][0]}")
    rates = sorted({row["steps_per_second"] for row in rows})
    axes.set_xscale("log")
    axes.set_xticks([1 / rate for rate in rates], [label(rate) for rate in rates], fontsize=7)
    axes.minorticks_off()
    axes.set_ylim(bottom=0)
    axes.set_title("Cost", fontsize=9)
    axes.set_ylabel("processor time of a step [ms]", fontsize=8)
    axes.tick_params(axis="y", labelsize=7)
    axes.grid(True, which="major", linewidth=0.4, alpha=0.6)
    axes.legend(fontsize=6.5)


def main():
    parser = argparse.ArgumentParser(description="Draws motion against the step.")
    parser.add_argument("figures", help="JSON file of bulletfem_bench_motion, all cases")
    parser.add_argument("picture", help="PNG to write")
    options = parser.parse_args()
    with open(options.figures, encoding="utf-8") as file:
        rows = json.load(file)["results"]
    figure, grid = plt.subplots(2, 3, figsize=(10, 5.6), dpi=100)
    for case, axes in zip(CASES, grid.flat):
        draw(rows, case, axes)
    draw_cost(rows, grid.flat[5])
    grid[1][0].legend(fontsize=6.5, loc="lower right")
    for axes in grid[1]:
        axes.set_xlabel("step [s]", fontsize=8)
    figure.tight_layout()
    figure.savefig(options.picture)


if __name__ == "__main__":
    main()
