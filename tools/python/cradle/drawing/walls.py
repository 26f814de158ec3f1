"""Between walls. At rest: the positions of a gas, its energies, and the energy from the walls (Du, Li and Kadanoff,
Phys. Rev. Lett. 74, 1268, 1995). Shaken (formulas: core/laws/README.md): the height of one ball once a period against
the amplitude, with the first period doubling; of a column of beads against X = N (1 - r), beside nearly elastic ones.
"""
import numpy as np

from .particles import MARKED, few, one_falls
from .settings import mean_mass
from .style import BLUE, GREY, ORANGE, shaded

FEW = 12  # snapshots, for quantiles against time to mean something
LAST = 64  # samples of a ball that are shown


def pictures(result, _theory, _units):
    if given_by(result.means) and len(result.snapshots) >= FEW and not few(result):
        yield "walls", draw_gas, result


def given_by(series):
    """The names of the columns with the energy that each wall has given."""
    return [name for name in ("wall_left_energy", "wall_right_energy") if name in series]


def shaken(result, _theory, _units):
    points = [point for point in result.points if floor_of(point) and point.setting("gravity", "acceleration", 0.0) < 0]
    if len(points) < 3:
        return
    if one_falls(points[0]):
        yield "bouncing", draw_ball, points
    elif all(floor_of(point)["motion"] == "sawtooth" for point in points):
        yield "column", draw_column, points


# ---- a gas

def draw_gas(result, panels):
    series, snapshots = result.means, result.snapshots
    axes = panels.stacked("position $x$ ($l$)", "share of the energy\nthat one particle has", r"energy ($m\,l^2/t^2$)",
                          x="time ($t$)", height=2.2)
    times = np.array([s["time"] for s in snapshots])
    places = np.array([np.quantile(s["x"], (0.1, 0.5, 0.9)) for s in snapshots])
    energies = [0.5 * s["m"] * s["v"] ** 2 for s in snapshots]
    fastest = np.array([s["x"][e.argmax()] for s, e in zip(snapshots, energies)])
    share = np.array([e.max() / e.sum() if e.sum() > 0 else np.nan for e in energies])
    axes[0].fill_between(times, places[:, 0], places[:, 2], color=BLUE, alpha=0.3, lw=0, label="80 % of the particles")
    axes[0].plot(times, places[:, 1], color=BLUE, lw=1.2, label="median")
    axes[0].plot(times, fastest, "o", color=ORANGE, ms=3 if len(times) <= MARKED else 1.5,
                 label="the particle with most energy")
    low, high = axes[0].get_ylim()
    axes[0].set_ylim(low - 0.2 * (high - low), high)  # room for the legend
    axes[0].legend(loc="lower left", ncol=3, fontsize=7)
    axes[1].plot(times, share, "o-" if len(times) <= MARKED else "-", color=ORANGE, ms=3, lw=0.8)
    axes[1].axhline(1 / len(snapshots[-1]["x"]), color=GREY, lw=0.8, ls="--", label="equal shares")
    axes[1].set_ylim(0, min(1.05, 1.6 * np.nanmax(share)))
    axes[1].legend(fontsize=7)
    positive = series["energy"] > 0
    axes[2].semilogy(series["time"][positive], series["energy"][positive], color=BLUE, lw=0.8, label="energy")
    given = sum(np.asarray(series[name]) for name in given_by(series))
    for sign, line, label in ((1, "-", "given by the walls"), (-1, "--", "taken by the walls")):
        if (there := sign * given > 0).any():
            axes[2].semilogy(series["time"][there], sign * given[there], line, color=ORANGE, lw=1.2, label=label)
    axes[2].legend(fontsize=7)


# ---- a shaken floor

def floor_of(point):
    """The left wall, if it is shaken."""
    wall = point.scene.get("walls", {}).get("left", {})
    return wall if wall.get("motion", "none") != "none" else {}


def heights(point, particles):
    """Of the centre of mass over the place of the floor, at all samples."""
    energy = np.asarray(point.means["potential_energy"])
    weight = particles * mean_mass(point) * -point.setting("gravity", "acceleration")
    return energy / weight - floor_of(point)["position"]


def doubling(restitution):
    """A omega^2/g at which the flight of one period of a ball on a sine doubles its period."""
    r = restitution
    return np.hypot(2 * (1 + r * r) / (1 + r) ** 2, np.pi * (1 - r) / (1 + r))


def draw_ball(points, panels):
    ax = panels(figsize=(7.4, 3.6))
    for point in points:
        floor, g = floor_of(point), -point.setting("gravity", "acceleration")
        strength = floor["amplitude"] * floor["frequency"] ** 2 / g
        last = heights(point, 1)[-LAST:]
        ax.plot(np.full(len(last), strength), last * floor["frequency"] ** 2 / g, ".", ms=1.5, color=BLUE, mew=0)
    r = floor_of(points[0])["restitution"]
    ax.axvline(1, color=GREY, lw=0.8, ls=":", label="the floor lets go")
    ax.axvline(doubling(r), color=ORANGE, lw=1, ls="--", label=f"periods double, {doubling(r):.4f}")
    ax.set(xlabel=r"$A\omega^2/g$", ylabel=r"height once a period $x\,\omega^2/g$")
    ax.legend(loc="upper left")


def column_of(point):
    """X, V and the mean height over the later half of the samples, with its error from blocks of them."""
    particles = point.setting("initial", "particles")
    later = heights(point, particles)[len(point.means["time"]) // 2:]
    blocks = np.array([block.mean() for block in np.array_split(later, min(16, len(later)))])
    floor = floor_of(point)
    return (particles * (1 - point.setting("law", "restitution")), floor["amplitude"] * floor["frequency"] / np.pi,
            blocks.mean(), blocks.std(ddof=1) / np.sqrt(len(blocks)))


def draw_column(points, panels):
    left, right = panels(1, 2, figsize=(7.4, 3.4))
    g = -points[0].setting("gravity", "acceleration")
    found = np.array([column_of(point) for point in points])
    speeds = np.unique(np.round(found[:, 1], 9))
    for speed, colour in shaded(speeds):
        x, v, height, error = found[np.isclose(found[:, 1], speed)].T
        left.errorbar(x, height, yerr=error, fmt="o", ms=3.5, capsize=2, color=colour, label=rf"$V={speed:.3g}$")
        fine = np.geomspace(x.min(), x.max(), 50)
        left.plot(fine, np.pi * speed ** 2 / (g * fine ** 2), "--", lw=0.9, color=colour)
        right.errorbar(x, height * g * x ** 2 / (np.pi * v ** 2), yerr=error * g * x ** 2 / (np.pi * v ** 2), fmt="o",
                       ms=3.5, capsize=2, color=colour)
    left.set(xscale="log", yscale="log", xlabel="$X=N(1-r)$", ylabel="height of the centre of mass ($l$)")
    left.legend(loc="lower left")
    right.axhline(1, color="k", ls="--", lw=1)
    right.set(xscale="log", xlabel="$X=N(1-r)$", ylabel=r"height / ($\pi V^2/gX^2$)", ylim=(0, None))
