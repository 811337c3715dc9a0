#!/usr/bin/env python3
"""The results of a suite as results.csv, results.json, table.md in the paper's shape, and SVG plots.

    tables.py --suite SUITE --datasets DIR       in the suite's output folder

Every mesh of the suite is in every denominator: failures, time-outs, runs out of memory and unreadable inputs are
counted apart, and what was not run is said.
"""
import argparse
import csv
import json
import pathlib
import statistics
import subprocess
import sys

sys.dont_write_bytecode = True
import plots  # pylint: disable=wrong-import-position
from run_case import read_json, write_json  # pylint: disable=wrong-import-position
from suite import Suite  # pylint: disable=wrong-import-position

STATUSES = ("ok", "failed", "timeout", "memory", "unreadable", "not run")
CHECKS = ("boundary_edges", "nonmanifold_edges", "nonmanifold_vertices", "misoriented_edges", "degenerate_faces",
          "intersecting_pairs")
GIGABYTE = 1e9


# ---- rows ---------------------------------------------------------------------------------------------------

def f1_at(evaluation, threshold):
    for entry in evaluation.get("f1", []):
        if abs(entry["threshold"] - threshold) < 1e-12:
            return entry["f1"]
    return None


def volume_ratio(overlap):
    """The solid's volume over that of the truth, both counted by the same random points."""
    return overlap["in_mesh"] / overlap["in_reference"] if overlap.get("in_reference") else None


def row_of(result):
    """The flat row of one result: what the CSV holds and the tables read."""
    check = result.get("check") or {}
    evaluation = result.get("evaluation") or {}
    overlap = evaluation.get("volume_iou") or {}
    unit = (evaluation.get("reference") or {}).get("unit")
    volume = check.get("volume")
    row = {"mesh": result["mesh"], "method": result["method"], "status": result["status"],
           "exit_code": result.get("exit_code"), "reason": result.get("reason", ""),
           "seconds": result.get("seconds"), "cpu_seconds": result.get("cpu_seconds"),
           "peak_memory_gb": (result.get("peak_memory_bytes") or 0) / GIGABYTE,
           "valid": check.get("valid"), "triangles": check.get("triangles"), "components": check.get("components"),
           "volume": volume}
    row.update({key: check.get(key) for key in CHECKS})
    row.update({"cd": evaluation.get("cd"), "hd": evaluation.get("hd"), "anc": evaluation.get("anc"),
                "cd_p2s": evaluation.get("cd_p2s"), "hd_p2s": evaluation.get("hd_p2s"),
                "anc_p2s": evaluation.get("anc_p2s"),
                "f1_0.01": f1_at(evaluation, 0.01), "f1_0.002": f1_at(evaluation, 0.002),
                "volume_relative": volume / unit ** 3 if volume is not None and unit else None,
                "iou": overlap.get("value"), "volume_ratio": volume_ratio(overlap)})
    images = (evaluation.get("images") or {}).get("mean") or {}
    row.update({f"image_{key}": value for key, value in images.items() if isinstance(value, (int, float))})
    row["measured"] = bool(check)
    row["measure_error"] = result.get("measure_error", "")
    return row


def load(suite):
    """Results and rows of every case, those that are not there as `not run`."""
    results = {}
    for method in suite.methods:
        for mesh in suite.meshes:
            found = read_json(pathlib.Path("runs") / method / f"{mesh}.json")
            results[method, mesh] = found or {"mesh": mesh, "method": method, "status": "not run"}
    return results, {case: row_of(result) for case, result in results.items()}


def numbers(rows, key):
    return [row[key] for row in rows if row.get(key) is not None]


def mean(rows, key):
    found = numbers(rows, key)
    return statistics.fmean(found) if found else None


def median(rows, key):
    found = numbers(rows, key)
    return statistics.median(found) if found else None


def largest(rows, key):
    return max(numbers(rows, key), default=None)


def shapes_with(rows, key):
    """The number of shapes with one defect or more of a kind: what the paper counts."""
    return sum(1 for row in rows if row.get(key))


# ---- Markdown -----------------------------------------------------------------------------------------------

def show(value, digits=4):
    if value is None:
        return "-"
    if isinstance(value, float):
        return f"{value:.{digits}g}"
    return str(value)


def markdown(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows]) + "\n"


def outcome_columns(rows):
    """How many of all meshes ended how."""
    counts = [sum(row["status"] == status for row in rows) for status in STATUSES]
    unmeasured = sum(row["status"] == "ok" and not row["measured"] for row in rows)
    return [len(rows), *counts, unmeasured]


OUTCOMES = ["meshes", "ok", "failed", "time-out", "memory", "unreadable", "not run", "not measured"]


class Tables:
    """The Markdown tables of a suite."""

    def __init__(self, suite, results, rows):
        self.suite, self.results, self.rows = suite, results, rows

    def of(self, method):
        return [self.rows[method, mesh] for mesh in self.suite.meshes]

    def each(self, columns, methods=None):
        """A row for each method: its label and what `columns` says of its rows."""
        return [[self.label(name), *columns(self.of(name))] for name in (methods or self.suite.methods)]

    def label(self, name):
        method = self.suite.methods[name]
        values = ", ".join(f"{key} {label}" for key, (label, _) in method.values.items())
        return f"{method.label} {values}".strip() if values else method.label

    def outcomes(self):
        return markdown(["Method", *OUTCOMES], self.each(outcome_columns))

    def cost(self):
        def columns(rows):
            # A run that was stopped took its limit: leaving it out would reward time-outs.
            ran = [row for row in rows if row["status"] in ("ok", "failed", "timeout", "memory")]
            return [show(value, 3) for value in (median(ran, "seconds"), mean(ran, "seconds"), largest(ran, "seconds"),
                                                 median(ran, "cpu_seconds"), largest(ran, "cpu_seconds"),
                                                 median(ran, "peak_memory_gb"), largest(ran, "peak_memory_gb"))]
        return markdown(["Method", "seconds, median", "mean", "worst", "CPU seconds, median", "worst",
                         "memory in GB, median", "worst"], self.each(columns))

    def robustness(self):
        def columns(rows):
            lost = sum(row["status"] in ("failed", "timeout", "memory") for row in rows)
            return [*(shapes_with(rows, key) for key in CHECKS), lost, sum(bool(row["valid"]) for row in rows)]
        text = markdown(["Methods", "Boundary", "NM Edges", "NM Vertices", "Misoriented", "Degenerate", "Intersecting",
                         "Failure", "valid"], self.each(columns))
        return text + "\nShapes with one or more of each; Failure is failed, time-out or memory.\n"

    def agreement(self, keep=None):
        """The measures of the paper as means over the meshes that each method has a measure for."""
        heads = ["Methods", "Failure", "measured", "CD", "HD", "ANC", "F1@0.01", "F1@0.002", "volume"]
        keys = ["cd", "hd", "anc", "f1_0.01", "f1_0.002", "volume_relative"]
        everything = list(self.rows.values())
        if numbers(everything, "iou"):
            heads.append("volume IoU")
            keys.append("iou")
        for key in sorted({key for row in everything for key in row if key.startswith("image_")}):
            heads.append(key[len("image_"):])
            keys.append(key)

        def columns(rows):
            kept = [row for row in rows if keep is None or row["mesh"] in keep]
            lost = sum(row["status"] in ("failed", "timeout", "memory") for row in kept)
            return [lost, len(numbers(kept, "cd")), *(show(mean(kept, key)) for key in keys)]
        return markdown(heads, self.each(columns, self.compared()))

    def compared(self):
        """The methods that have a reference."""
        return [name for name, method in self.suite.methods.items() if method.reference != "none"]

    def fidelity(self):
        common = {mesh for mesh in self.suite.meshes
                  if all(self.rows[name, mesh]["cd"] is not None for name in self.compared())}
        text = self.agreement()
        text += ("\nMeans over what was measured; lengths relative to the longest edge of the reference's box, volume to "
                 "its cube.\n")
        if common and len(common) < len(self.suite.meshes):
            text += f"\nOver the {len(common)} meshes that every method has a measure for:\n\n" + self.agreement(common)
        return text

    def completion(self):
        return self.fidelity() + "\n" + self.losses()

    def losses(self, margin=0.0):
        """Meshes where another method has the better volume IoU (or CD, where there is none) than the first, by more
        than the margin."""
        first, *others = self.compared()
        key = "iou" if numbers(self.rows.values(), "iou") else "cd"
        sign = 1 if key == "iou" else -1
        lines = []
        for mesh in self.suite.meshes:
            if self.rows[first, mesh]["status"] == "not run":
                continue
            ours = self.rows[first, mesh].get(key)
            for other in others:
                theirs = self.rows[other, mesh].get(key)
                if theirs is not None and (ours is None or sign * (theirs - ours) > margin):
                    lines.append([mesh, self.label(other), show(ours), show(theirs)])
        if not lines:
            return f"No mesh where another method has a better {key} than {self.label(first)}.\n"
        return f"Where {self.label(first)} loses, by {key}:\n\n" + markdown(["Mesh", "to", "ours", "theirs"], lines)

    def filling(self):
        """How often the right parts are solid. What has no measure counts as an IoU of 0."""
        def columns(rows):
            ious = sorted(row["iou"] or 0.0 for row in rows if row["status"] != "not run")
            if not ious:
                return [0, *["-"] * 5]
            right = sum(row["volume_ratio"] is not None and abs(row["volume_ratio"] - 1) <= 0.02 for row in rows)
            worst = ious[:max(1, len(ious) // 10)]
            return [len(ious), show(statistics.median(ious)), show(statistics.fmean(ious)),
                    show(statistics.fmean(worst)), show(ious[0]), f"{100 * right / len(ious):.0f} %"]
        return (markdown(["Method", "models", "volume IoU, median", "mean", "mean of the worst tenth", "worst",
                          "within 2 % of the true volume"], self.each(columns))
                + "\nOnly where the difference is above 0.01:\n\n" + self.losses(0.01))

    def sensitivity(self):
        return self.fidelity()

    def ablation(self):
        def columns(rows):
            empty = sum("no cell is interior" in row["reason"] for row in rows)
            return [empty, *(show(mean(rows, key)) for key in ("cd", "hd", "anc", "f1_0.01", "f1_0.002")),
                    show(mean(rows, "components"))]
        return markdown(["Variant", "empty solids", "CD", "HD", "ANC", "F1@0.01", "F1@0.002", "components"],
                        self.each(columns, self.compared()))

    def deviation(self):
        return self.agreement()

    def runtime(self):
        """Mean seconds, and the share of each stage in the summed time of the runs that have a report."""
        text = self.cost()
        for name in self.suite.methods:
            stages, order = {}, []
            for mesh in self.suite.meshes:
                report = self.results[name, mesh].get("report") or {}
                for stage in report.get("stages", []):
                    if stage["name"] not in stages:
                        order.append(stage["name"])
                    stages[stage["name"]] = stages.get(stage["name"], 0) + stage["seconds"]
            total = sum(stages.values())
            if total > 0:
                text += f"\n{self.label(name)}, share of the stages:\n\n"
                text += markdown(["Stage", "Time Ratio (%)"],
                                 [[stage, f"{100 * stages[stage] / total:.2f}"]
                                  for stage in sorted(order, key=lambda stage: -stages[stage])])
        return text

    def bad_ends(self):
        """Every case that is not ok, or could not be measured, with what was said."""
        lines = [[row["mesh"], row["method"], row["status"], row["reason"] or row["measure_error"]]
                 for row in self.rows.values() if row["status"] not in ("ok", "not run") or row["measure_error"]]
        if not lines:
            return "Nothing failed.\n"
        return markdown(["Mesh", "Method", "Status", "What was said"],
                        [[cell.replace("|", "\\|") for cell in line] for line in lines])

    def paper(self):
        entry = self.suite.entry.get("paper")
        if not entry:
            return ""
        return (f"\n## What the paper says, on its own data ({entry['data']})\n\n"
                + markdown(entry["heads"], entry["rows"]))

    def text(self, facts):
        note = self.suite.entry.get("note", "")
        parts = [f"# {self.suite.title}\n", f"{note.strip()}\n" if note else "", facts_line(facts),
                 getattr(self, self.suite.table)(), "## Outcomes\n", self.outcomes(), self.cost() if
                 self.suite.table != "runtime" else "", "## Not ok\n", self.bad_ends(), self.paper()]
        return "\n".join(part for part in parts if part)


# ---- facts --------------------------------------------------------------------------------------------------

def busy_seconds(results):
    """Wall time with at least one job at work: kills and pauses between sessions do not count."""
    spans = sorted((result["started"], result["finished"]) for result in results if "finished" in result)
    total, end = 0.0, float("-inf")
    for start, finish in spans:
        total += max(0.0, finish - max(start, end))
        end = max(end, finish)
    return total


def commit():
    """The commit of the working copy that holds this file, if it is one."""
    here = pathlib.Path(__file__).resolve().parent
    try:
        found = subprocess.run(["git", "-C", str(here), "describe", "--always", "--dirty", "--abbrev=12"], check=True,
                               text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    except (OSError, subprocess.CalledProcessError):
        return None
    return found.stdout.strip()


def facts_of(suite, results):
    finished = [result for result in results.values() if "finished" in result]
    programs = {}
    for result in finished:
        programs.setdefault(result["method"], set()).add(result.get("program_sha256"))
    return {"suite": suite.name, "commit": commit(), "meshes": len(suite.meshes), "methods": len(suite.methods),
            "runs": len(finished), "wall_seconds": busy_seconds(finished),
            "run_seconds": sum(result["finished"] - result["started"] for result in finished),
            "mixed_programs": sorted(name for name, found in programs.items() if len(found) > 1),
            "versions": sorted({result["report"]["version"] for result in finished if "report" in result})}


def facts_line(facts):
    text = (f"{facts['meshes']} meshes, {facts['methods']} methods, {facts['runs']} of "
            f"{facts['meshes'] * facts['methods']} runs; commit {facts['commit'] or 'unknown'}; wall time "
            f"{facts['wall_seconds']:.0f} s.\n")
    if facts["mixed_programs"]:
        text += f"\nWarning: runs of more than one build are mixed: {', '.join(facts['mixed_programs'])}.\n"
    return text


def write_text(path, text):
    fresh = pathlib.Path(str(path) + ".new")
    fresh.write_text(text, encoding="utf-8")
    fresh.replace(path)


def write_csv(path, rows):
    keys = list(dict.fromkeys(key for row in rows for key in row))
    fresh = pathlib.Path(str(path) + ".new")
    with open(fresh, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, keys, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    fresh.replace(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--suite", required=True)
    parser.add_argument("--datasets", required=True)
    arguments = parser.parse_args()
    suite = Suite(arguments.suite, arguments.datasets)
    results, rows = load(suite)
    facts = facts_of(suite, results)
    write_csv(pathlib.Path("results.csv"), list(rows.values()))
    write_json(pathlib.Path("results.json"), {"facts": facts, "title": suite.title, "results": list(results.values())})
    plots.draw(suite, rows)
    write_text(pathlib.Path("table.md"), Tables(suite, results, rows).text(facts))


if __name__ == "__main__":
    main()
