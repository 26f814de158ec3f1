"""Headless Chromium, driven through a pipe as DevTools speaks it: loads a page and inspects it.

What it logs, what it throws and what it asks any network for is in `complaints` and `requests`.
"""
import json
import os
import select
import shutil
import subprocess
import tempfile
import time


def find():
    """The browser, $CRADLE_CHROMIUM first, or None."""
    names = (os.environ.get("CRADLE_CHROMIUM", ""), "chromium", "chromium-browser", "google-chrome", "chrome")
    return next(filter(None, map(shutil.which, names)), None)


class Browser:
    """Use it in `with`. hidden: no frame is drawn, which takes half the time; the mouse and printing need frames."""

    def __init__(self, hidden=False):
        self.folder = tempfile.mkdtemp()
        ours_read, theirs_write = os.pipe()
        theirs_read, ours_write = os.pipe()
        # Chromium reads from 3 and writes to 4.
        self.process = subprocess.Popen(
            ["bash", "-c", f'exec "$0" "$@" 3<&{theirs_read} 4>&{theirs_write}', find(), "--headless", "--no-sandbox",
             "--disable-gpu", "--hide-scrollbars", "--disable-dev-shm-usage", "--disable-background-networking",
             "--disable-back-forward-cache", "--renderer-process-limit=1",  # else each page has a process of its own
             "--no-first-run", "--remote-debugging-pipe", f"--user-data-dir={self.folder}", "about:blank"],
            pass_fds=(theirs_read, theirs_write), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        os.close(theirs_read), os.close(theirs_write)
        self.reading, self.writing = os.fdopen(ours_read, "rb"), os.fdopen(ours_write, "wb")
        self.number, self.left, self.session = 0, b"", None
        self.complaints, self.requests, self.seen = [], [], []
        target = self.call("Target.createTarget", url="about:blank", hidden=hidden)["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.call(f"{domain}.enable")
        self.resize()

    def resize(self, width=1100, height=900, ratio=1):
        """The size of the window in pixels, and those of the screen in each of them."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=ratio,
                  mobile=False)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        self.reading.close(), self.writing.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def message(self):
        while b"\0" not in self.left:
            if not select.select([self.reading], [], [], 120)[0]:
                raise TimeoutError("no answer from the browser in two minutes")
            piece = os.read(self.reading.fileno(), 1 << 20)
            if not piece:
                raise RuntimeError("the browser has ended")
            self.left += piece
        text, self.left = self.left.split(b"\0", 1)
        return json.loads(text)

    def call(self, method, **parameters):
        self.number += 1
        request = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            request["sessionId"] = self.session
        self.writing.write(json.dumps(request).encode() + b"\0")
        self.writing.flush()
        while True:
            answer = self.message()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.note(answer)

    def note(self, event):
        method, about = event.get("method"), event.get("params", {})
        self.seen.append(method)
        if method in ("Runtime.exceptionThrown", "Log.entryAdded", "Runtime.consoleAPICalled"):
            self.complaints.append(json.dumps(about)[:500])
        elif method == "Network.requestWillBeSent":
            self.requests.append(about["request"]["url"][:200])

    def outside(self):
        """What it has asked any network for."""
        return [url for url in self.requests if not url.startswith(("file:", "about:", "blob:", "data:"))]

    def emulate(self, scheme="light", media="", afresh=True):
        """scheme: light or dark; media: "print" or as on a screen; afresh: forgets what was logged and asked for."""
        if afresh:
            self.complaints.clear(), self.requests.clear()
        self.call("Emulation.setEmulatedMedia", media=media,
                  features=[{"name": "prefers-color-scheme", "value": scheme}])

    def load(self, place):
        """Opens a file from the disk, or an address of a server, and waits until it is whole."""
        self.seen.clear()
        self.call("Page.navigate", url=place if str(place).startswith("http:") else "file://" + os.path.abspath(place))
        while "Page.loadEventFired" not in self.seen:
            self.note(self.message())

    def evaluate(self, expression):
        """The value of a JavaScript expression in the page; promises are waited for."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{expression}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def until(self, condition, seconds=500):  # before CTest ends the test
        """The value of an expression once it is true, or not empty."""
        end = time.monotonic() + seconds
        while not (value := self.evaluate(condition)):
            if time.monotonic() > end:
                raise TimeoutError(f"never came true: {condition}")
            time.sleep(0.05)
        return value
