"""Every script of viz/paraview, run by pvbatch on real meshes; the colours of the pictures, the messages.

CELLOCUT_PROGRAM names the program, CELLOCUT_MESHES the folder of meshes, CELLOCUT_PARAVIEW_PYTHON where
ParaView's Python modules are unpacked if they are not installed.
"""
import glob
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import png

KIT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "viz", "paraview")
PROGRAM = os.environ["CELLOCUT_PROGRAM"]
MESHES = os.environ["CELLOCUT_MESHES"]
# A bunny with holes, an aeroplane of sheets, and furniture whose minimum cut is not unique.
BUNNY, PLANE, TABLE = "g3_holey_bunny_2.obj", "oded_plane_holes.obj", "sh3d_BlendSwap-CC-0_bedsideTable2.obj"
RUNS = {BUNNY: (), PLANE: (), TABLE: ("--support", "facets")}
SOLID, PALE, MARKED, ABSORBED = (221, 122, 60), (236, 239, 243), (184, 30, 74), (86, 180, 233)
OUTLINE, ANCHORED = (26, 31, 41), (60, 120, 176)
WHITE = (255, 255, 255)
# The share of a picture that the legend has of each colour; what is more is the scene.
LEGEND = 0.003


def start_display():
    """A display of our own, that picks its number itself and stays up between two clients.

    (ParaView closes its first connection and opens another; a server that resets in between refuses it.)
    """
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x1024x24",
                               "-noreset"],
                              pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    unittest.addModuleCleanup(server.wait)
    unittest.addModuleCleanup(server.terminate)
    os.close(write)
    with os.fdopen(read) as answer:
        os.environ["DISPLAY"] = ":" + answer.readline().strip()


def setUpModule():
    global FOLDER
    start_display()
    FOLDER = tempfile.mkdtemp(prefix="cellocut-paraview-")
    unittest.addModuleCleanup(shutil.rmtree, FOLDER)
    for mesh, options in RUNS.items():
        subprocess.run([PROGRAM, "remesh", os.path.join(MESHES, mesh), "-o", path("out.ply"), "-R", "64",
                        "--quiet", "--save-stages", path(mesh), *options], check=True)


def path(name):
    return os.path.join(FOLDER, name)


def pvbatch(script, *arguments):
    command = [os.path.join(KIT, "with_python"), "pvbatch", os.path.join(KIT, script), *arguments]
    return subprocess.run(command, cwd=FOLDER, text=True, timeout=300, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE)


def compare(mesh, *options):
    """compare's files of a mesh, one for each backend."""
    folder = tempfile.mkdtemp(dir=FOLDER)
    subprocess.run([PROGRAM, "compare", os.path.join(MESHES, mesh), "-o", folder, "-R", "64", "--quiet",
                    "--repeat", "1", "--no-crossover", *options], check=True)
    return sorted(glob.glob(os.path.join(folder, "*.vtu")))


class KitCase(unittest.TestCase):
    def picture(self, script, *arguments):
        """Share of each colour in the script's picture, which must not be blank; and what it printed."""
        picture = path("picture.png")
        if os.path.exists(picture):
            os.remove(picture)
        run = pvbatch(script, *arguments, "--screenshot", picture, *self.size(script))
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        return self.shares(picture), run.stdout

    def size(self, script):
        return () if script == "labelled_cells.py" else ("--size", "600x450")

    def shares(self, picture):
        counts = png.colours(picture)
        total = sum(counts.values())
        self.assertLess(counts[WHITE], 0.97 * total, "blank")
        self.assertGreater(len(counts), 20, "blank")
        return {colour: number / total for colour, number in counts.items()}

    def assert_shows(self, shares, **least):
        """Each colour has more than this share of the picture, up to rounding: nothing lights it."""
        for name, share in least.items():
            wanted = globals()[name]
            found = sum(part for colour, part in shares.items()
                        if max(abs(a - b) for a, b in zip(colour, wanted)) <= 3)
            self.assertGreater(found, share, name)


class Pictures(KitCase):
    def test_section(self):
        for mesh, solid in ((BUNNY, 0.05), (PLANE, LEGEND), (TABLE, LEGEND)):
            with self.subTest(mesh):
                shares, _ = self.picture("section.py", mesh)
                self.assert_shows(shares, SOLID=solid, PALE=LEGEND, OUTLINE=0.001)

    def test_section_by_single_files(self):
        shares, _ = self.picture("section.py", f"{BUNNY}/cells.vtu", os.path.join(MESHES, BUNNY), "--array",
                                 "anchored", "--normal", "1,0,0", "--up", "y")
        self.assert_shows(shares, ANCHORED=LEGEND, PALE=LEGEND, OUTLINE=0.001)

    def test_absorbed(self):
        for mesh, absorbed in ((BUNNY, 0.02), (PLANE, LEGEND), (TABLE, 0.05)):
            with self.subTest(mesh):
                shares, text = self.picture("absorbed.py", f"{mesh}/run.vtm")
                self.assertRegex(text, r"\Aabsorbed: [1-9]\d* cells absorbed, \d+ given up\n\Z")
                self.assert_shows(shares, ABSORBED=absorbed, SOLID=LEGEND)

    def test_ambiguous(self):
        for mesh in (BUNNY, PLANE):
            with self.subTest(mesh):
                shares, text = self.picture("ambiguous.py", mesh)
                self.assertEqual(text, "0 cells ambiguous: the minimum cut is unique\n")
                self.assertNotIn(MARKED, shares)
        with self.subTest(TABLE):
            shares, text = self.picture("ambiguous.py", TABLE)
            self.assertRegex(text, r"\A[1-9]\d* cells ambiguous\n\Z")
            self.assert_shows(shares, MARKED=LEGEND)

    def test_solvers_that_disagree(self):
        # lp, stopped early, has a labelling that is no minimum.
        for mesh in (BUNNY, PLANE, TABLE):
            with self.subTest(mesh):
                files = compare(mesh, "--backends", "cgal", "--solvers", "bk,lp", "--lp-iterations", "5")
                shares, text = self.picture("disagreement.py", files[0])
                self.assertRegex(text, r"\A[1-9]\d* cells labelled differently by solvers\n\Z")
                self.assert_shows(shares, MARKED=LEGEND)

    def test_solvers_that_agree(self):
        files = compare(PLANE, "--backends", "cgal", "--solvers", "bk,ibfs")
        shares, text = self.picture("disagreement.py", files[0])
        self.assertEqual(text, "0 cells labelled differently by solvers: they all agree\n")
        self.assertNotIn(MARKED, shares)

    def test_two_backends(self):
        for mesh in (BUNNY, PLANE, TABLE):
            with self.subTest(mesh):
                files = compare(mesh, "--backends", "cgal,tetgen", "--solvers", "bk")
                self.assertEqual(len(files), 2)
                shares, _ = self.picture("disagreement.py", *files)
                self.assert_shows(shares, SOLID=LEGEND + 0.01, PALE=0.1)

    def test_two_complexes(self):
        # Other cells altogether: a coarser grid, and so a thicker solid.
        subprocess.run([PROGRAM, "remesh", os.path.join(MESHES, BUNNY), "-o", path("out.ply"), "-R", "24",
                        "--quiet", "--vtu", path("coarse.vtu")], check=True)
        shares, _ = self.picture("disagreement.py", BUNNY, "coarse.vtu")
        self.assert_shows(shares, SOLID=0.05, PALE=0.1, MARKED=LEGEND + 0.01)

    def test_saturation(self):
        for mesh in (BUNNY, PLANE, TABLE):
            with self.subTest(mesh):
                shares, _ = self.picture("saturation.py", mesh)
                # Viridis ends in yellow, lit: red and green without blue.
                yellow = sum(share for (r, g, b), share in shares.items() if r > 100 and g > 90 and b < 90)
                self.assertGreater(yellow, 0.03)

    def test_orbit(self):
        for mesh in (BUNNY, PLANE, TABLE):
            with self.subTest(mesh):
                run = pvbatch("orbit.py", mesh, "--frames", "4", "--output", path("turn.png"), "--size",
                              "200x150")
                self.assertEqual(run.returncode, 0, run.stderr)
                frames = sorted(glob.glob(path("turn.*.png")))
                self.assertEqual(len(frames), 4)
                shares = [self.shares(frame) for frame in frames]
                self.assertEqual(len({frozenset(s.items()) for s in shares}), 4, "the camera moves")
                self.assert_shows(shares[0], ABSORBED=LEGEND)
                for frame in frames:
                    os.remove(frame)

    def test_orbit_of_each_scene(self):
        solvers = compare(PLANE, "--backends", "cgal", "--solvers", "bk,ibfs")[0]
        for scene, file in (("section", BUNNY), ("ambiguous", TABLE), ("saturation", BUNNY),
                            ("disagreement", solvers)):
            with self.subTest(scene):
                run = pvbatch("orbit.py", file, "--scene", scene, "--frames", "2", "--output", path("turn.png"),
                              "--size", "200x150")
                self.assertEqual(run.returncode, 0, run.stderr)
                for frame in sorted(glob.glob(path("turn.*.png"))):
                    self.shares(frame)
                    os.remove(frame)

    def test_labelled_cells(self):
        shares, _ = self.picture("labelled_cells.py", f"{BUNNY}/cells.vtu", "--mode", "section")
        self.assert_shows(shares, SOLID=LEGEND, PALE=LEGEND)


# Every macro in turn on an open run, within ParaView itself; a line and a picture for each.
WITHIN = """
import os
import sys
import traceback
from paraview import simple
log = open({log!r}, "w")
try:
    sys.path[:0] = [{kit!r}]
    opened = simple.XMLMultiBlockDataReader(FileName=[{run!r}])
    for name in {names!r}:
        simple.SetActiveSource(simple.XMLUnstructuredGridReader(FileName=[{compared!r}])
                               if name == "disagreement" else opened)
        __import__(name).main([])
        simple.SaveScreenshot(name + ".png", ImageResolution=[600, 450])
        print("drawn", name, simple.GetActiveSource() == opened, file=log)
except BaseException:
    traceback.print_exc(file=log)
finally:
    log.close()
    os._exit(0)
"""


class Graphical(KitCase):
    def test_macros_within_paraview(self):
        names = ["section", "absorbed", "ambiguous", "saturation", "orbit", "disagreement"]
        with open(path("within.py"), "w", encoding="utf-8") as script:
            script.write(WITHIN.format(kit=os.path.abspath(KIT), log=path("within.log"), names=names,
                                       run=path(f"{TABLE}/run.vtm"),
                                       compared=compare(PLANE, "--backends", "cgal", "--solvers", "bk,ibfs")[0]))
        subprocess.run([os.path.join(KIT, "with_python"), "paraview", "--script=" + path("within.py")],
                       cwd=FOLDER, timeout=300, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                       env=dict(os.environ, XDG_CONFIG_HOME=path("config"), XDG_RUNTIME_DIR=FOLDER))
        with open(path("within.log"), encoding="utf-8") as log:
            drawn = log.read().splitlines()
        # What was selected is selected afterwards, for the next macro.
        self.assertEqual(drawn, [f"drawn {name} {name != 'disagreement'}" for name in names])
        self.assert_shows(self.shares(path("section.png")), SOLID=LEGEND, PALE=LEGEND, OUTLINE=0.001)
        self.assert_shows(self.shares(path("absorbed.png")), ABSORBED=LEGEND)
        self.assert_shows(self.shares(path("ambiguous.png")), MARKED=LEGEND)


# Prints for each array of a .vtu its name and a hash of its bytes, by the VTK of whoever runs it.
HASH_ARRAYS = """
import hashlib
import sys
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
reader = vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[-1])
reader.Update()
grid = reader.GetOutput()
data = grid.GetCellData()
arrays = [("points", grid.GetPoints().GetData()), ("corners", grid.GetCells().GetConnectivityArray())]
arrays += [(data.GetArrayName(k), data.GetArray(k)) for k in range(data.GetNumberOfArrays())]
for name, array in arrays:
    print("array", name, array.GetDataTypeAsString(), hashlib.sha256(memoryview(array)).hexdigest())
"""


class Reading(KitCase):
    def test_paraview_reads_what_vtk_reads(self):
        with open(path("hash_arrays.py"), "w", encoding="utf-8") as script:
            script.write(HASH_ARRAYS)
        cells = f"{BUNNY}/cells.vtu"
        here = subprocess.run(["/usr/bin/python3", path("hash_arrays.py"), path(cells)], capture_output=True, text=True,
                              check=False)
        if "ModuleNotFoundError" in here.stderr:
            self.skipTest("python3-vtk9 is not installed")
        there = pvbatch(path("hash_arrays.py"), path(cells))
        found = [line for line in there.stdout.splitlines() if line.startswith("array ")]
        self.assertGreater(len(found), 8, there.stderr)
        self.assertEqual(found, here.stdout.splitlines())


class Messages(KitCase):
    def refuse(self, pattern, script, *arguments):
        run = pvbatch(script, *arguments, "--screenshot", path("none.png"))
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertRegex(run.stderr, rf"\A{script[:-3]}: [^\n]+\n\Z")
        self.assertRegex(run.stderr, pattern)
        self.assertFalse(os.path.exists(path("none.png")))

    def test_missing_arrays(self):
        # Another name is as good as no array.
        with open(path(f"{PLANE}/cells.vtu"), "rb") as file:
            data = file.read()
        for script, array in (("section.py", "label"), ("absorbed.py", "label_initial"),
                              ("ambiguous.py", "ambiguous")):
            with self.subTest(script):
                with open(path("other.vtu"), "wb") as file:
                    file.write(data.replace(f'"{array}"'.encode(), f'"{array[::-1]}"'.encode()))
                self.refuse(rf"other.vtu: there is no cell array '{array}'; there are: .*{array[::-1]}.*"
                            r"'cellocut remesh IN -o OUT --save-stages DIR' writes it", script, "other.vtu")

    def test_disagreement_needs_compare(self):
        self.refuse("no cell array 'disagree'; .*'cellocut compare IN... -o DIR' writes it",
                    "disagreement.py", PLANE)

    def test_saturation_needs_the_cut_facets(self):
        self.refuse("no cell array 'saturation'; there are: .*defect", "saturation.py", f"{PLANE}/input.vtp")
        self.refuse("no cut_facets.vtp among .*--save-stages", "saturation.py", f"{PLANE}/cells.vtu")

    def test_files(self):
        self.refuse("there.vtu: no such file", "section.py", "there.vtu")
        self.refuse("no labelled cells", "absorbed.py", f"{PLANE}/input.vtp")

    def test_macros(self):
        subprocess.run([sys.executable, os.path.join(KIT, "install_macros.py"), path("macros")], check=True,
                       stdout=subprocess.DEVNULL)
        names = sorted(os.listdir(path("macros")))
        self.assertEqual(len(names), 6)
        for name in names:
            with open(path(f"macros/{name}"), encoding="utf-8") as file:
                compile(file.read(), name, "exec")
        # What a macro has in the graphical program: no arguments, no name of a file.
        with open(path("as_macro.py"), "w", encoding="utf-8") as file:
            file.write("import sys\nfrom paraview import simple\n"
                       f"simple.XMLUnstructuredGridReader(FileName={path(PLANE + '/cells.vtu')!r})\n"
                       f"sys.argv[0] = ''\nexec(open({path('macros/CelloCut_absorbed.py')!r}).read())\n"
                       f"simple.SaveScreenshot({path('macro.png')!r}, ImageResolution=[400, 300])\n")
        run = pvbatch(path("as_macro.py"))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("cells absorbed", run.stdout)
        self.assert_shows(self.shares(path("macro.png")), ABSORBED=LEGEND)


if __name__ == "__main__":
    for program in ("pvbatch", "Xvfb"):
        if shutil.which(program) is None:
            print(f"skipped: there is no {program} (apt-get install paraview xvfb)")
            sys.exit(77)
    ready = subprocess.run([os.path.join(KIT, "with_python"), "true"], check=False)
    if ready.returncode != 0:
        sys.exit(77 if ready.returncode == 3 else 1)
    unittest.main(verbosity=2)
