"""Paths of a few particles, and how their gaps or the intervals between their collisions shrink; at an inelastic
collapse against the time that is left to it, in which everything is a power."""
import numpy as np

from .style import BLUE, ORANGE, RED, shaded

FEW_PARTICLES = 20       # up to here every particle has a path of its own
MARKED = 40              # points of a line; marks of more would cover it


def few(result):
    return 0 < max((len(s["x"]) for s in result.snapshots), default=0) <= FEW_PARTICLES and not result.mean_profiles


def pictures(result, theory, units):
    if (few(result) or one_falls(result)) and not theory.curve("front_position")[0].size:
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
