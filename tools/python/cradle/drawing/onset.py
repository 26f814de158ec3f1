"""How many particles collapse: the share of the replicas of a ring that collapse against the number of particles,
for each restitution of a sweep. Half of them collapse at a number that is compared with McNamara and Young's
estimate and with the exact number of particles in free space."""
import numpy as np

from .scenarios import wilson
from .style import shades, subplots


def pictures(result, _theory, _units):
    curves = curves_of(result)
    if not curves or max(len(points) for points in curves.values()) < 3:
        return []
    return [("onset", lambda axes=None: draw(curves, axes))]


def curves_of(result):
    """(N, collapsed, replicas) by increasing N for each restitution; for rings that stop at a collapse."""
    found = {}
    for point in result.points:
        if point.word("initial", "type") != "ring" or point.word("run", "collapse") != "stop":
            continue
        if "collapse_time" not in point.replicas:
            continue
        known = np.isfinite(point.replicas["collapse_time"])
        found.setdefault(point.setting("law", "restitution"), []).append(
            (point.setting("initial", "particles"), int(known.sum()), len(known)))
    return {eps: sorted(points) for eps, points in sorted(found.items())}


def free(eps):
    return 2 / (1 - 4 / np.pi * np.arctan(np.sqrt(eps)))


def half(points):
    """N at which half of the replicas collapse, interpolated at the first crossing; NaN if there is none."""
    share = np.array([hits / count for _, hits, count in points])
    at = np.array([number for number, _, _ in points])
    above = np.flatnonzero(share >= 0.5)
    if not above.size or above[0] == 0:
        return np.nan
    k = above[0]
    return at[k - 1] + (at[k] - at[k - 1]) * (0.5 - share[k - 1]) / (share[k] - share[k - 1])


def draw(curves, axes=None):
    figure, (left, right) = subplots(axes, 1, 2, figsize=(7.4, 3.4))
    for (eps, points), colour in zip(curves.items(), shades(len(curves))):
        number = np.array([n for n, _, _ in points])
        share, low, high = np.array([wilson(hits, count) for _, hits, count in points]).T
        left.errorbar(number * (1 - eps), share, yerr=[share - low, high - share], fmt="o-", ms=3, lw=0.9, capsize=2,
                      color=colour, label=rf"$\epsilon={eps:g}$")
    left.set(xlabel=r"$N(1-\epsilon)$", ylabel="part of the rings that collapse", ylim=(-0.03, 1.03))
    left.legend(loc="lower right")
    eps = np.array(list(curves))
    right.loglog(1 - eps, [half(points) for points in curves.values()], "o", ms=5, label="half of the rings")
    least = [min((number for number, hits, _ in points if hits), default=np.nan) for points in curves.values()]
    right.loglog(1 - eps, least, "v", ms=4, label="one ring")
    fine = np.geomspace((1 - eps).min() / 1.5, min((1 - eps).max() * 1.5, 0.95), 100)
    right.plot(fine, np.log(4 / fine) / fine, "k--", lw=1, label=r"$\ln(4/(1-\epsilon))/(1-\epsilon)$")
    right.plot(fine, free(1 - fine), "k:", lw=1, label="free space, exact")
    right.set(xlabel=r"$1-\epsilon$", ylabel="particles $N_c$")
    right.legend(loc="lower left")
    return figure
