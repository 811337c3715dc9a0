"""What a run that succeeds leaves behind: the same bytes by every way, a whole report, honest checks."""
import json
import re

from program import COARSE, HAS_VTU, HOLED_BOX, OLD, ProgramCase, join, box, obj_text

FORMATS = ("obj", "off", "ply", "ply-ascii", "stl", "stl-ascii")


class Remesh(ProgramCase):
    def test_standard_input_and_output_give_the_bytes_of_files(self):
        for name in FORMATS:
            with self.subTest(name):
                self.succeed("remesh", "holed.obj", "-o", "file", "--output-format", name, "--quiet",
                             *COARSE)
                run = self.succeed("remesh", "-", "--format", "obj", "-o", "-", "--output-format", name,
                                   *COARSE, input=self.get("holed.obj"))
                self.assertEqual(run.stdout, self.get("file"))

    def test_quiet_prints_nothing(self):
        run = self.succeed("remesh", "holed.obj", "-o", "out.obj", "--quiet", "-R", "16", "--epsilon",
                           "0.04")  # below one step: a warning, but for --quiet
        self.assertEqual(run.stdout, b"")
        run = self.succeed("check", "out.obj", "--quiet")
        self.assertEqual(run.stdout, b"")

    def test_warning_for_an_epsilon_below_one_step(self):
        run = self.run_program("remesh", "holed.obj", "-o", "out.obj", "-R", "16", "--epsilon", "0.04",
                               "--json", "r.json")
        self.assertEqual(run.returncode, 0)
        self.assertRegex(run.stderr.decode(), r"\Acellocut: warning: epsilon [^\n]*\n\Z")
        self.assertTrue(json.loads(self.get("r.json"))["parameters"]["epsilon_below_step"])

    def test_no_bar_and_no_stages_where_no_terminal_is(self):
        self.succeed("remesh", "holed.obj", "-o", "out.obj", *COARSE)  # standard error is empty

    def test_same_bytes_for_any_number_of_threads(self):
        self.put("two.obj", obj_text(join(HOLED_BOX, box((0.3, 0.2, 0.1), (1.4, 0.5, 0.9)))))
        for surface in (("union", "--fair", "--faces", "2000"), ("union", "--no-pull"), ("sdf",), ("cells",)):
            seen = set()
            for threads in ("1", "2", "8"):
                cells = ["--vtu", "out.vtu"] if HAS_VTU else []
                self.succeed("remesh", "two.obj", "-o", "out.obj", "--quiet", "--surface", *surface, "-R",
                             "32", "--threads", threads, *cells)
                seen.add((self.get("out.obj"), self.get("out.vtu") if HAS_VTU else b""))
            self.assertEqual(len(seen), 1, surface)

    def test_output_may_be_the_input(self):
        self.succeed("remesh", "holed.obj", "-o", "out.obj", "--quiet", *COARSE)
        self.succeed("remesh", "holed.obj", "-o", "holed.obj", "--quiet", *COARSE)
        self.assertEqual(self.get("holed.obj"), self.get("out.obj"))


class Report(ProgramCase):
    def remesh(self, *arguments):
        run = self.succeed("remesh", "holed.obj", "-o", "out.obj", *COARSE, "--json", "-", *arguments)
        return json.loads(run.stdout)  # the report and nothing but the report

    def test_keys(self):
        report = self.remesh()
        wanted = {
            (): "version input parameters stages peak_memory_bytes counts cut certificate output",
            ("input",): "path",
            ("counts",): "vertices cells facets nodes edges nodes_removed",
            ("cut",): "backend solver status value constant energy lower_bound gap build_seconds "
                      "solve_seconds area_bits area_quantum lambda_num lambda_den",
            ("certificate",): "valid checks",
            ("output",): "path valid triangles boundary_edges nonmanifold_edges nonmanifold_vertices "
                         "degenerate_faces intersecting_pairs components volume euler",
        }
        for place, keys in wanted.items():
            part = report
            for key in place:
                part = part[key]
            self.assertEqual(set(keys.split()) - set(part), set(), place)
        for stage in report["stages"]:
            self.assertEqual(set(stage), {"name", "seconds", "threads", "peak_memory_bytes"})
        peaks = [stage["peak_memory_bytes"] for stage in report["stages"]]
        self.assertEqual(peaks, sorted(peaks))
        self.assertLess(1e6, peaks[0])
        self.assertLessEqual(peaks[-1], report["peak_memory_bytes"])
        for component in report["output"]["components"]:
            self.assertEqual(set(component) & {"triangles", "volume"}, {"triangles", "volume"})

    def test_values(self):
        report = self.remesh("--lambda-fill", "5/2", "--threads", "1", "--solver", "push_relabel")
        self.assertEqual(report["input"]["path"], "holed.obj")
        self.assertEqual(report["output"]["path"], "out.obj")
        self.assertEqual(report["cut"]["solver"], "push_relabel")
        self.assertEqual((report["cut"]["lambda_num"], report["cut"]["lambda_den"]), (5, 2))
        self.assertEqual(report["cut"]["gap"], 0)
        self.assertEqual(report["cut"]["value"], report["cut"]["lower_bound"])
        # The box is one unit long, so relative and input units agree.
        self.assertAlmostEqual(report["cut"]["energy"],
                               report["cut"]["value"] * report["cut"]["area_quantum"] / 2, delta=1e-12)
        self.assertTrue(report["certificate"]["valid"])
        self.assertTrue(all(check["passed"] for check in report["certificate"]["checks"]))
        self.assertEqual({stage["threads"] for stage in report["stages"]}, {1})
        self.assertEqual([stage["name"] for stage in report["stages"]][0], "read")
        self.assertEqual([stage["name"] for stage in report["stages"]][-1], "write")

    def test_solvers_agree(self):
        values = {self.remesh("--solver", solver)["cut"]["value"] for solver in ("bk", "push_relabel")}
        self.assertEqual(len(values), 1)

    def test_check_of_the_file_agrees(self):
        for name in FORMATS:
            with self.subTest(name):
                file = "out." + name.split("-", maxsplit=1)[0]
                self.succeed("remesh", "holed.obj", "-o", file, "--output-format", name, "--quiet",
                             "--json", "r.json", *COARSE)
                told = json.loads(self.get("r.json"))["output"]
                self.assertEqual(told.pop("dropped_components"), 0)
                found = json.loads(self.succeed("check", file, "--json", "-").stdout)["output"]
                self.assertEqual(told, found)
                self.assertTrue(found["valid"])


class Check(ProgramCase):
    def test_valid(self):
        self.put("closed.obj", obj_text(box((0.0, 0.0, 0.0), (1.0, 2.0, 3.0))))
        run = self.succeed("check", "closed.obj", "--json", "r.json")
        self.assertRegex(run.stdout.decode(), r"\nvalid: closed, oriented, manifold, embedded\n\Z")
        output = json.loads(self.get("r.json"))["output"]
        self.assertEqual((output["triangles"], output["euler"], output["valid"]), (12, 2, True))
        self.assertEqual(output["components"], [{"triangles": 12, "volume": 6.0}])

    def check_invalid(self, mesh, **defects):
        self.put("bad.obj", obj_text(mesh))
        run = self.run_program("check", "bad.obj", "--json", "-")
        self.assertEqual((run.returncode, run.stderr), (4, b""))
        output = json.loads(run.stdout)["output"]
        self.assertFalse(output["valid"])
        for name, count in defects.items():
            self.assertEqual(output[name], count, name)

    def test_not_valid(self):
        self.check_invalid(HOLED_BOX, boundary_edges=3, intersecting_pairs=0)
        points, faces = box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
        self.check_invalid((points, faces + [faces[0]]), nonmanifold_edges=3, duplicate_faces=1)
        self.check_invalid((points, [faces[0][::-1]] + faces[1:]), misoriented_edges=3, boundary_edges=0)
        crossing = join((points, faces), box((0.5, 0.5, 0.5), (1.5, 1.5, 1.5)))
        self.check_invalid(crossing, boundary_edges=0, nonmanifold_edges=0)

    def test_standard_input(self):
        run = self.succeed("check", "-", "--format", "obj", input=obj_text(
            box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))).encode())
        self.assertIn(b"valid: closed", run.stdout)


class ListAndHelp(ProgramCase):
    def test_list_shows_every_variant(self):
        report = json.loads(self.succeed("list", "--json", "-").stdout)
        text = self.succeed("list").stdout.decode()
        for table, needed in (("backends", {"cgal", "tetgen"}), ("solvers", {"bk", "push_relabel"})):
            self.assertEqual(needed - {row["name"] for row in report[table]}, set())
            for row in report[table]:
                found = re.search(r"^  %s +(.*)\n(.*)" % row["name"], text, re.MULTILINE)
                self.assertIsNotNone(found, row["name"])
                if row["built"]:
                    self.assertIn(row["summary"], found.group(1))
                    self.assertIn("licence " + row["licence"] + "; " + row["reference"], found.group(2))
                    self.assertTrue(row["licence"] and row["reference"])
                else:
                    self.assertRegex(found.group(1), r"\Anot built: \S")

    def test_report_of_list_goes_to_a_file_too(self):
        self.put("list.json", OLD)
        run = self.succeed("list", "--json", "list.json")
        self.assertIn(b"minimum-cut solvers", run.stdout)
        self.assertEqual(set(json.loads(self.get("list.json"))), {"backends", "solvers", "report"})

    def test_help_and_version(self):
        self.assertRegex(self.succeed("--version").stdout.decode(), r"\A\d+\.\d+\.\d+\n\Z")
        names = re.findall(r"^  (\w+) ", self.succeed("--help").stdout.decode().split("Subcommands:")[1],
                           re.MULTILINE)
        self.assertEqual({"remesh", "check", "list"} - set(names), set())
        for name in names:
            text = self.succeed(name, "--help").stdout.decode()
            for option in ("--threads", "--quiet", "--verbose", "--json"):
                self.assertIn(option, text, name)
