"""How many particles collapse: the share of the replicas on a ring, at a wall or between two that collapse against the
number of particles, for each restitution of a sweep. Half of them collapse at a number that is compared with McNamara
and Young's estimate and with the exact number of particles in free space, or at a wall, which is a mirror."""
import numpy as np

from .scenarios import critical_number, wilson
from .style import shaded


def pictures(result, _theory, _units):
    curves = curves_of(result)
    if curves and max(len(points) for points in curves.values()) >= 3:
        yield "onset", draw, curves, any("walls" in point.scene for point in result.points)


def can_collapse(point):
    """On a ring, or at walls that lose as much as a collision of two."""
    walls = [wall for wall in point.scene.get("walls", {}).values() if isinstance(wall, dict)]
    restitution = point.setting("law", "restitution")
    return point.word("run", "collapse") == "stop" and (
        point.word("initial", "type") == "ring" or walls and all(w.get("restitution") == restitution for w in walls))


def particles_of(point):
    initial = point.scene["initial"]
    return initial["particles"] if "particles" in initial else sum(initial[s]["particles"] for s in ("left", "right"))


def curves_of(result):
    """(N, collapsed, replicas) by increasing N for each restitution; for those that stop at a collapse."""
    found = {}
    for point in result.points:
        if not can_collapse(point) or "collapse_time" not in point.replicas:
            continue
        known = np.isfinite(point.replicas["collapse_time"])
        found.setdefault(point.setting("law", "restitution"), []).append(
            (particles_of(point), int(known.sum()), len(known)))
    return {eps: sorted(points) for eps, points in sorted(found.items())}


def half(points):
    """N at which half of the replicas collapse, interpolated at the first crossing; NaN if there is none."""
    share = np.array([hits / count for _, hits, count in points])
    at = np.array([number for number, _, _ in points])
    above = np.flatnonzero(share >= 0.5)
    if not above.size or above[0] == 0:
        return np.nan
    k = above[0]
    return at[k - 1] + (at[k] - at[k - 1]) * (0.5 - share[k - 1]) / (share[k] - share[k - 1])


def draw(curves, walled, panels):
    left, right = panels(1, 2, figsize=(7.4, 3.4))
    for (eps, points), colour in shaded(curves.items()):
        number = np.array([n for n, _, _ in points])
        share, low, high = np.array([wilson(hits, count) for _, hits, count in points]).T
        left.errorbar(number * (1 - eps), share, yerr=[share - low, high - share], fmt="o-", ms=3, lw=0.9, capsize=2,
                      color=colour, label=rf"$r={eps:g}$")
    left.set(xlabel=r"$N(1-r)$", ylabel="part of the replicas that collapse", ylim=(-0.03, 1.03))
    left.legend(loc="lower right")
    eps = np.array(list(curves))
    right.loglog(1 - eps, [half(points) for points in curves.values()], "o", ms=5, label="half of the replicas")
    least = [min((number for number, hits, _ in points if hits), default=np.nan) for points in curves.values()]
    right.loglog(1 - eps, least, "v", ms=4, label="one replica")
    fine = np.geomspace((1 - eps).min() / 1.5, min((1 - eps).max() * 1.5, 0.95), 100)
    right.plot(fine, np.log(4 / fine) / fine, "k--", lw=1, label=r"$\ln(4/(1-r))/(1-r)$")
    right.plot(fine, critical_number(1 - fine) / (2 if walled else 1), "k:", lw=1,
               label="at a wall, exact" if walled else "free space, exact")
    right.set(xlabel=r"$1-r$", ylabel="particles $N_c$")
    right.legend(loc="lower left")
