"""`cellocut render`, and `cellocut evaluate --images`: what the pictures hold, and what is refused."""
import filecmp
import json
import os
import struct
import subprocess
import sys
import unittest
import zlib

from program import ProgramCase, box, join, obj_text, sphere

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data")
NETWORKS = os.path.join(DATA, "networks")
VIEWS = ["posx", "negx", "posy", "negy", "posz", "negz"]
SMALL = ("--resolution", "44", "--antialiasing", "1")
SMALL_IMAGES = ("--samples", "200", "--volume-points", "0", "--image-resolution", "44",
                "--image-antialiasing", "1")


def paeth(left, above, corner):
    """PNG's predictor (https://www.w3.org/TR/png/, section 9.4)."""
    guess = left + above - corner
    return min((left, above, corner), key=lambda value: abs(guess - value))


def png_pixels(content):
    """Width, bits of a component, and the rows' components."""
    assert content[:8] == b"\x89PNG\r\n\x1a\n"
    at, data = 8, b""
    while at < len(content):
        size, kind = struct.unpack(">I4s", content[at:at + 8])
        if kind == b"IHDR":
            width, height, bits, colour = struct.unpack(">IIBB", content[at + 8:at + 18])
        if kind == b"IDAT":
            data += content[at + 8:at + 8 + size]
        at += size + 12
    raw = zlib.decompress(data)
    step = {0: 1, 2: 3}[colour] * bits // 8
    stride = width * step
    rows, above = [], bytes(stride)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            left, corner = (line[x - step], above[x - step]) if x >= step else (0, 0)
            line[x] = line[x] + (0, left, above[x], (left + above[x]) // 2,
                                 paeth(left, above[x], corner))[kind] & 255
        above = bytes(line)
        rows.append(struct.unpack(">%d%s" % (stride * 8 // bits, "H" if bits == 16 else "B"), above))
    return width, bits, rows


class Render(ProgramCase):
    def setUp(self):
        super().setUp()
        self.put("box.obj", obj_text(box((0.0, 0.0, 0.0), (4.0, 2.0, 4.0))))

    def pixels(self, name):
        return png_pixels(self.get(name))

    def test_six_views_of_a_box(self):
        run = self.succeed("render", "box.obj", "-o", "new/pictures", "--depth", "--normals", *SMALL)
        names = ["%s%s.png" % (view, kind) for view in VIEWS for kind in ("", "_depth", "_normal")]
        self.assertEqual(run.stdout.decode().split(), ["new/pictures/" + name for name in names])
        self.assertEqual(sorted(os.listdir(self.path("new/pictures"))), sorted(names))
        for view in VIEWS:
            # 40 of 44 pixels for the longest edge; half as many for the box's height.
            rows = 40 if view.endswith("y") else 20
            width, bits, depth = self.pixels("new/pictures/%s_depth.png" % view)
            self.assertEqual((width, bits, len(depth)), (44, 16, 44))
            seen = [value for row in depth for value in row if value]
            self.assertEqual(len(seen), 40 * rows)
            # The face is half of 4 before the centre, from above half of 2: 1/2 and 1/4 of the unit.
            level = 1 + round(65534 * (0.375 if view.endswith("y") else 0.25))
            self.assertLessEqual({abs(value - level) for value in seen}, {0, 1})
            _, bits, normals = self.pixels("new/pictures/%s_normal.png" % view)
            self.assertEqual(bits, 8)
            self.assertEqual(normals[22][66:69], (128, 128, 255))
            self.assertEqual(normals[0][:3], (0, 0, 0))
            _, _, clay = self.pixels("new/pictures/%s.png" % view)
            self.assertEqual(clay[0][:3], (255, 255, 255))
            self.assertNotEqual(clay[22][66:69], (255, 255, 255))

    def test_the_same_camera_for_two_meshes(self):
        self.put("half.obj", obj_text(box((0.0, 0.0, 0.0), (2.0, 1.0, 2.0))))
        run = self.succeed("render", "half.obj", "-o", "a", "--reference", "box.obj", "--depth", "--json", "-", *SMALL)
        report = json.loads(run.stdout)
        self.assertEqual(report["frame"], {"centre": [2.0, 1.0, 2.0], "unit": 4.0})
        self.assertEqual([view["name"] for view in report["views"]], VIEWS)
        self.assertEqual(report["views"][4]["towards_viewer"], [0.0, 0.0, 1.0])
        self.assertEqual(report["views"][4]["depth"], "a/posz_depth.png")
        self.assertIsNone(report["views"][4]["normals"])
        _, _, depth = self.pixels("a/posz_depth.png")
        covered = [(x, y) for y, row in enumerate(depth) for x, value in enumerate(row) if value]
        self.assertEqual((min(covered), max(covered), len(covered)), ((2, 22), (21, 31), 200))

    def test_options_change_the_picture(self):
        # The nearest face of the box fills its part of the picture with and without perspective.
        self.put("two.obj", obj_text(join(box((0.0, 0.0, 0.0), (1.0, 4.0, 4.0)), box((2.0, 0.0, 0.0), (4.0, 1.0, 2.0)))))
        seen = set()
        for more in ((), ("--up", "z"), ("--perspective", "40"), ("--perspective", "0")):
            self.succeed("render", "two.obj", "-o", "p", "--quiet", *SMALL, *more)
            seen.add(self.get("p/posx.png"))
        self.assertEqual(len(seen), 3)

    def test_same_bytes_for_any_number_of_threads(self):
        self.put("ball.obj", obj_text(sphere(9)))
        for threads in ("1", "2", "8"):
            self.succeed("render", "ball.obj", "-o", threads, "--depth", "--normals", "--resolution", "64",
                         "--threads", threads)
        for other in ("2", "8"):
            names = os.listdir(self.path("1"))
            self.assertEqual(len(names), 18)
            self.assertEqual(filecmp.cmpfiles(self.path("1"), self.path(other), names, False)[0], names)

    def test_standard_input_and_quiet(self):
        run = self.succeed("render", "-", "--format", "obj", "-o", "p", "--quiet", *SMALL, input=self.get("box.obj"))
        self.assertEqual(run.stdout, b"")
        self.assertEqual(len(os.listdir(self.path("p"))), 6)

    def refuse(self, code, pattern, *arguments):
        os.makedirs(self.path("p"), exist_ok=True)
        outputs = tuple("p/%s.png" % view for view in VIEWS)
        self.fail_with(code, r"\Acellocut: " + pattern, "render", *arguments, "-o", "p", outputs=outputs)

    def test_wrong_files(self):
        self.put("flat.obj", obj_text(([(1.0, 1.0, 1.0)] * 3, [(0, 1, 2)])))
        self.put("far.obj", obj_text(box((1e9, 0.0, 0.0), (2e9, 1.0, 1.0))))
        self.put("huge.obj", obj_text(box((-1.7e308, 0.0, 0.0), (1.7e308, 1.0, 1.0))))
        self.put("cut.stl", b"\0" * 84 + b"\1")
        self.refuse(3, r"missing\.obj: cannot open", "missing.obj")
        self.refuse(3, r"p: is a directory", "p")
        self.refuse(3, r"cut\.stl: ", "cut.stl")
        self.refuse(3, r"flat\.obj: the mesh has no extent", "flat.obj")
        self.refuse(3, r"flat\.obj: the mesh has no extent", "box.obj", "--reference", "flat.obj")
        self.refuse(3, r"missing\.ply: cannot open", "box.obj", "--reference", "missing.ply")
        self.refuse(3, r"far\.obj: the mesh is over a million times larger", "far.obj", "--reference", "box.obj")
        self.refuse(3, r"huge\.obj: the coordinates are too large", "huge.obj")

    def test_wrong_arguments(self):
        self.refuse(2, "the resolution of pictures must be 16 to 4096", "box.obj", "--resolution", "8")
        self.refuse(2, "perspective must be an angle", "box.obj", "--perspective", "180")
        self.refuse(2, "antialiasing must be 1 to 8", "box.obj", "--antialiasing", "0")
        self.refuse(2, "'x': the axis that points up is y or z", "box.obj", "--up", "x")
        run = self.run_program("render", "box.obj")
        self.assert_one_line(run, 2, "--output is required")
        self.put("file", b"")
        self.assert_one_line(self.run_program("render", "box.obj", "-o", "file"), 2, "file: ")
        self.refuse(2, "p/posx.png: two outputs cannot be the same file", "box.obj", "--json", "p/posx.png")

    def test_full_disk(self):
        os.makedirs(self.path("p"))
        self.put("p/posx.png", b"old")
        run = self.run_program("render", "box.obj", "-o", "p", *SMALL,
                               env=self.shimmed(CELLOCUT_TEST_WRITE_LIMIT="20"))
        self.assert_one_line(run, 6, r"\Acellocut: p/posx\.png: cannot write: No space left")
        self.assertEqual(os.listdir(self.path("p")), ["posx.png"])
        self.assertEqual(self.get("p/posx.png"), b"old")


class EvaluateImages(ProgramCase):
    def setUp(self):
        super().setUp()
        self.put("cube.obj", obj_text(box((0.0, 0.0, 0.0), (8.0, 8.0, 8.0))))
        self.put("low.obj", obj_text(box((0.0, 0.0, 0.0), (8.0, 4.0, 8.0))))

    def report(self, *arguments):
        run = self.succeed("evaluate", *arguments, "--images", *SMALL_IMAGES, "--json", "-")
        return json.loads(run.stdout)

    def test_a_box_half_as_tall(self):
        report = self.report("low.obj", "--reference", "cube.obj")
        images = report["meshes"][0]["images"]
        views = {view["name"]: view for view in images["views"]}
        self.assertEqual(list(views), VIEWS)
        for view in VIEWS:
            self.assertAlmostEqual(views[view]["silhouette_iou"], 1 if view.endswith("y") else 0.5)
            self.assertAlmostEqual(views[view]["depth_error"], 0.5 if view == "posy" else 0, delta=1e-6)
            self.assertAlmostEqual(views[view]["normal_error"], 0, delta=1e-4)
        self.assertAlmostEqual(images["mean"]["silhouette_iou"], 4 / 6)
        self.assertAlmostEqual(images["mean"]["depth_error"], 0.5 / 6, delta=1e-6)
        self.assertTrue(0 < images["mean"]["ms_ssim"] < 1)
        self.assertEqual(images["ms_ssim_scales"], 3)
        for key in ("lpips", "clip"):
            self.assertIsNone(images["mean"][key])
        self.assertIsNone(images["fid"])
        parameters = report["parameters"]["images"]
        self.assertEqual((parameters["resolution"], parameters["up"]), (44, "y"))
        self.assertEqual(set(parameters["empty"]), {"lpips", "fid", "clip"})

    def test_without_networks_it_says_so(self):
        text = self.succeed("evaluate", "low.obj", "--reference", "cube.obj", "--images",
                            *SMALL_IMAGES).stdout.decode()
        for name in ("LPIPS", "FID", "CLIP"):
            self.assertRegex(text, r"(?m)^%s is left empty: " % name)
        self.assertRegex(text, r"(?m)^low\.obj +0\.6667 +0\.08333 +[0-9.e-]+ +0\.[0-9]+ +- +- +-$")

    def test_without_images_nothing_is_drawn(self):
        run = self.succeed("evaluate", "low.obj", "--reference", "cube.obj", "--samples", "100", "--json", "-")
        report = json.loads(run.stdout)
        self.assertIsNone(report["parameters"]["images"])
        self.assertNotIn("images", report["meshes"][0])

    def test_a_reference_of_points_has_no_pictures(self):
        self.put("p.ply", "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\n"
                          "property double z\nend_header\n0 0 0\n8 8 8\n")
        self.assertIsNone(self.report("low.obj", "--reference", "p.ply")["meshes"][0]["images"])

    def test_wrong_arguments(self):
        good = ("low.obj", "--reference", "cube.obj", "--samples", "100", "--json", "out.json")
        self.fail_with(2, "--fid requires --images", "evaluate", *good, "--fid", "n.onnx", outputs=("out.json",))
        self.fail_with(2, "--lpips-weights requires", "evaluate", *good, "--images", "--lpips-weights", "w.txt",
                       outputs=("out.json",))
        self.fail_with(2, "16 to 4096", "evaluate", *good, "--images", "--image-resolution", "2", outputs=("out.json",))


class EvaluateNetworks(ProgramCase):
    """Only in a build with OpenCV. tests/data/make_networks.py says what the networks compute."""

    def setUp(self):
        super().setUp()
        self.put("cube.obj", obj_text(box((0.0, 0.0, 0.0), (8.0, 8.0, 8.0))))
        self.put("low.obj", obj_text(box((0.0, 0.0, 0.0), (8.0, 4.0, 8.0))))
        for name in os.listdir(NETWORKS):
            with open(os.path.join(NETWORKS, name), "rb") as file:
                self.put(name, file.read())
        self.put("weights.txt", "# layers\n1 2\n0,0,0.5\n")
        self.put("mean_colour.json", '{"size": 4, "mean": [0, 0, 0], "std": [1, 1, 1]}')

    def arguments(self):
        return ("--images", *SMALL_IMAGES, "--lpips", "two_layers.onnx", "--lpips-weights", "weights.txt",
                "--fid", "mean_colour.onnx", "--clip", "mean_colour.onnx")

    def report(self, *arguments):
        return json.loads(self.succeed("evaluate", *arguments, *self.arguments(), "--json", "-").stdout)

    def mean_colours(self, mesh):
        """The embedding of each picture, from the pictures of `cellocut render`."""
        self.succeed("render", mesh, "--reference", "cube.obj", "-o", "p", "--quiet", *SMALL)
        result = []
        for view in VIEWS:
            width, _, rows = png_pixels(self.get("p/%s.png" % view))
            result.append([sum(sum(row[c::3]) for row in rows) / 255 / width ** 2 for c in range(3)])
        return result

    def test_a_mesh_is_like_itself(self):
        images = self.report("cube.obj", "--reference", "cube.obj")["meshes"][0]["images"]
        self.assertEqual(images["mean"]["lpips"], 0)
        self.assertAlmostEqual(images["mean"]["clip"], 100, delta=1e-6)
        self.assertAlmostEqual(images["fid"]["value"], 0, delta=1e-9)

    def test_clip_from_the_pictures_themselves(self):
        images = self.report("low.obj", "--reference", "cube.obj")["meshes"][0]["images"]
        for view, a, b in zip(images["views"], self.mean_colours("low.obj"), self.mean_colours("cube.obj")):
            dot, aa, bb = (sum(x * y for x, y in zip(p, q)) for p, q in ((a, b), (a, a), (b, b)))
            self.assertAlmostEqual(view["clip"], 100 * dot / (aa * bb) ** 0.5, delta=1e-3)
        self.assertGreater(images["mean"]["lpips"], 0)
        self.assertEqual((images["fid"]["samples"], images["fid"]["dimensions"]), (6, 3))
        self.assertIsNone(images["fid"]["warning"])

    def test_fid_over_all_pairs(self):
        self.put("pairs.csv", "mesh,reference\nlow.obj,cube.obj\ncube.obj,cube.obj\nmissing.obj,cube.obj\n")
        run = self.run_program("evaluate", "--pairs", "pairs.csv", *self.arguments(), "--json", "r.json")
        self.assertEqual(run.returncode, 3, run.stderr)
        self.assertRegex(run.stdout.decode(), r"(?m)^FID [0-9.e-]+ over 12 pictures each$")
        report = json.loads(self.get("r.json"))
        self.assertEqual((report["fid"]["samples"], report["fid"]["dimensions"]), (12, 3))
        alone = report["pairs"][0]["evaluation"]["meshes"][0]["images"]["fid"]["value"]
        self.assertTrue(0 < report["fid"]["value"] < alone)

    def test_fewer_samples_than_dimensions_are_a_warning(self):
        self.put("first.onnx", self.get("two_layers.onnx"))
        self.put("first.json", '{"size": 8, "outputs": ["second"]}')
        run = self.succeed("evaluate", "low.obj", "--reference", "cube.obj", "--images", *SMALL_IMAGES,
                           "--fid", "first.onnx", "--json", "r.json")
        self.assertNotIn(b"fewer than", run.stdout)  # six samples, three dimensions
        self.assertEqual(json.loads(self.get("r.json"))["meshes"][0]["images"]["fid"]["dimensions"], 3)
        self.put("pixels.json", '{"size": 4}')
        run = self.succeed("evaluate", "low.obj", "--reference", "cube.obj", "--images", *SMALL_IMAGES,
                           "--fid", "pixels.onnx", "--json", "r.json")
        self.assertIn(b"6 samples are fewer than 48 dimensions", run.stdout)
        fid = json.loads(self.get("r.json"))["meshes"][0]["images"]["fid"]
        self.assertIn("fewer than 48", fid["warning"])

    def test_lpips_without_weights_says_so(self):
        run = self.succeed("evaluate", "low.obj", "--reference", "cube.obj", "--images", *SMALL_IMAGES,
                           "--lpips", "two_layers.onnx")
        self.assertIn(b"LPIPS is left empty: no layer weights are given", run.stdout)

    def test_same_bytes_for_any_number_of_threads(self):
        seen = {self.succeed("evaluate", "low.obj", "--reference", "cube.obj", *self.arguments(), "--threads",
                             threads, "--json", "-").stdout for threads in ("1", "2", "8")}
        self.assertEqual(len(seen), 1)

    def refuse(self, pattern, *arguments, code=3):
        self.fail_with(code, r"\Acellocut: " + pattern, "evaluate", "low.obj", "--reference", "cube.obj", "--images",
                       *SMALL_IMAGES, *arguments, "--json", "out.json", outputs=("out.json",))

    def test_wrong_networks(self):
        self.put("text.onnx", b"no network\n")
        self.put("cut.onnx", self.get("two_layers.onnx")[:200])
        self.refuse(r"text\.onnx: cannot be read as a network", "--clip", "text.onnx")
        self.refuse(r"cut\.onnx: ", "--clip", "cut.onnx")
        self.refuse(r"missing\.onnx: ", "--fid", "missing.onnx")
        self.refuse(r"two_layers\.onnx: has several outputs", "--fid", "two_layers.onnx")

    def test_wrong_settings(self):
        for text, what in (("{", "is no JSON"), ("[]", "is no JSON object"), ('{"sice": 3}', "unknown key 'sice'"),
                           ('{"size": -1}', "size must be 0 to"), ('{"size": 1.5}', "size must be a whole"),
                           ('{"mean": [1, 2]}', "wrong values"), ('{"std": [0, 1, 1]}', "std must be"),
                           ('{"order": "hsv"}', "order must be"), ("", "empty")):
            with self.subTest(text):
                self.put("mean_colour.json", text)
                self.refuse(r"mean_colour\.json: .*" + what, "--clip", "mean_colour.onnx")
        self.put("mean_colour.json", '{"outputs": ["none"]}')
        self.refuse(r"mean_colour\.onnx: no output 'none'; there are: embedding", "--clip", "mean_colour.onnx")

    def test_wrong_weights(self):
        lpips = ("--lpips", "two_layers.onnx", "--lpips-weights", "weights.txt")
        for text, what in (("", "empty"), ("# none\n", "no weights"), ("1 2\n1 x 3\n", "line 2: 'x' is no number"),
                           ("1 nan\n", "line 1: 'nan' is no number")):
            with self.subTest(text):
                self.put("weights.txt", text)
                self.refuse(r"weights\.txt: .*" + what, *lpips)
        self.put("weights.txt", "1 2\n")
        self.refuse(r".*weights for 1 layers, but the network has 2 outputs", *lpips)
        self.put("weights.txt", "1 2 3\n1 2 3\n")
        self.refuse(r".*3 weights for layer 1, which has 2 channels", *lpips)

    def test_the_networks_are_what_their_script_writes(self):
        os.makedirs(self.path("again"))
        subprocess.run([sys.executable, os.path.join(DATA, "make_networks.py"), self.path("again")], check=True)
        names = sorted(os.listdir(NETWORKS))
        self.assertEqual(sorted(os.listdir(self.path("again"))), names)
        self.assertEqual(filecmp.cmpfiles(self.path("again"), NETWORKS, names, False)[0], names)


if __name__ == "__main__":
    unittest.main()
