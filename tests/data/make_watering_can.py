#!/usr/bin/env python3
"""Writes watering_can.obj: a presentable mesh with many defects, for the demo and for tests.

    python3 make_watering_can.py [FILE]       (by default watering_can.obj beside this script)

Standard library only, no random numbers: the same bytes on every run. README.md names the defects.
"""

import math
import os
import sys


class Mesh:
    """Points and faces; every part has points of its own, as after sloppy modelling."""

    def __init__(self):
        self.points = []
        self.faces = []

    def grid(self, rows, closed, keep=lambda i, j: True):
        """Joins rows of points by triangles; `closed` joins the end of each row to its start."""
        first = len(self.points)
        width = len(rows[0])
        for row in rows:
            self.points.extend(row)
        for i in range(len(rows) - 1):
            for j in range(width if closed else width - 1):
                if not keep(i, j):
                    continue
                a = first + i * width + j
                b = first + i * width + (j + 1) % width
                c, d = b + width, a + width
                self.faces += [(a, b, c), (a, c, d)]


def ring(centre, u, v, radius, count):
    return [
        tuple(
            centre[k]
            + radius * (math.cos(2 * math.pi * j / count) * u[k] + math.sin(2 * math.pi * j / count) * v[k])
            for k in range(3)
        )
        for j in range(count)
    ]


def tube(mesh, path, radii, count):
    """A tube without ends around a curve in the plane y = 0."""
    rows = []
    for i, centre in enumerate(path):
        before, after = path[max(i - 1, 0)], path[min(i + 1, len(path) - 1)]
        dx, dz = after[0] - before[0], after[2] - before[2]
        length = math.hypot(dx, dz)
        rows.append(ring(centre, (dz / length, 0, -dx / length), (0, 1, 0), radii[i], count))
    mesh.grid(rows, closed=True)


def bezier(p, count):
    """A cubic Bezier curve in the plane y = 0."""
    curve = []
    for i in range(count + 1):
        t = i / count
        w = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3)
        curve.append((sum(a * q[0] for a, q in zip(w, p)), 0.0, sum(a * q[1] for a, q in zip(w, p))))
    return curve


def body(mesh):
    """A bellied wall without lid, with a ragged hole in one side, and a bottom that is not sewn on."""
    around, up = 64, 26
    rows = []
    for i in range(up + 1):
        t = i / up
        radius = 0.86 + 0.20 * math.sin(math.pi * (0.12 + 0.80 * t)) - 0.16 * t
        radius += 0.035 * math.exp(-(((t - 0.97) / 0.03) ** 2))  # the rim
        rows.append(ring((0, 0, 1.7 * t), (1, 0, 0), (0, 1, 0), radius, around))

    def in_hole(i, j):
        u = (j + 0.5) - 46.0
        v = (i + 0.5) - 13.0
        angle = math.atan2(v, u)
        return math.hypot(u / 5.5, v / 4.0) < 1 + 0.18 * math.sin(5 * angle)

    mesh.grid(rows, closed=True, keep=lambda i, j: not in_hole(i, j))
    # The bottom: rings to the middle, with points of its own along the seam.
    base = math.hypot(rows[0][0][0], rows[0][0][1])
    rows = [ring((0, 0, 0), (0, 1, 0), (1, 0, 0), base * r / 6, around) for r in range(6, 0, -1)]
    mesh.grid(rows, closed=True)
    centre = len(mesh.points)
    mesh.points.append((0.0, 0.0, 0.0))
    inner = centre - around
    mesh.faces += [(inner + j, inner + (j + 1) % around, centre) for j in range(around)]


def brow(mesh):
    """A half lid: an open sheet over one side of the mouth, not joined to the wall."""
    rows = []
    for i in range(7):
        radius = 0.10 + 0.66 * i / 6
        rows.append(
            [
                (
                    radius * math.cos(math.pi * (-0.5 + j / 24)),
                    radius * math.sin(math.pi * (-0.5 + j / 24)),
                    1.70 + 0.12 * (1 - (i / 6) ** 2),
                )
                for j in range(25)
            ]
        )
    mesh.grid(rows, closed=False)


def spout(mesh):
    """A tube open at both ends that starts inside the body, and a rose (the sieve) in two layers."""
    path = bezier([(0.70, 0.35), (1.45, 0.45), (1.35, 1.25), (2.05, 1.75)], 30)
    tube(mesh, path, [0.24 - 0.13 * math.sqrt(i / 30) for i in range(31)], 24)
    end, before = path[-1], path[-2]
    dx, dz = end[0] - before[0], end[2] - before[2]
    length = math.hypot(dx, dz)
    axis = (dx / length, 0.0, dz / length)
    u, v = (axis[2], 0.0, -axis[0]), (0.0, 1.0, 0.0)
    # A flaring cone that begins inside the tube, then a domed front, overlapping rather than joined.
    cone = [
        ring(tuple(end[k] + s * axis[k] for k in range(3)), u, v, radius, 32)
        for s, radius in ((-0.06, 0.085), (0.04, 0.14), (0.13, 0.20), (0.22, 0.26))
    ]
    mesh.grid(cone, closed=True)
    dome = [
        ring(tuple(end[k] + s * axis[k] for k in range(3)), u, v, radius, 32)
        for s, radius in ((0.20, 0.265), (0.235, 0.22), (0.265, 0.16), (0.28, 0.09), (0.288, 0.03))
    ]
    mesh.grid(dome, closed=True)


def handles(mesh):
    """Two tubes whose open ends pass through the wall into the body, and that cross each other."""
    path = bezier([(-0.66, 1.25), (-1.70, 1.75), (-1.75, 0.35), (-0.74, 0.40)], 40)
    tube(mesh, path, [0.085] * 41, 16)
    path = bezier([(-1.20, 1.10), (-0.95, 2.65), (0.75, 2.65), (0.62, 1.45)], 40)
    tube(mesh, path, [0.07] * 41, 16)


def spoil(mesh):
    """Flipped, duplicated and degenerate faces at fixed places."""
    sound = list(mesh.faces)
    for i, (a, b, c) in enumerate(sound):
        if i % 17 == 3 or 900 <= i < 960:
            mesh.faces[i] = (a, c, b)
    mesh.faces += [sound[i] for i in range(5, len(sound), 41)]
    mesh.faces += [(c, b, a) for a, b, c in sound[11::97]]
    mesh.faces += [(a, b, b) for a, b, _ in sound[23::301]]


def main():
    mesh = Mesh()
    body(mesh)
    brow(mesh)
    spout(mesh)
    handles(mesh)
    spoil(mesh)
    default = os.path.join(os.path.dirname(os.path.abspath(__file__)), "watering_can.obj")
    with open(sys.argv[1] if len(sys.argv) > 1 else default, "w", newline="\n") as out:
        out.write("# A watering can with many defects, generated by make_watering_can.py\n")
        for p in mesh.points:
            # Six decimals hide the last-bit differences of sine and cosine between C libraries; the
            # sum with zero turns -0 into 0.
            out.write("v %s\n" % " ".join("%.6f" % (round(x, 6) + 0.0) for x in p))
        for face in mesh.faces:
            out.write("f %d %d %d\n" % tuple(k + 1 for k in face))


if __name__ == "__main__":
    main()
