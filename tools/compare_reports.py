#!/usr/bin/env python3
"""Prints one row per JSON report of `cellocut remesh`, and says whether the exact solvers agree.

Usage: compare_reports.py REPORT.json...
Exits with 1 where a certificate or an output is not valid, or two solvers on the same backend (that is,
on the same integer problem) report different cut values.
"""
import json
import sys

COLUMNS = (
    ("backend", "{}", lambda r: r["cut"]["backend"]),
    ("solver", "{}", lambda r: r["cut"]["solver"]),
    ("cut value", "{}", lambda r: r["cut"]["value"]),
    ("energy", "{:.6g}", lambda r: r["cut"]["energy"]),
    ("cells", "{}", lambda r: r["counts"]["cells"]),
    ("triangles", "{}", lambda r: r["output"]["triangles"]),
    ("volume", "{:.6g}", lambda r: r["output"]["volume"]),
    ("cut s", "{:.3f}", lambda r: r["cut"]["build_seconds"] + r["cut"]["solve_seconds"]),
    ("total s", "{:.2f}", lambda r: sum(stage["seconds"] for stage in r["stages"])),
    ("certificate", "{}", lambda r: "valid" if r["certificate"]["valid"] else "FAILED"),
    ("output", "{}", lambda r: "valid" if r["output"]["valid"] else "NOT VALID"),
)


def main(paths):
    if not paths:
        print(__doc__, file=sys.stderr)
        return 2
    reports = []
    for path in paths:
        with open(path, encoding="utf-8") as file:
            reports.append(json.load(file))

    rows = [[name for name, _, _ in COLUMNS]]
    rows += [[form.format(get(report)) for _, form, get in COLUMNS] for report in reports]
    widths = [max(len(row[i]) for row in rows) for i in range(len(COLUMNS))]
    for row in rows:
        cells = [cell.ljust(width) if i < 2 else cell.rjust(width)
                 for i, (cell, width) in enumerate(zip(row, widths))]
        print("  ".join(cells).rstrip())

    values = {}
    for report in reports:
        values.setdefault(report["cut"]["backend"], set()).add(report["cut"]["value"])
    disagree = [backend for backend, found in values.items() if len(found) > 1]
    for backend in disagree:
        print(f"{backend}: the solvers DISAGREE on the cut value")
    if not disagree:
        print("Equal cut values on each backend: the optimum, found independently and certified.")
    sound = all(r["certificate"]["valid"] and r["output"]["valid"] for r in reports)
    return 0 if sound and not disagree else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
