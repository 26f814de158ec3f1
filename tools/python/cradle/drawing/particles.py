"""A few particles: their paths, and how gaps or the intervals between collisions shrink, at an inelastic collapse
against the time that is left to it, in which everything is a power. Those that merge or pass (Fig. 5): paths in space
and time, wider for heavier ones, and Newton's cradle: the paths of the single particles in the clusters."""
import numpy as np

from .style import BLUE, GREY, ORANGE, RED, beside, ends, shaded, shades

FEW_PARTICLES = 20       # up to here every particle has a path of its own
MARKED = 40              # points of a line; marks of more would cover it
MOST_SINGLE = 40         # of the cradle: more circles could not be distinguished


def few(result):
    return 0 < max((len(s["x"]) for s in result.snapshots), default=0) <= FEW_PARTICLES and not result.mean_profiles


def pictures(result, theory, units):
    if few(result) and result.law in ("wet", "sticky"):
        yield "spacetime", draw_spacetime, result, units
    elif (few(result) or one_falls(result)) and not theory.curve("front_position")[0].size:
        yield "particles", draw_particles, result, units


def one_falls(result):
    """Whether a single particle is under gravity: then its potential energy is its height."""
    return "potential_energy" in result.means and len(result.scene["initial"].get("x", ())) == 1


def draw_particles(result, units, panels):
    """Paths; energy and collisions, at a collapse collisions alone; and how intervals (from events) or gaps shrink."""
    shrinking = {"interval", "closing_speed"} <= result.events.keys()
    gaps = not shrinking and len(result.snapshots) > 1 and len(result.snapshots[0]["x"]) > 1
    left = time_to_collapse(result) if shrinking else None
    third = ["interval, closing speed"] if shrinking else [units.label("gap", r"gap$\,/\,l$")] if gaps else []
    axes = panels.stacked(units.position_label(), units.energy_label() if left is None else "collisions", *third)
    series, paths = result.means, {}
    if one_falls(result):
        weight = -result.setting("gravity", "acceleration") * float(result.scene["initial"].get("m", [1])[0])
        axes[0].plot(series["time"], series["potential_energy"] / weight, color=BLUE)
    for snapshot in () if one_falls(result) else result.snapshots:
        for particle, x in zip(snapshot["index"], snapshot["x"]):
            paths.setdefault(int(particle), []).append((snapshot["time"], x))
    for (particle, path), colour in shaded(sorted(paths.items())):
        path = np.array(path)
        seam = np.flatnonzero(np.abs(np.diff(path[:, 1])) > (result.setting("initial", "length", 0.0) or np.inf) / 2)
        path = np.insert(path, seam + 1, np.nan, axis=0)  # ends at the seam of a ring and begins anew behind it
        axes[0].plot(*(path / (units.t, units.x)).T, "o-" if len(path) <= MARKED else "-", ms=3,
                     color=colour, label=f"particle {particle}")
    for name, line in (("front_left", ":"), ("front_right", "--")):
        if name in series and not one_falls(result):
            axes[0].plot(series["time"] / units.t, series[name] / units.x, line, color="k", lw=0.8, zorder=0,
                         label="outermost" if line == ":" else None)
    for ax in axes:
        ax.set_xlabel(units.time_label())
    if paths and len(paths) <= 8:
        axes[0].legend(ncol=2)
    if left is not None:  # the number of collisions is a straight line in the logarithm of the time that is left
        axes[1].plot(left / units.t, np.arange(1, len(left) + 1), ".", ms=3, color=BLUE)
        towards_collapse(axes[1], units)
    elif series:
        time = series["time"] / units.t
        falling = "potential_energy" in series  # then energy changes between collisions too
        axes[1].plot(time, series["energy"] / units.energy, color=BLUE, label="kinetic" if falling else None,
                     drawstyle="default" if falling else "steps-post")
        least = 0.0
        if falling:
            total = (series["energy"] + series["potential_energy"]) / units.energy
            axes[1].plot(time, total, color=ORANGE, label="with that of gravity")
            least = min(total.min(), 0.0)
        axes[1].set_ylim(least, None)
        if "collisions" in series:
            other = axes[1].twinx()
            other.plot(time, series["collisions"], color=RED, ls="--", drawstyle="steps-post")
            other.set_ylabel("collisions (dashed)", color=RED)
    if shrinking:
        count = np.arange(1, len(result.events["interval"]) + 1) if left is None else left / units.t
        for name, mark, colour in (("interval", "o", BLUE), ("closing_speed", "^", ORANGE)):
            value = result.events[name]
            axes[2].semilogy(count, np.where(value > 0, value, np.nan), mark, ms=3, color=colour,
                             label=name.replace("_", " "))
        if left is None:
            axes[2].set_xlabel("collision")
        else:
            towards_collapse(axes[2], units)
    elif gaps:
        for pair in range(min(len(s["gap"]) for s in result.snapshots)):
            points = [(s["time"], s["gap"][pair]) for s in result.snapshots if s["gap"][pair] > 0]
            points = np.array(points).reshape(-1, 2)
            axes[2].semilogy(*(points / (units.t, units.x)).T, "o-" if len(points) <= MARKED else "-", ms=3,
                             label=f"gap {pair}")


def time_to_collapse(result):
    """t_c - t of every collision of a run that ended at a collapse, else None. Doubles do not resolve such times, but
    the sums of the intervals after each collision do; the intervals after the last one are a geometric series."""
    interval = np.asarray(result.events["interval"], float)
    if not np.isfinite(result.collapse.get("ratio", np.nan)) or len(interval) < 4 or not (interval[-3:] > 0).all():
        return None
    ratio = np.sqrt(interval[-1] / interval[-3])
    rest = np.cumsum(np.append(interval[1:], interval[-1] * ratio / (1 - ratio))[::-1])[::-1]
    return rest if 0 < ratio < 1 else None


def towards_collapse(ax, units):
    ax.set_xscale("log")
    ax.invert_xaxis()
    ax.set_xlabel(units.label("time to the collapse $t_c-t$ ($t$)", r"time to the collapse $(t_c-t)\,/\,(l/2u_0)$"))


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
           ylim=ends(result.snapshots.times / units.t))
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
    ax.set(xlabel=units.time_label(), ylabel=units.energy_label(), xlim=ends(time))
    ax.set_ylim(0, 1.1 * (result.means["energy"].max() / units.energy or 1))
