"""Fig. 5: a few particles that merge or pass through each other. Paths in space and time, wider for heavier
particles, with the collisions marked; and Newton's cradle: the paths of the single particles in the clusters."""
import numpy as np

from .particles import few
from .style import BLUE, GREY, ORANGE, RED, beside, shades

MOST_SINGLE = 40  # of the cradle: more circles could not be distinguished


def pictures(result, _theory, units):
    if few(result) and result.law in ("wet", "sticky"):
        yield "spacetime", draw_spacetime, result, units


def legs_of(result):
    """For each particle a list of (times, positions, mass, known). Between two snapshots a particle has the first one's
    velocity until its first collision, and the last one's after its last; between these two its path is not known."""
    left, right, time = (np.asarray(result.events.get(name, ())) for name in ("left", "right", "time"))
    legs = {}
    for before, after in zip(result.snapshots[:-1], result.snapshots[1:]):
        later = {int(particle): k for k, particle in enumerate(after["index"])}
        for k, particle in enumerate(before["index"].astype(int)):
            begin, end = before["time"], after["time"]
            met = np.sort(time[((left == particle) | (right == particle)) & (begin < time) & (time <= end)])
            x, v, m = before["x"][k], before["v"][k], before["m"][k]
            out = legs.setdefault(particle, [])
            first = met[0] if len(met) else end
            out.append(((begin, first), (x, x + v * (first - begin)), m, True))
            if len(met) and particle in later:
                j = later[particle]
                x_last = after["x"][j] - after["v"][j] * (end - met[-1])
                if met[-1] > first:
                    out.append(((first, met[-1]), (x + v * (first - begin), x_last), after["m"][j], False))
                out.append(((met[-1], end), (x_last, after["x"][j]), after["m"][j], True))
    return legs


def draw_spacetime(result, units, panels):
    masses = np.concatenate([s["m"] for s in result.snapshots])
    whole = np.allclose(masses, masses.round()) and result.snapshots[0]["m"].sum() <= MOST_SINGLE
    axes = panels(2 + whole, figsize=(5.6, 2.4 * (2 + whole)), height_ratios=(3, 2, 1.2) if whole else (3, 1.2),
                  letters=True)
    draw_paths(axes[0], result, units, masses.max())
    if whole:
        draw_cradle(axes[1], result.snapshots, units)
        axes[1].set_xlim(axes[0].get_xlim())
    draw_energy_steps(axes[-1], result, units)


def draw_paths(ax, result, units, heaviest):
    legs = legs_of(result)
    meetings = []
    for (particle, parts), colour in zip(sorted(legs.items()), particle_colours(len(legs))):
        for number, (time, x, mass, known) in enumerate(parts):
            ax.plot(np.array(x) / units.x, np.array(time) / units.t, "-" if known else ":", color=colour,
                    lw=1 + 5 * np.sqrt(mass / heaviest) if heaviest > 1 else 1.5, solid_capstyle="projecting",
                    label=f"particle {particle}, mass {mass:.4g}" if number == 0 and len(legs) <= 8 else None)
            if number and parts[number - 1][0][1] == time[0] and time[0] in result.events.get("time", ()):
                meetings.append((x[0] / units.x, time[0] / units.t))
    if meetings:
        ax.plot(*np.array(meetings).T, "o", ms=9, mfc="none", color=RED, mew=1.2, label="collision", zorder=5)
    ax.set(xlabel=units.position_label(), ylabel=units.time_label(),
           ylim=(result.snapshots[0]["time"] / units.t, result.snapshots[-1]["time"] / units.t))
    beside(ax)


def particle_colours(count):
    return (BLUE, ORANGE)[:count] if count <= 2 else shades(count)


def draw_cradle(ax, snapshots, units):
    """Single particles never change places: clusters from left to right take them in order. Circles: not to scale."""
    x = np.concatenate([s["x"] for s in snapshots]) / units.x
    size = 0.032 * max(np.ptp(x), 1e-12)
    owner = np.repeat(np.arange(len(snapshots[0]["m"])), snapshots[0]["m"].round().astype(int))
    colours = particle_colours(len(snapshots[0]["m"]))
    for row, snapshot in enumerate(snapshots):
        count = snapshot["m"].round().astype(int)
        ends = np.cumsum(count)
        previous = -np.inf
        for place, mass, end, v in zip(snapshot["x"] / units.x, count, ends, snapshot["v"] / units.v):
            left = max(place - size * (mass - 1) / 2, previous + size)  # side by side where they touch
            for k in range(mass):
                ax.plot(left + k * size, row, "o", ms=9.3, color=colours[owner[end - mass + k]], mec="k", mew=0.6)
            previous = left + (mass - 1) * size
            if abs(v) > 0.05 * max(np.abs(snapshot["v"]).max() / units.v, 1e-300):
                tip = (previous + 0.7 * size, row) if v > 0 else (left - 0.7 * size, row)
                ax.annotate("", (tip[0] + np.sign(v) * 2 * size, row), tip, arrowprops={"arrowstyle": "->", "lw": 0.9})
    ax.set_yticks(range(len(snapshots)), [units.at(s["time"], 4) for s in snapshots])
    ax.set(xlabel="the same as single particles, which never change places (sizes not to scale)",
           ylim=(-0.7, len(snapshots) - 0.3))
    ax.tick_params(axis="y", length=0)


def draw_energy_steps(ax, result, units):
    if not result.means:
        return
    time = result.means["time"] / units.t
    ax.plot(time, result.means["energy"] / units.energy, color=BLUE, drawstyle="steps-post")
    for t in result.events.get("time", ()):
        ax.axvline(t / units.t, color=GREY, lw=0.8, ls=":", zorder=0)
    ax.set(xlabel=units.time_label(), ylabel=units.energy_label(), xlim=(time[0], time[-1]))
    ax.set_ylim(0, 1.1 * (result.means["energy"].max() / units.energy or 1))
