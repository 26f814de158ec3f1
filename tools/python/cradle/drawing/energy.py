"""Fig. 4: energy and number of collisions against time."""
import numpy as np

from .cooling import cools
from .style import BLUE, GREEN, GREY, ORANGE


def pictures(result, theory, units):
    if (len(result.means.get("time", ())) > 1 and "energy" in result.means
            and not cools(result)):  # which has a picture of its own
        yield "energy", draw_energy, result, theory, units


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
            shown = t <= 1.3 * (theory.number("turnover_time") or np.inf)
        else:  # a law for late times begins above the energy at the start
            shown = value <= 1.001 * series["energy"][0]
        t, value = t[shown], value[shown]
        if len(t) and t[-1] > 0.02 * series["time"][-1]:  # else it would not be seen
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
