"""Reports as a reader sees them, in headless Chromium: nothing thrown, nothing logged, nothing asked of any network;
tables sort; dark is dark, and print is dark on white."""
import base64
import re
import unittest

import browser
import cradle
import small

BRIGHTNESS = """(() => {
  const rgb = getComputedStyle(document.body).%s.match(/[\\d.]+/g).slice(0, 3).map(Number);
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
})()"""

SHOWN = """Array.from(document.querySelectorAll('figure > img'))
  .filter(image => getComputedStyle(image).display !== 'none').map(image => image.className)"""


@unittest.skipUnless(browser.find(), "no Chromium (Debian: chromium)")
class Reader(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = cls.enterClassContext(browser.Browser())

    def load(self, make, scheme="light", media=""):
        small.page(make)
        self.browser.complaints.clear()
        self.browser.requests.clear()
        self.browser.emulate(scheme, media)
        self.browser.load(f"{make.__name__}.html")

    def test_pages_load_without_a_word_and_without_a_request_and_fit_a_window_and_a_telephone(self):
        self.addCleanup(self.browser.resize)
        for scheme, width in (("light", 1200), ("dark", 390)):
            self.browser.resize(width)
            for make in small.ALL:
                self.load(make, scheme)
                self.assertEqual(self.browser.complaints, [], make.__name__)
                self.assertEqual(self.browser.outside(), [])
                files = [url for url in self.browser.requests if url.startswith("file://")]
                self.assertEqual(len(files), 1, "the page itself, and nothing beside it")
                self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), width,
                                     make.__name__)
                heights = self.browser.evaluate("Array.from(document.querySelectorAll('figure > img." + scheme
                                                + "'), picture => picture.getBoundingClientRect().height)")
                self.assertEqual(len(heights), len(cradle.plot.names(make())))
                self.assertGreater(min(heights), width / 6, make.__name__)

    def test_tables_sort_up_and_down(self):
        self.load(small.sweep)
        column = """(() => {
          const heads = Array.from(document.querySelectorAll('.sortable thead button'));
          const head = heads.find(button => button.textContent.startsWith('collisions'));
          head.click();
          const at = head.parentNode.cellIndex;
          return [head.parentNode.getAttribute('aria-sort'),
                  Array.from(document.querySelectorAll('.sortable tbody tr'), row => Number(row.cells[at].dataset.by))];
        })()"""
        direction, values = self.browser.evaluate(column)
        self.assertEqual((direction, values), ("ascending", sorted(values)))
        self.assertEqual(len(set(values)), 6)
        direction, again = self.browser.evaluate(column)
        self.assertEqual((direction, again), ("descending", values[::-1]))

    def test_dark_is_dark_and_print_is_light(self):
        self.load(small.shock, "light")
        self.assertGreater(self.browser.evaluate(BRIGHTNESS % "backgroundColor"), 240)
        self.load(small.shock, "dark")
        self.assertLess(self.browser.evaluate(BRIGHTNESS % "backgroundColor"), 40)
        self.assertGreater(self.browser.evaluate(BRIGHTNESS % "color"), 200)
        self.assertEqual(set(self.browser.evaluate(SHOWN)), {"dark"})
        self.load(small.shock, "dark", "print")
        self.assertGreater(self.browser.evaluate(BRIGHTNESS % "backgroundColor"), 240)
        self.assertEqual(set(self.browser.evaluate(SHOWN)), {"light"})

    def test_prints(self):
        self.load(small.sweep, "light")
        printed = self.browser.call("Page.printToPDF", preferCSSPageSize=True, printBackground=True)
        pdf = base64.b64decode(printed["data"])
        self.assertGreaterEqual(len(re.findall(rb"/Type /Page[\n ]|/Type/Page/", pdf)), 2, "pages")
        self.assertGreater(len(pdf), 20000)

    def test_the_scene_can_be_copied(self):
        self.load(small.shock)
        self.assertTrue(self.browser.evaluate("document.getElementById('scene').textContent").startswith("title = "))
        self.browser.evaluate("document.querySelector('button.copy').click()")
        self.assertIn("[law]", self.browser.evaluate("String(getSelection())"))
        self.assertEqual(self.browser.complaints, [])
