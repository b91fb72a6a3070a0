#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Draws the launcher icon for Android before 8, which knows no adaptive icons: python3 android/demo/icon.py

The same picture as res/drawable/ic_launcher_foreground.xml: a block of samples, few of which have rays."""

import pathlib
import struct
import zlib

BACKGROUND, BRIGHT, DIM, CLEAR = (16, 35, 63, 255), (255, 179, 71, 255), (76, 110, 158, 255), (0, 0, 0, 0)
TRACED = {(0, 0), (2, 0), (0, 2), (2, 2), (3, 1), (1, 3)}
SIDES = {"mdpi": 48, "hdpi": 72, "xhdpi": 96, "xxhdpi": 144, "xxxhdpi": 192}
UNITS = 48  # the icon's own units: a rounded square of 44 with 4 x 4 samples of 8 in steps of 9


def colour(x, y):
    """The colour at a place in the icon's units."""
    edge = 2
    inner_x, inner_y = min(x, UNITS - x) - edge, min(y, UNITS - y) - edge
    radius = 6
    if min(inner_x, inner_y) < 0:
        return CLEAR
    if inner_x < radius and inner_y < radius and (radius - inner_x) ** 2 + (radius - inner_y) ** 2 > radius**2:
        return CLEAR
    column, row = (x - 6.5) / 9, (y - 6.5) / 9
    if 0 <= column < 4 and 0 <= row < 4 and column % 1 < 8 / 9 and row % 1 < 8 / 9:
        return BRIGHT if (int(column), int(row)) in TRACED else DIM
    return BACKGROUND


def pixel(side, column, row):
    """The mean of 16 places of a pixel, colours weighted by their alpha."""
    places = [colour((column + (i + 0.5) / 4) * UNITS / side, (row + (j + 0.5) / 4) * UNITS / side) for i in range(4) for j in range(4)]
    alpha = sum(p[3] for p in places)
    return bytes([round(sum(p[c] * p[3] for p in places) / alpha) if alpha else 0 for c in range(3)] + [round(alpha / 16)])


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def png(side):
    rows = b"".join(b"\0" + b"".join(pixel(side, column, row) for column in range(side)) for row in range(side))
    head = struct.pack(">IIBBBBB", side, side, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


for density, side in SIDES.items():
    folder = pathlib.Path(__file__).parent / "src/main/res" / f"mipmap-{density}"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "ic_launcher.png").write_bytes(png(side))
