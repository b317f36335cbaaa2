#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws a surface that palpate-query wrote (--field touch.vtu) as a PNG, coloured by displacement.

    palpate-organ paper-liver -o liver.msh && palpate-solve liver.msh --element-order 1 --order 3 -o liver.h5
    palpate-query liver.h5 --at 0.0593,-0.0164,0.0536 --displacement 0,0.004,-0.007 --field touch.vtu
    docs/render_press.py touch.vtu docs/press.png

Python's standard library only: the picture can be made again on any machine.
"""
import math
import struct
import sys
import xml.etree.ElementTree as ElementTree
import zlib

WIDTH, HEIGHT, FINE = 880, 500, 2  # FINE x FINE samples a pixel
YAW, PITCH = math.radians(28.0), math.radians(32.0)
LIGHT = (-0.45, 0.75, 0.5)
TIP_RADIUS = 0.005  # m
REST_COLOUR, PRESSED_COLOUR, TIP_COLOUR = (176, 84, 76), (255, 214, 120), (70, 110, 160)
BACKGROUND = (255, 255, 255)


def read(path):
    piece = ElementTree.parse(path).getroot().find("UnstructuredGrid/Piece")
    arrays = {a.get("Name", "Points"): a.text.split() for a in piece.iter("DataArray")}
    rest = triples(map(float, arrays["Points"]))
    moved = triples(map(float, arrays["displacement"]))
    return rest, moved, triples(map(int, arrays["connectivity"]))


def triples(numbers):
    flat = list(numbers)
    return list(zip(flat[0::3], flat[1::3], flat[2::3]))


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def scaled(a, s):
    return tuple(x * s for x in a)


def unit(a):
    length = math.sqrt(sum(x * x for x in a)) or 1.0
    return scaled(a, 1.0 / length)


def seen(p):
    """World to eye: x to the right, y up, z towards the eye."""
    x = p[0] * math.cos(YAW) + p[1] * math.sin(YAW)
    away = -p[0] * math.sin(YAW) + p[1] * math.cos(YAW)
    return (x, p[2] * math.cos(PITCH) + away * math.sin(PITCH), p[2] * math.sin(PITCH) - away * math.cos(PITCH))


def ball(centre, radius, steps=24):
    points, triangles = [], []
    for i in range(steps + 1):
        for j in range(2 * steps):
            t, p = math.pi * i / steps, math.pi * j / steps
            d = (math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t))
            points.append(add(centre, scaled(d, radius)))
    for i in range(steps):
        for j in range(2 * steps):
            a, b = i * 2 * steps + j, i * 2 * steps + (j + 1) % (2 * steps)
            triangles += [(a, a + 2 * steps, b), (b, a + 2 * steps, b + 2 * steps)]
    return points, triangles


def normals_of(points, triangles):
    sums = [(0.0, 0.0, 0.0)] * len(points)
    for t in triangles:
        a, b, c = (points[i] for i in t)
        u, v = add(b, scaled(a, -1)), add(c, scaled(a, -1))
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        for i in t:
            sums[i] = add(sums[i], n)
    return [unit(n) for n in sums]


class Canvas:
    def __init__(self, points):
        self.width, self.height = WIDTH * FINE, HEIGHT * FINE
        low = [min(p[i] for p in points) for i in (0, 1)]
        high = [max(p[i] for p in points) for i in (0, 1)]
        self.scale = 0.92 * min(self.width / (high[0] - low[0]), self.height / (high[1] - low[1]))
        self.middle = [(l + h) / 2 for l, h in zip(low, high)]
        self.depth = [-math.inf] * (self.width * self.height)
        self.pixels = [BACKGROUND] * (self.width * self.height)

    def place(self, p):
        return (self.width / 2 + (p[0] - self.middle[0]) * self.scale,
                self.height / 2 - (p[1] - self.middle[1]) * self.scale, p[2])

    def triangle(self, corners, colours):
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = map(self.place, corners)
        area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        if area == 0.0:
            return
        for y in range(max(0, math.floor(min(ay, by, cy))), min(self.height, math.ceil(max(ay, by, cy)))):
            for x in range(max(0, math.floor(min(ax, bx, cx))), min(self.width, math.ceil(max(ax, bx, cx)))):
                px, py = x + 0.5, y + 0.5
                v = ((px - ax) * (cy - ay) - (cx - ax) * (py - ay)) / area
                w = ((bx - ax) * (py - ay) - (px - ax) * (by - ay)) / area
                u = 1.0 - v - w
                if u < 0 or v < 0 or w < 0:
                    continue
                z, at = u * az + v * bz + w * cz, y * self.width + x
                if z > self.depth[at]:
                    self.depth[at] = z
                    self.pixels[at] = tuple(u * a + v * b + w * c for a, b, c in zip(*colours))

    def png(self):
        rows = bytearray()
        for y in range(HEIGHT):
            rows.append(0)
            for x in range(WIDTH):
                samples = [self.pixels[(y * FINE + j) * self.width + x * FINE + i]
                           for j in range(FINE) for i in range(FINE)]
                rows += bytes(min(255, round(sum(c) / len(samples))) for c in zip(*samples))

        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

        header = struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 2, 0, 0, 0)
        return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows), 9)) +
                chunk(b"IEND", b""))


def shaded(colour, normal):
    light = unit(LIGHT)
    lit = max(0.0, sum(n * l for n, l in zip(seen(normal), light)))
    return scaled(colour, 0.45 + 0.6 * lit)


def coloured(share):
    return add(scaled(REST_COLOUR, 1 - share), scaled(PRESSED_COLOUR, share))


def draw(canvas, points, triangles, colours):
    lit = [shaded(c, n) for c, n in zip(colours, normals_of(points, triangles))]
    eye = [seen(p) for p in points]
    for t in triangles:
        canvas.triangle([eye[i] for i in t], [lit[i] for i in t])


def main(source, target):
    # 1. What was written.
    rest, moved, triangles = read(source)
    points = [add(X, u) for X, u in zip(rest, moved)]
    sizes = [math.sqrt(sum(x * x for x in u)) for u in moved]
    deepest = max(range(len(sizes)), key=sizes.__getitem__)
    # 2. The organ, coloured by how far it moved.
    canvas = Canvas([seen(p) for p in points])
    draw(canvas, points, triangles, [coloured((s / (sizes[deepest] or 1.0)) ** 2) for s in sizes])
    # 3. The tool's tip, resting in the dimple.
    back = unit(scaled(moved[deepest], -1))
    tip, tip_triangles = ball(add(points[deepest], scaled(back, TIP_RADIUS)), TIP_RADIUS)
    draw(canvas, tip, tip_triangles, [TIP_COLOUR] * len(tip))
    # 4. The file.
    with open(target, "wb") as out:
        out.write(canvas.png())


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: render_press.py touch.vtu picture.png")
    main(sys.argv[1], sys.argv[2])
