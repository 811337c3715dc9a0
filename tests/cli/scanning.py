"""`cellocut scan` and `cellocut damage`: what they write, that it is repeatable, what they refuse."""
import json
import struct

from program import OLD, ProgramCase, box, join, obj_text, sphere


def welded_sphere(rings):
    """A closed sphere: the poles are one point each."""
    points, _ = sphere(rings)
    across = 2 * rings
    inner = points[across:-across]
    faces = []
    for j in range(across):
        k = (j + 1) % across
        faces += [(0, 1 + j, 1 + k), (1 + len(inner), 1 + len(inner) - across + k, 1 + len(inner) - across + j)]
        for i in range(rings - 2):
            a, b = 1 + across * i + j, 1 + across * i + k
            faces += [(a, a + across, b + across), (a, b + across, b)]
    return [points[0]] + inner + [points[-1]], faces


def read_cloud(content):
    header, _, body = content.partition(b"end_header\n")
    assert b"property float nz" in header
    return list(struct.iter_unpack("<3d3f", body))


def read_obj(content):
    rows = [line.split() for line in content.decode().splitlines()]
    points = [tuple(float(x) for x in row[1:]) for row in rows if row[0] == "v"]
    return [tuple(points[int(i) - 1] for i in row[1:]) for row in rows if row[0] == "f"], points


class Scan(ProgramCase):
    def test_clutter_in_a_box_is_not_seen(self):
        self.put("full.obj", obj_text(join(box((0.0, 0.0, 0.0), (2.0, 1.0, 1.0)),
                                           box((0.1, 0.1, 0.1), (1.9, 0.9, 0.9)))))
        run = self.succeed("scan", "full.obj", "-o", "outer.ply", "--points", "2000", "--viewpoints", "40", "--rays",
                           "2000", "--json", "r.json")
        cloud = read_cloud(self.get("outer.ply"))
        report = json.loads(self.get("r.json"))
        self.assertEqual(len(cloud), report["output"]["points"])
        self.assertRegex(run.stdout.decode(), r"\A%d points, " % len(cloud))
        self.assertTrue(1900 <= len(cloud) <= 2000, len(cloud))
        self.assertEqual((report["rays"], report["unit"]), (80000, 2))
        for x, y, z, *normal in cloud:
            distance = min(x, 2 - x, y, 1 - y, z, 1 - z)
            self.assertAlmostEqual(distance, 0, delta=1e-6)
            self.assertAlmostEqual(sum(abs(c) for c in normal), 1, delta=1e-6)
        # And `evaluate` takes it, with its normals.
        self.put("box.obj", obj_text(box((0.0, 0.0, 0.0), (2.0, 1.0, 1.0))))
        run = self.succeed("evaluate", "box.obj", "--reference", "outer.ply", "--samples", "2000", "--json", "-")
        mesh, = json.loads(run.stdout)["meshes"]
        self.assertGreater(mesh["anc"], 0.9)
        self.assertLess(mesh["distances"]["from_reference_p2s"]["relative"]["max"], 1e-6)

    def test_same_bytes_for_any_number_of_threads(self):
        self.put("ball.obj", obj_text(sphere(12)))
        seen = {self.succeed("scan", "ball.obj", "-o", "-", "--points", "500", "--viewpoints", "20", "--rays", "500",
                             "--threads", threads).stdout for threads in ("1", "2", "8")}
        self.assertEqual(len(seen), 1)

    def test_refuses(self):
        for arguments, code, what in (
                (("holed.obj", "-o", "out.obj"), 2, r"out\.obj: points are written as \.ply"),
                (("holed.obj", "-o", "out.ply", "--viewpoints", "0"), 2, "viewpoints must be"),
                (("holed.obj", "-o", "out.ply", "--spacing", "0.1", "--points", "9"), 2, ".*excludes"),
                (("holed.obj",), 2, "--output is required"),
                (("gone.obj", "-o", "out.ply"), 3, r"gone\.obj: cannot open")):
            with self.subTest(arguments):
                self.fail_with(code, r"\Acellocut: " + what, "scan", *arguments, outputs=("out.obj", "out.ply"))


class Damage(ProgramCase):
    def setUp(self):
        super().setUp()
        self.put("ball.obj", obj_text(welded_sphere(40)))

    def test_holes_and_nothing_else(self):
        run = self.succeed("damage", "ball.obj", "-o", "out.obj", "--seed", "5", "--json", "d.json")
        report = json.loads(self.get("d.json"))
        holes = report["holes"]
        self.assertTrue(6 <= len(holes) <= 12)
        self.assertEqual(len(run.stdout.decode().splitlines()), len(holes) + 1)
        self.assertEqual({hole["kind"] for hole in holes}, {"grazing", "gap", "stripe"})
        before, _ = read_obj(self.get("ball.obj"))
        after, points = read_obj(self.get("out.obj"))
        rest = iter(before)
        self.assertTrue(all(face in rest for face in after), "the faces that stay are in their order")
        self.assertEqual(len(before) - len(after), sum(hole["faces"] for hole in holes))
        self.assertEqual({p for face in after for p in face}, set(points))
        check = self.run_program("check", "out.obj", "--json", "c.json")
        self.assertEqual(check.returncode, 4)
        found = json.loads(self.get("c.json"))["output"]
        self.assertEqual(found["boundary_edges"], sum(hole["boundary_edges"] for hole in holes))
        self.assertEqual((found["nonmanifold_vertices"], len(found["components"])), (0, 1))
        self.assertEqual(found["euler"], 2 - len(holes))

    def test_same_bytes_for_the_same_seed(self):
        for seeds, different in ((("3", "3"), 1), (("3", "4"), 2)):
            outputs = set()
            for number, seed in enumerate(seeds):
                self.succeed("damage", "ball.obj", "-o", "%d.ply" % number, "--seed", seed, "--json",
                             "%d.json" % number, "--quiet", "--threads", str(number + 1))
                outputs.add(self.get("%d.ply" % number))
            self.assertEqual(len(outputs), different)

    def test_size(self):
        shares = []
        for size in ("0.6", "1"):
            self.succeed("damage", "ball.obj", "-o", "out.obj", "--holes", "6", "--size", size, "--json", "d.json",
                         "--quiet")
            shares.append(json.loads(self.get("d.json"))["share"])
        self.assertLess(shares[0], 0.7 * shares[1])

    def test_number_of_holes(self):
        for holes, count in (("2", (2, 2)), ("3..4", (3, 4))):
            self.succeed("damage", "ball.obj", "-o", "out.obj", "--holes", holes, "--json", "d.json", "--quiet")
            self.assertTrue(count[0] <= len(json.loads(self.get("d.json"))["holes"]) <= count[1])

    def test_refuses(self):
        self.put("box.obj", obj_text(box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))))
        for arguments, code, what in (
                (("holed.obj", "-o", "out.obj"), 3, r"holed\.obj: not closed and manifold: 3 boundary edges"),
                (("box.obj", "-o", "out.obj"), 3, r"box\.obj: too coarse for holes"),
                (("ball.obj", "-o", "out.obj", "--holes", "5..4"), 2, "holes must be"),
                (("ball.obj", "-o", "out.obj", "--holes", "some"), 2, "--holes: 'some' is neither"),
                (("ball.obj", "-o", "out.obj", "--size", "0"), 2, "size must be"),
                (("ball.obj", "-o", "out"), 2, "out: cannot tell the mesh format"),
                (("ball.obj",), 2, "--output is required")):
            with self.subTest(arguments):
                self.fail_with(code, r"\Acellocut: " + what, "damage", *arguments)
        self.assertEqual(self.get("out.obj"), OLD)
