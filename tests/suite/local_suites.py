"""Suites on the local cores: every way to end is counted, kills are survived, wrong suites are refused."""
import os
import signal
import sys
import time
import unittest

from suite_case import HOLED_BOX, OURS, WORKFLOW, SuiteCase, alive, children_of, descendants_of, wait_for

sys.path.insert(0, WORKFLOW)
import solids  # pylint: disable=wrong-import-position,wrong-import-order


class Outcomes(SuiteCase):
    def test_every_way_to_end_is_counted(self):
        (self.meshes / "torn.obj").write_text("v 0 0\nf 1 2\n", encoding="ascii")
        self.write_suite({
            "ours": [f"command: {OURS}", "unreadable: [3]"],
            "slow": ["command: sleep 60", "limits: {seconds: 0.5}"],
            "hungry": ["command: python3 -c \"import time; held = bytearray(300000000); time.sleep(60)\"",
                       "limits: {memory_gb: 0.1}"],
            "failing": ["command: \"sh -c 'echo it broke; exit 7'\""],
            "silent": ["command: 'true'"],
            "missing": ["command: no-such-program-here {input}"],
            "garbage": ["command: \"sh -c 'echo no mesh > {output}'\"", "output: obj"],
        })
        table = self.bench().stdout
        results = self.results()
        self.assertEqual(len(results), 7 * 3)
        status = {case: result["status"] for case, result in results.items()}
        for mesh in ("holed", "tetrahedron"):
            self.assertEqual(status["ours", mesh], "ok")
            self.assertTrue(results["ours", mesh]["check"]["valid"])
            self.assertEqual(results["ours", mesh]["report"]["parameters"]["resolution"], 16)
        self.assertEqual(status["ours", "torn"], "unreadable")
        for mesh in ("holed", "tetrahedron", "torn"):
            self.assertEqual(status["slow", mesh], "timeout")
            self.assertEqual(status["hungry", mesh], "memory")
            for method in ("failing", "silent", "missing", "garbage"):
                self.assertEqual(status[method, mesh], "failed")
        self.assertEqual(results["failing", "holed"]["exit_code"], 7)
        self.assertEqual(results["failing", "holed"]["reason"], "it broke")
        self.assertIn("output unreadable", results["garbage", "holed"]["reason"])
        # meshes, ok, failed, time-out, memory, unreadable, not run, not measured
        self.assertIn("| ours | 3 | 2 | 0 | 0 | 0 | 1 | 0 | 0 |", table)
        self.assertIn("| slow | 3 | 0 | 0 | 3 | 0 | 0 | 0 | 0 |", table)
        self.assertIn("| hungry | 3 | 0 | 0 | 0 | 3 | 0 | 0 | 0 |", table)
        self.assertIn("| garbage | 3 | 0 | 3 | 0 | 0 | 0 | 0 | 0 |", table)
        self.assertEqual((self.out / "results.csv").read_text(encoding="utf-8").count("\n"), 1 + 21)

    def test_measures_against_the_input_and_another_method(self):
        self.write_suite({
            "ours": [f"command: {OURS}"],
            "again": [f"command: {OURS}", "reference: {method: ours}"],
            "copy": ["command: cp {input} {output}", "output: obj", "reference: input"],
        }, head="measures: [evaluate]")
        self.bench()
        results = self.results()
        self.assertNotIn("evaluation", results["ours", "holed"])
        for method in ("again", "copy"):
            self.assertLess(results[method, "holed"]["evaluation"]["cd_p2s"], 1e-30)
        self.assertFalse(results["copy", "holed"]["check"]["valid"])
        self.assertGreater(results["copy", "holed"]["check"]["boundary_edges"], 0)

    def test_scan_and_damage(self):
        for mesh in self.meshes.iterdir():
            mesh.unlink()
        (self.meshes / "ball.obj").write_text(solids.obj_text(solids.ellipsoid((1.0, 0.8, 0.6), rows=24)), encoding="ascii")
        (self.meshes / "open.obj").write_text(HOLED_BOX, encoding="ascii")
        self.write_suite({"ours": [f"command: {OURS}"]}, head="reference: scan\nmeasures: [evaluate]")
        self.bench()
        against_scan = self.results()["ours", "ball"]["evaluation"]
        self.assertEqual(against_scan["reference"]["kind"], "points")
        self.assertLess(against_scan["hd"], 0.2)
        self.out = self.folder / "damaged"
        self.write_suite({"ours": [f"command: {OURS}"], "copy": ["command: cp {input} {output}", "output: obj"]},
                         head="damage: {seeds: [3]}\nreference: truth\nmeasures: [evaluate]\n"
                              "evaluate: [--volume-points, '10000']")
        self.bench()
        results = self.results()
        self.assertEqual(results["ours", "ball-seed3"]["status"], "ok")
        self.assertGreater(results["ours", "ball-seed3"]["evaluation"]["volume_iou"]["value"], 0.5)
        self.assertGreater(results["copy", "ball-seed3"]["check"]["boundary_edges"], 0)
        # A mesh that cannot be damaged stays in the table.
        self.assertEqual(results["ours", "open-seed3"]["status"], "unreadable")

    def test_a_changed_parameter_runs_again_and_nothing_else(self):
        self.write_suite({"gated": self.gated(), "other": ["command: cp {input} {output}", "output: obj"]})
        (self.folder / "go").touch()
        self.bench()
        self.write_suite({"gated": self.gated(), "other": ["command: cp -f {input} {output}", "output: obj"]})
        before = self.results()
        self.bench()
        after = self.results()
        self.assertEqual([self.starts("holed"), self.starts("tetrahedron")], [1, 1])
        self.assertEqual(before["gated", "holed"], after["gated", "holed"])
        self.assertGreater(after["other", "holed"]["started"], before["other", "holed"]["finished"])


class Kills(SuiteCase):
    def test_a_killed_job_is_run_again(self):
        marker = self.folder / "killed"
        self.write_suite({"once": [
            f"command: \"sh -c 'test -e {marker} || {{{{ touch {marker}; kill -9 $PPID; sleep 60; }}}};"
            " cp {input} {output}'\"", "output: obj"]})
        self.bench()
        self.assertTrue(marker.exists())
        self.assertEqual({result["status"] for result in self.results().values()}, {"ok"})

    def test_a_killed_engine_goes_on_where_it_was(self):
        self.write_suite({"gated": self.gated()})
        process = self.start("--threads", "1")
        wait_for((self.folder / "blocked").exists, "the second job")
        refused = self.bench(code=2)  # one run at a time in a folder
        self.assertIn("another run is at work here", refused.stderr)
        family = descendants_of(process.pid)
        self.kill_all(process)
        wait_for(lambda: not any(map(alive, family)), "the end of the jobs")
        self.assertEqual(len(list(self.out.glob("runs/gated/*.json"))), 1)
        self.assertFalse((self.out / "table.md").exists())
        (self.folder / "go").touch()
        self.bench()
        self.assertEqual({result["status"] for result in self.results().values()}, {"ok"})
        self.assertEqual(sorted([self.starts("holed"), self.starts("tetrahedron")]), [1, 2])

    def test_an_engine_that_stopped_with_tables_goes_on(self):
        go = self.folder / "go"
        self.write_suite({
            "gated": [f"command: \"sh -c 'test -e {go} || {{{{ kill -9 $PPID; sleep 60; }}}}; cp {{input}} {{output}}'\"",
                      "output: obj"],
            "copy": ["command: cp {input} {output}", "output: obj"]})
        self.bench(code=4)  # as often as the engine tries it
        self.assertIn("2 of 4 runs", (self.out / "table.md").read_text(encoding="utf-8"))
        go.touch()
        self.bench()
        self.assertEqual({result["status"] for result in self.results().values()}, {"ok"})
        self.assertIn("4 of 4 runs", (self.out / "table.md").read_text(encoding="utf-8"))

    def test_interruption_ends_the_jobs(self):
        self.write_suite({"gated": self.gated()})
        process = self.start("--threads", "1")
        wait_for((self.folder / "blocked").exists, "the second job")
        family = descendants_of(process.pid)
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=60), 130)
        wait_for(lambda: not any(map(alive, family)), "the end of the jobs")

    def test_a_killed_front_ends_the_engine(self):
        self.write_suite({"gated": self.gated()})
        process = self.start("--threads", "1")
        wait_for((self.folder / "blocked").exists, "the second job")
        engine = children_of(process.pid)[0]
        self.addCleanup(lambda: alive(engine) and os.killpg(engine, signal.SIGKILL))
        process.kill()
        process.wait()
        (self.folder / "go").touch()  # the job at work may end
        wait_for(lambda: not alive(engine), "the end of the engine")


class WrongUse(SuiteCase):
    def test_no_engine(self):
        self.write_suite({"ours": [f"command: {OURS}"]})
        run = self.bench(code=2, env={**os.environ, "PATH": str(self.folder)})
        self.assertRegex(run.stderr, r"\Acellocut: bench needs the program snakemake[^\n]*tools/setup bench[^\n]*\n\Z")

    def test_no_suite(self):
        self.assertIn("no suite", self.bench(code=2).stderr)

    def test_wrong_suites(self):
        for head, said in (("measure: [check]", "unknown key 'measure'"), ("measures: [taste]", "measures are"),
                           ("reference: scam", "is none of"), ("limits: {seconds: 1, memory: 2}", "unknown key 'memory'"),
                           ("reference: truth", "needs 'damage'"), ("reference: {method: nobody}", "no method 'nobody'")):
            with self.subTest(head):
                self.write_suite({"ours": [f"command: {OURS}"]}, head=head)
                self.assertIn(said, self.bench(code=3).stderr)

    def test_a_list_with_a_mesh_that_is_not_there(self):
        self.write_suite({"ours": [f"command: {OURS}"]})
        text = (self.folder / "tiny.yaml").read_text(encoding="utf-8")
        (self.folder / "tiny.yaml").write_text(text.replace("meshes/*}", "meshes/*, list: names.txt}"), encoding="utf-8")
        (self.folder / "names.txt").write_text("holed\nmissing\n", encoding="utf-8")
        self.assertIn("no mesh 'missing'", self.bench(code=3).stderr)

    def test_dry_run_runs_nothing(self):
        self.write_suite({"gated": self.gated()})
        self.bench("--dry-run")
        self.assertEqual(self.starts("holed"), 0)


if __name__ == "__main__":
    unittest.main()
