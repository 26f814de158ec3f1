"""Cold gases that are set in motion, beside closed forms (derived in bench/results/classics.md). A blast: fronts, and
profiles over x/R (Euler's equations for gamma = 3; arXiv:2010.15868). Dominoes of two masses: when each heavy particle
is first hit, t = n - 1 + 1/(2c), c = m/(m + mu), if the front is ballistic (arXiv:2605.16125). A splash, the outermost
particle kicked: front and energy at x > 0, with exponents for every point of a sweep."""
from fractions import Fraction

import numpy as np

from .settings import mean_mass, since_label, since_start
from .style import BLUE, GREY, ORANGE, note, power, shades

AMPLITUDE = 1071 / 152  # of a blast: R^3 rho/(E t^2)
FRONT, ENERGY = 0.627952, -0.116144  # exponents of a splash, by Euler's equations
LAST = 0.1  # exponents are fitted over the last decade of time


def pictures(result, _theory, _units):
    initial = result.scene.get("initial", {})
    cold, half_line = initial.get("type") == "cold", initial.get("place") == "left"
    if (cold and not half_line and result.setting("initial", "hot", 1) >= 2
            and result.setting("law", "restitution") == 1):
        yield "blast", draw_blast, result
    elif (cold and half_line and len(initial.get("masses", ())) == 2 and len(result.events.get("time", ()))
          and order(result) != 0):
        yield "domino", draw_dominoes, result
    elif points := [p for p in (result.points or [result]) if is_splash(p)]:
        yield "splash", draw_splash, points


# ---- a blast

def solution(size=400):
    """xi, density, velocity relative to the front's, and temperature relative to its square, for V from 1/3 to 1/2."""
    v = 1 / 3 + np.linspace(1e-3, 1, size) ** 3 / 6
    xi = (6 * v - 2) ** 0.4 * (2 * v) ** (-2 / 3) * (3 - 4 * v) ** (-11 / 15)
    density = 2 * (2 - 2 * v) ** 2 * (6 * v - 2) ** 0.2 * (3 - 4 * v) ** (-11 / 5)
    return xi, density, xi * v, (xi * v) ** 2 * (1 - v) / (3 * v - 1)


def draw_blast(result, panels):
    energy, rho = result.setting("initial", "energy"), mean_mass(result) / result.setting("initial", "spacing", 1.0)
    axes = panels(2, 2, figsize=(7.2, 5.6))
    draw_front(axes[0, 0], result, energy, rho)
    others, (xi, *solutions) = axes.flat[1:], solution()
    for profile, spread, colour in zip(result.mean_profiles, result.profiles, shades(len(result.profiles))):
        time = since_start(result, profile["time"])
        front = np.cbrt(AMPLITUDE * energy * time ** 2 / rho)
        speed = 2 * front / (3 * time)
        place = profile["x"] / front
        shown = np.abs(place) < 1.3
        for ax, name, unit in zip(others, ("mass_density", "velocity", "temperature"), (rho, speed, speed ** 2)):
            mean = profile[name] / unit
            ax.plot(place[shown], mean[shown], color=colour, lw=0.9, label=f"$t={power(profile['time'])}$")
            if result.replicas:
                error = spread[name]["sem"] / unit
                ax.fill_between(place[shown], (mean - error)[shown], (mean + error)[shown], color=colour, alpha=0.2,
                                lw=0)
    for ax, exact, odd, label, top in zip(others, solutions, (False, True, False), (
            r"density $\rho\,/\,\rho_0$", r"velocity $u\,/\,\dot R$", r"temperature $\theta\,/\,\dot R^2$"),
            (2.4, 0.75, 1.5)):
        ax.plot(xi, exact, "k--", lw=1, zorder=3, label="Euler, exact")
        ax.plot(-xi, -exact if odd else exact, "k--", lw=1, zorder=3)
        ax.set(xlabel=r"$x\,/\,R(t)$", ylabel=label, xlim=(-1.3, 1.3), ylim=(-top if odd else 0, top))
    others[0].legend(loc="upper center", ncol=2)


def draw_front(ax, result, energy, rho):
    """R^3 rho/(E t^2) of both fronts; it tends to A as the gas forgets its initial state."""
    series = result.means
    time = since_start(result, series["time"])
    later = time > 0
    time = time[later]
    front = (series["front_right"][later] - series["front_left"][later]) / 2
    value = front ** 3 * rho / (energy * time ** 2)
    seen = np.isfinite(value) & (value < 4 * AMPLITUDE)
    ax.semilogx(time[seen], value[seen], color=BLUE, lw=1.4, label="outermost particles")
    if result.replicas:
        sem = np.hypot(result.series["front_right"]["sem"], result.series["front_left"]["sem"])[later] / 2
        error = 3 * value * sem / front
        ax.fill_between(time[seen], (value - error)[seen], (value + error)[seen], color=BLUE, alpha=0.25, lw=0)
    ax.axhline(AMPLITUDE, color="k", ls="--", label="$A=1071/152$")
    ax.axhspan(0.98 * AMPLITUDE, 1.02 * AMPLITUDE, color=GREY, alpha=0.3, lw=0, label=r"$\pm 2\,\%$")
    ax.set(xlabel=since_label(result), ylabel=r"$R^3\rho_0\,/\,(Et^2)$", ylim=(0, 2.5 * AMPLITUDE))
    ax.legend(loc="upper right")


# ---- dominoes

def order(result):
    """k with m/mu = c/(1 - c), c = cos(pi/(2k + 1)); 0 if there is no such k."""
    heavy, light = (float(mass) for mass in result.scene["initial"]["masses"])
    turns = np.pi / np.arccos(heavy / (heavy + light))
    k = int(turns // 2)
    return k if k > 0 and abs(turns - (2 * k + 1)) < 1e-6 * turns else 0


def step_of(result):
    """The time that the first particle takes to the next one."""
    initial = result.scene["initial"]
    return Fraction(str(initial.get("spacing", 1))) / Fraction(str(initial.get("speed", 1)))


def first_hits(result):
    """Heavy particles, and how much later than in the closed form each is first hit, in times between two hits."""
    events, step = result.events, step_of(result)
    right = events["right"].astype(np.int64)
    before = np.maximum.accumulate(np.concatenate([[0], right[:-1]]))
    first = np.flatnonzero((right > before) & (right % 2 == 0))
    time, low, delay = events["time"].values, events["time_low"].values, delay_of(result)
    start = Fraction(str(result.scene["run"].get("start", 0)))
    late = [(Fraction(time[e]) + Fraction(low[e]) - start) / step - (int(right[e]) - delay) for e in first]
    return right[first], np.array(late, float)


def draw_dominoes(result, panels):
    particle, late = first_hits(result)
    top, below = panels.stacked("particle on the right", r"$|t_n-(n-c_k)|\,u/a$", height=2.6)
    events = result.events
    some = events["right"] <= 24
    time = since_start(result, events["time"][some]) / float(step_of(result))
    top.plot(time, events["right"][some], "o", ms=3, color=GREY, label="collisions")
    shown = particle <= 24
    top.plot(particle[shown] - float(delay_of(result)), particle[shown], "x", ms=5, color=ORANGE, label="closed form")
    top.set_xlabel(since_label(result, r"time $t\,u/a$"))
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


# ---- a splash

def is_splash(point):
    initial = point.scene.get("initial", {})
    one_bin = len(point.mean_profiles) > 2 and all(len(p["x"]) == 1 and p["x"][0] > 0 for p in point.mean_profiles)
    return initial.get("type") == "cold" and initial.get("place") == "left" and one_bin


def energies(point):
    """Times since the start, and M (theta + u^2)/2 of the single bin, which begins at x = 0."""
    time = since_start(point, [p["time"] for p in point.mean_profiles])
    width = np.array([2 * p["x"][0] for p in point.mean_profiles])
    mass, speed, temperature = (np.array([p[name][0] for p in point.mean_profiles])
                                for name in ("mass_density", "velocity", "temperature"))
    return time, mass * width * (temperature + speed ** 2) / 2


def fit(time, value):
    late = (time >= LAST * time[-1]) & (time > 0) & (value > 0)
    return np.polyfit(np.log(time[late]), np.log(value[late]), 1)[0]


def draw_splash(points, panels):
    axes = panels(2, 2, figsize=(7.2, 5.2), sharex="col", width_ratios=(1.6, 1))
    fronts = [(since_start(p, p.means["time"]), p.means["front_right"]) for p in points]
    inside = [energies(p) for p in points]
    for row, (curves, known, label, colour) in enumerate(((fronts, FRONT, "front $R$ ($l$)", BLUE),
                                                          (inside, ENERGY, r"energy at $x>0$ ($m\,l^2/t^2$)", ORANGE))):
        left, right = axes[row]
        for time, value in curves:
            seen = (time > 0) & np.isfinite(value) & (value > 0)
            left.loglog(time[seen], value[seen], ".-" if row else "-", color=colour, lw=0.7, ms=3, alpha=0.6)
        time = np.geomspace(*(curves[0][0][-1] * np.array([1e-3, 1])), 50)
        left.plot(time, curves[0][1][-1] * (time / time[-1]) ** known, "k--", lw=1, label=f"$t^{{{known}}}$")
        left.set_ylabel(label)
        left.legend(loc="lower right" if row == 0 else "upper right")
        slopes = np.array([fit(*curve) for curve in curves])
        mean = slopes.mean()
        error = slopes.std(ddof=1) / np.sqrt(len(slopes)) if len(slopes) > 1 else np.nan
        right.plot(np.arange(len(slopes)), slopes, "o", ms=4, color=colour)
        right.axhline(known, color="k", ls="--", lw=1, label="Euler's equations")
        right.legend()
        if np.isfinite(error):
            right.axhspan(mean - 2 * error, mean + 2 * error, color=colour, alpha=0.2, lw=0)
        right.set_title(f"{mean:.5f} ± {error:.5f}" if np.isfinite(error) else f"{mean:.5f}", fontsize=8)
        right.set_ylabel("exponent, last decade")
    axes[1, 0].set_xlabel(since_label(points[0]))
    axes[1, 1].set_xlabel("ensemble")
