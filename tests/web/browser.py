"""Headless Chromium over WebDriver (chromedriver), by the standard library alone."""
import base64
import collections
import json
import os
import pwd
import re
import shutil
import struct
import subprocess
import tempfile
import time
import urllib.error
import urllib.request
import zlib

CHROMIUM = shutil.which("chromium")
CHROMEDRIVER = shutil.which("chromedriver")
AVAILABLE = CHROMIUM is not None and CHROMEDRIVER is not None
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # the key of the standard


class Browser:
    """A browser with a window of its own, as the current user or as another one (for root alone)."""

    def __init__(self, width=1200, height=1600, user=None, dark=False):
        self.folder = tempfile.mkdtemp(prefix="cellocut-browser-")
        environment = {"PATH": os.environ["PATH"], "HOME": self.folder, "TMPDIR": self.folder, "LANG": "C.UTF-8"}
        identity = {}
        if user is not None:
            entry = pwd.getpwnam(user)
            os.chown(self.folder, entry.pw_uid, entry.pw_gid)
            identity = {"user": entry.pw_uid, "group": entry.pw_gid, "extra_groups": []}
        self.log = open(os.path.join(self.folder, "driver.log"), "w+b")  # pylint: disable=consider-using-with
        self.driver = subprocess.Popen(  # pylint: disable=consider-using-with
            [CHROMEDRIVER, "--port=0"], cwd=self.folder, env=environment, stdin=subprocess.DEVNULL,
            stdout=self.log, stderr=subprocess.STDOUT, start_new_session=True, **identity)
        self.session = None
        try:
            self.address = f"http://127.0.0.1:{self.port()}"
            arguments = ["--headless=new", "--no-first-run", "--disable-dev-shm-usage", "--hide-scrollbars",
                         "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                         f"--window-size={width},{height}", f"--user-data-dir={self.folder}/profile"]
            # Root has no sandbox, and neither has who may make no namespaces of users, as in a container.
            if user is None and os.getuid() == 0 or not may_make_namespaces(identity):
                arguments.append("--no-sandbox")
            if dark:
                arguments.append("--force-dark-mode")
            answer = self.call("POST", "/session", {"capabilities": {"alwaysMatch": {
                "browserName": "chrome",
                "goog:chromeOptions": {"binary": CHROMIUM, "args": arguments},
                "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}}})
            self.session = answer["sessionId"]
        except Exception:
            self.close()
            raise

    def port(self):
        for _ in range(200):
            with open(self.log.name, encoding="utf-8") as file:
                found = re.search(r"started successfully on port (\d+)", file.read())
            if found:
                return int(found.group(1))
            if self.driver.poll() is not None:
                break
            time.sleep(0.05)
        raise RuntimeError("chromedriver does not start")

    def call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.address + path, data, {"Content-Type": "application/json"}, method=method)
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        try:
            with opener.open(request, timeout=90) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(error.read().decode()[:2000]) from None

    def do(self, method, path, body=None):
        return self.call(method, f"/session/{self.session}{path}", body)

    def open(self, path):
        """Opens a file; console() and requests() tell what happened from here on."""
        self.do("POST", "/url", {"url": "about:blank"})  # instead of the page for new tabs, which asks for much
        self.requests()
        self.console()
        self.do("POST", "/url", {"url": "file://" + path})

    def narrow_to(self, width, height):
        """Narrower than a window can be."""
        self.do("POST", "/goog/cdp/execute", {"cmd": "Emulation.setDeviceMetricsOverride", "params": {
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}})

    def run(self, script, *arguments):
        return self.do("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def find(self, selector):
        return self.do("POST", "/element", {"using": "css selector", "value": selector})[ELEMENT]

    def wait_for(self, script, seconds=30):
        end = time.monotonic() + seconds
        while not self.run("return " + script):
            if time.monotonic() > end:
                raise AssertionError(f"not within {seconds} s: {script}")
            time.sleep(0.1)

    def picture(self, selector=None):
        """PNG bytes of an element, or of what the window shows."""
        place = f"/element/{self.find(selector)}/screenshot" if selector else "/screenshot"
        return base64.b64decode(self.do("GET", place))

    def drag(self, selector, dx, dy):
        origin = {ELEMENT: self.find(selector)}
        move = {"type": "pointerMove", "duration": 100}
        self.do("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": [
            {**move, "origin": origin, "x": 0, "y": 0}, {"type": "pointerDown", "button": 0},
            {**move, "origin": origin, "x": dx, "y": dy}, {"type": "pointerUp", "button": 0}]}]})

    def console(self):
        return self.do("POST", "/se/log", {"type": "browser"})

    def requests(self):
        """Addresses that the page asked for since the last call."""
        asked = []
        for entry in self.do("POST", "/se/log", {"type": "performance"}):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                asked.append(message["params"]["request"]["url"])
            elif message["method"] == "Network.webSocketCreated":
                asked.append(message["params"]["url"])
        return asked

    def close(self):
        if self.session is not None:
            self.call("DELETE", f"/session/{self.session}")
        self.driver.terminate()
        try:
            self.driver.wait(20)
        except subprocess.TimeoutExpired:
            self.driver.kill()
            self.driver.wait()
        self.log.close()
        shutil.rmtree(self.folder, ignore_errors=True)


def may_make_namespaces(identity):
    run = subprocess.run(["unshare", "--user", "--pid", "--fork", "true"], stdin=subprocess.DEVNULL,
                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False, **identity)
    return run.returncode == 0


def pixels_of(png):
    """Width, height and rows of (red, green, blue) of a PNG with 8 bits, RGB or RGBA, not interlaced."""
    place, packed, head = 8, b"", None
    while place < len(png):
        size, = struct.unpack(">I", png[place:place + 4])
        kind, body = png[place + 4:place + 8], png[place + 8:place + 8 + size]
        if kind == b"IHDR":
            head = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        place += 12 + size
    width, height, depth, colour, _, _, interlaced = head
    assert depth == 8 and colour in (2, 6) and not interlaced
    step = 3 if colour == 2 else 4
    data, last, rows = zlib.decompress(packed), bytearray(width * step), []
    for y in range(height):
        start = y * (width * step + 1)
        kind, row = data[start], bytearray(data[start + 1:start + 1 + width * step])
        for i, value in enumerate(row if kind else b""):
            left = row[i - step] if i >= step else 0
            above, corner = last[i], last[i - step] if i >= step else 0
            if kind == 1:
                guess = left
            elif kind == 2:
                guess = above
            elif kind == 3:
                guess = (left + above) // 2
            else:
                guess = min((abs(above - corner), 0, left), (abs(left - corner), 1, above),
                            (abs(left + above - 2 * corner), 2, corner))[2]
            row[i] = (value + guess) & 255
        rows.append([tuple(row[i:i + 3]) for i in range(0, width * step, step)])
        last = row
    return width, height, rows


def smaller(png):
    """The same picture with a palette: the 256 colours that it has most, and one close to it for any other."""
    width, height, rows = pixels_of(png)
    counts = collections.Counter(pixel for row in rows for pixel in row)
    palette = [colour for colour, _ in counts.most_common(256)]
    place = {colour: number for number, colour in enumerate(palette)}
    nearest = {}  # of colours that are alike
    for colour in counts:
        if colour in place:
            continue
        alike = tuple(value >> 3 for value in colour)
        if alike not in nearest:
            nearest[alike] = min(range(len(palette)),
                                 key=lambda k, c=colour: sum((a - b) ** 2 for a, b in zip(palette[k], c)))
        place[colour] = nearest[alike]

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    data = b"".join(b"\0" + bytes(place[pixel] for pixel in row) for row in rows)
    return (png[:8] + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)) +
            chunk(b"PLTE", b"".join(bytes(colour) for colour in palette)) +
            chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b""))
