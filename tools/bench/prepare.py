#!/usr/bin/env python3
"""What a mesh needs before any method runs: its virtual scan, or its damaged copy with the list of holes.

    prepare.py --suite SUITE --datasets DIR --bin DIR --kind scans|damaged --mesh NAME -o RESULT.json

A mesh that cannot be scanned or damaged is a result as well: the JSON says so, and no file stands beside it.
"""
import argparse
import pathlib
import sys
import tempfile

sys.dont_write_bytecode = True
from limited_run import run_limited  # pylint: disable=wrong-import-position
from run_case import last_line, read_json, write_json  # pylint: disable=wrong-import-position
from suite import Suite  # pylint: disable=wrong-import-position

SECONDS = 1200
MEMORY_BYTES = 8e9


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for option in ("--suite", "--datasets", "--bin", "--kind", "--mesh"):
        parser.add_argument(option, required=True)
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path)
    arguments = parser.parse_args()
    suite = Suite(arguments.suite, arguments.datasets)
    truth, seed = suite.meshes[arguments.mesh]
    target = arguments.output.with_suffix(".ply" if arguments.kind == "scans" else ".obj")
    target.parent.mkdir(parents=True, exist_ok=True)
    target.unlink(missing_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        report, log = pathlib.Path(scratch) / "report.json", pathlib.Path(scratch) / "log"
        command = [f"{arguments.bin}/cellocut"]
        if arguments.kind == "scans":
            command += ["scan", str(suite.truths[truth]), *suite.scan]
        else:
            command += ["damage", str(suite.truths[truth]), "--seed", str(seed),
                        *map(str, suite.damage.get("arguments", []))]
        command += ["-o", str(target), "--json", str(report), "--quiet", "--threads", "1"]
        ran = run_limited(command, SECONDS, MEMORY_BYTES, log)
        ran.update(mesh=arguments.mesh, report=read_json(report), reason=last_line(log))
        if ran["status"] == "done" and ran["exit_code"] != 0:
            ran["status"] = "failed"
        write_json(arguments.output, ran)


if __name__ == "__main__":
    main()
