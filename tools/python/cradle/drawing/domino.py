"""Dominoes of two masses: when each heavy particle is first hit, and the closed form t = n - 1 + 1/(2c), c = m/(m +
mu), for the mass ratios whose front is ballistic (derived in bench/results/classics.md; arXiv:2605.16125)."""
from fractions import Fraction

import numpy as np

from .style import BLUE, GREY, ORANGE, note


def pictures(result, _theory, _units):
    initial = result.scene.get("initial", {})
    if (initial.get("type") == "cold" and initial.get("place") == "left" and len(initial.get("masses", ())) == 2
            and len(result.events.get("time", ())) and order(result) != 0):
        yield "domino", draw, result


def order(result):
    """k with m/mu = c/(1 - c), c = cos(pi/(2k + 1)); 0 if there is no such k."""
    heavy, light = (float(mass) for mass in result.scene["initial"]["masses"])
    turns = np.pi / np.arccos(heavy / (heavy + light))
    k = int(turns // 2)
    return k if k > 0 and abs(turns - (2 * k + 1)) < 1e-6 * turns else 0


def first_hits(result):
    """Heavy particles, and how much later than in the closed form each is first hit, in times between two hits."""
    events, initial = result.events, result.scene["initial"]
    step = Fraction(str(initial.get("spacing", 1))) / Fraction(str(initial.get("speed", 1)))
    right = events["right"].astype(np.int64)
    before = np.maximum.accumulate(np.concatenate([[0], right[:-1]]))
    first = np.flatnonzero((right > before) & (right % 2 == 0))
    time, low, delay = events["time"].values, events["time_low"].values, delay_of(result)
    late = [(Fraction(time[e]) + Fraction(low[e])) / step - (int(right[e]) - delay) for e in first]
    return right[first], np.array(late, float)


def draw(result, panels):
    particle, late = first_hits(result)
    top, below = panels.stacked("particle on the right", r"$|t_n-(n-c_k)|\,u/a$", height=2.6)
    events = result.events
    some = events["right"] <= 24
    top.plot(events["time"][some], events["right"][some], "o", ms=3, color=GREY, label="collisions")
    shown = particle <= 24
    exactly = (particle - late)[shown] - float(delay_of(result))
    top.plot(exactly, particle[shown], "x", ms=5, color=ORANGE, label="closed form")
    top.set_xlabel(r"time $t\,u/a$")
    top.legend(loc="upper left")
    size = np.abs(late)
    precision = str(result.attributes.get("precision", ""))
    below.loglog(particle[size > 0], size[size > 0], "o", ms=2.5, color=BLUE, label=precision)
    below.set_xlabel("heavy particle $n$")
    note(below, f"k = {order(result)}; {(size == 0).sum()} of {len(size)} exact to the digits kept")
    below.legend(loc="upper left")


def delay_of(result):
    heavy, light = (Fraction(str(mass)) for mass in result.scene["initial"]["masses"])
    return 1 - (heavy + light) / (2 * heavy)
