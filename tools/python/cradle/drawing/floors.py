"""A shaken floor (formulas: core/laws/README.md): the height of one ball once a period against the amplitude, with the
first period doubling; the height of a column of beads against X = N (1 - r), beside that of nearly elastic ones."""
import numpy as np

from .style import BLUE, GREY, ORANGE, shaded

LAST = 64  # samples of a ball that are shown


def pictures(result, _theory, _units):
    points = [point for point in result.points if floor_of(point) and point.setting("gravity", "acceleration", 0.0) < 0]
    if len(points) < 3:
        return
    if "potential_energy" in points[0].means and len(points[0].scene["initial"].get("x", ())) == 1:
        yield "bouncing", draw_ball, points
    elif all(floor_of(point)["motion"] == "sawtooth" for point in points):
        yield "column", draw_column, points


def floor_of(point):
    """The left wall, if it is shaken."""
    wall = point.scene.get("walls", {}).get("left", {})
    return wall if wall.get("motion", "none") != "none" else {}


def heights(point, particles):
    """Of the centre of mass over the place of the floor, at all samples (masses 1)."""
    energy = np.asarray(point.means["potential_energy"])
    return energy / (particles * -point.setting("gravity", "acceleration")) - floor_of(point)["position"]


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
