"""Tiny suites in a folder of their own, run by `cellocut bench`.

CELLOCUT_PROGRAM names the program, CELLOCUT_WORKFLOW the folder of the Snakefile.
"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ["CELLOCUT_PROGRAM"]
WORKFLOW = os.environ["CELLOCUT_WORKFLOW"]
PATIENCE = 400  # seconds until something that must happen is missed; Slurm waits two minutes before it begins again
HOLED_BOX = """v 0 0 0
v 1 0 0
v 0 0.7 0
v 1 0.7 0
v 0 0 0.5
v 1 0 0.5
v 0 0.7 0.5
v 1 0.7 0.5
f 1 3 4
f 1 4 2
f 5 6 8
f 5 8 7
f 1 2 6
f 1 6 5
f 3 7 8
f 3 8 4
f 1 5 7
f 1 7 3
f 2 4 8
"""
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
# One grid so coarse that a run takes a tenth of a second.
OURS = '"{bin}/cellocut remesh {input} -o {output} --json {report} -R 16 --epsilon 0.1 --threads 1 --quiet"'


def wait_for(happened, what):
    end = time.monotonic() + PATIENCE
    while not happened():
        if time.monotonic() > end:
            raise AssertionError(f"waited in vain for {what}")
        time.sleep(0.1)


def children_of(pid):
    """Direct children of a process."""
    try:
        text = pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii")
    except OSError:
        return []
    return [int(word) for word in text.split()]


def descendants_of(pid):
    found = []
    for child in children_of(pid):
        found += [child, *descendants_of(child)]
    return found


def alive(pid):
    """Whether a process still runs; one that nobody waited for does not."""
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="ascii", errors="replace").rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


class SuiteCase(unittest.TestCase):
    """A folder with meshes/, a suite that is written by write_suite(), and out/ for its results."""

    FOLDER = None  # where the temporary folder is made

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="cellocut-suite-", dir=self.FOLDER))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.meshes = self.folder / "meshes"
        self.meshes.mkdir()
        (self.meshes / "holed.obj").write_text(HOLED_BOX, encoding="ascii")
        (self.meshes / "tetrahedron.obj").write_text(TETRAHEDRON, encoding="ascii")
        self.out = self.folder / "out"

    def write_suite(self, methods, head=""):
        """A suite of all meshes; `methods` maps names to the YAML of their commands and settings."""
        lines = ["title: tiny", "table: robustness", "meshes: [{glob: meshes/*}]", head, "methods:"]
        for name, settings in methods.items():
            lines += [f"  - name: {name}", *(f"    {line}" for line in settings)]
        (self.folder / "tiny.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")

    def command(self, *arguments):
        return [PROGRAM, "bench", str(self.folder / "tiny.yaml"), "-o", str(self.out), "--workflow", WORKFLOW,
                "--datasets", str(self.folder / "datasets"), *arguments]

    def bench(self, *arguments, code=0, **settings):
        """Runs the suite to its end; the program's output."""
        run = subprocess.run(self.command(*arguments), check=False, text=True, stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, timeout=PATIENCE, **settings)
        self.assertEqual(run.returncode, code, run.stderr)
        return run

    def start(self, *arguments):
        """Starts the suite; whatever happens, nothing of it is left."""
        log = open(self.folder / "log", "ab")  # pylint: disable=consider-using-with
        self.addCleanup(log.close)
        process = subprocess.Popen(  # pylint: disable=consider-using-with
            self.command(*arguments), stdout=log, stderr=log)
        self.addCleanup(self.kill_all, process)
        return process

    @staticmethod
    def kill_all(process):
        for pid in [process.pid, *descendants_of(process.pid)]:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        process.wait()

    def results(self):
        """(method, mesh) -> result, of results.json."""
        content = json.loads((self.out / "results.json").read_text(encoding="utf-8"))
        return {(result["method"], result["mesh"]): result for result in content["results"]}

    def starts(self, mesh):
        """How often a gated method was started on a mesh."""
        path = self.folder / f"starts-{mesh}.obj"
        return len(path.read_text(encoding="ascii").splitlines()) if path.is_file() else 0

    def gated(self):
        """A method that counts its starts, and whose second start in all waits for the file `go`."""
        script = self.folder / "gated.sh"
        script.write_text(f"""set -e
cd '{self.folder}'
echo started >> "starts-$(basename "$1")"
if [ "$(cat starts-* | wc -l)" -eq 2 ]; then
  touch blocked
  while [ ! -e go ]; do sleep 0.1; done
fi
cp "$1" "$2"
""", encoding="utf-8")
        return [f"command: sh {script} {{input}} {{output}}", "output: obj"]
