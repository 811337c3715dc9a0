"""`cellocut path` and `--lambda-fill auto`: what they write, that other cuts agree, what they refuse."""
import csv
import io
import json
import os
import re
import xml.etree.ElementTree

from program import COARSE, HAS_VTU, ProgramCase, box, obj_text


class Path(ProgramCase):
    def labellings(self, *arguments):
        self.succeed("path", "holed.obj", "-o", "out", *COARSE, *arguments, "--quiet")
        return list(csv.DictReader(io.StringIO(self.get("out/path.csv").decode())))

    def test_intervals_meet_and_areas_trade(self):
        rows = self.labellings("--range", "1/2,500")
        self.assertGreater(len(rows), 2)
        self.assertEqual(rows[0]["lambda_from_exact"], "1/2")
        self.assertEqual(rows[-1]["lambda_to_exact"], "500")
        for before, after in zip(rows, rows[1:]):
            self.assertEqual(before["lambda_to_exact"], after["lambda_from_exact"])
            self.assertLess(int(before["supported_quanta"]), int(after["supported_quanta"]))
            self.assertGreater(int(before["unsupported_quanta"]), int(after["unsupported_quanta"]))
            self.assertGreater(float(before["volume"]), float(after["volume"]))
        report = json.loads(self.get("out/path.json"))
        self.assertTrue(report["certificate"]["valid"])
        self.assertEqual([check["name"] for check in report["certificate"]["checks"]],
                         ["sizes", "anchors", "areas", "breakpoints", "capacities", "conservation"])
        self.assertEqual(len(report["labellings"]), len(rows))

    def test_single_cuts_agree(self):
        rows = self.labellings()
        # The widest intervals: their ends have small terms between them.
        rows.sort(key=lambda row: float(row["lambda_from"]) / float(row["lambda_to"]))
        for row in rows[:5]:
            middle = round(500 * (float(row["lambda_from"]) + float(row["lambda_to"])))
            self.assertTrue(float(row["lambda_from"]) < middle / 1000 < float(row["lambda_to"]))
            fraction = f"{middle}/1000"
            self.succeed("remesh", "holed.obj", "-o", "o.obj", *COARSE, "--lambda-fill", fraction, "--json", "r.json")
            cut = json.loads(self.get("r.json"))["cut"]
            self.assertEqual(cut["value"], cut["lambda_den"] * int(row["supported_quanta"]) +
                             cut["lambda_num"] * int(row["unsupported_quanta"]))
            self.assertEqual(cut["interior_cells_largest"], int(row["interior_cells"]))

    def test_surfaces_are_those_of_this_run(self):
        if not HAS_VTU:
            self.skipTest("built without VTK")
        self.labellings("--surfaces", "3")
        self.put("out/interface_notes.vtp", "the user's")
        surfaces = [name for name in os.listdir(self.path("out")) if name.startswith("interface_0")]
        self.assertEqual(len(surfaces), 3)
        self.labellings("--surfaces", "0")
        self.assertEqual(sorted(os.listdir(self.path("out"))),
                         ["cells.vtu", "interface_notes.vtp", "path.csv", "path.json", "path.svg"])

    def test_the_report_tells_how_to_do_it_again(self):
        self.labellings("--decimate", "0.5", "--decimation", "quadric", "--exterior", "hull-cells", "--inside", "0.5,0.5,0.25")
        report = json.loads(self.get("out/path.json"))
        wanted = {"decimate": 0.5, "decimation": "quadric", "exterior": "hull-cells",
                  "guidance": {"inside": [[0.5, 0.5, 0.25]], "outside": []}}
        self.assertEqual({key: report["parameters"][key] for key in wanted}, wanted)
        self.assertEqual((report["input"]["points"], report["input"]["triangles"]), (8, 11))

    def test_same_bytes_for_other_solvers_and_threads(self):
        rows = self.labellings("--threads", "1")
        for arguments in (("--threads", "4"), ("--solver", "bk"), ("--solver", "ibfs")):
            self.assertEqual(self.labellings(*arguments), rows)

    def test_support_of_facets(self):
        rows = self.labellings("--support", "facets", "--range", "2,200")
        report = json.loads(self.get("out/path.json"))
        self.assertFalse(report["nested"])
        self.assertEqual(report["parameters"]["support"], "facets")
        self.assertEqual([check["name"] for check in report["certificate"]["checks"]],
                         ["sizes", "anchors", "areas", "breakpoints", "flows"])
        self.assertTrue(report["certificate"]["valid"])
        self.assertEqual(self.labellings("--support", "facets", "--range", "2,200", "--solver", "ibfs"), rows)
        if HAS_VTU:
            self.assertNotIn(b'Name="label_path"', self.get("out/cells.vtu"))
        # One cut of its own, within the widest interval.
        row = min(rows, key=lambda row: float(row["lambda_from"]) / float(row["lambda_to"]))
        middle = round(500 * (float(row["lambda_from"]) + float(row["lambda_to"])))
        self.succeed("remesh", "holed.obj", "-o", "o.obj", *COARSE, "--support", "facets", "--lambda-fill",
                     f"{middle}/1000", "--json", "r.json")
        single = json.loads(self.get("r.json"))
        self.assertEqual(single["parameters"]["support"], "facets")
        self.assertTrue(single["certificate"]["valid"])
        cut = single["cut"]
        self.assertEqual(cut["value"], cut["lambda_den"] * int(row["supported_quanta"]) +
                         cut["lambda_num"] * int(row["unsupported_quanta"]))

    def test_files_for_looking_at(self):
        rows = self.labellings("--surfaces", "3")
        svg = xml.etree.ElementTree.fromstring(self.get("out/path.svg"))
        self.assertEqual(len(svg.findall("{http://www.w3.org/2000/svg}polyline")), 2)
        self.assertIn(f"{len(rows)} labellings", self.get("out/path.svg").decode())
        if not HAS_VTU:
            return
        self.assertIn(b'Name="label_path"', self.get("out/cells.vtu"))
        sets = xml.etree.ElementTree.fromstring(self.get("out/path.pvd")).findall("./Collection/DataSet")
        self.assertEqual(len(sets), min(3, len(rows)))
        times = [float(entry.get("timestep")) for entry in sets]
        self.assertEqual(times, sorted(times))
        for entry in sets:
            self.assertTrue(os.path.isfile(self.path("out/" + entry.get("file"))))

    def test_refuses(self):
        self.put("file", "")
        for arguments, code, what in (
                (("holed.obj", "-o", "out", "--range", "5,5"), 2, "--range: the first has to be"),
                (("holed.obj", "-o", "out", "--range", "5"), 2, "--range: give two numbers"),
                (("holed.obj", "-o", "out", "--range", "0,5"), 2, "--range: '0' is not a positive"),
                (("holed.obj", "-o", "out", "--no-unary"), 2, ".*--no-unary"),
                (("holed.obj", "-o", "out", "--epsilon", "0.0001"), 2, "epsilon .*below half a grid step"),
                (("holed.obj", "-o", "out", "--json", "out/path.csv"), 2, ".*two outputs cannot be"),
                (("holed.obj", "-o", "out", "--solver", "lp"), 2, "--solver: .*exact"),
                (("holed.obj", "-o", "out", "--lambda-fill", "3"), 2, ".*--lambda-fill"),
                (("gone.obj", "-o", "out"), 3, r"gone\.obj: cannot open"),
                (("holed.obj", "-o", "file"), 2, "file: not a folder")):
            with self.subTest(arguments):
                self.fail_with(code, r"\Acellocut: " + what, "path", *arguments, outputs=())


class AutoFill(ProgramCase):
    def test_the_report_says_what_was_chosen(self):
        run = self.succeed("remesh", "holed.obj", "-o", "o.obj", *COARSE, "--lambda-fill", "auto", "--json", "r.json")
        report = json.loads(self.get("r.json"))
        choice = report["fill_choice"]
        self.assertEqual(report["parameters"]["lambda_fill"], choice["lambda_fill"])
        numerator, _, denominator = choice["lambda_fill"].partition("/")
        chosen = int(numerator) / int(denominator or 1)
        self.assertTrue(choice["chosen"]["lambda_from"] < chosen < choice["chosen"]["lambda_to"])
        self.assertTrue(report["certificate"]["valid"])
        self.assertIn("fill path", [stage["name"] for stage in report["stages"]])
        self.assertRegex(run.stdout.decode(), "(?m)^lambda_fill %s of [0-9]+ labellings" %
                         re.escape(choice["lambda_fill"]))
        # It is what that number gives by itself.
        self.succeed("remesh", "holed.obj", "-o", "p.obj", *COARSE, "--lambda-fill", choice["lambda_fill"])
        self.assertEqual(self.get("o.obj"), self.get("p.obj"))

    def test_refuses(self):
        for arguments, what in (
                (("remesh", "holed.obj", "-o", "o.obj", "--solver", "lp"), "--lambda-fill auto needs an exact"),
                (("remesh", "holed.obj", "-o", "o.obj", "--no-unary", "--surface", "sdf"), "--lambda-fill auto needs"),
                (("remesh", "holed.obj", "-o", "o.obj", "--support", "facets"), "--support labels"),
                (("compare", "holed.obj", "-o", "out"), "--lambda-fill auto: give a number")):
            with self.subTest(arguments):
                self.fail_with(2, r"\Acellocut: .*" + what, *arguments, "--lambda-fill", "auto", outputs=())


class Guidance(ProgramCase):
    def volume(self, *arguments):
        self.succeed("remesh", "box.obj", "-o", "o.obj", *COARSE, *arguments, "--json", "r.json")
        report = json.loads(self.get("r.json"))
        self.assertTrue(report["certificate"]["valid"])
        return report["output"]["volume"], report["counts"]

    def setUp(self):
        super().setUp()
        self.put("box.obj", obj_text(box((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))))

    def test_points_and_files(self):
        filled, counts = self.volume()
        self.assertGreater(filled, 7)
        self.assertEqual((counts["cells_guided_inside"], counts["cells_guided_outside"]), (0, 0))
        hollow, counts = self.volume("--outside", "0,0,0")
        self.assertLess(hollow, 0.5 * filled)
        self.assertGreater(counts["cells_guided_outside"], 0)
        self.put("points.txt", "# the middle\n\n0 0 0  # of the box\n-0.1, 0.2, 0.1\r\n")
        self.assertLess(self.volume("--outside", "points.txt")[0], 0.5 * filled)
        self.assertEqual(self.volume("--inside=-0.1,0.2,0.1", "--inside", "0,0,0")[0], filled)
        self.succeed("path", "box.obj", "-o", "out", *COARSE, "--outside", "0,0,0", "--quiet")
        self.assertTrue(json.loads(self.get("out/path.json"))["certificate"]["valid"])

    def test_refuses(self):
        self.put("bad.txt", "0 0 0\n1 2\n")
        for arguments, code, what in (
                (("--inside", "1,2"), 2, "--inside 1,2: neither a point"),
                (("--inside", "1,2,nan"), 2, "--inside 1,2,nan: neither a point"),
                (("--inside", "bad.txt"), 3, r"bad\.txt: line 2: not a point"),
                (("--outside", "1,0,0"), 2, "--outside 1,0,0: lies in the thickened input"),
                (("--inside", "9,0,0"), 2, "--inside 9,0,0: lies beyond the hull"),
                (("--inside", "0,0,0", "--outside", "0,0,0"), 2, "--inside 0,0,0: .*same tetrahedron")):
            with self.subTest(arguments):
                self.fail_with(code, r"\Acellocut: " + what, "remesh", "box.obj", "-o", "out.obj", *COARSE, *arguments)
