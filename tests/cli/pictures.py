"""Labelled cells for ParaView, and sections through them."""
import json
import os
import pathlib
import struct
import subprocess
import xml.etree.ElementTree as tree

from program import COARSE, ProgramCase


class LabelledCells(ProgramCase):
    def setUp(self):
        super().setUp()
        self.succeed("remesh", "holed.obj", "-o", "out.obj", "--vtu", "cells.vtu", "--quiet", *COARSE)

    def test_section_as_png_and_svg(self):
        run = self.succeed("section", "cells.vtu", "out.obj", "--plane", "y=50%", "-o", "cut.png", "-o",
                           "cut.svg", "--json", "cut.json")
        self.assertEqual(run.stdout, b"")
        self.assertEqual(self.get("cut.png")[:8], b"\x89PNG\r\n\x1a\n")
        self.assertTrue(tree.fromstring(self.get("cut.svg")).tag.endswith("svg"))
        report = json.loads(self.get("cut.json"))
        self.assertEqual(report["outputs"], ["cut.png", "cut.svg"])
        plane, = report["planes"]
        self.assertEqual(plane["normal"], [0.0, 1.0, 0.0])
        self.assertAlmostEqual(plane["offset"], 0.35, delta=0.2)

    def size_of(self, name):
        return struct.unpack(">II", self.get(name)[16:24])

    def test_series_and_runs_side_by_side(self):
        self.succeed("remesh", "holed.obj", "-o", "sdf.obj", "--vtu", "sdf.vtu", "--lambda-fill", "3", "--quiet",
                     *COARSE)
        self.succeed("section", "cells.vtu", "-o", "one.png", "--width", "300")
        self.succeed("section", "cells.vtu", "holed.obj", "-o", "series.png", "--series", "5", "--width", "300",
                     "--colour-by", "phi", "--json", "series.json")
        report = json.loads(self.get("series.json"))
        offsets = [plane["offset"] for plane in report["planes"]]
        self.assertEqual(len(offsets), 5)
        steps = [b - a for a, b in zip(offsets, offsets[1:])]
        for step in steps:
            self.assertAlmostEqual(step, steps[0])
            self.assertGreater(step, 0)
        self.assertEqual(report["columns"], 3)
        width, height = self.size_of("one.png")
        self.assertGreater(self.size_of("series.png")[0], 2.5 * width)
        self.assertGreater(self.size_of("series.png")[1], 1.5 * height)
        # The input over both runs, the planes in rows.
        self.succeed("section", "holed.obj", "cells.vtu", "sdf.vtu", "-o", "runs.svg", "--plane", "y=40%",
                     "--plane", "z=50%", "--width", "300", "--json", "runs.json")
        self.assertEqual(json.loads(self.get("runs.json"))["columns"], 2)
        self.succeed("section", "holed.obj", "out.obj", "sdf.obj", "--apart", "-o", "apart.png", "--json", "a.json")
        self.assertEqual(json.loads(self.get("a.json"))["columns"], 3)

    def test_other_readers_see_the_same_arrays(self):
        script = pathlib.Path(__file__).with_name("compare_readers.py")
        run = subprocess.run(["/usr/bin/python3", script, "cells.vtu"], cwd=self.folder, capture_output=True, text=True,
                             check=False)
        if run.returncode == 77:
            self.skipTest(run.stdout.strip())
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        for name in ("label", "label_initial", "anchored", "ambiguous", "component", "phi", "volume"):
            self.assertIn(name, run.stdout.split())

    def test_stages(self):
        self.succeed("remesh", "holed.obj", "-o", "with.obj", "--save-stages", "stages", "--json", "with.json", "--quiet",
                     *COARSE)
        self.assertEqual(self.get("with.obj"), self.get("out.obj"))
        collection = tree.fromstring(self.get("stages/run.vtm"))
        files = {entry.get("name"): entry.get("file") for entry in collection.iter("DataSet")}
        self.assertEqual(list(files), ["input", "thickened", "proxy", "interface_initial", "cut_facets", "cells",
                                       "output"])
        self.assertEqual(sorted([*files.values(), "run.vtm"]),
                         sorted(os.listdir(self.path("stages"))))
        self.assertEqual(self.get("stages/cells.vtu"), self.get("cells.vtu"))
        script = pathlib.Path(__file__).with_name("read_stages.py")
        run = subprocess.run(["/usr/bin/python3", script, "stages/run.vtm", "with.json"], cwd=self.folder,
                             capture_output=True, text=True, check=False)
        if run.returncode == 77:
            self.skipTest(run.stdout.strip())
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)

    def test_section_of_an_empty_solid(self):
        self.run_program("remesh", "holed.obj", "-o", "no.obj", "--vtu", "empty.vtu", "--no-unary", "--surface", "sdf", *COARSE)
        self.succeed("section", "empty.vtu", "-o", "cut.png")

    def refuse(self, code, pattern, *arguments):
        self.fail_with(code, pattern, "section", *arguments, outputs=("cut.png",))

    def test_wrong_input(self):
        self.refuse(3, r"\Acellocut: cells\.vtu: .*'nope'.*label_initial", "cells.vtu", "-o", "cut.png",
                    "--colour-by", "nope")
        self.refuse(3, r"\Acellocut: missing\.vtu: no such file", "missing.vtu", "-o", "cut.png")
        self.refuse(3, r"\Acellocut: missing\.obj: cannot open", "missing.obj", "-o", "cut.png")
        self.put("text.vtu", b"this is no XML\n")
        self.refuse(3, r"\Acellocut: text\.vtu: ", "text.vtu", "-o", "cut.png")
        self.put("cut.vtu", self.get("cells.vtu")[:3000])
        self.refuse(3, r"\Acellocut: cut\.vtu: ", "cut.vtu", "-o", "cut.png")

    def test_wrong_arguments(self):
        self.refuse(2, "png or .svg", "cells.vtu", "-o", "cut.gif")
        self.refuse(2, "missing/cut.png: cannot create", "cells.vtu", "-o", "missing/cut.png")
        self.refuse(2, "plane 'q'", "cells.vtu", "-o", "cut.png", "--plane", "q")
        self.refuse(2, "pixels", "cells.vtu", "-o", "cut.png", "--width", "-5")
        self.refuse(2, "too large", "cells.vtu", "-o", "cut.png", "--series", "900", "--columns", "900")
        self.refuse(2, "--series", "cells.vtu", "-o", "cut.png", "--series", "0")

    def test_full_disk(self):
        self.put("cut.png", b"old")
        run = self.run_program("section", "cells.vtu", "-o", "cut.png",
                               env=self.shimmed(CELLOCUT_TEST_WRITE_LIMIT="100"))
        self.assert_one_line(run, 6, r"\Acellocut: cut\.png: cannot write: No space left")
        self.assertEqual(self.get("cut.png"), b"old")
        self.assertEqual(self.names(), ["cells.vtu", "cut.png", "holed.obj", "out.obj"])
