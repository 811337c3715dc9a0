"""Runs the program in a folder of its own, and the meshes that the cases feed it.

CELLOCUT_PROGRAM names the program, CELLOCUT_SHORT_WRITE the module of tests/support/short_write.cpp.
"""
import math
import os
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["CELLOCUT_PROGRAM"]
SHORT_WRITE = os.environ["CELLOCUT_SHORT_WRITE"]
OLD = b"what stood here before\n"
# A grid so coarse that a run takes a tenth of a second; epsilon above one step, so that nothing warns.
COARSE = ("-R", "16", "--epsilon", "0.1")


def program_has(option):
    """Whether `cellocut remesh` knows an option; --vtu is not there in a build without VTK."""
    text = subprocess.run([PROGRAM, "remesh", "--help"], stdout=subprocess.PIPE, check=True).stdout
    return option.encode() in text


HAS_VTU = program_has("--vtu")


def box(low, high, leave_out=()):
    """Points and outward triangles of a box, but for the triangles in leave_out."""
    points = [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
    faces = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4),
             (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]
    return points, [face for number, face in enumerate(faces) if number not in leave_out]


def join(first, second):
    shift = len(first[0])
    return first[0] + second[0], first[1] + [tuple(i + shift for i in face) for face in second[1]]


def sphere(rings):
    points = [(math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t))
              for t in (math.pi * i / rings for i in range(rings + 1))
              for p in (math.pi * j / rings for j in range(2 * rings))]
    faces = []
    for i in range(rings):
        for j in range(2 * rings):
            a, b = 2 * rings * i + j, 2 * rings * i + (j + 1) % (2 * rings)
            faces += [(a, a + 2 * rings, b + 2 * rings), (a, b + 2 * rings, b)]
    return points, faces


def obj_text(mesh):
    points, faces = mesh
    lines = ["v %r %r %r" % point for point in points]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    return "\n".join(lines) + "\n"


HOLED_BOX = box((0.0, 0.0, 0.0), (1.0, 0.7, 0.5), leave_out=(11,))
BOXES_AT_AN_EDGE = join(box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), box((1.0, 1.0, 0.0), (2.0, 2.0, 1.0)))


class ProgramCase(unittest.TestCase):
    """A temporary working folder with holed.obj in it; run() and what a failed run must look like."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="cellocut-cli-")
        self.addCleanup(shutil.rmtree, self.folder)
        self.put("holed.obj", obj_text(HOLED_BOX))

    def path(self, name):
        return os.path.join(self.folder, name)

    def put(self, name, content):
        with open(self.path(name), "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())

    def get(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def names(self):
        return sorted(os.listdir(self.folder))

    def shimmed(self, **variables):
        """The environment with the short-write module in front of the system's writes."""
        environment = dict(os.environ, LD_PRELOAD=SHORT_WRITE, **variables)
        sanitizer = environment.get("ASAN_OPTIONS", "")
        environment["ASAN_OPTIONS"] = sanitizer + (":" if sanitizer else "") + "verify_asan_link_order=0"
        return environment

    def run_program(self, *arguments, **how):
        return subprocess.run([PROGRAM, *arguments], cwd=self.folder, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, timeout=300, check=False, **how)

    def succeed(self, *arguments, **how):
        run = self.run_program(*arguments, **how)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stderr, b"")
        return run

    def assert_one_line(self, run, code, pattern):
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertEqual(run.stdout, b"")
        text = run.stderr.decode()
        self.assertRegex(text, r"\Acellocut: [^\n]+\n\Z")
        self.assertRegex(text, pattern)

    def fail_with(self, code, pattern, *arguments, outputs=("out.obj",), **how):
        """The exit code, one line, and not a byte of the folder changed; every output stood before."""
        for name in outputs:
            self.put(name, OLD)
        before = self.names()
        run = self.run_program(*arguments, **how)
        self.assert_one_line(run, code, pattern)
        for name in outputs:
            self.assertEqual(self.get(name), OLD, name)
        self.assertEqual(self.names(), before)
        return run
