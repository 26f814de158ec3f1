"""Questions that each replica of a sweep answers: whether it collapses on a ring or at walls, against the number of
particles (beside McNamara and Young's estimate, and the exact number in free space or at a wall, which is a mirror);
whether the two heaviest clusters of a wet shock pass or stick (paper, section VI); when an inelastic shock collapses
(against N_c/(2 u0), section III)."""
import numpy as np

from .settings import mass_of, since_start
from .style import BLUE, GREY, RED, SKY, shaded, shades

# Of core/observe/scenario.hpp.
REGIMES = {1: ("apart", SKY), 2: ("through each other", BLUE), 3: ("stuck last", RED), 0: ("one cluster only", "0.8")}
LOSS = r"$E_\mathrm{loss}$ ($m\,l^2/t^2$)"
ENOUGH = 10  # replicas of a point of which shares are drawn


def onsets(result, _theory, _units):
    curves = shares_of(result)
    if curves and max(len(points) for points in curves.values()) >= 3:
        yield "onset", draw_onset, result, curves


def pictures(result, _theory, _units):
    if not result.sweep:
        return
    if "first_passed" in result.sweep:
        if any(len(point.replicas.get("index", ())) >= ENOUGH for point in result.points):
            yield "scenarios", draw_scenarios, result
        yield "regimes", draw_regimes, result
    elif collapsed(result):
        yield "collapse", draw_collapse, result


def wilson(hits, count):
    """Share of hits and its 95 % confidence interval (Wilson 1927, doi 10.1080/01621459.1927.10502953)."""
    z = 1.959964
    share = hits / count
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z * np.sqrt(share * (1 - share) / count + z * z / (4 * count * count)) / (1 + z * z / count)
    return share, max(0.0, middle - half), min(1.0, middle + half)


def grouped(points, *setting):
    """The points for each value of a setting, by increasing value."""
    groups = {}
    for point in points:
        groups.setdefault(point.setting(*setting), []).append(point)
    return sorted(groups.items())


def finite(values):
    values = np.asarray(values, float)
    return values[np.isfinite(values)]


def known_times(point):
    return finite(point.replicas.get("collapse_time", ()))


def critical_number(restitution):
    """N_c: more particles than this collapse in free space."""
    return 2 / (1 - 4 / np.pi * np.arctan(np.sqrt(restitution)))


def can_collapse(point):
    """On a ring, or at walls that lose as much as a collision of two."""
    walls = [wall for wall in point.scene.get("walls", {}).values() if isinstance(wall, dict)]
    restitution = point.setting("law", "restitution")
    return point.word("run", "collapse") == "stop" and (
        point.word("initial", "type") == "ring" or walls and all(w.get("restitution") == restitution for w in walls))


def particles_of(point):
    initial = point.scene["initial"]
    return initial["particles"] if "particles" in initial else sum(initial[s]["particles"] for s in ("left", "right"))


def shares_of(result):
    """(N, collapsed, replicas) by increasing N for each restitution; for those that stop at a collapse."""
    found = [point for point in result.points if can_collapse(point) and "collapse_time" in point.replicas]
    return {eps: sorted((particles_of(point), known_times(point).size, len(point.replicas["collapse_time"]))
                        for point in points) for eps, points in grouped(found, "law", "restitution")}


def half(points):
    """N at which half of the replicas collapse, interpolated at the first crossing; NaN if there is none."""
    number, hits, count = np.array(points).T
    share = hits / count
    above = np.flatnonzero(share >= 0.5)
    if not above.size or above[0] == 0:
        return np.nan
    crossing = slice(above[0] - 1, above[0] + 1)
    return np.interp(0.5, share[crossing], number[crossing])


def draw_onset(result, curves, panels):
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
    walled = any("walls" in point.scene for point in result.points)
    if all(map(mass_of, result.points)):
        right.plot(fine, np.log(4 / fine) / fine, "k--", lw=1, label=r"$\ln(4/(1-r))/(1-r)$")
        right.plot(fine, critical_number(1 - fine) / (2 if walled else 1), "k:", lw=1,
                   label="at a wall, exact" if walled else "free space, exact")
    right.set(xlabel=r"$1-r$", ylabel="particles $N_c$")
    right.legend(loc="lower left")


def curves(result):
    """The points for each perturbation, by increasing loss."""
    return {size: sorted(points, key=lambda p: p.setting("law", "loss"))
            for size, points in grouped(result.points, "initial", "perturbation", 0.0)}


def estimated(points, name, estimate):
    """Losses, and the estimate for each from the numbers of its replicas; none for fewer than ENOUGH."""
    known = [(point.setting("law", "loss"), finite(point.replicas[name])) for point in points]
    rows = [(loss, *estimate(values)) for loss, values in known if len(values) >= ENOUGH]
    return np.array(rows).reshape(-1, 4).T


def mean(values):
    error = 1.96 * values.std(ddof=1) / np.sqrt(len(values))
    return values.mean(), values.mean() - error, values.mean() + error


def draw_scenarios(result, panels):
    axes = panels.stacked("first meeting\nis a pass", "passing through\nat the end", "times stuck",
                          "exponent of\nseparation", x=LOSS, height=2.1)
    groups = curves(result)
    for (size, points), colour, mark in zip(groups.items(), shades(len(groups)), "osD^v<>"):
        for ax, name, estimate in ((axes[0], "first_passed", lambda known: wilson(known.sum(), len(known))),
                                   (axes[1], "regime", lambda known: wilson((known == 2).sum(), len(known))),
                                   (axes[2], "sticks", mean), (axes[3], "separation_exponent", mean)):
            loss, value, low, high = estimated(points, name, estimate)
            ax.errorbar(loss, value, yerr=[value - low, high - value], fmt=mark + "-", ms=4, lw=0.9, capsize=2,
                        color=colour, label=f"perturbation {size:g} $l$")
    for ax in axes[:2]:
        ax.set_ylim(-0.03, 1.03)
    axes[2].set_yscale("symlog", linthresh=1)
    axes[2].set_ylim(0, None)
    axes[3].axhline(1 / 3, color=GREY, lw=0.8, zorder=0)
    axes[3].set_xscale("log")
    axes[0].set_title("95 % confidence", loc="right", fontsize=7)


def draw_regimes(result, panels):
    """The outcomes of the replicas as shares, for each loss and size of perturbation."""
    groups = curves(result)
    axes = panels.stacked(*(f"perturbation {size:g} $l$" for size in groups), x=LOSS, height=1.9)
    for ax, points in zip(axes, groups.values()):
        below = np.zeros(len(points))
        places = np.arange(len(points))
        for regime, (name, colour) in REGIMES.items():
            share = np.array([np.mean(point.replicas["regime"] == regime) for point in points])
            ax.bar(places, share, bottom=below, width=0.85, color=colour, label=name)
            below += share
        ax.set_ylim(0, 1)
        losses = [f"{point.setting('law', 'loss'):.2g}" for point in points]
        ax.set_xticks(places, losses, fontsize=7, rotation=90 if len(points) > 13 else 0)
    axes[0].legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=4)


def collapsed(result):
    """The points of shocks of which enough replicas have collapsed for a distribution."""
    return [p for p in result.points if p.word("initial", "type") == "rows" and known_times(p).size >= ENOUGH]


def draw_collapse(result, panels):
    """Distributions of t_c over replicas, in units of the time when N_c particles are engaged."""
    ax = panels(figsize=(5.2, 3.6))
    for point, colour in shaded(collapsed(result)):
        restitution, speed = point.setting("law", "restitution"), point.setting("initial", "speed", 0.5)
        spacing = point.setting("initial", "spacing", 1.0)
        engaged = critical_number(restitution) * spacing / (2 * speed)
        times = since_start(point, known_times(point)) / engaged
        ax.hist(times, bins=max(8, int(np.sqrt(len(times)) * 1.5)), density=True, histtype="step", lw=1.4, color=colour,
                label=rf"$r={restitution:g}$: {times.mean():.4f} $\pm$ {times.std(ddof=1):.4f}, "
                      f"{len(times)} replicas")
    if all(map(mass_of, result.points)):  # N_c is that of equal masses
        ax.axvline(1, color=GREY, lw=0.8, zorder=0)
    ax.set(xlabel=r"collapse time $t_c\,/\,(N_c/2u_0)$", ylabel="probability density")
    ax.legend(loc="upper left", bbox_to_anchor=(0.06, 1.0))
