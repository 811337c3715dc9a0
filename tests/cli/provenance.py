"""Where the vertices of the output come from: properties in PLY, arrays in VTP, colours."""
import json
import math
import struct
import unittest
import xml.etree.ElementTree as tree
import zlib

from program import COARSE, HOLED_BOX, ProgramCase, obj_text, program_has

HAS_VTP = program_has("--vtp")
PROPERTIES = ["int nearest_face", "double distance", "uchar supported"]
COLOURS = ["uchar red", "uchar green", "uchar blue"]
CODES = {"double": "d", "uchar": "B", "int": "i"}


def coloured_box():
    """holed.obj, red at x = 0 and blue at x = 1."""
    points, faces = HOLED_BOX
    lines = ["v %r %r %r %s" % (*p, "1 0 0" if p[0] == 0 else "0 0 1") for p in points]
    return "\n".join(lines + obj_text(([], faces)).splitlines()) + "\n"


def distance_to_box(point):
    """From the box of holed.obj without its hole."""
    outside = [max(0.0, -x, x - side) for x, side in zip(point, (1.0, 0.7, 0.5))]
    if any(outside):
        return math.hypot(*outside)
    return min(min(x, side - x) for x, side in zip(point, (1.0, 0.7, 0.5)))


class Provenance(ProgramCase):
    def setUp(self):
        super().setUp()
        self.put("coloured.obj", coloured_box())

    def vertices(self, name):
        """Properties of the vertices in the header, and one dictionary for each vertex."""
        header, data = self.get(name).split(b"end_header\n", 1)
        lines = header.decode().splitlines()
        count = int(next(line for line in lines if line.startswith("element vertex")).split()[2])
        last = next(i for i, line in enumerate(lines) if line.startswith("element face"))
        properties = [line[len("property "):] for line in lines[:last] if line.startswith("property")]
        names = [each.split()[1] for each in properties]
        if "format ascii 1.0" in lines:
            rows = [[float(x) for x in line.split()] for line in data.decode().splitlines()[:count]]
        else:
            rows = struct.Struct("<" + "".join(CODES[each.split()[0]] for each in properties))
            rows = list(rows.iter_unpack(data[:count * rows.size]))
        return properties, [dict(zip(names, row)) for row in rows]

    def check_vertices(self, vertices):
        self.assertEqual({v["supported"] for v in vertices}, {0, 1})  # the hole was completed
        self.assertTrue(all(0 <= v["nearest_face"] < len(HOLED_BOX[1]) for v in vertices))
        for v in vertices:
            # The input is a part of the box, and whole but at the hole in the face x = 1.
            least = distance_to_box((v["x"], v["y"], v["z"]))
            self.assertGreaterEqual(v["distance"], least - 1e-12)
            if v["x"] < 0.5 or v["supported"] == 1 and v["x"] < 0.9:
                self.assertAlmostEqual(v["distance"], least, delta=1e-12)

    def test_properties_in_ply(self):
        for name in ("ply", "ply-ascii"):
            with self.subTest(name):
                self.succeed("remesh", "holed.obj", "-o", "out.ply", "--output-format", name, "--quiet",
                             "--provenance", "--json", "r.json", *COARSE)
                properties, vertices = self.vertices("out.ply")
                self.assertEqual(properties, ["double x", "double y", "double z", *PROPERTIES])
                self.check_vertices(vertices)
                report = json.loads(self.get("r.json"))
                self.assertIn("provenance", [stage["name"] for stage in report["stages"]])
                self.assertTrue(report["parameters"]["provenance"])
                self.succeed("check", "out.ply", "--quiet")

    def test_the_surface_is_the_same_with_and_without(self):
        for options in ([], ["--provenance"], ["--transfer-colour"]):
            self.succeed("remesh", "coloured.obj", "-o", "out.ply", "--quiet", *options, *COARSE)
            vertices = [(v["x"], v["y"], v["z"]) for v in self.vertices("out.ply")[1]]
            if not options:
                self.assertEqual(self.vertices("out.ply")[0], ["double x", "double y", "double z"])
                plain = vertices
            self.assertEqual(vertices, plain, options)

    def test_other_surfaces_have_it_too(self):
        for surface in ("sdf", "cells"):
            self.succeed("remesh", "holed.obj", "-o", "out.ply", "--quiet", "--provenance", "--surface",
                         surface, *COARSE)
            self.assertEqual(self.vertices("out.ply")[0][3:], PROPERTIES)

    def test_same_bytes_for_any_number_of_threads(self):
        seen = set()
        for threads in ("1", "2", "8"):
            vtp = ["--vtp", "out.vtp"] if HAS_VTP else []
            self.succeed("remesh", "coloured.obj", "-o", "out.ply", "--quiet", "--provenance",
                         "--transfer-colour", "--threads", threads, *vtp, *COARSE)
            seen.add((self.get("out.ply"), self.get("out.vtp") if HAS_VTP else b""))
        self.assertEqual(len(seen), 1)

    def check_colours(self, vertices):
        for v in vertices:
            self.assertEqual(v["green"], 0)
            self.assertLessEqual(abs(v["red"] + v["blue"] - 255), 1)
            if 0.05 < v["x"] < 0.8 and v["supported"] == 1:  # linear in x along the walls
                self.assertAlmostEqual(v["blue"], 255 * v["x"], delta=12)
        self.assertEqual(max(v["blue"] for v in vertices), 255)
        self.assertEqual(max(v["red"] for v in vertices), 255)

    def test_colours_in_ply_and_obj(self):
        self.succeed("remesh", "coloured.obj", "-o", "out.ply", "--quiet", "--transfer-colour",
                     "--provenance", *COARSE)
        properties, vertices = self.vertices("out.ply")
        self.assertEqual(properties[3:], COLOURS + PROPERTIES)
        self.check_colours(vertices)
        # A mesh with all that goes in again, whatever its format.
        self.succeed("remesh", "out.ply", "-o", "again.obj", "--quiet", "--transfer-colour", *COARSE)
        lines = [line.split() for line in self.get("again.obj").decode().splitlines()]
        self.assertEqual({len(line) for line in lines if line[0] == "v"}, {7})
        self.succeed("remesh", "coloured.obj", "-o", "out.ply", "--quiet", "--transfer-colour", *COARSE)
        self.assertEqual(self.vertices("out.ply")[0][3:], COLOURS)
        self.succeed("remesh", "coloured.obj", "-o", "plain.obj", "--quiet", *COARSE)
        lines = [line.split() for line in self.get("plain.obj").decode().splitlines()]
        self.assertEqual({len(line) for line in lines if line[0] == "v"}, {4})

    def test_input_without_colours(self):
        for name in ("out.ply", "out.obj"):
            self.fail_with(3, r"\Acellocut: holed\.obj: .*no colours", "remesh", "holed.obj", "-o", name,
                           "--transfer-colour", *COARSE, outputs=(name,))

    def test_formats_without_a_place(self):
        for name in ("out.obj", "out.off", "out.stl"):
            self.fail_with(2, r"--provenance.*\.ply" + (r".*--vtp" if HAS_VTP else ""), "remesh",
                           "coloured.obj", "-o", name, "--provenance", *COARSE, outputs=(name,))
        for name in ("out.off", "out.stl"):
            self.fail_with(2, r"--transfer-colour.*\.ply" + (r".*--vtp" if HAS_VTP else ""), "remesh",
                           "coloured.obj", "-o", name, "--transfer-colour", *COARSE, outputs=(name,))

    def arrays(self, name):
        """Name, type and number of components of the point arrays, and the numbers of points, faces."""
        head = self.get(name).split(b"<AppendedData", 1)[0] + b"</VTKFile>"
        piece = tree.fromstring(head).find("PolyData/Piece")
        found = {array.get("Name"): (array.get("type"), array.get("NumberOfComponents", "1"))
                 for array in piece.find("PointData")}
        return found, int(piece.get("NumberOfPoints")), int(piece.get("NumberOfPolys"))

    def values(self, name, array, code):
        """The values of an array of the file, from its compressed blocks."""
        head, data = self.get(name).split(b"<AppendedData", 1)
        at = data.index(b"_") + 1 + int(next(
            each.get("offset") for each in tree.fromstring(head + b"</VTKFile>").iter("DataArray")
            if each.get("Name") == array))
        blocks, = struct.unpack_from("<Q", data, at)
        sizes = struct.unpack_from("<%dQ" % blocks, data, at + 24)
        at += 24 + 8 * blocks
        raw = b""
        for size in sizes:
            raw += zlib.decompress(data[at:at + size])
            at += size
        return [value for value, in struct.iter_unpack("<" + code, raw)]

    def rows(self, name):
        """The vertices of a file as the vertices of a PLY file are told."""
        xyz = self.values(name, "Points", "d")
        return [{"x": xyz[3 * i], "y": xyz[3 * i + 1], "z": xyz[3 * i + 2], "nearest_face": face,
                 "distance": distance, "supported": supported}
                for i, (face, distance, supported) in enumerate(zip(
                    self.values(name, "nearest_face", "i"), self.values(name, "distance", "d"),
                    self.values(name, "supported", "B")))]

    @unittest.skipUnless(HAS_VTP, "built without VTK")
    def test_vtp_of_an_stl_has_the_values_of_its_own_points(self):
        seen = {}
        for name in ("out.obj", "out.stl"):
            self.succeed("remesh", "holed.obj", "-o", name, "--vtp", "out.vtp", "--quiet", "--float-coordinates",
                         *COARSE)
            rows = self.rows("out.vtp")
            self.check_vertices(rows)
            seen[name] = sorted((v["x"], v["y"], v["z"], v["supported"]) for v in rows)
            for point in seen[name]:
                self.assertEqual(point[:3], struct.unpack("<3f", struct.pack("<3f", *point[:3])))
        self.assertEqual(seen["out.stl"], seen["out.obj"])  # nothing merges here, but all are renumbered

    @unittest.skipUnless(HAS_VTP, "built without VTK")
    def test_vtp(self):
        wanted = {"nearest_face": ("Int32", "1"), "distance": ("Float64", "1"),
                  "supported": ("UInt8", "1")}
        for name in ("out.obj", "out.stl", "out.off", "out.ply"):
            for options in ([], ["--provenance"], ["--transfer-colour"]):
                with self.subTest(name=name, options=options):
                    self.succeed("remesh", "coloured.obj", "-o", name, "--vtp", "out.vtp", "--quiet",
                                 "--json", "r.json", *options, *COARSE)
                    arrays, points, faces = self.arrays("out.vtp")
                    coloured = "--transfer-colour" in options
                    self.assertEqual(arrays, {**wanted, **({"RGB": ("UInt8", "3")} if coloured else {})})
                    self.assertEqual(faces, json.loads(self.get("r.json"))["output"]["triangles"])
                    self.assertGreater(points, 100)
                    if name == "out.ply":
                        self.assertEqual(points, len(self.vertices(name)[1]))
                        self.assertEqual("int nearest_face" in self.vertices(name)[0],
                                         "--provenance" in options)

    @unittest.skipUnless(HAS_VTP, "built without VTK")
    def test_vtp_that_cannot_be_written(self):
        self.fail_with(2, r"\Acellocut: missing/out\.vtp: cannot create", "remesh", "holed.obj", "-o",
                       "out.obj", "--vtp", "missing/out.vtp", *COARSE)
        self.fail_with(2, "two outputs", "remesh", "holed.obj", "-o", "out.ply", "--vtp", "out.ply",
                       *COARSE, outputs=("out.ply",))
        run = self.succeed("remesh", "holed.obj", "-o", "out.obj", "--vtp", "-", *COARSE)
        self.assertTrue(run.stdout.lstrip().startswith(b"<VTKFile"))
