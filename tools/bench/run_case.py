#!/usr/bin/env python3
"""One mesh, one method: runs it, measures its surface, writes one JSON. What fails is a result too.

    run_case.py --suite SUITE --datasets DIR --bin DIR --method NAME --mesh NAME -o RESULT.json

The exit code is 0 whatever the method did; it is another only where this program itself could not work, so that
the engine tries again. Paths of the results are relative to the working folder, the suite's output folder.
"""
import argparse
import hashlib
import json
import os
import pathlib
import shutil
import signal
import sys
import tempfile
import time

sys.dont_write_bytecode = True
import datasets  # pylint: disable=wrong-import-position
from limited_run import run_limited  # pylint: disable=wrong-import-position
from suite import Suite  # pylint: disable=wrong-import-position

LOG_TAIL = 300  # characters of the last line that is kept


def last_line(path):
    """The last line that a program said, without the names of folders."""
    text = path.read_text(encoding="utf-8", errors="replace") if path.is_file() else ""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return " ".join(pathlib.PurePosixPath(piece).name if piece.startswith("/") else piece
                    for piece in (lines[-1] if lines else "").split())[:LOG_TAIL]


def read_json(path):
    """A report, or nothing where it is missing or torn."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def write_json(path, content):
    """All or nothing: a killed job leaves no half result."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile("w", dir=path.parent, prefix=".", delete=False, encoding="utf-8") as file:
        json.dump(content, file, indent=1)
        file.write("\n")
    os.replace(file.name, path)


def program_digest(arguments):
    """Of the program that ran: results of two builds are not one table."""
    found = shutil.which(arguments[0])
    return datasets.digest(found) if found else None


class Case:
    """A mesh and a method of a suite, with the folders that its run may use."""

    def __init__(self, suite, method, mesh, binaries, scratch):
        self.suite, self.method, self.mesh = suite, method, mesh
        self.binaries, self.scratch = pathlib.Path(binaries), pathlib.Path(scratch)
        truth, seed = suite.meshes[mesh]
        self.truth = suite.truths[truth]
        self.input = self.truth if seed is None else pathlib.Path("damaged") / f"{mesh}.obj"
        self.output = self.scratch / f"output.{method.ending}"
        self.report = self.scratch / "report.json"

    def cellocut(self, *arguments):
        return [str(self.binaries / "cellocut"), *map(str, arguments)]

    def reference(self):
        """The reference's file, or None; and why there is none."""
        kind = self.method.reference
        if isinstance(kind, dict):
            path = surface_path(self.suite.methods[kind["method"]], self.mesh)
            return (path, "") if path.is_file() else (None, f"no surface of {kind['method']}")
        if kind == "scan":
            path = pathlib.Path("scans") / f"{self.mesh}.ply"
            return (path, "") if path.is_file() else (None, "no scan")
        return {"none": (None, ""), "input": (self.input, ""), "truth": (self.truth, "")}[kind]

    def run(self):
        """How the method ended, and its surface in self.output if it made one."""
        places = {"input": str(self.input.resolve()), "output": str(self.output), "report": str(self.report),
                  "scratch": str(self.scratch), "bin": str(self.binaries)}
        arguments = self.method.arguments(**places)
        log = self.scratch / "log"
        ran = run_limited(arguments, self.method.seconds, self.method.memory_gb * 1e9, log, cwd=self.scratch)
        if self.method.output:
            self.output = pathlib.Path(self.method.output.format(**places))
        taken = ("exit_code", "seconds", "cpu_seconds", "peak_memory_bytes")
        result = {"status": ran["status"], "reason": "", **{key: ran[key] for key in taken},
                  "program_sha256": program_digest(arguments)}
        if ran["status"] == "done":
            result["status"], result["reason"] = self.judge(ran["exit_code"], last_line(log))
        elif ran["status"] == "missing":
            result["status"], result["reason"] = "failed", last_line(log)
        report = read_json(self.report)
        if report:
            result["report"] = {key: report[key] for key in
                                ("version", "parameters", "stages", "counts", "cut", "output") if key in report}
            trim_components(result["report"].get("output"))
        return result

    def judge(self, exit_code, said):
        """Status and reason of a run that ended by itself."""
        if exit_code in self.method.unreadable:
            return "unreadable", said
        if exit_code != 0:
            return "failed", said or f"exit code {exit_code}"
        if not self.output.is_file() or self.output.stat().st_size == 0:
            return "failed", "no output file"
        return "ok", ""

    def measure(self, result):
        """Adds what `cellocut check` and `cellocut evaluate` say of the surface."""
        reference, missing = self.reference() if "evaluate" in self.suite.measures else (None, "")
        if missing:
            result["measure_error"] = missing
        found = self.scratch / "measures.json"
        if reference is None:
            command = self.cellocut("check", self.output)
        else:
            command = self.cellocut("evaluate", self.output, "--reference", reference.resolve(), *self.method.evaluate)
        command += ["--json", str(found), "--quiet", "--threads", str(self.method.threads)]
        log = self.scratch / "measure.log"
        ran = run_limited(command, self.method.evaluate_seconds, self.method.memory_gb * 1e9, log)
        measures = read_json(found)
        if measures is None:
            if ran["status"] == "done" and ran["exit_code"] == 3:
                result["status"], result["reason"] = "failed", f"output unreadable: {last_line(log)}"
            else:
                result["measure_error"] = f"{ran['status']}: {last_line(log)}"
            return
        if reference is not None:
            result["evaluation"] = measures["meshes"][0]
            result["evaluation"]["reference"] = {key: value for key, value in measures["reference"].items()
                                                 if key != "path"}
            result["evaluation"].pop("path", None)
            result["check"] = result["evaluation"].pop("output", None)
        else:
            result["check"] = measures["output"]
        trim_components(result["check"])


def trim_components(output):
    """The number of components in place of the list of them, and no path."""
    if output and isinstance(output.get("components"), list):
        output["components"] = len(output["components"])
        output.pop("path", None)


def surface_path(method, mesh):
    return pathlib.Path("surfaces") / method.name / f"{mesh}.{method.ending}"


def run_case(case):
    """The whole result of a case."""
    started = time.time()
    result = {"suite": case.suite.name, "mesh": case.mesh, "method": case.method.name, "label": case.method.label,
              "parameters": {key: label for key, (label, _) in case.method.values.items()},
              "limits": {"seconds": case.method.seconds, "memory_gb": case.method.memory_gb},
              "threads": case.method.threads}
    if case.input.is_file():
        result["input_sha256"] = datasets.digest(case.input)
        result.update(case.run())
    else:
        result.update(status="unreadable", reason="there is no input", exit_code=None, seconds=0.0,
                      cpu_seconds=0.0, peak_memory_bytes=0)
    if result["status"] == "ok":
        case.measure(result)
    if result["status"] == "ok":
        result["output_sha256"] = hashlib.sha256(case.output.read_bytes()).hexdigest()
        if case.method.name in case.suite.kept():
            kept = surface_path(case.method, case.mesh)
            kept.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(case.output, str(kept) + ".new")
            os.replace(str(kept) + ".new", kept)
    result.update(started=started, finished=time.time())
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for option in ("--suite", "--datasets", "--bin", "--method", "--mesh"):
        parser.add_argument(option, required=True)
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path)
    arguments = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # ends the method too
    suite = Suite(arguments.suite, arguments.datasets)
    scratch_root = pathlib.Path("scratch").resolve()
    scratch_root.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=scratch_root) as scratch:
        case = Case(suite, suite.methods[arguments.method], arguments.mesh, arguments.bin, scratch)
        write_json(arguments.output, run_case(case))


if __name__ == "__main__":
    main()
