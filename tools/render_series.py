#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Draws frames of the series of bulletfem_drop side by side into one PNG. Needs python3-numpy and python3-pil.

    demos/run.sh
    tools/render_series.py out/drop docs/drop.png

The folder holds body.pvd and rigid.pvd; y is up. The body's colour tells how far its points are from where a rigid motion
would have brought them.
"""
import argparse
import os
import xml.etree.ElementTree as ElementTree

import numpy as np
from PIL import Image

BODY, STRAINED = np.array([0.86, 0.64, 0.42]), np.array([0.75, 0.16, 0.12])
GROUND, RIGID, SKY = np.array([0.78, 0.80, 0.82]), np.array([0.40, 0.52, 0.66]), np.array([0.97, 0.97, 0.98])
LIGHT = np.array([-0.35, 1.0, 0.45]) / np.linalg.norm([-0.35, 1.0, 0.45])
OVERSAMPLING = 2
FULL_COLOUR = 0.08  # deformation [longest side] that is drawn in STRAINED


def read_pvd(path):
    """Times [s] and files of a series."""
    sets = ElementTree.parse(path).iter("DataSet")
    return [(float(s.get("timestep")), os.path.join(os.path.dirname(path), s.get("file"))) for s in sets]


def read_vtu(path):
    """Positions (n, 3) [m] and triangles (m, 3) of an ASCII .vtu."""
    root = ElementTree.parse(path).getroot()
    points = np.array(root.find(".//Points/DataArray").text.split(), dtype=float).reshape(-1, 3)
    cells = np.array(root.find(".//Cells/DataArray[@Name='connectivity']").text.split(), dtype=int).reshape(-1, 3)
    return points, cells


def deformation(rest, x):
    """Distance of every point from the best rigid placement of the rest shape (n,) [longest side]."""
    X, y = rest - rest.mean(0), x - x.mean(0)
    u, _, vt = np.linalg.svd(y.T @ X)
    u[:, 2] *= np.linalg.det(u @ vt)
    return np.linalg.norm(y - X @ (u @ vt).T, axis=1) / np.ptp(rest, axis=0).max()


class Camera:
    """Looks from `eye` to `target`; distance None: parallel rays, as of the light."""

    def __init__(self, target, towards, pixels, height, distance=None):
        self.back = towards / np.linalg.norm(towards)
        self.right = np.cross([0, 1, 0], self.back)
        self.right /= np.linalg.norm(self.right)
        self.up = np.cross(self.back, self.right)
        self.target, self.pixels, self.height, self.distance = target, pixels, height, distance

    def project(self, x):
        """Pixel coordinates and depth, larger is farther (n, 3)."""
        r = x - self.target
        depth = -r @ self.back
        scale = self.pixels[1] / self.height
        if self.distance is not None:
            scale = scale * self.distance / (self.distance + depth)
        column = self.pixels[0] / 2 + scale * (r @ self.right)
        row = self.pixels[1] / 2 - scale * (r @ self.up)
        return np.stack([column, row, depth], 1)


def rasterise(projected, triangles, pixels):
    """Nearest triangle of every pixel, -1 for none, with its barycentric weights and depth."""
    shape = (pixels[1], pixels[0])
    owner, depth, weights = np.full(shape, -1), np.full(shape, np.inf), np.zeros(shape + (3,))
    for t, (a, b, c) in enumerate(projected[triangles]):
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        low = np.maximum(np.floor(np.minimum(np.minimum(a, b), c)[:2]).astype(int), 0)
        high = np.minimum(np.ceil(np.maximum(np.maximum(a, b), c)[:2]).astype(int) + 1, pixels)
        if area == 0 or (high <= low).any():
            continue
        py, px = np.mgrid[low[1]:high[1], low[0]:high[0]] + 0.5
        wb = ((px - a[0]) * (c[1] - a[1]) - (py - a[1]) * (c[0] - a[0])) / area
        wc = ((b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0])) / area
        wa = 1 - wb - wc
        z = wa * a[2] + wb * b[2] + wc * c[2]
        window = (slice(low[1], high[1]), slice(low[0], high[0]))
        nearer = (wa >= 0) & (wb >= 0) & (wc >= 0) & (z < depth[window])
        depth[window][nearer] = z[nearer]
        owner[window][nearer] = t
        weights[window][nearer] = np.stack([wa, wb, wc], -1)[nearer]
    return owner, weights, depth


def corner_normals(points, triangles, smooth):
    """Unit normals at the triangles' corners (m, 3, 3): of the vertices where smooth, else of the triangle."""
    p = points[triangles]
    flat = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    at_vertex = np.zeros_like(points)
    for corner in range(3):
        np.add.at(at_vertex, triangles[:, corner], flat)
    normals = np.where(smooth[:, None, None], at_vertex[triangles], flat[:, None, :])
    return normals / np.maximum(np.linalg.norm(normals, axis=2, keepdims=True), 1e-30)


def lit(points, triangles, places, size):
    """False where something is between a place (k, 3) and the light."""
    sun = Camera(np.array([0.5 * size, 0.5 * size, 0]), LIGHT, (2400, 2400), 6 * size)
    depth = rasterise(sun.project(points), triangles, sun.pixels)[2]
    seen = sun.project(places)
    column, row = (np.clip(seen[:, i].astype(int), 0, sun.pixels[i] - 1) for i in (0, 1))
    outside = ((seen[:, :2] < 0) | (seen[:, :2] >= sun.pixels)).any(1)
    return outside | (seen[:, 2] < depth[row, column] + 0.01 * size)


def draw(points, triangles, corner_colours, smooth, camera, size):
    """An RGB picture (height, width, 3) in [0, 1]."""
    owner, weights, _ = rasterise(camera.project(points), triangles, camera.pixels)
    hit = owner >= 0
    t, w = owner[hit], weights[hit]
    normal = np.einsum("kc,kcd->kd", w, corner_normals(points, triangles, smooth)[t])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
    colour = np.einsum("kc,kcd->kd", w, corner_colours[t])
    places = np.einsum("kc,kcd->kd", w, points[triangles][t])
    sun = np.maximum(normal @ LIGHT, 0) * lit(points, triangles, places, size)
    sky = 0.5 + 0.5 * normal[:, 1]
    picture = np.tile(SKY, owner.shape + (1,))
    picture[hit] = colour * (0.22 + 0.30 * sky + 0.50 * sun)[:, None]
    return np.clip(picture, 0, 1)


def draw_frame(body_file, rigid_file, rest, options):
    x, body = read_vtu(body_file)
    y, rigid = read_vtu(rigid_file)
    size = np.ptp(rest, axis=0).max()
    strained = deformation(rest, x)
    share = np.minimum(strained / FULL_COLOUR, 1)[body][..., None]
    body_colours = (1 - share) * BODY + share * STRAINED
    rigid_colours = np.tile(RIGID, (len(rigid), 3, 1))
    rigid_colours[:2] = GROUND  # the plane comes first
    points = np.concatenate([x, y])
    triangles = np.concatenate([body, rigid + len(x)])
    colours = np.concatenate([body_colours, rigid_colours])
    smooth = np.arange(len(triangles)) < len(body)
    pixels = (options.width * OVERSAMPLING, options.height * OVERSAMPLING)
    towards = np.array([0.35, 0.42, 1.0])
    target = np.array(options.target) * size
    camera = Camera(target, towards, pixels, options.view * size, 6 * size)
    picture = Image.fromarray((255 * draw(points, triangles, colours, smooth, camera, size)).astype(np.uint8))
    return picture.resize((options.width, options.height), Image.LANCZOS), strained.max()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="of body.pvd and rigid.pvd")
    parser.add_argument("picture", help="PNG to write")
    parser.add_argument("--times", type=float, nargs="+", default=[0, 0.35, 0.6, 0.75, 1, 4], help="nearest frames [s]")
    parser.add_argument("--width", type=int, default=340, help="of a frame [pixels]")
    parser.add_argument("--height", type=int, default=400, help="of a frame [pixels]")
    parser.add_argument("--target", type=float, nargs=3, default=[0.45, 0.65, 0.1], help="looked at [longest sides]")
    parser.add_argument("--view", type=float, default=2.5, help="height of the view at the target [longest sides]")
    options = parser.parse_args()

    bodies, rigids = (read_pvd(os.path.join(options.folder, name)) for name in ("body.pvd", "rigid.pvd"))
    rest = read_vtu(bodies[0][1])[0]
    sheet = Image.new("RGB", (options.width * len(options.times), options.height))
    for column, wanted in enumerate(options.times):
        k = min(range(len(bodies)), key=lambda i: abs(bodies[i][0] - wanted))
        frame, most = draw_frame(bodies[k][1], rigids[k][1], rest, options)
        sheet.paste(frame, (column * options.width, 0))
        print(f"{bodies[k][0]:.3f} s: deformed by up to {most:.3f} of the longest side (full colour: {FULL_COLOUR})")
    sheet.quantize(256, dither=Image.Dither.NONE).save(options.picture, optimize=True)


if __name__ == "__main__":
    main()
