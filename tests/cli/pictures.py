"""Labelled cells for ParaView, and sections through them."""
import json
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
        self.assertEqual(report["plane"]["normal"], [0.0, 1.0, 0.0])
        self.assertAlmostEqual(report["plane"]["offset"], 0.35, delta=0.2)

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

    def test_full_disk(self):
        self.put("cut.png", b"old")
        run = self.run_program("section", "cells.vtu", "-o", "cut.png",
                               env=self.shimmed(CELLOCUT_TEST_WRITE_LIMIT="100"))
        self.assert_one_line(run, 6, r"\Acellocut: cut\.png: cannot write: No space left")
        self.assertEqual(self.get("cut.png"), b"old")
        self.assertEqual(self.names(), ["cells.vtu", "cut.png", "holed.obj", "out.obj"])
