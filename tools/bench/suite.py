"""Suites: which meshes, which methods with which parameters, what is measured. See docs/benchmarks.md."""
import glob
import itertools
import os
import pathlib
import re
import shlex

import yaml

import datasets

PEER_LIMITS = {"seconds": 600, "memory_gb": 8}
MEASURES = ("check", "evaluate")
TABLES = ("robustness", "fidelity", "completion", "sensitivity", "ablation", "deviation", "runtime",
          "filling")


class SuiteError(Exception):
    """What is wrong with a suite, in one line."""


def word(text):
    """A text as one word of a file name."""
    return re.sub(r"[^A-Za-z0-9_.+-]", "_", str(text))


def allow(mapping, keys, where):
    """Unknown keys are errors: a misspelt one would leave something out silently."""
    if not isinstance(mapping, dict):
        raise SuiteError(f"{where}: must be a mapping")
    unknown = sorted(set(mapping) - set(keys))
    if unknown:
        raise SuiteError(f"{where}: unknown key '{unknown[0]}'; there are: {', '.join(sorted(keys))}")


class Method:
    """One way to make a surface of a mesh: a command with its parameters filled in."""

    def __init__(self, entry, values, suite):
        self.base = word(entry["name"])
        self.values = dict(values)
        self.name = self.base + "".join(f"_{word(key)}-{word(label)}" for key, (label, _) in self.values.items())
        self.label = str(entry.get("label", entry["name"]))
        self.command = str(entry["command"])
        self.ending = str(entry.get("output", "ply"))
        self.output = entry.get("output_file")
        self.unreadable = [int(code) for code in entry.get("unreadable", [])]
        limits = {**PEER_LIMITS, **suite.get("limits", {}), **entry.get("limits", {})}
        allow(limits, PEER_LIMITS, "limits")
        self.seconds = float(limits["seconds"])
        self.memory_gb = float(limits["memory_gb"])
        threads = entry.get("threads", suite.get("threads", 1))
        self.threads = len(os.sched_getaffinity(0)) if threads == "all" else int(threads)
        self.reference = entry.get("reference", suite.get("reference", "none"))
        self.evaluate = list(map(str, suite.get("evaluate", [])))
        self.evaluate_seconds = float(suite.get("measure_seconds", 1200))

    def arguments(self, **places):
        """The command's words, with {input}, {output}, {report}, {scratch}, {bin}, {threads}, {seconds} and the
        parameters in place. No shell takes part; a command that needs one says `sh -c`."""
        places.update({key: str(value) for key, (_, value) in self.values.items()})
        places.update(threads=self.threads, seconds=f"{self.seconds:g}")
        try:
            return [part.format(**places) for part in shlex.split(self.command)]
        except (KeyError, IndexError, ValueError) as error:
            raise SuiteError(f"method '{self.base}': the command has no value for {error}") from error

    def fingerprint(self):
        """What a result depends on: a change of it makes the run again."""
        return [self.command, self.ending, self.output, self.seconds, self.memory_gb, self.threads, self.unreadable,
                str(self.reference), self.evaluate]


class Suite:
    """A suite file with its meshes found and its methods times parameters listed."""

    METHOD_KEYS = ("name", "label", "command", "output", "output_file", "parameters", "limits", "threads", "reference",
                   "unreadable")
    KEYS = ("title", "table", "meshes", "methods", "limits", "threads", "reference", "measures", "measure_seconds",
            "evaluate", "damage", "scan", "paper", "note", "plot")

    def __init__(self, path, dataset_root):
        self.path = pathlib.Path(path)
        try:
            entry = yaml.safe_load(self.path.read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
            raise SuiteError(f"{path}: {str(error).splitlines()[0]}") from error
        allow(entry, self.KEYS, path)
        for key in ("title", "table", "meshes", "methods"):
            if not entry.get(key):
                raise SuiteError(f"{path}: '{key}' is missing")
        self.name = self.path.stem
        self.entry = entry
        self.title = str(entry["title"])
        self.table = entry["table"]
        if self.table not in TABLES:
            raise SuiteError(f"{path}: table '{self.table}' is none of {', '.join(TABLES)}")
        self.measures = entry.get("measures", ["check"])
        if not set(self.measures) <= set(MEASURES):
            raise SuiteError(f"{path}: measures are {', '.join(MEASURES)}")
        self.damage = entry.get("damage")
        if self.damage is not None:
            allow(self.damage, ("seeds", "arguments"), "damage")
        self.scan = [str(argument) for argument in entry.get("scan", [])]
        self.plot = entry.get("plot")
        self.methods = {}
        for method in entry["methods"]:
            allow(method, self.METHOD_KEYS, "methods")
            for key in ("name", "command"):
                if not method.get(key):
                    raise SuiteError(f"{path}: a method has no '{key}'")
            for values in self._combinations(method.get("parameters", {})):
                made = Method(method, values, entry)
                if made.name in self.methods:
                    raise SuiteError(f"{path}: two methods are named '{made.name}'")
                self.methods[made.name] = made
        for method in self.methods.values():
            self._check_reference(method)
        self.truths = self._find_meshes(pathlib.Path(dataset_root))
        self.meshes = self._cases()

    @staticmethod
    def _combinations(parameters):
        """Every choice of (label, value) for each parameter; a list of values, or a mapping from labels."""
        axes = []
        for key, values in parameters.items():
            pairs = values.items() if isinstance(values, dict) else [(value, value) for value in values]
            axes.append([(key, pair) for pair in pairs])
        return [dict(choice) for choice in itertools.product(*axes)]

    def _check_reference(self, method):
        reference = method.reference
        if isinstance(reference, dict):
            allow(reference, ("method",), "reference")
            if reference.get("method") not in self.methods:
                raise SuiteError(f"{self.path}: reference of '{method.name}': no method '{reference.get('method')}'")
            if reference["method"] == method.name:
                raise SuiteError(f"{self.path}: '{method.name}' is its own reference")
        elif reference not in ("none", "input", "scan", "truth"):
            raise SuiteError(f"{self.path}: reference '{reference}' is none of none, input, scan, truth")
        if reference == "truth" and self.damage is None:
            raise SuiteError(f"{self.path}: reference truth needs 'damage'")

    def reference_method(self, method):
        """The method whose surface is the reference of this one, or None."""
        return method.reference["method"] if isinstance(method.reference, dict) else None

    def kept(self):
        """Methods whose surfaces are references: those are kept, the others are measured and removed."""
        return {name for name in map(self.reference_method, self.methods.values()) if name}

    def _find_meshes(self, dataset_root):
        found = {}
        for entry in self.entry["meshes"]:
            allow(entry, ("dataset", "glob", "list"), "meshes")
            if "dataset" in entry:
                manifest = datasets.install(entry["dataset"], dataset_root)
                here = {file["name"]: dataset_root / entry["dataset"] / file["file"] for file in manifest["files"]}
            elif "glob" in entry:
                pattern = os.path.expandvars(str(entry["glob"]))
                paths = sorted(glob.glob(os.path.join(self.path.parent, pattern)))
                here = {word(pathlib.Path(path).stem): pathlib.Path(path) for path in paths
                        if pathlib.Path(path).suffix.lower() in datasets.MESH_ENDINGS}
                if len(here) == 0:
                    raise SuiteError(f"{self.path}: no meshes match {pattern}")
            else:
                raise SuiteError(f"{self.path}: meshes need 'dataset' or 'glob'")
            if "list" in entry:
                here = self._listed(entry["list"], here)
            for name, path in here.items():
                if name in found:
                    raise SuiteError(f"{self.path}: two meshes are named '{name}'")
                found[name] = pathlib.Path(path).resolve()
        return found

    def _listed(self, name, here):
        """Those of a file of names, one a line; a name that is not there is an error, not a smaller table."""
        try:
            lines = (self.path.parent / name).read_text(encoding="utf-8").splitlines()
        except OSError as error:
            raise SuiteError(f"{self.path}: {name}: {error.strerror}") from error
        names = [line.split("#")[0].strip() for line in lines]
        names = [entry for entry in names if entry]
        for entry in names:
            if entry not in here:
                raise SuiteError(f"{self.path}: {name}: no mesh '{entry}'")
        return {entry: here[entry] for entry in names}

    def _cases(self):
        """Name -> (truth, seed): the meshes themselves, or each of them damaged with each seed."""
        if self.damage is None:
            return {name: (name, None) for name in self.truths}
        seeds = self.damage.get("seeds", [1])
        return {f"{name}-seed{seed}": (name, int(seed)) for name in self.truths for seed in seeds}

    def needs_scan(self):
        return any(method.reference == "scan" for method in self.methods.values())
