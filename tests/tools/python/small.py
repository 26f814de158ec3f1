"""What the tests share: small results, made once by the program in the working folder, and how errors are checked."""
import functools
import unittest

import cradle
from cradle import program, simulation


class Case(unittest.TestCase):
    def refused(self, status, message, call, *arguments, **keys):
        """The cradle.Error that call(...) raises: of this status, with a message in which the expression is found."""
        with self.assertRaisesRegex(cradle.Error, message) as raised:
            call(*arguments, **keys)
        self.assertEqual(raised.exception.status, status, raised.exception.message)
        return raised.exception


def set_words(settings):
    """The same settings as words for the program."""
    return [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]


def live():
    """Why there can be no live simulations; "" where the module for them is built."""
    try:
        simulation.module()
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

SHOCK = {"initial.particles": 200, "run.until": 60, "output.snapshots": [20, 60], "output.profiles.times": [30, 60],
         "output.series.points": 20}

# Of "cooling", 1e18 collisions: a run that does not end by itself, however quick the machine is.
ENDLESS = {"law.type": "inelastic", "law.restitution": 1, "initial.particles": 2000, "run.until": "1e15",
           "output.checkpoint.every_seconds": 0.1}


@functools.cache
def shock():
    """200 particles with snapshots, profiles and events."""
    cradle.run("fig2", set=SHOCK | {"output.events": True}, output="shock.h5").close()
    return "shock.h5"


@functools.cache
def ensemble():
    """4 replicas of 40 particles, which collapse."""
    cradle.ensemble("fig2", 4, output="ensemble.h5", set={
        "initial.particles": 40, "law.restitution": 0.6, "law.cutoff": 0, "run.stop_gap": 1e-12, "run.until": 30,
        "output.snapshots": [], "output.series.points": 20, "output.profiles.times": [2, 4],
        "output.profiles.range": [-8, 8]}).close()
    return "ensemble.h5"


@functools.cache
def sweep():
    """Six points of two replicas."""
    cradle.sweep("fig2", {"law.restitution": [0.5, 0.7, 0.9], "initial.speed": "0.5:1:2"}, replicas=2,
                 output="sweep.h5", set={"initial.particles": 40, "run.until": 10, "output.snapshots": [],
                                         "output.series.points": 5, "output.profiles.times": []}).close()
    return "sweep.h5"


@functools.cache
def collapse():
    """Three particles, certified."""
    cradle.certify("collapse3", output="collapse.h5").close()
    return "collapse.h5"


@functools.cache
def trust():
    cradle.trust("collapse3", digits=[16, 31, 50], both=True, output="trust.h5").close()
    return "trust.h5"


TAGGED = {"initial.particles": 100, "run.until": 40, "output.structure.times": [10, 40],
          "output.pair_distribution.times": [10]}


@functools.cache
def tagged():
    """100 tagged particles."""
    cradle.run("classics/diffusion", set=TAGGED, output="tagged.h5").close()
    return "tagged.h5"


@functools.cache
def tagged_ensemble():
    """4 replicas of them."""
    cradle.ensemble("classics/diffusion", 4, set=TAGGED, output="tagged_ensemble.h5").close()
    return "tagged_ensemble.h5"


@functools.cache
def words():
    """A word of three particles."""
    program.call(["words", "3", "ab", "--digits", "10", "-o", "words.h5"])
    return "words.h5"


@functools.cache
def threshold():
    """Up to which restitution three particles collapse."""
    cradle.threshold("collapse3", {"law.restitution": "0.05:0.1"}, digits=6, output="threshold.h5").close()
    return "threshold.h5"


@functools.cache
def page(make):
    """The text of the report of one of these, beside it with .html."""
    return read(cradle.report(make()))


ALL = (shock, ensemble, sweep, collapse, trust, tagged, tagged_ensemble, words, threshold)
