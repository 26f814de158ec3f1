"""Energy against time: Fig. 4, with the number of collisions; and free cooling on a ring beside the asymptotic law of
the sticky gas. For independent velocities of variance s^2 and mean spacing a, at t after the start,
    E/N = 0.221376226650747359 m s^2 tau^(-2/3),  clusters/N = 1.32825735990448415 tau^(-2/3),  tau = s t/a,
exact for t -> infinity in the sticky gas (Burgers equation with white noise); Haff's law where it is predicted."""
import numpy as np

from .settings import mass_of, since_label, since_start, start_of
from .style import BLUE, GREEN, GREY, ORANGE, RED, logarithmic, note, power, thinned

ENERGY, CLUSTERS = 0.221376226650747359, 1.32825735990448415
FEWEST = 10   # clusters that are left, for the law of infinitely many particles to say something of these
FEWEST_AT_START = 50  # particles: of fewer that law would hold for less than a decade of time
STRETCH = 80  # particles of the last snapshot that are shown of the velocities


def pictures(result, theory, units):
    if len(result.means.get("time", ())) > 1 and "energy" in result.means and not cools(result):
        yield "energy", draw_energy, result, theory, units


def cooling(result, theory, _units):
    if cools(result) and len(result.means.get("time", ())) > 1:
        yield "cooling", draw_cooling, result, theory
        if result.snapshots:
            yield "field", draw_field, result


def cools(result):
    """Whether it is a ring whose particles lose energy."""
    return result.word("initial", "type") == "ring" and result.setting("law", "restitution", 0.0) != 1


def ring_of(result):
    """N, s and a."""
    particles = result.setting("initial", "particles", 1.0)
    return (particles, np.sqrt(result.setting("initial", "variance", 1.0)),
            result.setting("initial", "length", particles) / particles)


def sticky_law(result, time):
    """The energy per particle at times since the start; NaN before clusters form, after only FEWEST would be left, for
    a few particles, and for unequal ones."""
    particles, speed, spacing = ring_of(result)
    with np.errstate(divide="ignore"):
        share = (speed * time / spacing) ** (-2 / 3)
    clusters = CLUSTERS * share
    holds = (clusters < 1) & (particles * clusters >= FEWEST) & (particles >= FEWEST_AT_START)
    return np.where(holds, (mass_of(result) or np.nan) * ENERGY * speed ** 2 * share, np.nan)


def cooled(result):
    """Which samples come after the first meetings, their times since the start, energies per particle, and those of
    the sticky gas."""
    particles, speed, spacing = ring_of(result)
    time = since_start(result, result.means["time"])
    later = time * speed / spacing > 0.03
    time = time[later]
    return later, time, result.means["energy"][later] / particles, sticky_law(result, time)


def draw_cooling(result, theory, panels):
    particles, speed, spacing = ring_of(result)
    series = result.means
    later, time, energy, law = cooled(result)
    merging = result.law in ("sticky", "wet")
    applies = bool(np.isfinite(law).any())
    axes = panels.stacked(r"energy per particle $E\,/\,N$", *["simulation / sticky law"] * applies,
                          *["clusters per particle"] * merging, height=2.2,
                          x=since_label(result) + rf"   ($\tau=st/a$, $s={speed:.4g}$, $a={spacing:.4g}$)")
    axes[0].plot(time, energy, color=BLUE, lw=1.6, label="simulation")
    logarithmic(axes[0])
    if applies:
        mass = "" if mass_of(result) == 1 else r"m\,"
        axes[0].plot(time, law, "k--", label=rf"sticky gas, $0.2214\,{mass}s^2\tau^{{-2/3}}$")
        axes[1].semilogx(time, energy / law, color=BLUE, lw=1.6)
        axes[1].axhline(1, color="k", ls="--")
        if np.nanmax(energy / law) > 10:
            axes[1].set_yscale("log")
        else:
            axes[1].set_ylim(bottom=0)
    draw_laws(axes[0], theory, start_of(result), time, energy, particles)
    axes[0].legend(loc="lower left")
    if merging:
        axes[-1].plot(time, 1 - series["merges"][later] / particles, color=BLUE, lw=1.6, label="simulation")
        logarithmic(axes[-1])
        if applies:
            clusters = CLUSTERS / ENERGY * law / (mass_of(result) * speed ** 2)
            axes[-1].plot(time, clusters, "k--", label=r"sticky gas, $1.328\,\tau^{-2/3}$")
        axes[-1].legend(loc="lower left")


def draw_laws(ax, theory, start, time, energy, particles=1):
    """The predicted energies, but that of the sticky gas, where they are not far below the measured ones, at times
    since the start."""
    known = [name for name in dict.fromkeys(row["quantity"] for row in theory.rows) if name.startswith("energy")]
    for quantity, colour in zip((name for name in known if "sticky" not in name), (ORANGE, GREEN, RED)):
        t, value = theory.curve(quantity)
        t = t - start
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


def draw_energy(result, theory, units, panels):
    series = result.means
    time = series["time"] / units.t
    top, below = panels.stacked(units.label(r"kinetic energy $E$ ($m\,l^2/t^2$)", units.energy_label()), "number",
                                x=units.time_label(), height=2.5, margin=0.4, height_ratios=(3, 2))
    energy = series["energy"] / units.energy
    top.plot(time, energy, color=BLUE, lw=1.6, label="simulation")
    if "potential_energy" in series:
        total = energy + series["potential_energy"] / units.energy
        top.plot(time, total, color=ORANGE, label="with that of gravity")
        energy = np.concatenate([energy, total])
    cited = theory.equation("energy").replace("E_loss", r"$E_\mathrm{loss}$")
    for quantity, line, label in (("energy", ":", cited), ("energy_sticky", "--", "sticky gas")):
        t, value = theory.curve(quantity)
        if quantity == "energy":  # the linear profiles are meant for the expanding front
            start = start_of(result)
            shown = t - start <= 1.3 * ((theory.number("turnover_time") or np.inf) - start)
        else:  # a law for late times begins above the energy at the start
            shown = value <= 1.001 * series["energy"][0]
        t, value = t[shown], value[shown]
        shown, whole = (since_start(result, times[-1:]).sum() for times in (t, series["time"]))
        if shown > 0.02 * whole:  # else it would not be seen
            top.plot(t / units.t, value / units.energy, "k" + line, lw=1.3, label=label)
    onset = theory.number("collapse_onset_time")
    if onset and onset <= series["time"][-1]:
        for ax in (top, below):
            ax.axvline(onset / units.t, color=GREY, lw=1, zorder=0, label="onset of collapse" if ax is top else None)
    top.set_xlim(time[0], time[-1])
    least, most = energy.min(), energy.max()
    change = most - least if most - least > 1e-9 * most else most  # rounding alone is none
    top.set_ylim(min(0, 1.05 * least) if least < 0.6 * most else least - 0.1 * change, 1.05 * most if most > 0 else 1)
    if top.get_ylim()[0] > 0:
        top.set_ylim(top=most + 0.1 * change)
    draw_collisions(below, series, time)


def draw_collisions(ax, series, time):
    for name, line, colour, label in (("collisions", "-", BLUE, "collisions"), ("merges", "-.", GREEN, "merges"),
                                      ("collisions_below_cutoff", "--", ORANGE, "below the cut-off")):
        count = series.get(name)
        if count is not None and count.max() > 0:
            count = count.astype(float)
            ax.plot(time[count > 0], count[count > 0], line, color=colour, label=label)
    counts = series.get("collisions")
    if counts is not None and counts.max() > 1000:
        ax.set_yscale("log")
