"""The microscope, used as a person would, in headless Chromium: it loads without an error or a request, what it draws
at depths from 1 to 1e-290 is where exact rational arithmetic has it, and mouse, wheel, keys, touch, play, dark mode and
high resolution do what they should.

Exact: collapse of three particles in fractions; two rows of elastic particles, whose world lines are straight lines
that cross (a million collisions). Twin: gaps against those of the program's snapshots. Bound of positions: a hundredth
of a pixel, where doubles that are sums of local terms are good to 1e-9 of one.
"""
import base64
import bisect
import itertools
import math
import pathlib
import tempfile
import time
import unittest
import zlib
from fractions import Fraction

import h5py
import numpy as np

import browser
import cradle
from cradle import microscope
from cradle.page import page

HUNDREDTH = 0.01  # of a pixel


class Microscope(browser.Browser):
    """The browser, with the hands that a person has."""

    run = browser.Browser.evaluate

    def open(self, path):
        self.emulate()
        self.load(path)
        self.until("Boolean(window.cradleMicroscopeTest)")
        self.run("cradleMicroscopeTest.ready.then(() => 1)")

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def wheel(self, x, y, turned, **more):
        self.mouse("mouseWheel", x, y, deltaX=0, deltaY=turned, **more)

    def click(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.mouse(kind, x, y, button="left", clickCount=1)

    def key(self, key, code=None, **more):
        text = {"text": key} if len(key) == 1 else {}
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, code=code or "", **text, **more)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key, code=code or "", **more)

    def touch(self, *steps):
        """Fingers down at the first of these lists of places, moved to the others, and up."""
        self.call("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)
        for kind, points in zip(("touchStart", *["touchMove"] * (len(steps) - 1), "touchEnd"), (*steps, ())):
            self.call("Input.dispatchTouchEvent", type=kind,
                      touchPoints=[{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)])
        self.call("Emulation.setTouchEmulationEnabled", enabled=False)


def rational_collapse(count):
    """Initial state and first collisions of collapse3, as fractions: (left, time, closing speed, x, v after it)."""
    restitution = Fraction(1, 20)
    x, v, t = [Fraction(0), Fraction(1), Fraction(3)], [Fraction(1), Fraction(0), Fraction(-1)], Fraction(0)
    start, collisions = (None, t, None, x, list(v)), []
    while len(collisions) < count:
        due = [((x[i + 1] - x[i]) / (v[i] - v[i + 1]), i) for i in (0, 1)
               if v[i] > v[i + 1] and not (collisions and collisions[-1][0] == i)]
        step, left = min(due)
        t += step
        x = [place + speed * step for place, speed in zip(x, v)]
        w = v[left] - v[left + 1]
        kick = (1 + restitution) * w / 2
        v[left] -= kick
        v[left + 1] += kick
        collisions.append((left, t, w, x, list(v)))
    return start, collisions


def crossings(x):
    """Time, place and left particle of every collision of elastic particles in two rows at speeds 1/2 and -1/2, from
    their places at the start: world lines are exchanged at collisions, so that lines i and j of the two rows, straight
    all along, cross at (x_j - x_i); particle i + j is then on the left."""
    half = len(x) // 2
    moments = (x[None, half:] - x[:half, None]).ravel()
    order = np.argsort(moments, kind="stable")
    places = ((x[None, half:] + x[:half, None]) / 2).ravel()
    # Of the left row its particle i has i lines of its own row below it, and those of the right row that it has met.
    below = (np.arange(half)[:, None] + np.arange(half)[None, :]).ravel()
    return moments[order], places[order], below[order]


def unpack(packed):
    """The array of which `microscope.pack` made a text."""
    kind = np.dtype("<" + packed["type"])
    planes = np.frombuffer(zlib.decompress(base64.b64decode(packed["deflate"])), np.uint8)
    return planes.reshape(kind.itemsize, packed["length"]).T.copy().view(kind).ravel()


class Data(unittest.TestCase):
    """What goes into a page, without a browser."""

    def test_arrays_come_back_bit_by_bit(self):
        for array in (np.array([1e-300, -0.1, 3.0, 0.0]), np.arange(70000, dtype=np.uint32), np.zeros(0, np.uint16)):
            back = unpack(microscope.pack(array))
            self.assertEqual(back.dtype, array.dtype)
            self.assertEqual(back.tobytes(), array.tobytes())

    def test_rounded_mantissas_are_within_half_a_unit(self):
        array = np.random.default_rng(1).random(1000) * 10.0 ** np.arange(-250, 250, 0.5)
        back = unpack(microscope.pack(array, 24))
        self.assertLessEqual(np.max(np.abs(back / array - 1)), 2.0 ** -25)
        self.assertFalse(np.array_equal(back, array))

    def test_nothing_to_show_is_none(self):
        scene = '[law]\ntype = "inelastic"\nrestitution = 0.5\n[initial]\ntype = "list"\nx = [0]\n'
        with h5py.File("empty.h5", "w") as file:
            for change in (lambda: None, lambda: file.attrs.update(scene=scene),
                           lambda: file.create_group("snapshots"), lambda: file.attrs.update(kind="ensemble")):
                change()
                self.assertIsNone(microscope.data(cradle.Result("empty.h5", file)))


@unittest.skipUnless(browser.find(), "no Chromium (Debian: chromium)")
class InBrowser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.browser = cls.enterClassContext(Microscope())
        cls.page, result, _ = cls.made("collapse3", "collapse3", {})
        cls.start, cls.collisions = rational_collapse(len(result.events.left))

    @classmethod
    def made(cls, name, scene, keys):
        """A page with the microscope of a report alone, of a run; the run's result, and the microscope's data of it."""
        result = cradle.run(scene, {"output.events": True} | keys, output=cls.folder / f"{name}.h5")
        cls.addClassCleanup(result.close)
        path = cls.folder / f"{name}.html"
        path.write_text("<!doctype html><meta charset=utf-8><meta name=color-scheme content='light dark'><title>"
                        f"microscope</title><style>body{{margin:12px}}</style>{page.microscope(result)}", "utf-8")
        return path, result, microscope.data(result)

    def opened(self, *run):
        """The result and the data of what is made, in an open page."""
        path, *made = self.made(*run)
        self.browser.open(path)
        return made

    def setUp(self):
        self.browser.resize(1100, 760)
        self.browser.open(self.page)

    def tearDown(self):
        """No exception, no word on the console, no request but for the page itself."""
        self.assertEqual((self.browser.complaints, self.browser.outside()), ([], []))

    def m(self, expression):
        """Of the page's handle on the microscope."""
        return self.browser.run("cradleMicroscopeTest." + expression)

    def view(self):
        return self.m("view()")

    def position(self, particle, collision):
        return self.m(f"position({particle}, {collision})")

    def middle(self):
        """Of the picture, in pixels of the page, and the corner of the canvas."""
        corner = self.browser.run("(r => [r.left, r.top])(document.querySelector('canvas').getBoundingClientRect())")
        box = self.view()["box"]
        return corner[0] + box["left"] + box["width"] / 2, corner[1] + box["top"] + box["height"] / 2, corner, box

    def clicked(self):
        x, y, *corner = self.middle()
        self.browser.click(x, y)
        return x, y, *corner

    def exact_place(self, view, particle, time):
        """Pixels of a particle at a time (a fraction)."""
        event = view["anchor"]["e"]
        left, origin, _, places, after = self.collisions[event]
        frame = (after[left] + after[left + 1]) / 2  # of the pair at the anchor
        states = [self.start, *self.collisions]
        _, since, _, at, speed = states[bisect.bisect(states, time, key=lambda state: state[1]) - 1]
        x = at[particle] + speed[particle] * (time - since) - places[left] - frame * (time - origin)
        return self.pixels_of(view, time - origin, x)

    def pixels_of(self, view, tau, x):
        """Pixels of what is tau after the anchor's collision and x from it, in fractions until the last step."""
        box = view["box"]
        across = (tau - Fraction(view["tau"])) / Fraction(view["T"]) + Fraction(1, 2)
        up = (x - Fraction(view["V"]) * tau - Fraction(view["xi"])) / Fraction(view["X"])
        return box["left"] + box["width"] * float(across), box["top"] + box["height"] * float(Fraction(1, 2) - up)

    def assert_at(self, drawn, x, y):
        self.assertAlmostEqual(drawn["x"], x, delta=HUNDREDTH)
        self.assertAlmostEqual(drawn["y"], y, delta=HUNDREDTH)

    def assert_exact(self, view, least=3):
        """Every collision in sight, of both its particles, and points of all lines between, are in their places."""
        box, seen = view["box"], 0
        for event, (left, moment, _, _, _) in enumerate(self.collisions):
            x, y = self.exact_place(view, left, moment)
            if not (0 < x - box["left"] < box["width"] and 0 < y - box["top"] < box["height"]):
                continue
            seen += 1
            for particle in (left, left + 1):
                self.assert_at(self.position(particle, event), x, y)
        self.assertGreaterEqual(seen, least)
        last = self.collisions[-1][1]
        for particle, part in itertools.product(range(3), (0.03, 0.21, 0.4, 0.55, 0.7)):
            column = box["left"] + part * box["width"]
            across = (Fraction(column) - Fraction(box["left"])) / Fraction(box["width"])
            tau = Fraction(view["tau"]) + Fraction(view["T"]) * (across - Fraction(1, 2))
            moment = self.collisions[view["anchor"]["e"]][1] + tau
            if not 0 <= moment <= last:
                continue
            y = self.exact_place(view, particle, moment)[1]
            drawn = self.m(f"height({particle}, {column})")
            self.assertAlmostEqual(drawn, y, delta=HUNDREDTH + 1e-9 * abs(y))

    def test_drawn_positions_are_exact_at_any_depth(self):
        for depth in ("1", "1e-10", "1e-100", "1e-200", "1e-287", "1e-290"):
            with self.subTest(depth=depth):
                view = self.m(f"zoomTo({{depth: {depth}}})")
                self.assertEqual(view["X"], float(depth))
                self.assertTrue(view["exact"])
                self.assert_exact(view, 1 if depth == "1e-290" else 3)

    def test_what_doubles_do_not_hold_is_left_out_and_reported(self):
        """A collapse to gaps of 1e-700, whose last intervals and speeds are nothing in doubles."""
        _, data = self.opened("deeper", "collapse3", {"run.precision": "mpfr", "run.digits": 50,
                                                      "run.stop_gap": "1e-700"})
        self.assertLess(data["collisions"], data["total"])
        self.assertGreater(data["collisions"], 325)
        self.collisions = rational_collapse(data["collisions"])[1]
        self.m("actions.deepest()")
        self.browser.until("cradleMicroscopeTest.readout()"
                           f".endsWith('the first {data['collisions']} collisions are here')")
        self.assertEqual(self.view()["anchor"]["e"], data["collisions"] - 1)
        self.assert_exact(self.view(), 1)

    def test_gaps_are_exact(self):
        for event in (0, 1, 2, 57, 144, 245, 320, len(self.collisions) - 1):
            left, _, _, places, after = self.collisions[event]
            for a in (0, 1):
                found = self.m(f"gap({a}, {a + 1}, {event})")
                exact, w = places[a + 1] - places[a], after[a] - after[a + 1]
                self.assertLessEqual(abs(Fraction(found["gap"]) - exact), exact * Fraction(1, 10**11))
                self.assertLessEqual(abs(Fraction(found["w"]) - w), abs(w) * Fraction(1, 10**11))
                self.assertEqual(found["gap"] == 0, a == left)

    def test_the_wheel_goes_down_and_stays_exact(self):
        """Hundreds of turns over the place of the collapse, the pointer at rest; the anchor has to move with it."""
        x, y, corner, _ = self.clicked()
        last = len(self.collisions) - 1
        target = self.position(self.collisions[last][0], last)
        for turn in range(700):
            self.browser.wheel(corner[0] + target["x"], corner[1] + target["y"], -300)
            view = self.view()
            if turn % 50 == 49 or view["X"] < 1e-280:
                self.assertGreater(view["anchor"]["e"], 2)
                self.assert_exact(view, 1)
            if view["X"] < 1e-280:
                break
        self.assertLess(view["X"], 1e-280)
        # And out again: to the whole run.
        self.browser.run(f"""(m => {{ for (let turn = 0; turn < 3000 && m.view().X <= 1; ++turn)
            m.zoom(1 / 3, {{x: {x - corner[0]}, y: {y - corner[1]}}}); }})(cradleMicroscopeTest)""")
        self.assertGreater(self.view()["X"], 1)
        self.assert_exact(self.view(), 1)

    def test_time_and_space_zoom_apart(self):
        x, y, corner, box = self.clicked()
        below, beside = corner[1] + box["top"] + box["height"] + 15, corner[0] + 20
        shift, alt = 8, 1
        for at, modifiers, zoomed, other in (((x, y), shift, "T", "X"), ((x, y), alt, "X", "T"),
                                             ((x, below), 0, "T", "X"), ((beside, y), 0, "X", "T")):
            for turned in (-120, 120):
                before = self.view()
                self.browser.wheel(*at, turned, modifiers=modifiers)
                after = self.view()
                self.assertEqual(after[other], before[other])
                wide, narrow = (before, after) if turned < 0 else (after, before)
                self.assertLess(narrow[zoomed], 0.9 * wide[zoomed])

    def test_zooming_beside_collisions_keeps_the_chart(self):
        """The anchor, a collision in sight at first, is left behind; between it and the view are others."""
        self.opened("beside", "cooling", {"initial.particles": 100, "run.until": 20})
        for _ in range(30):
            self.m("zoom(1.35, {x: 300, y: 200})")
            self.assertTrue(self.m("camera().chart === null || cradleMicroscopeTest.camera().chart.xi.every(isFinite)"))
        self.assertTrue(self.view()["exact"])

    def test_a_page_scrolls_past(self):
        x, y, _, _ = self.middle()
        before = self.view()
        self.browser.wheel(x, y, -120)
        self.assertEqual(self.view(), before)

    def test_dragging_moves_what_is_under_the_pointer(self):
        x, y, _, _ = self.middle()
        before = self.position(0, 0)
        self.browser.mouse("mousePressed", x, y, button="left", clickCount=1)
        self.browser.mouse("mouseMoved", x + 37, y - 21, button="left", buttons=1)
        self.browser.mouse("mouseReleased", x + 37, y - 21, button="left", clickCount=1)
        self.assert_at(self.position(0, 0), before["x"] + 37, before["y"] - 21)

    def test_keys(self):
        self.clicked()
        home = self.view()
        for key, event in (("n", 1), ("n", 2), ("p", 1), ("d", len(self.collisions) - 1)):
            self.browser.key(key)
            self.assertEqual(self.view()["anchor"]["e"], event)
        self.assertLess(self.view()["X"], 1e-285)
        self.browser.key("0")
        self.assertEqual(self.view(), home)
        for key, code, what, sign in (("ArrowRight", "ArrowRight", "tau", 1), ("ArrowUp", "ArrowUp", "xi", 1),
                                      ("+", "NumpadAdd", "T", -1)):
            self.browser.key(key, code)
            self.assertGreater(sign * self.view()[what], sign * home[what])
        self.assertEqual(self.m("state.quantity"), "speed")
        self.browser.key("c")
        self.assertEqual(self.m("state.quantity"), "lost")

    def test_two_fingers_zoom_along_the_axis_they_part(self):
        x, y, *_ = self.clicked()
        before = self.view()
        self.browser.touch(*([(x - 60 - 10 * step, y), (x + 60 + 10 * step, y)] for step in range(7)))
        after = self.view()
        self.assertAlmostEqual(after["T"] / before["T"], 0.5, delta=0.02)
        self.assertEqual(after["X"], before["X"])

    def test_one_finger_pans(self):
        x, y, *_ = self.clicked()
        before = self.position(0, 0)
        self.browser.touch(*([(x + step, y + step)] for step in (0, 20, 40, 60)))
        after = self.position(0, 0)
        self.assertGreater(after["x"], before["x"] + 30)
        self.assertGreater(after["y"], before["y"] + 30)

    def test_the_strip_leads_to_a_depth(self):
        _, _, corner, box = self.middle()
        strip = corner[1] + box["top"] + box["height"] + 42 + 6 + 20
        self.browser.click(corner[0] + box["left"] + 0.5 * box["width"], strip)
        view = self.view()
        self.assertAlmostEqual(view["anchor"]["e"] / len(self.collisions), 0.5, delta=0.01)
        self.assert_exact(view)

    def test_play_flies_into_the_collapse(self):
        x, y, *_ = self.clicked()
        self.browser.key(" ", "Space")
        self.browser.until("cradleMicroscopeTest.view().X < 1e-30")
        self.browser.key(" ", "Space")
        self.assertFalse(self.m("state.playing"))
        still = self.view()
        self.assert_exact(still, 2)
        time.sleep(0.3)
        self.assertEqual(self.view(), still)

    def test_readout(self):
        self.m("zoomTo({event: 245, depth: 1e-220})")
        _, _, corner, box = self.middle()
        place = self.position(1, 245)
        self.browser.mouse("mouseMoved", corner[0] + place["x"] + 2, corner[1] + place["y"])
        self.browser.until("cradleMicroscopeTest.readout().startsWith('collision 246, particles 1 and 2')")
        said = self.m("readout()")
        mantissa, exponent = f"{float(self.collisions[245][2]):.5e}".split("e-")
        raised = "".join("⁰¹²³⁴⁵⁶⁷⁸⁹"[int(digit)] for digit in exponent)
        self.assertIn(f"closing speed {mantissa.rstrip('0')}×10⁻{raised} l/t", said)
        # Between two lines: their gap there, by fractions.
        view = self.view()
        column = box["left"] + 0.2 * box["width"]
        heights = [self.m(f"height({particle}, {column})") for particle in (0, 1)]
        self.browser.mouse("mouseMoved", corner[0] + column, corner[1] + sum(heights) / 2)
        self.browser.until("cradleMicroscopeTest.readout().startsWith('particles 0 and 1: gap')")
        gap = (heights[0] - heights[1]) / box["height"] * view["X"]
        said = self.m("readout()").split("gap ")[1].split(" l")[0]
        number, power = said.split("×10")
        spoken = float(number) * 10.0 ** int(power.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")))
        self.assertAlmostEqual(spoken / gap, 1, delta=0.01)

    def pixel(self, x, y):
        """Red, green and blue of a pixel of the canvas."""
        return self.browser.run(f"""(() => {{
            const all = document.querySelector('canvas'), one = document.createElement('canvas');
            one.width = one.height = 1;
            const pen = one.getContext('2d', {{ willReadFrequently: true }});
            pen.drawImage(all, -{round(x)}, -{round(y)});
            return [...pen.getImageData(0, 0, 1, 1).data].slice(0, 3); }})()""")

    def test_dark_and_light(self):
        self.assertGreater(min(self.pixel(3, 3)), 200)
        self.browser.emulate("dark", afresh=False)
        while max(self.pixel(3, 3)) >= 60:
            time.sleep(0.05)
        # A dot of a collision stands out in both.
        view = self.m("zoomTo({event: 100, depth: 1e-88})")
        dot = self.position(0, 100) or self.position(1, 100)
        colour = self.pixel(dot["x"], dot["y"])
        self.assertGreater(max(colour) - min(colour), 40)
        self.assertTrue(view["exact"])

    def test_high_resolution(self):
        self.browser.resize(1100, 760, 2)
        self.browser.open(self.page)
        sizes = self.browser.run("""(c => [c.width, c.clientWidth, c.height, c.clientHeight])(
            document.querySelector('canvas'))""")
        self.assertEqual(sizes[::2], [2 * size for size in sizes[1::2]])

    def test_a_million_collisions(self):
        result, data = self.opened("million", "fig2", {
            "law.restitution": 1, "law.cutoff": 0, "initial.particles": 2000, "initial.perturbation": 0.05,
            "run.until": 2000, "output.snapshots": [], "output.profiles.times": []})
        self.assertEqual(data["collisions"], 1_000_000)
        moments, places, left = crossings(result.table("initial").x.values)
        self.assertLess((self.folder / "million.html").stat().st_size, 15e6)
        # What is drawn of the whole: collisions in the lens where the rows overlap, nothing beside them.
        view = self.view()
        self.assertFalse(view["exact"])
        anchor = view["anchor"]["e"]

        def colourful(t, x):  # the home view's frame is the lab's
            at = self.pixels_of(view, Fraction(t - moments[anchor]), Fraction(x - places[anchor]))
            colour = self.pixel(*at)
            return max(colour) - min(colour)
        self.assertGreater(colourful(1000, 3.3), 30)
        self.assertGreater(colourful(1000, -333.7), 30)
        self.assertLess(colourful(300, 600), 15)  # a row that nobody has met
        self.assertLess(colourful(1000, 900), 15)  # nobody
        # Near by, collisions are where the straight lines cross.
        for event in (12345, 500_000, 777_777):
            view = self.m(f"zoomTo({{event: {event}, depth: 4, time: 6}})")
            self.assertTrue(view["exact"])
            near = np.flatnonzero((np.abs(moments - moments[event]) < 3) & (np.abs(places - places[event]) < 2))
            self.assertGreater(len(near), 8)
            for other in near:
                # Pairs of equal elastic particles: the frame at any collision is the lab's.
                at = self.pixels_of(view, Fraction(moments[other] - moments[event]),
                                    Fraction(places[other] - places[event]))
                self.assert_at(self.position(left[other], other), *at)

    def assert_gaps_of_snapshots(self, result, bound):
        """The gaps right after the collision before a snapshot, flown until then, are the snapshot's."""
        moments = result.file["events/time"][:] + result.file["events/time_low"][:]
        compared = 0
        for shot in result.file["snapshots"].values():
            last = int(np.searchsorted(moments, shot.attrs["time"], side="right")) - 1
            index, gaps, speeds = shot["index"][:], shot["gap"][:], shot["closing_speed"][:]
            found = self.browser.run(f"""(() => {{ const m = cradleMicroscopeTest, i = {index.tolist()};
                return i.map((a, k) => [a, i[(k + 1) % i.length]]).slice(0, {len(gaps)}).map(([a, b]) => {{
                    const g = m.gap(a, b, {last}); return [g.gap, g.w]; }}); }})()""")
            gap, w = np.array(found).T
            flown = gap - w * (shot.attrs["time"] - (moments[last] if last >= 0 else 0))
            scale = np.abs(gaps) + np.abs(w) * 1e-3
            self.assertLess(np.max(np.abs(flown - gaps) / scale), bound)
            self.assertLess(np.max(np.abs(w - speeds) / (np.abs(speeds) + 1e-3)), bound)
            compared += len(gaps)
        self.assertGreater(compared, 100)

    def assert_charts_are_where_positions_are(self, result):
        """Collisions and lines of charts with some width, against places in the lab: every particle that is drawn at a
        time is there once, and where it should be."""
        count, compared = len(result.file["events/left"]), 0
        for event in (0, count // 3, count // 2, count - 2):
            for span, depth in ((8, 4), (30, 10), (1, 12)):
                worst, seen = self.browser.run(f"""(() => {{ const m = cradleMicroscopeTest, w = m.world();
                    m.zoomTo({{event: {event}, depth: {depth}, time: {span}}});
                    const {{ chart, view }} = m.camera(), e = view.anchor.e;
                    const round = x => w.ring ? x - w.ring * Math.round(x / w.ring) : x;
                    let worst = 0, seen = 0;
                    if (!chart) return [0, 0];  // too crowded for one
                    chart.collisions.forEach((k, i) => {{ ++seen;
                      const there = w.x[k] - w.x[e] - view.lab * chart.tau[i];
                      worst = Math.max(worst, Math.abs(round(there - chart.xi[i]))); }});
                    for (const part of [-0.45, -0.2, 0.01, 0.3]) {{
                      const tau = view.tau + part * view.T, k = microscopeCollisionAt(w, e, tau), drawn = new Set();
                      for (const line of chart.lines) if (line.from[0] < tau && line.to[0] > tau) {{
                        const since = tau - microscopeBetween(w, e, k);
                        const there = microscopeState(w, line.particle, k, since).x;
                        const off = round(there - w.x[e] - view.lab * tau - microscopeAlong(chart, line, tau));
                        // On a ring a particle may be in sight again, a turn away.
                        const turn = w.ring ? Math.round((there - microscopeAlong(chart, line, tau)) / w.ring) : 0;
                        const image = `${{line.particle}} ${{turn}}`;
                        worst = Math.max(worst, Math.abs(off), drawn.has(image) ? 1 : 0);
                        drawn.add(image); ++seen;
                      }} }}
                    return [worst, seen]; }})()""")
                self.assertLess(worst, 1e-9, f"collision {event}, {span} x {depth}")
                compared += seen > 3
        self.assertGreaterEqual(compared, 8)
        # Once all passes and mergers are undone, the particles are in their first order.
        self.assertTrue(self.browser.run("""(() => { const w = cradleMicroscopeTest.world(), last = w.particles - 1;
            const order = microscopeOrder(w, -1);
            const ordered = i => order.next[i] === i + 1 && order.previous[i + 1] === i;
            return w.x0.every((_, i) => i === last || ordered(i)); })()"""))

    def test_gaps_are_those_of_snapshots_and_charts_are_where_positions_are(self):
        rows = {"run.until": 250, "output.snapshots": [0, 50, 150, 250], "output.profiles.times": [10]}
        ring = {"initial.particles": 200, "initial.perturbation": 0.2, "run.until": 20,
                "output.snapshots": [0, 1, 5, 20]}
        inelastic = {"law.type": "inelastic", "law.restitution": 0.8}
        for name, scene, bound, keys in (
                ("inelastic-rows", "fig2", 1e-9, rows | {"initial.particles": 400, "law.restitution": 0.98}),
                ("wet-rows", "fig6", 1e-7, rows | {"initial.particles": 300}),
                ("inelastic-ring", "cooling", 1e-8, ring | inelastic),
                ("cut-off-ring", "cooling", 1e-8, ring | inelastic | {"law.cutoff": 0.01}),
                ("sticky-ring", "cooling", 1e-8, ring),
                ("wet-ring", "cooling", 1e-8, ring | {"law.type": "wet", "law.loss": 0.03})):
            with self.subTest(name):
                result, data = self.opened(name, scene, keys)
                self.assertEqual(data["kind"], "collisions")
                self.assert_gaps_of_snapshots(result, bound)
                self.assert_charts_are_where_positions_are(result)

    def test_snapshots_alone(self):
        result, data = self.opened("shots", "fig2", {
            "initial.particles": 400, "run.until": 300, "output.snapshots": [100, 200, 300],
            "output.profiles.times": [10], "output.events": False})
        self.assertEqual(data["kind"], "snapshots")
        shot = result.file["snapshots/0000"]
        found = self.browser.run("(w => [[...w.x0], [...w.v0]])(cradleMicroscopeTest.world())")
        self.assertLess(np.max(np.abs(np.array(found) - [shot["x"][:], shot["v"][:]])), 1e-6)
        self.browser.run("""(s => { s.value = 2; s.dispatchEvent(new Event('change')); })(
            document.querySelector('select'))""")
        self.browser.until("cradleMicroscopeTest.world().start === 300")
        self.assertTrue(math.isfinite(self.view()["X"]))
        offered = self.browser.run("document.querySelector('.microscope-help').textContent")
        self.assertIn("space: play", offered)
        for key in ("n, p:", "d:", "c:"):
            self.assertNotIn(key, offered, "of collisions, which snapshots do not have")

    def test_a_core_is_drawn_from_gaps_where_positions_do_not_serve(self):
        result, _ = self.opened("core", "fig2", {
            "initial.particles": 400, "law.restitution": 0.98, "run.until": 325, "output.profiles.times": [10]})
        count = len(result.file["events/left"])
        for depth in (1e-3, 1e-9):
            event = self.browser.run(f"""(d => d.findIndex((x, e) => e > {0.9 * count} && x > -12 &&
                x < {math.log10(depth / 20)}))(cradleMicroscopeTest.world().depth)""")
            view = self.m(f"zoomTo({{event: {event}, depth: {depth}}})")
            span = 0.06 * view["T"]
            self.m(f"zoomTo({{event: {event}, depth: {depth}, time: {span}}})")
            self.assertEqual(self.view()["exact"], depth < 1e-6)  # where positions serve, they do
