"""Closed manifold solids with known truth: analytic surfaces and simple CAD shapes, from formulas alone."""
import math

TWO_PI = 2 * math.pi


def grid_faces(rows, columns, wrap_rows):
    """Triangles of a grid of points that is closed along its columns, and along its rows if asked for."""
    faces = []
    for i in range(rows if wrap_rows else rows - 1):
        for j in range(columns):
            a, b = i * columns + j, i * columns + (j + 1) % columns
            c, d = ((i + 1) % rows) * columns + j, ((i + 1) % rows) * columns + (j + 1) % columns
            faces += [(a, b, d), (a, d, c)]
    return faces


def revolve(profile, columns):
    """Around z: profile of (radius, z) from bottom to top on the axis, its outside on the right."""
    inner = profile[1:-1]
    points = [(r * math.cos(TWO_PI * j / columns), r * math.sin(TWO_PI * j / columns), z)
              for r, z in inner for j in range(columns)]
    faces = grid_faces(len(inner), columns, False)
    bottom, top, last = len(points), len(points) + 1, (len(inner) - 1) * columns
    points += [(0.0, 0.0, profile[0][1]), (0.0, 0.0, profile[-1][1])]
    for j in range(columns):
        k = (j + 1) % columns
        faces += [(bottom, k, j), (top, last + j, last + k)]
    return points, faces


def ring_of_revolution(profile, columns):
    """Around z: a closed profile of (radius, z), counter-clockwise, away from the axis."""
    points = [(r * math.cos(TWO_PI * j / columns), r * math.sin(TWO_PI * j / columns), z)
              for r, z in profile for j in range(columns)]
    return points, grid_faces(len(profile), columns, True)


def ellipsoid(radii, rows=96):
    profile = [(math.sin(math.pi * i / rows), -math.cos(math.pi * i / rows)) for i in range(rows + 1)]
    points, faces = revolve(profile, 2 * rows)
    return [(x * radii[0], y * radii[1], z * radii[2]) for x, y, z in points], faces


def torus(major, minor, rows=80, columns=200):
    profile = [(major + minor * math.cos(TWO_PI * i / rows), minor * math.sin(TWO_PI * i / rows))
               for i in range(rows)]
    return ring_of_revolution(profile, columns)


def subdivided(profile, step, closed=False):
    """The same outline with points at most `step` apart."""
    result = []
    ends = profile[1:] + profile[:1] if closed else profile[1:]
    for (x0, y0), (x1, y1) in zip(profile, ends):
        pieces = max(1, math.ceil(math.hypot(x1 - x0, y1 - y0) / step))
        result += [(x0 + (x1 - x0) * k / pieces, y0 + (y1 - y0) * k / pieces) for k in range(pieces)]
    return result if closed else result + profile[-1:]


def tube(curve, radius, rows=400, columns=40):
    """Around a closed curve, with frames that are perpendicular to the curve and a fixed direction."""
    points = []
    for i in range(rows):
        t, step = TWO_PI * i / rows, 1e-4
        here, ahead, behind = curve(t), curve(t + step), curve(t - step)
        tangent = unit([a - b for a, b in zip(ahead, behind)])
        side = unit(cross(tangent, (0.0, 0.0, 1.0)))
        up = cross(side, tangent)
        for j in range(columns):
            c, s = math.cos(TWO_PI * j / columns), math.sin(TWO_PI * j / columns)
            points.append(tuple(p + radius * (c * a - s * b) for p, a, b in zip(here, side, up)))
    return points, grid_faces(rows, columns, True)


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def trefoil(t):
    return ((2 + math.cos(3 * t)) * math.cos(2 * t), (2 + math.cos(3 * t)) * math.sin(2 * t), math.sin(3 * t))


def gear(teeth, inner, outer, height, layers=12, rings=10):
    """A spur gear: a star-shaped outline, extruded, its caps in rings around the axis."""
    outline = []
    for i in range(teeth):
        for k in range(16):
            radius = outer if 2 <= k < 8 else inner
            angle = TWO_PI * (i + k / 16) / teeth
            outline.append((radius, angle))
    columns = len(outline)
    rows = [(ring / rings, 0.0) for ring in range(1, rings + 1)]
    rows += [(1.0, height * layer / layers) for layer in range(1, layers + 1)]
    rows += [(ring / rings, height) for ring in range(rings - 1, 0, -1)]
    points = [(share * r * math.cos(a), share * r * math.sin(a), z) for share, z in rows for r, a in outline]
    faces = grid_faces(len(rows), columns, False)
    bottom, top, last = len(points), len(points) + 1, (len(rows) - 1) * columns
    points += [(0.0, 0.0, 0.0), (0.0, 0.0, height)]
    for j in range(columns):
        k = (j + 1) % columns
        faces += [(bottom, k, j), (top, last + j, last + k)]
    return points, faces


def polycube(cubes, fine=4):
    """The boundary of unit cubes, each cut into fine^3; they must not meet in an edge or corner alone."""
    filled = {(fine * x + i, fine * y + j, fine * z + k) for x, y, z in cubes
              for i in range(fine) for j in range(fine) for k in range(fine)}
    corners = {(0, 1): ((1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)), (0, -1): ((0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)),
               (1, 1): ((0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)), (1, -1): ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)),
               (2, 1): ((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)), (2, -1): ((0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0))}
    index, points, faces = {}, [], []
    for cube in sorted(filled):
        for (axis, side), square in corners.items():
            beyond = tuple(c + (side if a == axis else 0) for a, c in enumerate(cube))
            if beyond in filled:
                continue
            ids = []
            for corner in square:
                key = tuple(c + d for c, d in zip(cube, corner))
                if key not in index:
                    index[key] = len(points)
                    points.append(tuple(c / fine for c in key))
                ids.append(index[key])
            faces += [(ids[0], ids[1], ids[2]), (ids[0], ids[2], ids[3])]
    return points, faces


def block(x, y, z):
    return {(i, j, k) for i in range(*x) for j in range(*y) for k in range(*z)}


def all_solids():
    """Pairs of name and (points, triangles): closed, oriented outward, without intersections."""
    yield "sphere", ellipsoid((1.0, 1.0, 1.0))
    yield "ellipsoid", ellipsoid((1.0, 0.6, 0.35))
    yield "torus", torus(1.0, 0.35)
    yield "thin_ring", torus(1.0, 0.08)
    yield "trefoil_knot", tube(trefoil, 0.35)
    yield "cup", revolve(subdivided([(0.0, 0.0), (0.5, 0.0), (0.6, 1.2), (0.54, 1.2), (0.45, 0.08), (0.0, 0.08)], 0.02), 160)
    yield "vase", revolve([(0.0, -0.02)] + [(0.35 + 0.15 * math.sin(5 * z), 1.4 * z) for z in
                                          (i / 120 for i in range(121))] + [(0.0, 1.42)], 160)
    yield "stepped_shaft", revolve(subdivided([(0.0, 0.0), (0.3, 0.0), (0.3, 0.6), (0.18, 0.6), (0.18, 1.4), (0.25, 1.4),
                                              (0.25, 1.8), (0.0, 1.8)], 0.02), 128)
    yield "washer", ring_of_revolution(subdivided([(0.4, 0.0), (1.0, 0.0), (1.0, 0.15), (0.4, 0.15)], 0.02, True), 200)
    yield "cone", revolve(subdivided([(0.0, 0.0), (0.8, 0.0), (0.0, 1.5)], 0.02), 128)
    yield "gear", gear(14, 0.8, 1.0, 0.3)
    yield "bracket", polycube(block((0, 6), (0, 4), (0, 1)) | block((0, 1), (0, 4), (0, 5)))
    yield "frame", polycube(block((0, 7), (0, 2), (0, 7)) - block((2, 5), (0, 2), (2, 5)))
    yield "table", polycube(block((0, 8), (0, 6), (5, 6)) | block((0, 1), (0, 1), (0, 5)) | block((7, 8), (0, 1), (0, 5))
                            | block((0, 1), (5, 6), (0, 5)) | block((7, 8), (5, 6), (0, 5)))
    yield "stairs", polycube({(i, j, k) for i in range(6) for j in range(3) for k in range(i + 1)})


def obj_text(mesh):
    """An OBJ file with decimals that read back as the same doubles."""
    points, faces = mesh
    lines = ["v %r %r %r" % tuple(float(x) for x in point) for point in points]
    lines += ["f %d %d %d" % tuple(i + 1 for i in face) for face in faces]
    return "\n".join(lines) + "\n"
