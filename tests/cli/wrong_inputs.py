"""Inputs and arguments that are wrong: the exit code, one line, nothing written."""
import json
import os
import resource
import struct

from program import (BOXES_AT_AN_EDGE, COARSE, HAS_VTU, HOLED_BOX, OLD, ProgramCase, obj_text)


class InputFiles(ProgramCase):
    def refuse(self, name, what, content=None, code=3):
        if content is not None:
            self.put(name, content)
        pattern = r"\Acellocut: " + name.replace(".", r"\.") + ": " + what
        self.fail_with(code, pattern, "remesh", name, "-o", "out.obj", *COARSE)
        self.fail_with(code, pattern, "check", name, "--json", "out.json", outputs=("out.json",))

    def test_empty_file(self):
        for name in ("empty.obj", "empty.ply", "empty.stl", "empty.off"):
            with self.subTest(name):
                self.refuse(name, "the file is empty", b"")

    def test_truncated_binary_stl(self):
        triangle = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
        self.refuse("cut.stl", "", bytes(80) + struct.pack("<I", 3) + 2 * triangle + triangle[:20])

    def test_ply_header_promises_more_than_the_file_holds(self):
        header = ("ply\nformat {} 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
                  "property double z\nelement face 100\nproperty list uchar int vertex_indices\n"
                  "end_header\n")
        points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        text = "".join("%d %d %d\n" % p for p in points) + "3 0 1 2\n"
        self.refuse("ascii.ply", "", header.format("ascii") + text)
        binary = b"".join(struct.pack("<3d", *p) for p in points) + struct.pack("<B3i", 3, 0, 1, 2)
        self.refuse("binary.ply", "", header.format("binary_little_endian").encode() + binary)

    def test_coordinates_that_are_not_finite(self):
        for word in ("nan", "inf", "-inf", "1e999"):
            with self.subTest(word):
                text = obj_text(HOLED_BOX).replace("v 1.0", "v " + word, 1)
                self.refuse("wild.obj", "", text)

    def test_index_out_of_range(self):
        for face in ("f 1 2 99", "f 0 1 2", "f -1 -2 -99"):
            with self.subTest(face):
                self.refuse("wild.obj", "", obj_text(HOLED_BOX) + face + "\n")

    def test_directory(self):
        for name in ("folder", "folder.obj"):
            with self.subTest(name):
                os.mkdir(self.path(name))
                self.refuse(name, "is a directory")

    def test_missing_file(self):
        self.refuse("missing.obj", "cannot open: No such file or directory")

    def test_no_faces(self):
        self.refuse("points.obj", ".*no faces", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")

    def test_no_extent(self):
        self.put("point.obj", obj_text(([(1.0, 2.0, 3.0)] * 3, [(0, 1, 2)])))
        self.fail_with(3, r"\Acellocut: point\.obj: .*no extent",
                       "remesh", "point.obj", "-o", "out.obj", *COARSE)

    def test_format_that_the_name_does_not_tell(self):
        self.put("mesh.xyz", obj_text(HOLED_BOX))
        self.fail_with(2, r"'?mesh\.xyz.*--format", "remesh", "mesh.xyz", "-o", "out.obj", *COARSE)
        self.fail_with(2, "--format", "remesh", "-", "-o", "out.obj", *COARSE, input=b"")


class Arguments(ProgramCase):
    def refuse(self, pattern, *arguments):
        self.fail_with(2, pattern, "remesh", "holed.obj", "-o", "out.obj", "-R", "16", *arguments)

    def test_output_folder_that_cannot_be_written(self):
        # Before any work: the input does not even exist.
        self.put("file", OLD)
        for path in ("missing/out.obj", "file/out.obj"):
            with self.subTest(path):
                self.fail_with(2, r"\Acellocut: " + path + ": cannot create",
                               "remesh", "missing.obj", "-o", path, *COARSE, outputs=())
        self.fail_with(2, r"\Acellocut: missing/out\.json: cannot create", "check", "missing.obj",
                       "--json", "missing/out.json", outputs=())
        self.refuse(r"\Acellocut: missing/out\.json: cannot create", "--json", "missing/out.json")
        self.refuse(r"\Acellocut: missing/k\.obj: cannot create", "--keep-invalid", "missing/k.obj")
        if HAS_VTU:
            self.refuse(r"\Acellocut: missing/out\.vtu: cannot create", "--vtu", "missing/out.vtu")

    def test_output_is_a_directory(self):
        os.mkdir(self.path("out.ply"))
        self.fail_with(2, r"\Acellocut: out\.ply: .*directory", "remesh", "holed.obj", "-o", "out.ply",
                       *COARSE, outputs=())

    def test_output_format_that_the_name_does_not_tell(self):
        self.fail_with(2, r"\Acellocut: out\.xyz: .*--output-format", "remesh", "holed.obj", "-o",
                       "out.xyz", *COARSE, outputs=())
        self.refuse("foo.*obj, off, ply", "--output-format", "foo")
        self.refuse("foo.*obj, off, ply", "--format", "foo")

    def test_unknown_variant_lists_what_is_built(self):
        self.refuse("unknown backend 'foo'; built: .*cgal", "--backend", "foo")
        self.refuse("unknown solver 'foo'; built: .*bk, .*push_relabel", "--solver", "foo")

    def test_resolution_out_of_range(self):
        for value in ("7", "0", "-5", "16385", "x", "99999999999"):
            with self.subTest(value):
                self.fail_with(2, "--resolution", "remesh", "holed.obj", "-o", "out.obj", "-R", value)

    def test_epsilon_below_half_a_step_names_what_is_usable(self):
        self.refuse("--resolution 50 or more, or --epsilon 0.03125 or more", "--epsilon", "0.01")
        self.refuse("--resolution 50 or more, or --epsilon 0.03125 or more", "--epsilon-abs", "0.01")
        # And what it names is indeed accepted.
        for usable in (("-R", "50", "--epsilon", "0.01"), ("-R", "16", "--epsilon", "0.03125")):
            self.succeed("remesh", "holed.obj", "-o", "out.obj", "--quiet", *usable)

    def test_epsilon_nonsense(self):
        for value in ("0", "-1", "nan", "inf", "1.5", "x"):
            with self.subTest(value):
                self.refuse("--epsilon", "--epsilon", value)
                self.refuse("--epsilon-abs", "--epsilon-abs", value)
        self.refuse("--epsilon.*--epsilon-abs", "--epsilon", "0.1", "--epsilon-abs", "0.1")

    def test_lambda_nonsense(self):
        for value in ("x", "", "0", "-3", "1/0", "0/1", "nan", "inf", "1/2/3", "1048577", "20 ", "0x10"):
            with self.subTest(value):
                self.refuse("--lambda-fill: ", "--lambda-fill", value)

    def test_other_values_out_of_range(self):
        for option, values in (("--decimate", ("1", "-0.1", "nan")), ("--area-bits", ("7", "51")),
                               ("--min-component", ("-1", "2", "nan")), ("--threads", ("0", "-1", "x")),
                               ("--surface", ("foo",)), ("--cut", ("foo",)), ("--exterior", ("foo",))):
            for value in values:
                with self.subTest(option=option, value=value):
                    self.refuse(option, option, value)

    def test_memory_that_does_not_suffice(self):
        for command in (("remesh", "holed.obj", "-o", "out.obj"), ("path", "holed.obj", "-o", "out")):
            with self.subTest(command[0]):
                self.fail_with(6, r"needs about .* GB of memory at --resolution 4000.*--memory.*--resolution [0-9]+ "
                               "would fit", *command, "-R", "4000", "--memory", "200MB")
        self.refuse("--memory", "--memory", "x")
        self.refuse("--memory", "--memory", "-1")
        self.refuse("--memory", "--memory", "1.5 apples")
        self.fail_with(6, "--memory", "remesh", "holed.obj", "-o", "out.obj", *COARSE, "--memory", "0.001GB")
        self.succeed("remesh", "holed.obj", "-o", "out.obj", "--quiet", *COARSE, "--memory", "1.5 GiB")
        self.succeed("remesh", "holed.obj", "-o", "out.obj", "--quiet", *COARSE, "--memory", "0")

    def test_arguments_that_do_not_go_together(self):
        self.refuse("--quiet.*--verbose|--verbose.*--quiet", "--quiet", "--verbose")
        self.refuse("--bogus", "--bogus")
        self.fail_with(2, "standard output", "remesh", "holed.obj", "-o", "-", "--output-format", "obj",
                       "--json", "-", *COARSE, outputs=())
        self.fail_with(2, "--output", "remesh", "holed.obj", outputs=())
        self.fail_with(2, "subcommand", outputs=())
        self.fail_with(2, "'bogus' is no command", "bogus", outputs=())
        self.fail_with(2, "'--bogus' is no command", "--bogus", outputs=())


class OutputsOverInputs(ProgramCase):
    def test_no_output_but_the_surface_may_be_the_input(self):
        os.symlink("holed.obj", self.path("link.obj"))
        before = self.get("holed.obj")
        commands = [("remesh", "holed.obj", "-o", "out.obj", "--json", "./holed.obj", *COARSE),
                    ("check", "holed.obj", "--json", "link.obj"),
                    ("scan", "holed.obj", "-o", "out.ply", "--json", "holed.obj"),
                    ("evaluate", "holed.obj", "--reference", "holed.obj", "--json", "holed.obj")]
        for command in commands:
            with self.subTest(command):
                self.assert_one_line(self.run_program(*command), 2, "an output cannot be the input")
                self.assertEqual(self.get("holed.obj"), before)
                self.assertEqual(self.names(), ["holed.obj", "link.obj"])

    def test_folders_are_looked_at_before_the_work(self):
        for option in ("--save-stages", "--stage-surfaces"):
            for folder in ("holed.obj", "holed.obj/stages", "/proc/stages"):
                with self.subTest(option=option, folder=folder):
                    run = self.run_program("remesh", "holed.obj", "-o", "out.obj", *COARSE, option, folder)
                    self.assert_one_line(run, 2, "not a folder|cannot be written into")
                    self.assertEqual(self.names(), ["holed.obj"])


class SurfaceOptions(ProgramCase):
    def test_error_allowed_far_from_the_origin(self):
        # Two needles: the faces of their slabs could not be divided as finely as their distance asks for.
        self.put("needles.obj", """
            v 10000.100076490315 9999.617636118084 9999.8219701848
            v 9999.698936827364 10000.741644343128 9999.135468139662
            v 9999.698936827364 10000.741644343128 9999.13546852849
            v 9999.716246115626 9999.832694821991 10000.24313717056
            v 10000.493753877701 9999.345800672309 9999.13578017708
            v 10000.493753877352 9999.345800672309 9999.135745710926
            f 1 2 3
            f 4 5 6
        """)
        self.succeed("remesh", "needles.obj", "-o", "out.obj", "-R", "24", "--max-error", "0.2", "--quiet",
                     preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (60, 60)))

    def test_what_does_not_go_together(self):
        for wrong, words in (((("--no-unary",)), "--surface sdf or cells"),
                             ((("--no-thickening",)), "--surface sdf or cells"),
                             (("--no-thickening", "--surface", "sdf", "--pull"), "nothing to be pulled"),
                             ((("--surface", "cells", "--pull")), "cells cannot be pulled"),
                             ((("--surface", "cells", "--fair")), "cells cannot be faired"),
                             ((("--surface", "cells", "--faces", "100")), "cells cannot be simplified"),
                             ((("--no-pull", "--pull-distance", "0.001")), "needs --pull"),
                             ((("--pull-distance", "0.5")), "at most epsilon"),
                             ((("--pull-distance", "0")), "--pull-distance"),
                             ((("--faces", "3")), "at least 4"),
                             ((("--max-error", "-1")), "--max-error")):
            self.fail_with(2, words, "remesh", "holed.obj", "-o", "out.obj", *COARSE, *wrong)

    def test_faces_out_of_reach_are_said(self):
        run = self.succeed("remesh", "holed.obj", "-o", "out.obj", *COARSE, "--faces", "4", "--max-error", "1e-4",
                           "--json", "r.json")
        report = json.loads(self.get("r.json"))["surface"]["simplification"]
        self.assertFalse(report["reached"])
        self.assertNotEqual(report["stop"], "")
        self.assertIn(b"stopped early", run.stdout)
        self.succeed("check", "out.obj", "--quiet")


class Guarantees(ProgramCase):
    def test_empty_solid(self):
        for name in ("out.obj", "out.json", "kept.obj"):
            self.put(name, OLD)
        wanted = ["--vtu", "out.vtu"] if HAS_VTU else []
        run = self.run_program("remesh", "holed.obj", "-o", "out.obj", "--no-unary", "--surface", "sdf", *COARSE,
                               *wanted, "--json", "out.json", "--keep-invalid", "kept.obj")
        self.assert_one_line(run, 4, r"\Acellocut: holed\.obj: no cell is interior")
        self.assertEqual(self.get("out.obj"), OLD)
        self.assertEqual(self.get("kept.obj"), OLD)  # there is no surface to keep
        report = json.loads(self.get("out.json"))
        self.assertFalse(report["output"]["valid"])
        self.assertEqual(report["output"]["path"], "")
        self.assertEqual(report["cut"]["interior_cells"], 0)
        self.assertTrue(report["certificate"]["valid"])
        if HAS_VTU:
            self.assertIn(b"UnstructuredGrid", self.get("out.vtu")[:1000])
        self.assertFalse([name for name in self.names() if name.endswith(".tmp")])

    def test_flood_signed_distance_leaves_a_solid_or_says_that_there_is_none(self):
        self.put("closed.obj", obj_text(BOXES_AT_AN_EDGE))
        flood = ("-R", "16", "--no-thickening", "--surface", "sdf")
        self.succeed("remesh", "closed.obj", "-o", "out.obj", *flood, "--quiet")
        self.succeed("check", "out.obj", "--quiet")
        # Through the hole everything is outside: not even a cell is there.
        self.put("out.obj", OLD)
        cells = ["--vtu", "out.vtu"] if HAS_VTU else []
        run = self.run_program("remesh", "holed.obj", "-o", "out.obj", *flood, "--json", "out.json", *cells)
        self.assert_one_line(run, 4, r"\Acellocut: holed\.obj: no cell is interior")
        self.assertEqual(self.get("out.obj"), OLD)
        report = json.loads(self.get("out.json"))
        self.assertEqual((report["counts"]["cells"], report["output"]["valid"]), (0, False))
        if HAS_VTU:
            self.assertIn(b"UnstructuredGrid", self.get("out.vtu")[:1000])

    def test_contacts_do_not_fit_into_stl(self):
        # Between two boxes that meet in an edge the interface of the cells touches itself, at one
        # thickness or another.
        self.put("edge.obj", obj_text(BOXES_AT_AN_EDGE))
        for epsilon in ("0.05", "0.06", "0.07", "0.08", "0.09", "0.1"):
            common = ("remesh", "edge.obj", "--surface", "cells", "-R", "16", "--epsilon", epsilon, "--quiet")
            self.succeed(*common, "-o", "out.obj", "--json", "r.json")
            report = json.loads(self.get("r.json"))["output"]
            if report["touching_edges"] + report["touching_vertices"] > 0:
                break
        self.fail_with(4, r"\Acellocut: out\.stl: not written.*OBJ or PLY", *common, "-o", "out.stl",
                       outputs=("out.stl",))

        run = self.run_program(*common, "-o", "out.stl", "--json", "r.json", "--keep-invalid", "kept.ply")
        self.assert_one_line(run, 4, "OBJ or PLY")
        self.assertEqual(self.get("out.stl"), OLD)
        report = json.loads(self.get("r.json"))["output"]
        self.assertFalse(report["valid"])
        self.assertEqual(report["path"], "")
        self.assertGreater(report["nonmanifold_edges"] + report["nonmanifold_vertices"], 0)
        self.assertEqual(self.run_program("check", "kept.ply", "--quiet").returncode, 4)

        # The same solid as OBJ: the contacts are split, reported, and count as valid; nothing is kept.
        self.put("kept.ply", OLD)
        self.succeed(*common, "-o", "out.obj", "--json", "r.json", "--keep-invalid", "kept.ply")
        self.assertEqual(self.get("kept.ply"), OLD)
        report = json.loads(self.get("r.json"))["output"]
        self.assertTrue(report["valid"])
        self.assertGreater(report["touching_edges"] + report["touching_vertices"], 0)
        self.succeed("check", "out.obj", "--quiet")
