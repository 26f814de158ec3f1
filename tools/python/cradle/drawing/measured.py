"""What a run measures on request, with standard errors: averages over time in bins; histograms as densities, counts
divided by their sum and by the width of the bin; correlations of tagged particles; structure factors and pair
distributions, of a sweep those of all points. Beside them what is exact: the heat current of identical elastic
particles between thermal walls, which pass each other, J = n (T1 - T2) / (sqrt(pi m/2) (T1^-1/2 + T2^-1/2));
their closing speeds in equilibrium on a ring, w/(2 T) exp(-w^2/(4 T)); 1 for places that are independent.
"""
import functools
import math

import numpy as np

from .energy import ring_of
from .settings import mass_of
from .style import BLUE, ORANGE, beside, distinct, note, shaded, shades, thinned
from .sweep import label_of

AVERAGES = {"density": "density $n$ ($1/l$)", "velocity": "mean velocity\n$u$ ($l/t$)",
            "temperature": "temperature\n$T$ ($m\\,l^2/t^2$)", "heat_current": "heat current\n$J$ ($m\\,l^2/t^3$)"}
HISTOGRAMS = {"free_flight": "time between two collisions of a particle ($t$)",
              "pair_flight": "time between two collisions of a pair ($t$)",
              "closing_speed": "closing speed ($l/t$)",
              "dissipative_closing_speed": "closing speed of dissipative collisions ($l/t$)",
              "collisions_per_particle": "collisions of a particle",
              "gap": "gap ($l$)", "cluster": "particles of a cluster"}
CORRELATIONS = {"msd": "mean-square displacement ($l^2$)", "vacf": r"$\langle v(0)\,v(t)\rangle$ ($l^2/t^2$)"}
PLACES = (("structure_factor", "structure", "s", "k", "wave number $k$ ($1/l$)", "structure factor $S(k)$",
           {"xscale": "log", "yscale": "log"}),
          ("pair_distribution", "pair_distribution", "pair_distribution", "distance", "distance $r$ ($l$)",
           "pair distribution $g(r)$", {}))


def pictures(result, _theory, _units):
    if "x" in result.averages:
        yield "averages", draw_averages, result
    names = [name for name in HISTOGRAMS if name in result.histograms and counted(result.histograms[name])[1].any()]
    if names:
        yield "histograms", draw_histograms, result, names
    if "lag" in result.correlations and (np.asarray(with_error(result.correlations, "msd")[0]) > 0).any():
        yield "correlations", draw_correlations, result
    for name, group, *labels in PLACES:
        if result.sweep and any(len(getattr(p, group)) for p in result.points):
            yield name, draw_places_of_points, result, group, *labels
        elif not result.sweep and (len(getattr(result, group)) or getattr(result, group + "_average")):
            yield name, draw_places, result, group, *labels


def with_error(table, name):
    """Values and standard errors (None: not known) of a quantity, of a run or of an ensemble."""
    quantity = table[name]
    return (quantity["mean"], quantity["sem"]) if "mean" in quantity else (quantity, table.get(name + "_sem"))


def draw_points(ax, x, table, name, shown=slice(None), **how):
    """The values of a quantity at these x, with bars for standard errors that are known."""
    value, error = (np.asarray(numbers, float)[shown] for numbers in with_error(table, name))
    ax.errorbar(x[shown], value, yerr=np.where(np.isfinite(error), error, 0), fmt="o", ms=3, lw=0.9, **how)


def exact_current(result):
    """The heat current of identical elastic particles between thermal walls at rest; without gravity. Else None."""
    temperatures = [result.setting("walls", f"{side}.temperature") for side in ("left", "right")]
    walls = result.scene.get("walls", {})
    moving = result.setting("gravity", "acceleration", 0.0) != 0 or any(
        result.setting("walls", f"{side}.speed", 0.0) or walls.get(side, {}).get("motion", "none") != "none"
        for side in ("left", "right"))
    mass = mass_of(result)
    if None in (*temperatures, mass) or moving or result.setting("law", "restitution", 0.0) != 1:
        return None
    density, _ = with_error(result.averages, "density")
    left, right = temperatures
    return np.mean(density) * (left - right) / (np.sqrt(np.pi * mass / 2) * (left ** -0.5 + right ** -0.5))


def draw_averages(result, panels):
    table = result.averages
    x = np.asarray(table["x"])
    axes = panels.stacked(*AVERAGES.values(), x="position $x$ ($l$)", height=1.9)
    for ax, name in zip(axes, AVERAGES):
        draw_points(ax, x, table, name, color=BLUE)
    if (current := exact_current(result)) is not None:
        axes[-1].axhline(current, color=ORANGE, lw=1, ls="--", label=f"exact, {current:.4g}")
    note(axes[0], f"averages over $t={table['from']:.5g}$ to ${table['until']:.5g}$, bars: standard errors")


def counted(table):
    """Whether a bin has two edges other than 0, and the counts of a run, or their means and standard errors."""
    count = table["count"]
    mean, error = (count["mean"], count["sem"]) if "mean" in count else (count, np.sqrt(count))
    low, high = np.asarray(table["low"]), np.asarray(table["high"])
    drawn = np.isfinite(high) & (low > 0)
    return drawn, np.nan_to_num(np.asarray(mean, float)) * drawn, np.asarray(error, float)  # NaN: of no replica


def variance(result):
    """Of the velocities on a ring in equilibrium; None of others."""
    elastic = result.setting("law", "restitution", 0.0) == 1 and mass_of(result) is not None
    on_ring = result.word("initial", "type") == "ring" and result.word("initial", "velocities") == "gaussian"
    return result.setting("initial", "variance", 1.0) if elastic and on_ring else None


def draw_histograms(result, names, panels):
    axes = panels.stacked(*["density"] * len(names), height=2.2)
    for ax, name in zip(axes, names):
        table = result.histograms[name]
        drawn, count, error = counted(table)
        shown = drawn & (count > 0)
        low, high = np.asarray(table["low"])[shown], np.asarray(table["high"])[shown]
        scale = 1 / (count.sum() * (high - low))
        x = np.sqrt(low * high)
        ax.errorbar(x, count[shown] * scale, yerr=error[shown] * scale, fmt="o", ms=2.5, lw=0.8, color=BLUE)
        if name == "closing_speed" and (T := variance(result)) is not None:
            ax.plot(x, x / (2 * T) * np.exp(-x ** 2 / (4 * T)), "--", color=ORANGE, lw=1, label="equilibrium")
        ax.set(xscale="log", yscale="log", xlabel=HISTOGRAMS[name])
    note(axes[0], f"counted at $t={table['from']:.5g}$ to ${table['until']:.5g}$")


def draw_places(result, group, name, along, xlabel, ylabel, scales, panels):
    ax = panels(figsize=(5.6, 3.2))
    for table, colour in shaded(thinned(getattr(result, group))):
        ax.plot(table[along], with_error(table, name)[0], color=colour, lw=1, label=f"$t={table['time']:.5g}$")
    if mean := getattr(result, group + "_average"):
        draw_points(ax, mean[along], mean, name, color="k", label=f"${mean['from']:.5g}$ to ${mean['until']:.5g}$")
    ax.axhline(1, color=ORANGE, lw=1, ls="--", label="independent")
    ax.set(**scales, xlabel=xlabel, ylabel=ylabel)
    beside(ax)


def draw_places_of_points(result, group, name, along, xlabel, ylabel, scales, panels):
    points = [p for p in result.points if len(getattr(p, group))]
    times = thinned(getattr(points[0], group).times)
    axes = panels.stacked(*[ylabel] * len(times), x=xlabel, height=2.4)
    for ax, time in zip(axes, times):
        for point, colour, label in zip(points, shades(len(points)), distinct(map(label_of, points), points)):
            table = getattr(point, group).at(time, "nearest")
            ax.plot(table[along], with_error(table, name)[0], color=colour, lw=1, label=label)
        ax.axhline(1, color=ORANGE, lw=1, ls="--")
        ax.set(**scales, title=f"$t={time:.5g}$")
    axes[0].legend(fontsize=7)


@functools.cache  # of a second, for light and dark
def displacement(t, particles):
    """The exact mean-square displacement at one time t > 0 of identical elastic particles at independent places on a
    ring at rest, for rho = T = m = 1 (for infinitely many Jepsen, J. Math. Phys. 6, 405, 1965).

    Such particles pass each other's velocities on, so the tagged one is always the n-th in the line. It is to the right
    of y at time t if of all lines of flight more have come from its left to the right of y than the other way; with
    their difference D, P(x > y) = P(D >= 1), and the mean square is 4 times the integral of y P(x > y). Unrolled, a
    particle has a line in every length L of the ring. With w = v t - y the lines of another one, at random places, add
    to D the whole numbers q beside w/L with the probabilities 1 - |w/L - q|; its own add w/L, rounded up. Velocities
    are independent here: of a ring at rest the mean velocity, of variance T/N, is taken off, and t^2/N with it. After
    t = 2 L all places are random, to less than rounding, and the mean square stays (N - 1)/6.
    """
    t = min(t, 2.0 * particles)
    largest = 8 * max(min(t, math.sqrt(t)), t / math.sqrt(particles))  # of the displacements that matter
    y = np.linspace(0, largest, 101)
    turns = np.arange(math.floor(-(8 * t + largest) / particles) - 1, math.ceil(8 * t / particles) + 3)
    u = np.add.outer(y, turns * particles) / t
    faster = np.array([[math.erfc(each / math.sqrt(2)) / 2 for each in row] for row in u])  # P(v > u)
    ahead = (np.exp(-u ** 2 / 2) / math.sqrt(2 * math.pi) - u * faster) * t / particles  # the mean positive w/L - q
    other, own = np.diff(ahead, 2), -np.diff(faster)[:, :-1]  # P(q) of a line
    # The distribution of D from its characteristic function, on points that its spread resolves.
    spread = (particles - 1) * (other @ turns[1:-1] ** 2)[0]
    widest = min(1, math.sqrt(20 / spread)) if spread > 0 else 1  # of half a turn: beyond, less than exp(-40)
    points = 64 + int(16 * widest * (math.sqrt(spread) + largest + len(turns)))
    angle = (np.arange(points) + 0.5) * (widest * math.pi / points)
    wave = np.exp(1j * np.multiply.outer(turns[1:-1], angle))
    one = other @ wave
    size = np.abs(one) ** (particles - 1) * np.exp(1j * (particles - 1) * np.angle(one)) * (own @ wave)
    zero = widest * size.real.mean(axis=1)  # P(D = 0)
    more = widest * (size.imag / np.tan(angle / 2)).mean(axis=1)  # P(D >= 1) - P(D <= -1)
    # The sum over steps h is less than the integral by the first term of Euler and Maclaurin, h^2/12 of the slope 1/2.
    return 2 * (y * (1 - zero + more)).sum() * y[1] + y[1] ** 2 / 6 - t ** 2 / particles


def exact_correlations(result, lags):
    """Mean squares and autocorrelations, half of their second derivatives, at these lags; None of other particles."""
    initial = result.scene.get("initial", {})
    kind = [initial.get(key) for key in ("type", "positions", "velocities")]
    if (kind != ["ring", "poisson", "gaussian"] or result.setting("law", "restitution", 0.0) != 1
            or mass_of(result) is None):
        return None
    particles, speed, spacing = ring_of(result)
    times = np.asarray(lags) * speed / spacing
    step = 0.02
    before, now, after = ([displacement(t * (1 + k), particles) for t in times] for k in (-step, 0, step))
    products = np.diff([before, now, after], 2, axis=0)[0] / (2 * (step * times) ** 2)
    return spacing ** 2 * np.array(now), speed ** 2 * products


def draw_correlations(result, panels):
    table = result.correlations
    lag = np.asarray(table["lag"])
    axes = panels.stacked(*CORRELATIONS.values(), x="time between the two states ($t$)", height=2.6)
    shown = lag > 0
    for ax, name in zip(axes, CORRELATIONS):
        draw_points(ax, lag, table, name, shown, color=BLUE)
        ax.set_xscale("log")
    axes[0].set_yscale("log")
    axes[1].axhline(0, color="0.6", lw=0.7)
    if shown.any():
        times = np.geomspace(lag[shown][0], lag[shown][-1], 60)
        for ax, curve in zip(axes, exact_correlations(result, times) or ()):
            ax.plot(times, curve, "--", color=ORANGE, lw=1, label="exact")
            ax.legend()
    note(axes[0], f"tagged particles, $t={table['from']:.5g}$ to ${table['until']:.5g}$, bars: standard errors")
