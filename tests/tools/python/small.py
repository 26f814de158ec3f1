"""What the tests share: small results, made once in the working folder; a check of errors; what a page refers to."""
import functools
import html.parser
import signal
import subprocess
import sys
import unittest

import cradle
from cradle import compiled, program

signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell's background jobs ignore


class Case(unittest.TestCase):
    def refused(self, status, message, call, *arguments, **keys):
        """The cradle.Error that call(...) raises: of this status, with a message in which the expression is found."""
        with self.assertRaisesRegex(cradle.Error, message) as raised:
            call(*arguments, **keys)
        self.assertEqual(raised.exception.status, status, raised.exception.message)
        return raised.exception


class Page(html.parser.HTMLParser):
    """The ids of a page, what it links to, and what is loaded with it."""

    def __init__(self, text):
        super().__init__()
        self.ids, self.links, self.loads = [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id":
                self.ids.append(value)
            elif name in ("href", "xlink:href", "src", "action", "srcset", "poster"):
                (self.links if tag == "a" else self.loads).append(value or "")


def set_words(settings):
    """The same settings as words for the program."""
    return [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]


def live():
    """Why there can be no live simulations; "" where the module for them is built."""
    try:
        compiled.module()
        return ""
    except cradle.Error as error:
        return error.message


def read(path, mode="r"):
    with open(path, mode, encoding=None if "b" in mode else "utf-8") as file:
        return file.read()


def written(path, content):
    """A file with these bytes; its path."""
    with open(path, "wb") as file:
        file.write(content)
    return path


def python_again(calls):
    """What another Python prints, whose sets have another order, when the package's command is called with each of
    these lists of words, as the program calls it. Nothing may be written to standard error."""
    script = f"import sys, cradle.__main__ as package\nfor words in {calls!r}:\n  if package.main(words): sys.exit(1)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, ""), done
    return done.stdout


SHOCK = {"initial.particles": 200, "run.until": 60, "output.snapshots": [20, 60], "output.profiles.times": [30, 60],
         "output.series.points": 20}

# Of "cooling", 1e18 collisions: a run that does not end by itself, however quick the machine is.
ENDLESS = {"law.type": "inelastic", "law.restitution": 1, "initial.particles": 2000, "run.until": "1e15",
           "output.checkpoint.every_seconds": 0.1}


def result(name, call, *arguments, **keys):
    """A function that returns the path of a result, which it makes when it is called first."""
    @functools.cache
    def make():
        call(*arguments, output=f"{name}.h5", **keys).close()
        return f"{name}.h5"
    make.__name__ = name
    return make


# 200 particles with snapshots, profiles and events.
shock = result("shock", cradle.run, "fig2", set=SHOCK | {"output.events": True})
# 4 replicas of 40 particles, which collapse.
ensemble = result("ensemble", cradle.ensemble, "fig2", 4, spread=["energy=0:10:2000"], set={
    "initial.particles": 40, "law.restitution": 0.6, "law.cutoff": 0, "run.stop_gap": 1e-12, "run.until": 30,
    "output.snapshots": [], "output.series.points": 20, "output.profiles.times": [2, 4],
    "output.profiles.range": [-8, 8]})
# Six points of two replicas, the fourth and the fifth.
sweep = result("sweep", cradle.sweep, "fig2", {"law.restitution": [0.5, 0.7, 0.9], "initial.speed": "0.5:1:2"},
               replicas=2, first=3, set={"initial.particles": 40, "run.until": 10, "output.snapshots": [],
                                "output.series.points": 5, "output.profiles.times": []})
# Three particles, certified; and compared at several precisions.
collapse = result("collapse", cradle.certify, "collapse3")
trust = result("trust", cradle.trust, "collapse3", digits=[16, 31, 50], both=True)
# 100 tagged particles, and 4 replicas of them.
TAGGED = {"initial.particles": 100, "run.until": 40, "output.structure.times": [10, 40],
          "output.pair_distribution.times": [10]}
tagged = result("tagged", cradle.run, "classics/diffusion", set=TAGGED)
tagged_ensemble = result("tagged_ensemble", cradle.ensemble, "classics/diffusion", 4, set=TAGGED)
# Up to which restitution three particles collapse.
threshold = result("threshold", cradle.threshold, "collapse3", {"law.restitution": "0.05:0.1"}, digits=6)


@functools.cache
def words():
    """A word of three particles."""
    program.call(["words", "3", "ab", "--digits", "10", "-o", "words.h5"])
    return "words.h5"


@functools.cache
def page(make):
    """The text of the report of one of these, beside it with .html."""
    return read(cradle.report(make()))


ALL = (shock, ensemble, sweep, collapse, trust, tagged, tagged_ensemble, words, threshold)
