"""Correlations of tagged particles. Beside those of identical elastic particles at Poisson positions the exact ones
(Jepsen, J. Math. Phys. 6, 405, 1965). Such particles pass each other's velocities on, so the tagged one is always the
n-th in the line. It is to the right of y at time t if of all lines of flight more have come from its left to the right
of y than the other way; these are two Poisson numbers, of means a(y) and b(y), and its own line is one more. So with
their difference D, P(x > y) = P(D >= 1) + P(v > y/t) P(D = 0); the mean square is 4 times the integral of y P(x > y).
On a ring of N at rest as a whole the mean square is less by T t^2/N: the mean velocity, of variance T/N, is taken away.
The velocity autocorrelation is half of its second derivative."""
import math

import numpy as np

from .measured import draw_points
from .energy import ring_of
from .style import BLUE, ORANGE, note

PANELS = {"msd": "mean-square displacement ($l^2$)", "vacf": r"$\langle v(0)\,v(t)\rangle$ ($l^2/t^2$)"}


def pictures(result, _theory, _units):
    if "lag" in result.correlations:
        yield "correlations", draw, result


def displacement(t):
    """The exact mean square at one time t > 0, rho = T = m = 1."""
    largest = 8 * max(min(t, math.sqrt(t)), 1e-3 * t)  # of the displacements that matter
    y = np.linspace(0, largest, 801)
    u = y / t
    beyond = 0.5 * np.array([math.erfc(each / math.sqrt(2)) for each in u])  # P(v > y/t)
    b = t * np.exp(-u ** 2 / 2) / math.sqrt(2 * math.pi) + y * (1 - beyond)
    a = b - y
    # The distribution of D from its characteristic function, on points that its spread resolves.
    widest = min(1, math.sqrt(10 / b[0]))  # of half a turn: beyond, less than exp(-40)
    points = 64 + int(16 * widest * (math.sqrt(2 * b[0]) + largest))
    angle = (np.arange(points) + 0.5) * (widest * math.pi / points)
    size = np.exp(-np.multiply.outer(a + b, 1 - np.cos(angle)))
    turned = np.multiply.outer(a - b, np.sin(angle))
    zero = widest * (size * np.cos(turned)).mean(axis=1)  # P(D = 0)
    more = widest * (size * np.sin(turned) / np.tan(angle / 2)).mean(axis=1)  # P(D >= 1) - P(D <= -1)
    right = 0.5 * (1 - zero + more) + beyond * zero
    return 4 * (y * right).sum() * y[1]


def exact(result, lags):
    """Mean squares and autocorrelations at these lags; None of others than such particles."""
    initial = result.scene.get("initial", {})
    kind = [initial.get(key) for key in ("type", "positions", "velocities")]
    if (kind != ["ring", "poisson", "gaussian"] or result.setting("law", "restitution", 0.0) != 1
            or {"masses", "random_masses"} & initial.keys()):
        return None
    particles, speed, spacing = ring_of(result)
    unit = spacing / speed  # of time

    def squares(t):
        return displacement(t) - t ** 2 / particles

    def products(t):
        step = 0.02 * t
        return (squares(t + step) - 2 * squares(t) + squares(t - step)) / (2 * step ** 2)
    times = np.asarray(lags) / unit
    return spacing ** 2 * np.array([squares(t) for t in times]), speed ** 2 * np.array([products(t) for t in times])


def draw(result, panels):
    table = result.correlations
    lag = np.asarray(table["lag"])
    axes = panels.stacked(*PANELS.values(), x="time between the two states ($t$)", height=2.6)
    shown = lag > 0
    for ax, name in zip(axes, PANELS):
        draw_points(ax, lag, table, name, shown, color=BLUE)
        ax.set_xscale("log")
    axes[0].set_yscale("log")
    axes[1].axhline(0, color="0.6", lw=0.7)
    if shown.any():
        times = np.geomspace(lag[shown][0], lag[shown][-1], 60)
        for ax, curve in zip(axes, exact(result, times) or ()):
            ax.plot(times, curve, "--", color=ORANGE, lw=1, label="exact")
            ax.legend()
    note(axes[0], f"tagged particles, $t={table['from']:.5g}$ to ${table['until']:.5g}$, bars: standard errors")
