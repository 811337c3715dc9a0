"""Robustness on forty real furniture models: every output closed, manifold and without an intersecting pair."""
import json
import os
import pathlib
import subprocess
import unittest

PROGRAM = os.environ["CELLOCUT_PROGRAM"]
WORKFLOW = os.environ["CELLOCUT_WORKFLOW"]
BUILD = pathlib.Path(os.environ["CELLOCUT_BUILD"])
COUNTS = ("boundary_edges", "nonmanifold_edges", "nonmanifold_vertices", "misoriented_edges", "degenerate_faces",
          "intersecting_pairs")


class Robustness(unittest.TestCase):
    def test_all_counts_are_zero(self):
        out = BUILD / "furniture"
        subprocess.run([PROGRAM, "bench", "robustness-40", "--workflow", WORKFLOW, "-o", out, "--quiet",
                        "--snakemake=--forceall"], check=True)
        results = json.loads((out / "results.json").read_text(encoding="utf-8"))["results"]
        self.assertEqual(len(results), 40)
        for result in results:
            with self.subTest(result["mesh"]):
                self.assertEqual(result["status"], "ok", result.get("reason"))
                self.assertTrue(result["check"]["valid"])
                self.assertEqual([result["check"][key] for key in COUNTS], [0] * len(COUNTS))


if __name__ == "__main__":
    unittest.main()
