"""Cut problems as files: written by remesh, solved by solve, compared by compare."""

import csv
import json
import os
import unittest

from program import COARSE, HAS_VTU, OLD, ProgramCase

# Source 1, sink 6; maximum flow 5: 1-2-4-6 carries 3, 1-3-5-6 carries 2.
SMALL = """c a small network
p max 6 7
n 1 s
n 6 t
a 1 2 5
a 1 3 2
a 2 4 3
a 3 5 9
a 4 6 4
a 5 6 2
a 3 2 1
"""
SMALL_VALUE = 5
EXACT = ("bk", "bk_blocks", "push_relabel", "push_relabel_highest", "ibfs")


class Solve(ProgramCase):
    def report(self):
        return json.loads(self.get("r.json"))

    def test_known_answer_with_every_solver_of_ours(self):
        self.put("small.max", SMALL)
        for solver in EXACT:
            with self.subTest(solver):
                self.succeed("solve", "small.max", "--solver", solver, "--json", "r.json", "--quiet")
                cut = self.report()["cut"]
                self.assertEqual((cut["value"], cut["lower_bound"], cut["gap"]), (SMALL_VALUE, SMALL_VALUE, 0))
                self.assertEqual(cut["status"], "optimal")

    def test_a_reduced_problem_has_the_same_answer_and_says_what_was_removed(self):
        self.put("small.max", SMALL)
        self.succeed("solve", "small.max", "--json", "r.json", "--quiet")
        plain = self.report()["cut"]
        self.succeed("solve", "small.max", "--reduce", "--sol", "out.sol", "--json", "r.json", "--quiet")
        reduced = self.report()["cut"]
        for field in ("value", "lower_bound", "status", "source_side_smallest", "source_side_largest"):
            self.assertEqual(reduced[field], plain[field])
        self.assertNotIn("reduced_dominated", plain["counters"])
        counters = reduced["counters"]
        removed = sum(counters["reduced_" + rule] for rule in ("unreachable", "dominated", "heavy_edges", "isolated"))
        self.assertGreater(removed, 0)
        self.succeed("solve", "small.max", "--check", "out.sol", "--quiet")

    def test_the_solution_is_a_maximum_flow_and_another_is_told_from_it(self):
        self.put("small.max", SMALL)
        self.succeed("solve", "small.max", "--sol", "out.sol", "--quiet")
        lines = self.get("out.sol").decode().split("\n")
        self.assertIn(f"s {SMALL_VALUE}", lines)
        self.succeed("solve", "small.max", "--check", "out.sol", "--quiet")
        # A flow that is not maximum, one that does not balance, one above its capacity.
        for name, flows, what in (
                ("less.sol", "s 2\nf 1 3 2\nf 3 5 2\nf 5 6 2\n", "minimum cut is 5"),
                ("stuck.sol", "s 2\nf 1 3 2\nf 3 5 2\nf 5 6 1\n", "not a flow"),
                ("above.sol", "s 3\nf 1 3 3\nf 3 5 3\nf 5 6 3\n", "not a flow")):
            with self.subTest(name):
                self.put(name, flows)
                run = self.run_program("solve", "small.max", "--check", name, "--quiet")
                self.assert_one_line(run, 5, what)

    def test_the_relaxation_with_and_without_a_flow(self):
        self.put("small.max", SMALL)
        self.succeed("solve", "small.max", "--solver", "lp", "--sol", "out.sol", "--json", "r.json", "--quiet")
        cut = self.report()["cut"]
        self.assertEqual((cut["value"], cut["status"], cut["canonical"]), (SMALL_VALUE, "optimal", True))
        self.succeed("solve", "small.max", "--check", "out.sol", "--quiet")
        self.succeed("solve", "small.max", "--solver", "lp", "--no-crossover", "--json", "r.json", "--quiet")
        cut = self.report()["cut"]
        self.assertEqual((cut["value"], cut["status"], cut["stop"]), (SMALL_VALUE, "optimal", "proof"))
        self.assertFalse(cut["canonical"])
        run = self.succeed("solve", "small.max", "--solver", "lp", "--no-crossover")
        self.assertIn(b"stopped at: proof", run.stdout)

    def test_a_relaxation_that_stops_early_tells_its_gap(self):
        self.succeed("remesh", "holed.obj", "-o", "out.obj", "--problem", "cut.max", "--quiet", *COARSE)
        self.succeed("solve", "cut.max", "--json", "r.json", "--quiet")
        exact = self.report()["cut"]["value"]
        self.succeed("solve", "cut.max", "--solver", "lp", "--no-crossover", "--lp-iterations", "1",
                     "--json", "r.json", "--quiet")
        cut = self.report()["cut"]
        self.assertLessEqual(cut["lower_bound"], exact)
        self.assertGreaterEqual(cut["value"], exact)
        if cut["gap"] > 0:
            self.assertEqual((cut["status"], cut["stop"]), ("gap", "iteration limit"))

    def test_wrong_limits_of_the_relaxation(self):
        self.put("small.max", SMALL)
        for option, value, what in (("--lp-gap", "-1", "gap"), ("--lp-gap", "nan", "gap"),
                                    ("--lp-time", "-1", "time limit"), ("--lp-iterations", "0", "iteration")):
            with self.subTest(option):
                self.fail_with(2, what, "solve", "small.max", "--solver", "lp", option, value, outputs=())
        self.fail_with(2, "--sol: without a crossover", "solve", "small.max", "--solver", "lp",
                       "--no-crossover", "--sol", "out.sol", outputs=("out.sol",))

    def test_statistics(self):
        self.put("small.max", SMALL)
        self.succeed("solve", "small.max", "--statistics", "--json", "r.json", "--quiet")
        statistics = self.report()["statistics"]
        self.assertEqual((statistics["nodes"], statistics["edges"]), (4, 3))
        self.assertEqual(statistics["source_nodes"], 2)
        self.assertEqual(statistics["components"], 1)

    def test_conversion_keeps_the_value(self):
        self.put("small.max", SMALL)
        self.succeed("solve", "small.max", "--problem", "small.bbk", "--quiet")
        self.assertEqual(self.get("small.bbk")[:3], b"BBQ")
        self.succeed("solve", "small.bbk", "--json", "r.json", "--quiet")
        self.assertEqual(self.report()["cut"]["value"], SMALL_VALUE)

    def test_standard_input(self):
        run = self.run_program("solve", "-", "--format", "max", "--quiet", "--json", "-",
                               input=SMALL.encode())
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(json.loads(run.stdout)["cut"]["value"], SMALL_VALUE)

    def test_malformed_files_are_named_with_their_line(self):
        for name, content, what in (
                ("negative.max", SMALL.replace("a 3 5 9", "a 3 5 -9"), "line 8"),
                ("range.max", SMALL.replace("a 3 5 9", "a 3 7 9"), "line 8"),
                ("same.max", SMALL.replace("n 6 t", "n 1 t"), "line 4"),
                ("short.max", SMALL.replace("p max 6 7", "p max 6 9"), "line"),
                ("huge.max", SMALL.replace("a 3 5 9", "a 3 5 9223372036854775808"), "line 8"),
                ("sum.max", SMALL.replace("a 3 5 9", "a 3 5 4611686018427387904"), "sum"),
                ("words.max", "hello\n", "line 1"),
                ("empty.max", "", "empty"),
                ("cut.bbk", b"BBQ\x07\x07" + bytes(10), "")):
            with self.subTest(name):
                self.put(name, content)
                self.fail_with(3, r"\Acellocut: " + name.replace(".", r"\.") + r": .*" + what, "solve", name,
                               "--sol", "out.sol", outputs=("out.sol",))

    def test_wrong_usage(self):
        self.put("small.max", SMALL)
        self.fail_with(2, "unknown solver 'nothing'; built: ", "solve", "small.max", "--solver", "nothing",
                       outputs=())
        self.put("small.txt", SMALL)
        self.fail_with(2, "--format", "solve", "small.txt", outputs=())
        self.fail_with(2, r"out\.txt: use \.max or \.bbk", "solve", "small.max", "--problem", "out.txt",
                       outputs=())


class Compare(ProgramCase):
    def test_nothing_is_solved_within_the_limit(self):
        """Nothing is solved: no energies to compare, none in the cells, and the code of a limit."""
        run = self.run_program("compare", "holed.obj", "-o", "none", *COARSE, "--time-limit", "1e-9")
        self.assertEqual(run.returncode, 6)
        self.assertRegex(run.stderr.decode(), r"\Acellocut: holed\.obj: no solver solved it \(.*\)\n\Z")
        self.assertNotIn(b"nan", run.stdout)
        for pair in json.loads(self.get("none/compare.json"))["backends"]:
            self.assertIsNone(pair["energy_difference"])
        if HAS_VTU:
            self.assertNotIn(b"cut_value", self.get("none/holed_cgal.vtu"))

    def test_a_mesh_and_a_problem_on_everything_that_is_built(self):
        self.put("small.max", SMALL)
        run = self.succeed("compare", "holed.obj", "small.max", "-o", "out", "--repeat", "2", *COARSE,
                           "--write-problems")
        self.assertIn(b"geometric mean", run.stdout)
        listed = json.loads(self.succeed("list", "--json", "-").stdout)
        solvers = [row["name"] for row in listed["solvers"] if row["built"]]
        backends = [row["name"] for row in listed["backends"] if row["built"]]
        with open(self.path("out/compare.csv"), encoding="ascii", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(solvers) * (len(backends) + 1))
        for row in rows:
            self.assertEqual(row["status"], "optimal")
            self.assertEqual(row["number_of_runs"], "2")
            self.assertLessEqual(float(row["solve_time_min"]), float(row["solve_time"]))
            self.assertLessEqual(float(row["solve_time"]), float(row["solve_time_max"]))
        small = [row for row in rows if row["file_name"] == "small.max"]
        self.assertEqual({row["maxflow"] for row in small}, {str(SMALL_VALUE)})
        for backend in backends:
            values = {row["maxflow"] for row in rows if row["backend"] == backend}
            self.assertEqual(len(values), 1, backend)
        report = json.loads(self.get("out/compare.json"))
        self.assertEqual(len(report["instances"]), len(backends) + 1)
        self.assertEqual({instance["defect"] for instance in report["instances"]}, {""})
        if len(backends) > 1:
            self.assertLess(report["backends"][0]["energy_difference"], 1e-3)
        for backend in backends:
            for ending in (".max", ".bbk") + ((".vtu",) if HAS_VTU else ()):
                self.assertGreater(os.path.getsize(self.path(f"out/holed_{backend}{ending}")), 0)

    def test_what_was_written_gives_the_same_value_again(self):
        self.succeed("remesh", "holed.obj", "-o", "out.obj", "--problem", "cut.max", "--json", "r.json",
                     "--quiet", *COARSE)
        cut = json.loads(self.get("r.json"))["cut"]
        for solver in EXACT:
            self.succeed("solve", "cut.max", "--solver", solver, "--json", "s.json", "--quiet")
            again = json.loads(self.get("s.json"))["cut"]
            self.assertEqual((again["value"], again["constant"]), (cut["value"], cut["constant"]))
        self.succeed("solve", "cut.max", "--problem", "cut.bbk", "--quiet")
        self.succeed("solve", "cut.bbk", "--json", "s.json", "--quiet")
        self.assertEqual(json.loads(self.get("s.json"))["cut"]["value"], cut["value"])

    def test_what_cannot_be_read_is_found_first(self):
        self.put("empty.obj", "")
        run = self.run_program("compare", "holed.obj", "empty.obj", "-o", "out", "--repeat", "1", "--quiet", *COARSE)
        self.assert_one_line(run, 3, r"\Acellocut: empty\.obj: ")
        self.assertEqual(os.listdir(self.path("out")), [])

    def test_a_relaxation_beside_an_exact_solver(self):
        self.put("small.max", SMALL)
        self.succeed("compare", "small.max", "holed.obj", "-o", "out", "--solvers", "bk,lp", "--no-crossover",
                     "--backends", "cgal", "--repeat", "1", "--quiet", *COARSE)
        for instance in json.loads(self.get("out/compare.json"))["instances"]:
            self.assertEqual(instance["defect"], "")
            exact, relaxed = instance["runs"]
            self.assertTrue(exact["canonical"])
            self.assertFalse(relaxed["canonical"])
            self.assertLessEqual(relaxed["lower_bound"], exact["value"])
            self.assertGreaterEqual(relaxed["value"], exact["value"])

    def test_a_remesh_by_the_relaxation_has_its_certificate(self):
        self.succeed("remesh", "holed.obj", "-o", "first.obj", "--quiet", *COARSE)
        self.succeed("remesh", "holed.obj", "-o", "second.obj", "--solver", "lp", "--json", "r.json", "--quiet",
                     *COARSE)
        report = json.loads(self.get("r.json"))
        self.assertTrue(report["certificate"]["valid"])
        self.assertEqual(report["cut"]["status"], "optimal")
        self.assertEqual(self.get("first.obj"), self.get("second.obj"))

    def test_a_chosen_few(self):
        self.put("small.max", SMALL)
        self.succeed("compare", "small.max", "-o", "out", "--solvers", "bk,ibfs", "--repeat", "1", "--quiet")
        runs = json.loads(self.get("out/compare.json"))["instances"][0]["runs"]
        self.assertEqual([run["solver"] for run in runs], ["bk", "ibfs"])
        run = self.run_program("compare", "small.max", "-o", "out", "--solvers", "bk,nothing")
        self.assert_one_line(run, 2, "unknown solver 'nothing'")

    def test_a_solver_that_cannot_hold_the_numbers_refuses_and_the_others_go_on(self):
        self.put("large.max", SMALL.replace("a 3 5 9", f"a 3 5 {2**60}"))
        self.succeed("compare", "large.max", "-o", "out", "--repeat", "1", "--quiet")
        runs = json.loads(self.get("out/compare.json"))["instances"][0]["runs"]
        by_name = {run["solver"]: run for run in runs}
        self.assertEqual(by_name["bk"]["value"], SMALL_VALUE)
        if "libmaxflow" in by_name:
            self.assertEqual(by_name["libmaxflow"]["status"], "refused")

    def test_a_bad_file_loses_nothing(self):
        self.put("bad.max", "p max 2\n")
        os.mkdir(self.path("out"))
        self.put("out/compare.csv", OLD)
        run = self.run_program("compare", "bad.max", "-o", "out")
        self.assert_one_line(run, 3, r"bad\.max: line 1")
        self.assertEqual(self.get("out/compare.csv"), OLD)


if __name__ == "__main__":
    unittest.main()
