"""`cellocut evaluate`: known distances, references of points, what it refuses."""
import json
import os
import struct

from program import ProgramCase, join, box, obj_text, sphere

SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]


def sheet(height):
    return [(x, y, height) for x, y in SQUARE], [(0, 1, 2), (0, 2, 3)]


def cloud_text(points, normals=None):
    """A PLY file without faces."""
    names = ["x", "y", "z"] + (["nx", "ny", "nz"] if normals else [])
    rows = [p + n for p, n in zip(points, normals)] if normals else points
    lines = ["ply", "format ascii 1.0", "element vertex %d" % len(rows)]
    lines += ["property double " + name for name in names] + ["end_header"]
    return "\n".join(lines + [" ".join("%r" % v for v in row) for row in rows]) + "\n"


class Evaluate(ProgramCase):
    def setUp(self):
        super().setUp()
        self.put("low.obj", obj_text(sheet(0.0)))
        self.put("high.obj", obj_text(sheet(0.25)))

    def report(self, *arguments):
        run = self.succeed("evaluate", *arguments, "--samples", "2000", "--json", "-")
        return json.loads(run.stdout)

    def test_shifted_sheets(self):
        report = self.report("high.obj", "--reference", "low.obj", "--thresholds", "0.2499,0.2501")
        mesh, = report["meshes"]
        self.assertAlmostEqual(mesh["cd_p2s"], 0.125, delta=1e-12)
        self.assertAlmostEqual(mesh["hd_p2s"], 0.25, delta=1e-12)
        self.assertEqual(mesh["anc_p2s"], 1)
        self.assertEqual([row["f1_p2s"] for row in mesh["f1"]], [0, 100])
        self.assertEqual([row["threshold"] for row in mesh["f1"]], [0.2499, 0.2501])
        self.assertGreater(mesh["cd"], mesh["cd_p2s"])
        self.assertEqual((mesh["volume"], mesh["area"], mesh["components"]), (0, 1, 1))
        self.assertEqual(mesh["output"]["boundary_edges"], 4)
        self.assertEqual(mesh["output"]["by_position"]["boundary_edges"], 4)
        for way in ("to_reference_p2s", "from_reference_p2s"):
            for length in ("median", "p95", "mean", "max"):
                self.assertAlmostEqual(mesh["distances"][way]["relative"][length], 0.25, delta=1e-12)
            self.assertEqual(mesh["distances"][way]["normals"], 1)
        reference = report["reference"]
        self.assertEqual((reference["kind"], reference["unit"], reference["area"]), ("mesh", 1, 1))

    def test_input_units(self):
        for name, height in (("large.obj", 0.0), ("above.obj", 2.0)):
            points, faces = sheet(height)
            self.put(name, obj_text(([(8 * x, 8 * y, z) for x, y, z in points], faces)))
        mesh, = self.report("above.obj", "--reference", "large.obj")["meshes"]
        distances = mesh["distances"]["to_reference_p2s"]
        self.assertAlmostEqual(distances["relative"]["median"], 0.25, delta=1e-12)
        self.assertAlmostEqual(distances["input_units"]["median"], 2, delta=1e-12)
        self.assertAlmostEqual(distances["input_units"]["mean_square"], 4, delta=1e-12)

    def test_several_meshes_have_a_row_each(self):
        self.put("sphere.obj", obj_text(sphere(8)))
        alone = self.report("high.obj", "--reference", "low.obj")["meshes"]
        both = self.report("sphere.obj", "high.obj", "--reference", "low.obj")["meshes"]
        self.assertEqual([mesh["path"] for mesh in both], ["sphere.obj", "high.obj"])
        self.assertEqual(both[1:], alone)
        text = self.succeed("evaluate", "sphere.obj", "high.obj", "--reference", "low.obj",
                            "--samples", "500").stdout.decode()
        self.assertEqual(text.count("\nsphere.obj "), text.count("\nhigh.obj "))
        self.assertIn("\nto surface (p2s) ", text)

    def test_counts_by_index_and_by_position(self):
        # Two boxes that share a face but no points: sixteen points, twelve places.
        twins = join(box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), box((1.0, 0.0, 0.0), (2.0, 1.0, 1.0)))
        self.put("twins.obj", obj_text(twins))
        mesh, = self.report("twins.obj", "--reference", "low.obj")["meshes"]
        self.assertEqual((mesh["components"], mesh["components_by_position"]), (2, 1))
        self.assertEqual(mesh["output"]["nonmanifold_edges"], 0)
        self.assertEqual(mesh["output"]["by_position"]["nonmanifold_edges"], 5)
        bare, = self.report("twins.obj", "--reference", "low.obj", "--no-counts")["meshes"]
        self.assertNotIn("output", bare)
        self.assertAlmostEqual(bare["volume"], 2)

    def test_points_with_and_without_normals(self):
        points = [(x / 8, y / 8, 0.0) for x in range(9) for y in range(9)]
        self.put("bare.ply", cloud_text(points))
        self.put("full.ply", cloud_text(points, [(0.0, 0.0, -2.0)] * len(points)))
        for name, anc in (("bare.ply", None), ("full.ply", 1)):
            report = self.report("high.obj", "--reference", name)
            reference = report["reference"]
            self.assertEqual((reference["kind"], reference["points"]), ("points", 81))
            self.assertEqual(reference["normals"], anc is not None)
            mesh, = report["meshes"]
            self.assertEqual(mesh["anc"], anc)
            self.assertAlmostEqual(mesh["hd"], 0.26, delta=0.02)
            for key in ("cd_p2s", "hd_p2s", "anc_p2s"):
                self.assertIsNone(mesh[key])
            self.assertIsNone(mesh["f1"][0]["f1_p2s"])
            self.assertIsNone(mesh["distances"]["to_reference_p2s"])
            self.assertAlmostEqual(mesh["distances"]["from_reference_p2s"]["relative"]["max"], 0.25)
        text = self.succeed("evaluate", "high.obj", "--reference", "bare.ply", "--samples",
                            "100").stdout.decode()
        self.assertIn("81 points, without normals", text)
        self.assertIn("to reference (points)", text)

    def test_same_bytes_for_any_number_of_threads_and_another_seed_differs(self):
        self.put("sphere.obj", obj_text(sphere(12)))
        seen = set()
        for threads in ("1", "2", "8"):
            seen.add(self.succeed("evaluate", "sphere.obj", "--reference", "low.obj", "--samples", "3000",
                                  "--threads", threads, "--json", "-").stdout)
        self.assertEqual(len(seen), 1)
        report = json.loads(seen.pop())
        other = self.report("sphere.obj", "--reference", "low.obj", "--seed", "2")
        self.assertNotEqual(report["meshes"][0]["cd"], other["meshes"][0]["cd"])

    def test_standard_input_and_quiet(self):
        run = self.succeed("evaluate", "-", "--format", "obj", "--reference", "low.obj", "--quiet",
                           "--samples", "100", "--json", "r.json", input=self.get("high.obj"))
        self.assertEqual(run.stdout, b"")
        self.assertEqual(json.loads(self.get("r.json"))["meshes"][0]["path"], "-")

    def test_volume_of_shifted_cubes(self):
        self.put("cube.obj", obj_text(box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))))
        self.put("shifted.obj", obj_text(box((0.5, 0.0, 0.0), (1.5, 1.0, 1.0))))
        report = self.report("shifted.obj", "cube.obj", "low.obj", "--reference", "cube.obj")
        self.assertEqual(report["parameters"]["volume_points"], 1000000)
        shifted, same, sheet_ = (mesh["volume_iou"] for mesh in report["meshes"])
        self.assertAlmostEqual(shifted["value"], 1 / 3, delta=5 * shifted["standard_error"])
        self.assertLess(shifted["standard_error"], 0.001)
        self.assertEqual((shifted["points"], shifted["box_volume"]), (1000000, 1.5))
        self.assertEqual((same["value"], same["undefined"]), (1, None))
        self.assertIsNone(sheet_["value"])
        self.assertRegex(sheet_["undefined"], "the mesh is not closed .4 edges")
        text = self.succeed("evaluate", "low.obj", "shifted.obj", "--reference", "cube.obj", "--samples", "500",
                            "--volume-points", "9000").stdout.decode()
        self.assertRegex(text, r"\nvolumes +IoU")
        self.assertIn("\nlow.obj: no volume IoU: the mesh is not closed", text)
        none, = self.report("cube.obj", "--reference", "cube.obj", "--volume-points", "0")["meshes"]
        self.assertNotIn("volume_iou", none)
        open_, = self.report("cube.obj", "--reference", "low.obj")["meshes"]
        self.assertRegex(open_["volume_iou"]["undefined"], "the reference is not closed")

    def test_pairs(self):
        os.mkdir(self.path("deep"))
        self.put("deep/cube, one.obj", obj_text(box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))))
        self.put("deep/bad.obj", "v 0 0 zero\n")
        self.put("deep/list.csv", "# two that cannot be read\r\nmesh,reference\r\n../high.obj,../low.obj\r\n"
                 "missing.obj, ../low.obj\n\n\"cube, one.obj\",../low.obj\nbad.obj,../low.obj\n"
                 "../low.obj,bad.obj\n../low.obj,../low.obj\n")
        run = self.run_program("evaluate", "--pairs", "deep/list.csv", "--samples", "500", "--json", "r.json")
        self.assertEqual(run.returncode, 3)
        errors = run.stderr.decode().splitlines()
        self.assertEqual(len(errors), 3)
        self.assertRegex(errors[0], r"\Acellocut: deep/list\.csv: line 4: deep/missing\.obj: cannot open")
        rows = run.stdout.decode().splitlines()
        self.assertEqual(len(rows), 8)
        self.assertEqual(rows[-1], "6 pairs, 3 done, 3 failed")
        self.assertRegex(rows[2], r"\Amissing\.obj +\.\./low\.obj +failed\Z")
        report = json.loads(self.get("r.json"))
        self.assertEqual(report["counts"], {"pairs": 6, "done": 3, "failed": 3})
        self.assertEqual([pair["line"] for pair in report["pairs"]], [3, 4, 6, 7, 8, 9])
        self.assertEqual([pair["exit_code"] for pair in report["pairs"]], [0, 3, 0, 3, 3, 0])
        self.assertEqual(report["pairs"][2]["mesh"], "cube, one.obj")
        for pair in report["pairs"]:
            self.assertEqual(pair["error"] is None, pair["evaluation"] is not None)
        # The same object as the call for that pair alone.
        for number, mesh in ((0, "deep/../high.obj"), (2, "deep/cube, one.obj"), (5, "deep/../low.obj")):
            alone = self.succeed("evaluate", mesh, "--reference", "deep/../low.obj", "--samples", "500",
                                 "--json", "-")
            self.assertEqual(json.loads(alone.stdout), report["pairs"][number]["evaluation"])
        self.put("good.csv", "high.obj,low.obj\n")
        run = self.succeed("evaluate", "--pairs", "good.csv", "--samples", "500", "--json", "-")
        self.assertEqual(json.loads(run.stdout)["counts"]["failed"], 0)

    def test_lists_that_are_wrong(self):
        for content, what in (("# none\n", "no pairs"), ("a.obj\n", "line 1: a row is `mesh,reference`"),
                              ("mesh,reference\na,b,c\n", "line 2: a row is"), ("a.obj,\n", "line 1: a name is"),
                              ('"a.obj,b.obj\n', "line 1: a quote"), ('"a"b,c\n', "line 1: something follows"),
                              ("-,low.obj\n", "line 1: '-' is no file"), ("", "the file is empty")):
            with self.subTest(content):
                self.put("list.csv", content)
                self.refuse(3, r"list\.csv: " + what, "--pairs", "list.csv")
        self.refuse(3, r"gone\.csv: cannot open", "--pairs", "gone.csv")
        self.refuse(2, ".*excludes", "low.obj", "--pairs", "list.csv")
        self.refuse(2, ".*excludes", "--pairs", "list.csv", "--reference", "low.obj")

    def refuse(self, code, pattern, *arguments):
        few = () if "--samples" in arguments else ("--samples", "100")
        self.fail_with(code, r"\Acellocut: " + pattern, "evaluate", *arguments, *few, "--json",
                       "out.json", outputs=("out.json",))

    def test_wrong_files(self):
        self.put("flat.obj", obj_text(([(0.0, 0.0, 0.0)] * 3, [(0, 1, 2)])))
        self.put("line.obj", obj_text(([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (3.0, 0.0, 0.0)], [(0, 1, 2)])))
        self.put("none.ply", cloud_text([]))
        self.put("one.ply", cloud_text([(1.0, 2.0, 3.0)]))
        self.put("wild.ply", cloud_text([(1.0, 2.0, float("nan"))]))
        self.put("cut.ply", cloud_text([(1.0, 2.0, 3.0)]).replace("vertex 1", "vertex 2"))
        self.put("cut_binary.ply", cloud_text([]).replace("ascii", "binary_little_endian")
                 .replace("vertex 0", "vertex 2").encode() + struct.pack("<5d", 1, 2, 3, 4, 5))
        for name, what in (("flat.obj", "has no extent"), ("line.obj", "no face has an area"),
                           ("none.ply", "no points"), ("one.ply", "has no extent"),
                           ("wild.ply", "line 8: a coordinate is not finite"),
                           ("cut.ply", "the header promises 2 instances of 'vertex'"),
                           ("cut_binary.ply", "the header promises 2 instances of 'vertex'"),
                           ("missing.obj", "cannot open"), ("missing.ply", "cannot open")):
            with self.subTest(name):
                self.refuse(3, name.replace(".", r"\.") + ": " + what, "low.obj", "--reference", name)
        self.refuse(3, r"line\.obj: no face has an area", "low.obj", "line.obj", "--reference", "low.obj")
        self.refuse(3, r"one\.ply: no faces", "one.ply", "--reference", "low.obj")

    def test_wrong_arguments(self):
        good = ("high.obj", "--reference", "low.obj")
        self.refuse(2, "--reference is required", "high.obj")
        self.refuse(2, "meshes is required", "--reference", "low.obj")
        self.refuse(2, "volume points must be 0 to", *good, "--volume-points", "2000000000")
        self.refuse(2, "samples must be 1 to", *good, "--samples", "0")
        self.refuse(2, ".*--samples", *good, "--samples", "many")
        self.refuse(2, "a threshold must be a positive number", *good, "--thresholds", "0.1,0")
        self.refuse(2, ".*--thresholds", *good, "--thresholds", "0.1,near")
        self.refuse(2, "cannot tell the mesh format", "high.obj", "--reference", "low")
        self.refuse(2, "--reference must be a file", "high.obj", "--reference", "-")
