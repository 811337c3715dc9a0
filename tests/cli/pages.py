"""The page of compare, read as text; tests/web has how a browser shows it."""
import html.parser
import json
import re

from program import COARSE, HAS_VTU, OLD, ProgramCase
from problems import SMALL


class Elements(html.parser.HTMLParser):
    """The elements with their attributes, the cells with exact numbers by row, and the text of scripts."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.rows, self.scripts, self.text = [], [], {}, ""
        self.instance, self.script = None, None
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.elements.append((tag, attributes))
        if "data-instance" in attributes:
            self.instance = int(attributes["data-instance"])
        if tag == "tr" and "data-solver" in attributes:
            self.rows.append({"instance": self.instance, "solver": attributes["data-solver"]})
        if tag == "td" and self.rows and "data-key" in attributes:
            self.rows[-1].setdefault(attributes["data-key"], attributes["data-value"])
        self.script = attributes.get("id", "") if tag == "script" else None

    def handle_data(self, data):
        if self.script is None:
            self.text += data
        else:
            self.scripts[self.script] = self.scripts.get(self.script, "") + data
            self.script = None


class Page(ProgramCase):
    def compare(self, *arguments):
        self.succeed("compare", *arguments, "-o", "out", "--html", "page.html", "--repeat", "2", "--quiet", *COARSE)
        text = self.get("page.html").decode()
        return text, Elements(text), json.loads(self.get("out/compare.json"))

    def test_one_file_with_the_numbers_of_the_report(self):
        odd = "a<i>&amp;\"'</script>.max"
        name = odd.replace("/", "")  # a name, not a path
        self.put(name, SMALL)
        text, page, report = self.compare("holed.obj", name, "--solvers", "bk,ibfs,lp", "--backends", "cgal")
        self.assertEqual(json.loads(page.scripts["report"]), report)
        self.assertIn(name, page.text)
        self.assertNotIn("<i>&amp;\"", text)
        self.assertLess(len(text), 10_000_000)
        for tag, attributes in page.elements:
            self.assertNotIn(tag, ("iframe", "object", "embed", "base"))
            for key in ("src", "href"):
                self.assertRegex(attributes.get(key, "data:"), r"\Adata:", tag)
        self.assertNotRegex(text.split("<script")[0], r"@import|url\(")
        rows = iter(page.rows)
        for number, instance in enumerate(report["instances"]):
            for run in instance["runs"]:
                row = next(rows)
                self.assertEqual((row["instance"], row["solver"], row["status"]),
                                 (number, run["solver"], run["status"]))
                for key in ("value", "lower_bound", "gap", "bytes"):
                    self.assertEqual(int(row[key]), run[key])
                for key in ("build_seconds", "solve_seconds"):
                    self.assertEqual(float(row[key]), run[key]["median"])
                self.assertEqual("energy" in row, number == 0)
        self.assertEqual(next(rows, None), None)
        pictures = [attributes for tag, attributes in page.elements if tag == "img"]
        self.assertEqual(len(pictures), 1 if HAS_VTU else 0)
        self.assertEqual(report["instances"][0]["stages"][0]["name"], "field")
        self.assertEqual(report["parameters"]["resolution"], 16)

    def test_the_3d_view_is_there_where_list_says_so(self):
        listed = json.loads(self.succeed("list", "--json", "-").stdout)["report"][0]
        summary = self.succeed("list").stdout.decode()
        text, page, _ = self.compare("holed.obj", "--solvers", "bk", "--backends", "cgal")
        if listed["built"]:
            self.assertRegex(summary, r"3D view +three\.js r\d+, MIT\n")
            views = json.loads(page.scripts["meshes"])[0]["views"]
            self.assertEqual([view["title"] for view in views], ["Input", "Output of the cut"])
            self.assertIn("Permission is hereby granted", text)
        else:
            self.assertRegex(summary, r"3D view +not built in: .*; compare --html leaves it out\n")
            self.assertIn("this program was built without it", text)
            self.assertNotIn("meshes", page.scripts)

    def test_without_the_option_no_page_and_with_a_bad_path_no_work(self):
        self.put("small.max", SMALL)
        self.succeed("compare", "small.max", "-o", "out", "--solvers", "bk", "--quiet")
        self.assertEqual([name for name in self.names() if name.endswith(".html")], [])
        run = self.run_program("compare", "small.max", "-o", "other", "--html", "missing/page.html")
        self.assert_one_line(run, 2, r"missing/page\.html: cannot create")
        self.put("same", OLD)
        run = self.run_program("compare", "small.max", "-o", "out", "--html", "same", "--json", "same")
        self.assert_one_line(run, 2, "two outputs cannot be the same file")
        self.assertEqual(self.get("same"), OLD)

    def test_standard_output(self):
        self.put("small.max", SMALL)
        run = self.succeed("compare", "small.max", "-o", "out", "--solvers", "bk", "--html", "-")
        self.assertTrue(re.match(rb"<!DOCTYPE html>.*</html>\n\Z", run.stdout, re.DOTALL))
