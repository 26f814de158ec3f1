"""The manual as a site: it is built without a warning, its links lead somewhere, it asks no network for anything, and
a reader finds words with its search, from a disk and from a server, on a telephone too. Skipped without MkDocs."""
import functools
import http.server
import os
import re
import shutil
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import browser
import small

SETTINGS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tools", "manual", "mkdocs.yml")
PACKAGES = "Debian: mkdocs-material mkdocstrings-python-handlers"
LACKING = ("Unrecognised theme", "Unrecognized theme", "plugin is not installed")
OUTSIDE = re.compile("https?:|mailto:|data:|//")

# Goes to the search field, types a word once the search is ready, and says what it has found so far.
# At once, letter by letter: the index is not there yet.
TYPE = """(() => {
  const field = document.querySelector('input[name=query]'), open = document.querySelector('[data-md-toggle=search]');
  if (!open.checked) open.click();
  field.focus();
  for (const letter of '%s') {
    field.value += letter;
    for (const event of ['input', 'keyup']) field.dispatchEvent(new Event(event, {bubbles: true}));
  }
})()"""
TYPE_AT_ONCE = """(() => {
  const letters = [...'%s'];
  const type = setInterval(() => {
    const field = document.querySelector('input[name=query]');
    if (!field) return;
    field.focus();
    field.value += letters.shift();
    for (const event of ['input', 'keyup']) field.dispatchEvent(new Event(event, {bubbles: true}));
    if (!letters.length) clearInterval(type);
  }, 100);
})()"""
FOUND = "Array.from(document.querySelectorAll('.md-search-result__link'), link => link.getAttribute('href'))"
WIDTH = """(() => {
  const still = document.createElement('style');
  still.textContent = '* { transition: none !important }';
  document.head.append(still);
  return document.documentElement.scrollWidth;
})()"""


def built(folder):
    """Builds the site; the reason where that is impossible here."""
    if not shutil.which("mkdocs"):
        return f"no MkDocs ({PACKAGES})"
    run = subprocess.run(["mkdocs", "build", "--strict", "-f", SETTINGS, "-d", folder], text=True, check=False,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if run.returncode == 0:
        return ""
    if any(text in run.stdout for text in LACKING):
        return f"MkDocs without its theme or a plugin ({PACKAGES})"
    raise AssertionError(run.stdout)


class SlowServer(http.server.SimpleHTTPRequestHandler):
    """The worker of the search comes so late that a reader has typed a word before."""

    def do_GET(self):
        if "/workers/" in self.path:
            time.sleep(2)
        super().do_GET()

    def log_message(self, *_):
        pass


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory())) / "site"
        cls.reason = built(cls.folder)
        cls.pages = {str(path.relative_to(cls.folder)): small.Page(small.read(path))
                     for path in cls.folder.rglob("*.html") if path.name != "404.html"}
        cls.reader = cls.enterClassContext(browser.Browser(hidden=True)) if browser.find() else None

    def setUp(self):
        if self.reason:
            self.skipTest(self.reason)
        if self.reader:
            self.reader.emulate()
            self.reader.resize()

    def test_has_the_pages(self):
        self.assertGreater(len(self.pages), 30)
        for name in ("index.html", "cradle.html", "how-to-trust.html", "core/index.html", "bench/results/speed.html"):
            self.assertIn(name, self.pages)

    def test_links_lead_somewhere(self):
        for name, page in self.pages.items():
            for link in filter(lambda link: not OUTSIDE.match(link), page.links + page.loads):
                path, _, part = link.partition("#")
                there = os.path.normpath(os.path.join(os.path.dirname(name), path)) if path else name
                with self.subTest(page=name, link=link):
                    self.assertTrue((self.folder / there).is_file())
                    if part and there in self.pages:
                        self.assertIn(part, self.pages[there].ids)

    def test_nothing_is_loaded_from_elsewhere(self):
        for name, page in self.pages.items():
            self.assertEqual([load for load in page.loads if OUTSIDE.match(load) and not load.startswith("data:")], [],
                             name)
        for path in self.folder.rglob("*.css"):
            self.assertNotRegex(small.read(path), r"url\(['\"]?(https?:)?//|@import", path)

    def test_the_package_is_documented(self):
        names = self.pages["python-functions.html"].ids
        for name in ("cradle.run", "cradle.open", "cradle.Simulation", "cradle.resume"):
            self.assertIn(name, names)
        page = small.read(self.folder / "python-functions.html")
        self.assertIn("<code>x</code>: positions in l, shape (n,)", page)

    @unittest.skipUnless(browser.find(), "no Chromium (Debian: chromium)")
    def test_reader_finds_words_from_a_disk(self):
        for width, scheme, colours in ((1200, "light", "default"), (390, "dark", "slate")):
            self.reader.resize(width)
            self.reader.emulate(scheme, afresh=False)
            self.reader.load(os.path.join(self.folder, "index.html"))
            self.reader.until(f"document.body.dataset.mdColorScheme === '{colours}'")
            for word, page in (("gap", "precision"), ("resume", "how-to-run"), ("collapse", "how-to-trust"),
                               ("digits", "how-to-trust")):
                self.reader.load(self.folder / "index.html")
                self.reader.evaluate(TYPE % word)
                self.assertIn(page, self.reader.until(FOUND + "[0]", 60), word)
        self.assertEqual(self.reader.complaints, [])
        self.assertEqual(self.reader.outside(), [])

    @unittest.skipUnless(browser.find(), "no Chromium (Debian: chromium)")
    def test_a_reader_who_types_before_the_page_is_whole_finds_it(self):
        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(SlowServer, directory=self.folder)
                                             ) as server:
            threading.Thread(target=server.serve_forever).start()
            self.addCleanup(server.shutdown)
            script = self.reader.call("Page.addScriptToEvaluateOnNewDocument", source=TYPE_AT_ONCE % "collapse")
            self.addCleanup(self.reader.call, "Page.removeScriptToEvaluateOnNewDocument", **script)
            self.reader.load(f"http://127.0.0.1:{server.server_port}/index.html")
            self.assertIn("how-to-trust", self.reader.until(FOUND + "[0]", 60))

    @unittest.skipUnless(browser.find(), "no Chromium (Debian: chromium)")
    def test_no_page_is_wider_than_the_window_or_a_telephone(self):
        for name in self.pages:
            self.reader.load(self.folder / name)
            for width in (1200, 390):
                self.reader.resize(width)
                with self.subTest(page=name, width=width):
                    self.assertLessEqual(self.reader.evaluate(WIDTH), width)
        self.assertEqual(self.reader.complaints, [])
