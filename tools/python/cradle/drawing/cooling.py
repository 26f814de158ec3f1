"""Free cooling on a ring: energy against time, beside the asymptotic law of the sticky gas. For independent velocities
of variance s^2 and mean spacing a (m = 1)
    E/N = 0.221376226650747359 s^2 tau^(-2/3),  clusters/N = 1.32825735990448415 tau^(-2/3),  tau = s t/a,
exact for t -> infinity in the sticky gas (Burgers equation with white noise); Haff's law where it is predicted."""
import numpy as np

from .style import BLUE, GREEN, GREY, ORANGE, RED, note, power, thinned

ENERGY, CLUSTERS = 0.221376226650747359, 1.32825735990448415
FEWEST = 10   # clusters that are left, for the law of infinitely many particles to say something of these
FEWEST_AT_START = 50  # particles: of fewer that law would hold for less than a decade of time
STRETCH = 80  # particles of the last snapshot that are shown of the velocities


def cools(result):
    """Whether it is a ring whose particles lose energy."""
    return result.word("initial", "type") == "ring" and result.setting("law", "restitution", 0.0) != 1


def pictures(result, theory, _units):
    if cools(result) and len(result.means.get("time", ())) > 1:
        yield "cooling", draw_cooling, result, theory
        if result.snapshots:
            yield "field", draw_field, result


def ring_of(result):
    """N, s and a."""
    particles = result.setting("initial", "particles", 1.0)
    return (particles, np.sqrt(result.setting("initial", "variance", 1.0)),
            result.setting("initial", "length", particles) / particles)


def sticky_law(result, time):
    """The energy per particle; NaN before clusters form, after only FEWEST would be left, and for a few particles."""
    particles, speed, spacing = ring_of(result)
    with np.errstate(divide="ignore"):
        share = (speed * time / spacing) ** (-2 / 3)
    clusters = CLUSTERS * share
    holds = (clusters < 1) & (particles * clusters >= FEWEST) & (particles >= FEWEST_AT_START)
    return np.where(holds, ENERGY * speed ** 2 * share, np.nan)


def cooled(result):
    """Which samples come after the first meetings, their times, energies per particle, and those of the sticky gas."""
    particles, speed, spacing = ring_of(result)
    later = result.means["time"] * speed / spacing > 0.03
    time = result.means["time"][later]
    return later, time, result.means["energy"][later] / particles, sticky_law(result, time)


def draw_cooling(result, theory, panels):
    particles, speed, spacing = ring_of(result)
    series = result.means
    later, time, energy, law = cooled(result)
    merging = result.law in ("sticky", "wet")
    applies = bool(np.isfinite(law).any())
    axes = panels.stacked(r"energy per particle $E\,/\,N$", *["simulation / sticky law"] * applies,
                          *["clusters per particle"] * merging, height=2.2,
                          x=rf"time ($t$)   ($\tau=st/a$, $s={speed:.4g}$, $a={spacing:.4g}$)")
    axes[0].loglog(time, energy, color=BLUE, lw=1.6, label="simulation")
    if applies:
        axes[0].plot(time, law, "k--", label=r"sticky gas, $0.2214\,s^2\tau^{-2/3}$")
        axes[1].semilogx(time, energy / law, color=BLUE, lw=1.6)
        axes[1].axhline(1, color="k", ls="--")
        if np.nanmax(energy / law) > 10:
            axes[1].set_yscale("log")
        else:
            axes[1].set_ylim(bottom=0)
    draw_laws(axes[0], theory, time, energy, particles)
    axes[0].legend(loc="lower left")
    if merging:
        axes[-1].loglog(time, 1 - series["merges"][later] / particles, color=BLUE, lw=1.6, label="simulation")
        if applies:
            axes[-1].plot(time, CLUSTERS / ENERGY * law / speed ** 2, "k--", label=r"sticky gas, $1.328\,\tau^{-2/3}$")
        axes[-1].legend(loc="lower left")


def draw_laws(ax, theory, time, energy, particles=1):
    """The predicted energies, but that of the sticky gas, where they are not far below the measured ones."""
    known = [name for name in dict.fromkeys(row["quantity"] for row in theory.rows) if name.startswith("energy")]
    for quantity, colour in zip((name for name in known if "sticky" not in name), (ORANGE, GREEN, RED)):
        t, value = theory.curve(quantity)
        shown = (t >= time[0]) & (t <= time[-1]) & (value / particles > 0.3 * energy.min())
        ax.plot(t[shown], value[shown] / particles, ":", color=colour, lw=1.6, label=theory.equation(quantity))


def draw_field(result, panels):
    """Velocity against position on a part of the ring: larger clusters are heavier, velocities form a saw-tooth."""
    snapshots = thinned(result.snapshots, 4)
    last = snapshots[-1]
    whole = len(last["x"]) <= STRETCH
    axes = panels.stacked(*["velocity $v$ ($l/t$)"] * len(snapshots), height=1.8,
                          x="position $x$ ($l$)" + ("" if whole else ", a stretch of the ring"))
    low, high = (-np.inf, np.inf) if whole else np.sort(last["x"])[[0, STRETCH - 1]]
    for ax, snapshot in zip(axes, snapshots):
        shown = (snapshot["x"] >= low) & (snapshot["x"] <= high)
        size = 6 * np.sqrt(snapshot["m"][shown] / np.median(last["m"]))
        ax.scatter(snapshot["x"][shown], snapshot["v"][shown], s=np.clip(size, 4 if whole else 0.7, 60), color=BLUE,
                   alpha=0.7, lw=0, rasterized=True)
        ax.axhline(0, color=GREY, lw=0.6, zorder=0)
        note(ax, f"$t={power(snapshot['time'])}$, {shown.sum()} of {len(shown)}"
                 + (" clusters" if "merges" in result.means and result.means["merges"][-1] > 0 else " particles"))
