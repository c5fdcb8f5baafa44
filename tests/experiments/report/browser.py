"""A headless Chromium that is driven over WebDriver with nothing but the standard library."""

import base64
import json
import pathlib
import re
import shutil
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"
KEYS = {"left": "\ue012", "right": "\ue014", "shift": "\ue008", "space": " "}

ARGUMENTS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync",
    "--disable-background-networking", "--disable-component-update", "--disable-default-apps",
    "--hide-scrollbars", "--force-color-profile=srgb",
]


class Browser:
    """One browser with one empty profile. Use it in a with statement: it and its driver end there."""

    def __init__(self, width=1400, height=900):
        self.profile = tempfile.mkdtemp(prefix="flinch-browser-")
        self.driver = subprocess.Popen([shutil.which("chromedriver"), "--port=0"], text=True,
                                       stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.address = self._driver_address()
        self.session = None
        try:
            capabilities = {
                "browserName": "chrome",
                "goog:loggingPrefs": {"browser": "ALL"},
                "goog:chromeOptions": {"args": ARGUMENTS + [f"--user-data-dir={self.profile}",
                                                            f"--window-size={width},{height}"]},
            }
            answer = self._call("POST", "/session", {"capabilities": {"alwaysMatch": capabilities}})
            self.session = answer["sessionId"]
        except BaseException:
            self.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        if self.session:
            self._call("DELETE", f"/session/{self.session}")
        self.driver.terminate()
        self.driver.wait(timeout=20)
        self.driver.stdout.close()
        shutil.rmtree(self.profile, ignore_errors=True)

    def open(self, url):
        self._post("/url", {"url": url})

    def run(self, script, *arguments):
        """Runs JavaScript in the page; what it returns."""
        return self._post("/execute/sync", {"script": script, "args": list(arguments)})

    def press(self, *keys):
        """Presses keys one after the other on what has the focus; "shift+right" holds shift meanwhile."""
        actions = []
        for key in keys:
            parts = [KEYS.get(part, part) for part in key.split("+")]
            actions += [{"type": "keyDown", "value": part} for part in parts]
            actions += [{"type": "keyUp", "value": part} for part in reversed(parts)]
        self._post("/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": actions}]})

    def click(self, selector):
        found = self._post("/element", {"using": "css selector", "value": selector})
        self._post(f"/element/{found[ELEMENT]}/click", {})

    def drag(self, start, end):
        """Presses the mouse at `start` (x, y in the window), moves to `end` and lets go."""
        move = [{"type": "pointerMove", "x": round(x), "y": round(y), "duration": 50} for x, y in (start, end)]
        actions = [move[0], {"type": "pointerDown", "button": 0}, move[1], {"type": "pointerUp", "button": 0}]
        self._post("/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": actions}]})

    def hover(self, point):
        """Moves the mouse to `point` (x, y in the window)."""
        move = {"type": "pointerMove", "x": round(point[0]), "y": round(point[1]), "duration": 50}
        self._post("/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": [move]}]})

    def console_errors(self):
        """What the page has complained about since the last call."""
        log = self._post("/se/log", {"type": "browser"})
        return [entry["message"] for entry in log if entry["level"] == "SEVERE"]

    def devtools(self, command, **parameters):
        return self._post("/goog/cdp/execute", {"cmd": command, "params": parameters})

    def look(self, width, height, scheme):
        """As a reader sees it through a window of so many pixels, 'light' or 'dark'."""
        self.devtools("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        self.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self._call("GET", f"/session/{self.session}/screenshot")))

    def _driver_address(self):
        for line in self.driver.stdout:
            match = re.search(r"started successfully on port (\d+)", line)
            if match:
                return f"http://127.0.0.1:{match.group(1)}"
        raise RuntimeError("chromedriver did not start")

    def _post(self, path, body):
        return self._call("POST", f"/session/{self.session}{path}", body)

    def _call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.address + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=120) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from None


def until(browser, script, seconds=120.0):
    """What the script returns once that is something, before a machine that is far too slow would do it; else None."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = browser.run(script)
        if found:
            return found
        time.sleep(0.05)
    return None


def try_page(file, problems_of):
    """Opens a page and prints what problems_of(browser) yields, and what its console says; the exit status: 0, 1 with a
    problem, 77 where there is no chromedriver."""
    if not shutil.which("chromedriver"):
        print("there is no chromedriver (Debian: chromium-driver)")
        return 77
    with Browser() as browser:
        browser.open(pathlib.Path(file).resolve().as_uri())
        problems = list(problems_of(browser))
        problems += [f"the console says: {message}" for message in browser.console_errors()]
    for problem in problems:
        print(f"{file}: {problem}")
    return 1 if problems else 0
