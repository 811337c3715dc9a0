"""The page of `cellocut compare --html` in headless Chromium, opened from a file.

CELLOCUT_PROGRAM names the program, CELLOCUT_PAGE_WITHOUT_VIEWER what writes a page without the 3D view, and
CELLOCUT_SCREENSHOT the picture that is left behind.
"""
import json
import os
import shutil
import subprocess
import tempfile
import time
import unittest

import browser

PROGRAM = os.environ["CELLOCUT_PROGRAM"]
WITHOUT_VIEWER = os.environ["CELLOCUT_PAGE_WITHOUT_VIEWER"]
SCREENSHOT = os.environ.get("CELLOCUT_SCREENSHOT")
CAN = os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "data", "watering_can.obj")
SMALL = "p max 4 3\nn 1 s\nn 4 t\na 1 2 5\na 2 3 3\na 3 4 4\n"
CELLS = """return Array.from(document.querySelectorAll('tr[data-solver]'), (row) => [
  Number(row.closest('[data-instance]').dataset.instance), row.dataset.solver,
  Object.fromEntries(Array.from(row.querySelectorAll('[data-key]'), (c) => [c.dataset.key, c.dataset.value]))])"""
DRAWN = "Number(document.getElementById('viewer').dataset.frames) > 0"


def shown(rows, background):
    """The share of pixels that differ from the background."""
    pixels = [pixel for row in rows for pixel in row]
    return sum(max(abs(a - b) for a, b in zip(pixel, background)) > 12 for pixel in pixels) / len(pixels)


@unittest.skipUnless(browser.AVAILABLE, "chromium and chromedriver are not there (the packages of the group web)")
class ReportPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="cellocut-web-")
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        os.chmod(cls.folder, 0o755)
        odd = cls.path("<img src=x>.max")
        with open(odd, "w", encoding="ascii") as file:
            file.write(SMALL)
        shutil.copy(CAN, cls.path("watering_can.obj"))
        subprocess.run([PROGRAM, "compare", "watering_can.obj", odd, "-o", "out", "--html", "report.html", "-R", "256",
                        "--backends", "cgal", "--solvers", "bk,push_relabel,ibfs,lp", "--repeat", "3", "--quiet"],
                       cwd=cls.folder, check=True, timeout=300)
        with open(cls.path("out/compare.json"), encoding="utf-8") as file:
            cls.report = json.load(file)
        listed = subprocess.run([PROGRAM, "list", "--json", "-"], stdout=subprocess.PIPE, check=True).stdout
        cls.viewer = json.loads(listed)["report"][0]

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    def browser(self, **how):
        window = browser.Browser(**how)
        self.addCleanup(window.close)
        return window

    def assert_quiet(self, window, page):
        """It asked for nothing but itself (what it carries in data: addresses aside), and nothing went wrong."""
        asked = [address for address in window.requests() if not address.startswith("data:")]
        self.assertEqual(asked, ["file://" + page])
        self.assertEqual(window.console(), [])

    def assert_numbers(self, window):
        embedded = window.run("return document.getElementById('report').textContent")
        self.assertEqual(json.loads(embedded), self.report)
        rows = window.run(CELLS)
        wanted = [(number, run) for number, instance in enumerate(self.report["instances"])
                  for run in instance["runs"]]
        self.assertEqual(len(rows), len(wanted))
        for (instance, solver, cells), (number, run) in zip(rows, wanted):
            self.assertEqual((instance, solver), (number, run["solver"]))
            self.assertEqual([int(cells[key]) for key in ("value", "lower_bound", "gap")],
                             [run[key] for key in ("value", "lower_bound", "gap")])
            self.assertEqual([float(cells[key]) for key in ("build_seconds", "solve_seconds")],
                             [run[key]["median"] for key in ("build_seconds", "solve_seconds")])

    def check_3d(self, user):
        if not self.viewer["built"]:
            self.skipTest("the 3D view is not built: " + self.viewer["reason"])
        page = self.path("report.html")
        window = self.browser(user=user, width=1180, height=1850)
        window.open(page)
        window.wait_for(DRAWN)
        self.assertEqual(window.run("return document.images.length"), len(self.report["instances"]) - 1)
        self.assertTrue(window.run("return Array.from(document.images).every((i) => i.complete && i.naturalWidth > 0)"))
        self.assert_numbers(window)
        if SCREENSHOT and user is None:
            with open(SCREENSHOT, "wb") as file:
                file.write(browser.smaller(window.picture()))

        width, _, before = browser.pixels_of(window.picture("#viewer canvas"))
        background = before[5][5]
        for half in (slice(0, width // 2), slice(width // 2, width)):  # input and output
            self.assertGreater(shown([row[half] for row in before], background), 0.05)
        self.assertGreater(len({pixel for row in before for pixel in row}), 50)  # shaded
        window.drag("#viewer canvas", 150, 40)
        time.sleep(0.5)
        _, _, after = browser.pixels_of(window.picture("#viewer canvas"))
        changed = sum(a != b for first, second in zip(before, after) for a, b in zip(first, second))
        self.assertGreater(changed, 0.02 * width * len(before))

        frames = window.run("return document.getElementById('viewer').dataset.frames")
        time.sleep(1)
        self.assertEqual(window.run("return document.getElementById('viewer').dataset.frames"), frames)  # idle
        self.assert_quiet(window, page)

    def test_as_this_user(self):
        self.check_3d(None)

    @unittest.skipUnless(os.getuid() == 0, "only root can be another user")
    def test_as_an_ordinary_user(self):
        self.check_3d("nobody")

    def test_as_narrow_as_a_telephone(self):
        window = self.browser()
        window.narrow_to(400, 800)
        window.open(self.path("report.html"))
        self.assertEqual(window.run("return [innerWidth, document.documentElement.scrollWidth]"), [400, 400])
        self.assert_quiet(window, self.path("report.html"))

    def test_without_the_3d_view(self):
        page = self.path("plain.html")
        subprocess.run([WITHOUT_VIEWER, self.path("out/compare.json"), page], check=True)
        window = self.browser()
        window.open(page)
        self.assertIn("built without it (this is a test)",
                      window.run("return document.getElementById('no-viewer').textContent"))
        self.assertEqual(window.run("return document.querySelectorAll('canvas, script:not([type])').length"), 0)
        self.assert_numbers(window)
        self.assert_quiet(window, page)


if __name__ == "__main__":
    unittest.main()
