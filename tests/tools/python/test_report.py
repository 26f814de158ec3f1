"""Reports: as texts whole, of one file, the same twice, with what they must show; and in headless Chromium."""
import base64
import html
import os
import re
import shlex
import subprocess
import types
import unittest
from unittest import mock

import browser
import cradle
import cradle.drawing.pictures
import small
from cradle import program
from cradle.errors import COLLAPSE, DIFFERS, DONE
from cradle.page.elements import enclosed, measured, number
from cradle.page.numbers import errors_may_grow
from small import read

BRIGHTNESS = """(() => {
  const rgb = getComputedStyle(document.body).%s.match(/[\\d.]+/g).slice(0, 3).map(Number);
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
})()"""

SHOWN = """Array.from(document.querySelectorAll('figure > img'))
  .filter(image => getComputedStyle(image).display !== 'none').map(image => image.className)"""


def without_pictures(result):
    """The text of a report without its pictures, which take most of the time."""
    with mock.patch("cradle.page.page.pictures", return_value=""):
        return read(cradle.report(result))


class Reports(small.Case):
    def pages(self):
        return ((make, small.page(make)) for make in small.ALL)

    def test_hold_everything_and_request_nothing(self):
        for make, text in self.pages():
            page = small.Page(text)
            for link in page.links + page.loads:
                self.assertRegex(link, "^(#|data:)", make.__name__)
                if link.startswith("#"):
                    self.assertIn(link[1:], page.ids)
            self.assertNotIn("@import", text)
            self.assertNotRegex(text, r"url\((?!#|[\"']?data:)")
            self.assertEqual(len(page.ids), len(set(page.ids)), "an id stands twice")
            self.assertIn("default-src 'none'", text)

    def test_name_replicas_that_failed_and_how_to_make_one_again(self):
        point = {"law.restitution": 0, "law.cutoff": 0.1, "run.coordinates": "absolute"}
        self.refused(5, "", cradle.sweep, "fig2", points=[{"law.restitution": 0.5}, point], replicas=4,
                     output="failed.h5", set={
                         "initial.particles": 60, "initial.perturbation": 0.15, "run.until": 200,
                         "output.snapshots": [], "output.series.points": 3, "output.profiles.times": []})
        page = html.unescape(without_pictures("failed.h5"))
        warned = page[page.index('<ul class="warnings">'):page.index("</ul>")]
        self.assertIn("order of collisions lost", warned)
        command = re.search(r"alone: <code[^>]*>([^<]*)</code>", warned)[1]
        self.assertIn("failed/points/0001/scene.toml", command)
        folder = os.path.dirname(os.environ["CRADLE_PROGRAM"])
        again = subprocess.run(command, shell=True, capture_output=True, text=True,
                               env=os.environ | {"PATH": folder + os.pathsep + os.environ["PATH"]})
        self.assertEqual(again.returncode, 5, again.stderr)
        replica = int(re.search("initial.replica=([0-9]+)", command)[1])
        with cradle.open("failed.h5") as sweep, cradle.open("replica.h5") as alone:
            self.assertEqual(alone.series.collisions[-1], sweep.points[1].replicas.collisions[replica])

    def test_have_every_picture_of_the_result(self):
        for make, text in self.pages():
            for name in cradle.plot.names(make()):
                self.assertIn(f'id="picture-{name}"', text)
            self.assertEqual(text.count("<figure"), len(cradle.plot.names(make())))

    def test_begin_with_what_was_simulated_and_by_what(self):
        for make, text in self.pages():
            begin = text[text.index("<p class=intro>"):text.index("<nav>")]
            self.assertIn("Cradle, a program", begin, make.__name__)
            self.assertIn("particles", begin)
            if make is not small.words:
                self.assertIn("<b>Units.</b>", begin)
        first = small.page(small.shock)
        self.assertIn("Two rows of 100 particles run into each other, each at the speed 0.5&nbsp;l/t; two that collide "
                      "part at 0.999 times the speed at which they met, or without loss if that was below "
                      "10<sup>−5</sup>&nbsp;l/t.", first)
        # What a sweep varies is not said to have one value.
        self.assertIn("run into each other; two that collide part at a part of the speed", small.page(small.sweep))

    def test_say_what_defines_the_system(self):
        list_of = {"type": "list", "x": [1, 2], "v": [0, -1]}
        for name, scene, said, fronts in (
                ("floor", {"initial": list_of | {"m": [1, 50]}, "gravity": {"acceleration": -9.5}, "walls": {
                    "left": {"position": 0, "motion": "sine", "amplitude": 0.01, "frequency": 10, "rest_speed": 1e-3},
                    "right": {"position": 7, "temperature": 2.5}}},
                 ("2 particles start from given positions", "with the masses 1, 50", "fall to the left, at 9.5 l/t²",
                  "The left wall is at x = 0 l, is shaken as a sine of amplitude 0.01 l and angular frequency 10 1/t, "
                  "reflects without loss and holds what comes more slowly than 0.001 l/t.",
                  "The right wall is at x = 7 l and has the temperature 2.5 m l²/t²."), []),
                ("piston", {"initial": list_of,
                            "walls": {"right": {"position": 3, "speed": -0.25, "restitution": 0.5}}},
                 ("The right wall starts at x = 3 l and moves at −0.25 l/t and reflects with the restitution 0.5.",),
                 ["left"]),
                ("gas", {"initial": {"type": "gas", "particles": 20, "random_masses": [1, 3]}},
                 ("20 particles with random velocities move between two walls, with random masses from 1 to 3",), []),
                ("centre", {"initial": {"type": "rows", "left": {"particles": 20, "speed": 1},
                                        "right": {"particles": 1, "speed": -1}, "centre": {"mass": 50}}},
                 ("A row of 20 particles on the left and one of 1 particle on the right meet a particle of mass 50 at "
                  "rest between them, at the velocities 1 and -1 l/t;",), ["left", "right"]),
                ("one", {"initial": {"type": "list", "x": [1], "v": [0]}}, ("1 particle starts from given positions",),
                 [])):
            common = {"law": {"type": "inelastic", "restitution": 0.9}, "run": {"until": 1, "stop_gap": 1e-9}}
            with self.subTest(name), cradle.run(common | scene, output=name + ".h5") as result:
                page = without_pictures(result)
                begin = html.unescape(re.search("<p class=intro>(.*)</p>", page)[1]).replace("\xa0", " ")
                for words in said:
                    self.assertIn(words, begin)
                self.assertEqual(re.findall("(left|right) front at the end", page), fronts)
                if "walls" in scene:  # which give energy, too
                    self.assertNotIn("% lost", page)
        self.assertIn("1 particle in gaps", page)
        self.assertIn("% lost in collisions", small.page(small.shock))

    def test_name_the_paper_where_it_is_cited(self):
        paper = "Figures, equations and sections are those of the paper"
        self.assertIn(paper, small.page(small.shock))
        for make in (small.words, small.threshold):
            self.assertNotIn(paper, small.page(make), make.__name__)
        theory = cradle.drawing.theory.Theory("quantity,equation,form,t,value\nenergy,(7),continuous,,1\n"
                                              "energy_haff,Haff 1983,continuous,,1\nn,\"(6), line 1\",continuous,,1\n")
        self.assertEqual(theory.equation("energy", "n"), "Eqs. (7), (6)")
        self.assertEqual(theory.equation("energy_haff"), "Haff 1983")

    def test_distinguish_what_is_proved_estimated_and_unknown(self):
        for make, label, known in (
                (small.shock, "energy at the end", "estimated"), (small.shock, "collisions", "unknown"),
                (small.shock, "right front at the end", "unknown"), (small.collapse, "energy at the end", "proved"),
                (small.collapse, "collisions", "proved"), (small.collapse, "collapse", "estimated"),
                (small.collapse, "last interval", "unknown")):
            found = re.search(rf"<th scope=row>{label}<td>.*<span class=\"tag (\w+)\">", small.page(make))
            self.assertEqual(found[1], known, label)

    def test_say_where_errors_may_have_grown(self):
        for table, keys, grown in (
                ("initial", {"m": [1, 1]}, False), ("initial", {"m": [1, 2]}, True), ("initial", {"masses": [2]}, True),
                ("initial", {"random_masses": [1, 2]}, True), ("run", {"collapse": "merge"}, True),
                ("run", {"coordinates": "absolute"}, True), ("law", {"type": "wet"}, True), ("gravity", {}, True),
                ("walls", {"left": {}}, False), ("walls", {"left": {"motion": "sine"}}, True),
                ("walls", {"right": {"temperature": 1}}, True)):
            scene = {"law": {"type": "inelastic"}, "initial": {}, "run": {}} | {table: keys}
            self.assertEqual(errors_may_grow(scene), grown, keys)

    def test_tables_of_sweeps_have_no_blanks(self):
        # The second point takes the cut-off of the scene, the third one has none.
        with cradle.sweep("fig2", output="points.h5", points=[
                {"law.cutoff": 0.01}, {"law.restitution": 0.5},
                {"law.cutoff": 0, "run.collapse": "merge", "run.merge_speed": 0.1}],
                set={"initial.particles": 20, "run.until": 5, "output.snapshots": [], "output.profiles.times": []}
                          ) as result:
            table = without_pictures(result)
            labels = [cradle.drawing.sweep.label_of(point) for point in result.points]
            named = cradle.drawing.style.distinct(labels, result.points)
        table = table[table.index('class="sortable"'):]
        cells = re.findall(r'<td data-by="[^"]*">(.*?)(?=<td|</?tr|\n)', table[:table.index("</table>")])
        self.assertNotIn("", cells)
        self.assertNotIn("–", cells)
        self.assertEqual(cells.count("none"), 2)  # merging speeds of the points that do not merge
        self.assertEqual(len(set(labels)), 2)
        self.assertEqual(len(set(named)), 3)

    def test_equal_labels_of_points_get_what_differs(self):
        points = [types.SimpleNamespace(label=label) for label in ("r=1", "r=1 d=2", "r=1 d=3", "s=4")]
        distinct = cradle.drawing.style.distinct
        self.assertEqual(distinct(list("aaab"), points), ["a", "a, d=2", "a, d=3", "b"])
        self.assertEqual(distinct(list("aa"), points[:1] * 2), ["a, point 0", "a, point 1"])

    def test_are_the_same_twice_and_by_the_program(self):
        texts = {f"again-{make.__name__}.html": small.page(make) for make in small.ALL}
        small.python_again([["report", make(), "-o", name] for make, name in zip(small.ALL, texts)])
        call = program.call(["report", small.collapse(), "-o", "program.html"])
        self.assertEqual((call.stdout, call.stderr), ("program.html\n", ""))
        for name, text in (texts | {"program.html": small.page(small.collapse)}).items():
            self.assertEqual(read(name), text, name)

    def test_say_how_to_run_it_again(self):
        # The command and the scene of the page give the same file.
        for make in small.ALL:
            with cradle.open(make()) as result:
                command = re.search(r"<pre>(cradle .*)\n?</pre>", small.page(make))[1]
                small.written(result.attributes["name"] + ".toml", result.scene_text.encode())
            self.makes_again(command, make())

    def makes_again(self, command, result):
        words = shlex.split(html.unescape(command))[1:]
        words[words.index("-o") + 1] = "again.h5"
        program.call([*words, "--quiet"], accepted=(DONE, COLLAPSE))
        found = program.call(["diff", result, "again.h5"], accepted=(DONE, DIFFERS))
        self.assertEqual(found.returncode, DONE, f"{command}\n{found.stdout}")
        os.remove("again.h5")

    def test_replicas_that_were_merged_are_made_in_parts(self):
        for first, count in ((1, 2), (5, 1), (3, 1)):
            cradle.ensemble("collapse_times", count, {"initial.particles": 20, "run.until": 5}, first=first,
                            output=f"from{first}.h5").close()
        program.call(["merge", "from1.h5", "from5.h5", "from3.h5", "-o", "merged.h5"])
        page = without_pictures("merged.h5")
        commands = re.search(r"<pre>(cradle [^<]*)</pre>", page)[1].splitlines()
        with cradle.open("merged.h5") as result:
            small.written(result.attributes["name"] + ".toml", result.scene_text.encode())
        self.assertEqual(len(commands), 3)
        for command in commands[:-1]:
            program.call([*shlex.split(command)[1:], "--quiet"])
        self.makes_again(commands[-1], "merged.h5")

    def test_commands_are_quoted_for_a_shell(self):
        program.call(["new", "my scene.toml", "--from", "collapse3"])
        settings = {"initial.x": [-1, 0, 1.5], "title": "Newton's"}
        cradle.threshold("my scene.toml", {"law.restitution": "0.05:0.2"}, settings, digits=3, proof=False,
                         output="of it.h5").close()
        command = re.search(r"<pre>(cradle .*)\n?</pre>", without_pictures("of it.h5"))[1]
        self.assertIn("--no-proof", command)
        self.makes_again(command, "of it.h5")

    def test_say_what_is_proved(self):
        text = small.page(small.collapse)
        self.assertIn("<b>Proved</b>: each of the 322 collisions", text)
        with cradle.open(small.collapse()) as result:
            low, high = (str(result.exact.series[f"front_right_{side}"][-1]) for side in ("low", "high"))
        shown = re.search(r"right front at the end<td><span class=\"digits\">([\d.]+)", text)[1]
        # 4/3, to the 40 digits that are shown of those proved.
        self.assertEqual(shown, "1." + 39 * "3")
        self.assertEqual((low[:42], high[:42]), ("1." + 40 * "3", "1." + 40 * "3"))

    def test_warn(self):
        self.assertIn("ended at inelastic collapse", small.page(small.collapse))
        self.assertNotIn('class="warnings"', small.page(small.shock))

    def test_scripts_of_scenes_stay_texts(self):
        title = "</title><script>alert(1)</script><b>"
        with cradle.run("fig5", set={"title": title}, output="bad.h5") as result:
            text = without_pictures(result)
        self.assertNotIn("<script>alert", text)
        self.assertIn("&lt;script&gt;alert(1)", text)

    def test_citation_has_the_version(self):
        printed, version = program.call(["cite"]).stdout, program.call(["--version"]).stdout.split()[1]
        self.assertIn(f"version {version}:", printed)
        self.assertEqual(version, cradle.__version__)
        self.assertIn("10.1103/PhysRevE.75.031304", printed)
        self.assertIn("zaburdaev2007", small.page(small.shock))


@unittest.skipUnless(browser.find(), "no Chromium (Debian: chromium)")
class Reader(unittest.TestCase):
    """Reports as a reader sees them: nothing thrown, nothing logged, nothing asked of any network; tables sort; dark is
    dark, and print is dark on white."""

    @classmethod
    def setUpClass(cls):
        cls.browser = cls.enterClassContext(browser.Browser())

    def load(self, make, scheme="light", media=""):
        small.page(make)
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


class Elements(unittest.TestCase):
    def test_numbers(self):
        self.assertEqual(number(34681883), "34\u202f681\u202f883")
        self.assertEqual(number(-1.5e-14), "−1.5 × 10<sup>−14</sup>")
        self.assertEqual((number(float("nan")), number(True), number(2.5)), ("–", "yes", "2.5"))

    def test_a_mean_goes_as_far_as_its_error(self):
        self.assertEqual(measured(3157398.4, 189.2), "3157398 <small>± 189</small>")
        self.assertEqual(measured(6249.19123, 0.2812), "6249.19 <small>± 0.28</small>")

    def test_enclosures_show_the_digits_that_are_right(self):
        # Bounds 1.2345678 +- 1e-7: six digits do not depend on where between them the number is.
        shown, right = enclosed("1.2345677e+00", "1.2345679e+00")
        self.assertEqual(right, 6)
        self.assertEqual(shown, "1.23457 ± 1.0 × 10<sup>−7</sup>")
        self.assertEqual(enclosed("2.5e+00", "2.5e+00"), ("2.5", 2))
        self.assertEqual(enclosed("-1e-300", "1e-300")[1], 0)
