"""Ensembles: means over the replicas, with standard errors and extremes; profiles; the times of inelastic collapse."""
import numpy as np

from ..result import fronts
from .energy import cooled, cools, draw_laws, ring_of
from .settings import since_label, since_start, start_of
from .shock import draw_slope
from .style import BLUE, GREY, ORANGE, beside, logarithmic, note, shaded, thinned

SERIES = (("energy", "energy"), ("collisions", "collisions"), ("merges", "merges"), ("front_right", "right front"),
          ("cloud_width", "width of the cloud"))


def pictures(result, theory, units):
    if not result.replicas:
        return
    if len(result.series.get("time", ())) > 1:
        yield "ensemble", draw_series, result, theory, units
    if result.profiles:
        yield "profiles", draw_profiles, result, theory, units
    if np.isfinite(result.replicas.get("collapse_time", np.array([np.nan]))).any():
        yield "collapse", draw_collapse, result, units


def band(ax, x, quantity, unit, colour, **line):
    """The mean, the standard error and the extremes of one quantity."""
    mean, sem, low, high = (np.asarray(quantity[name], float) / unit for name in ("mean", "sem", "min", "max"))
    ax.fill_between(x, low, high, color=colour, alpha=0.18, lw=0)
    ax.fill_between(x, mean - sem, mean + sem, color=colour, alpha=0.45, lw=0)
    ax.plot(x, mean, color=colour, **line)


def draw_series(result, theory, units, panels):
    time = result.series["time"] / units.t
    if cools(result):
        time = since_start(result, time)
    scale = {"energy": units.energy, "front_right": units.x, "cloud_width": units.x}
    shown = [(name, label) for name, label in SERIES if name in result.series
             and (name != "front_right" or name in fronts(result))
             and (name == "energy" or (result.series[name]["max"] > 0).any())]
    spreads = {name: of for name, of in result.table("ensemble/spread/series").items()
               if np.ndim(of.get("quantile_50", np.zeros((0, 2)))) == 1}
    shown += [(name, name.replace("_", " ")) for name in spreads if name not in dict(shown)]
    axes = panels.stacked(*(units.energy_label() if name == "energy" else
                            label + (units.label("", r"$\,/\,l$") if scale.get(name) == units.x else "")
                            for name, label in shown),
                          x=since_label(result) if cools(result) else units.time_label(), height=2.0)
    replicas = len(result.replicas.get("index", ()))
    left = min((int(counts[-1]) for name, _ in shown if (counts := result.series[name].get("count")) is not None),
               default=replicas)
    note(axes[0], (f"{replicas} replicas, " if replicas else "") + (f"{left} at the end, " if left < replicas else "")
         + "bands: standard error, extremes" + (", orange: spread" if spreads else ""))
    axes[-1].set_xlim(time[0], time[-1])
    for ax, (name, _) in zip(axes, shown):
        band(ax, time, result.series[name], scale.get(name, 1), BLUE, lw=1.2)
        if name in spreads:
            # Bins that all replicas share, or half of them, say nothing of what is between.
            width = np.diff(spreads[name]["edges"][:2])
            known = spreads[name]["quantile_75"] - spreads[name]["quantile_25"] >= width
            low, *between, high = (np.where(known, spreads[name][f"quantile_{k:02}"], np.nan) / scale.get(name, 1)
                                   for k in (5, 25, 75, 95))
            if known.any():
                ax.fill_between(time, *between, color=ORANGE, alpha=0.35, lw=0, label="half of the replicas")
                ax.plot(time, np.transpose([low, high]), ":", color=ORANGE, lw=1, label=["90 % of them", None])
            else:
                note(ax, "the bins are wider than the spread")
    on_ring = result.word("initial", "type") == "ring"
    predicted = {"energy": ("energy_sticky", "sticky gas"), "front_right": ("front_position", "")}
    for ax, (name, _) in zip(axes, [] if on_ring else shown):
        quantity, label = predicted.get(name, ("", ""))
        t, value = theory.curve(quantity)
        inside = t / units.t <= time[-1]
        if quantity == "energy_sticky":
            inside &= value <= 1.001 * result.series["energy"]["mean"][0]
        if inside.any():
            ax.plot(t[inside] / units.t, value[inside] / scale[name], "k--", lw=1,
                    label=label or theory.equation(quantity))
    if cools(result):
        show_cooling(axes, result, theory, time)
    for lines in (ax.get_lines() for ax in axes):
        if len(lines) > 1:  # a prediction beside the mean
            lines[0].set_label("mean")


def show_cooling(axes, result, theory, time):
    """A logarithmic time axis from the first collisions, with the law of the sticky gas and other predictions."""
    later, _, _, law = cooled(result)
    law = law * ring_of(result)[0]
    if np.isfinite(law).any():
        axes[0].plot(time[later], law, "k--", lw=1, label="sticky gas")
    draw_laws(axes[0], theory, start_of(result), time[later], result.series["energy"]["mean"][later])
    logarithmic(axes[0])
    axes[-1].set(xscale="log", xlim=(time[later][0], time[-1]))


def draw_profiles(result, theory, units, panels):
    profiles = thinned(result.profiles, 6)
    name = "mass_density" if result.law in ("wet", "sticky") and "mass_density" in profiles[0] else "density"
    velocity, density = panels.stacked(
        units.mean_velocity_label(), ("mass " if name == "mass_density" else "") + units.density_label(),
        x=units.position_label(), width=6.4, height=2.7)
    for profile, colour in shaded(profiles):
        x = profile["x"] / units.x
        band(velocity, x, profile["velocity"], units.v, colour, lw=1.1, label=units.at(profile["time"]))
        band(density, x, profile[name], 1 / units.x, colour, lw=1.1)
    draw_slope(velocity, profiles, theory, units)
    density.set_ylim(0, None)
    beside(velocity)


def draw_collapse(result, units, panels):
    times = result.replicas["collapse_time"] / units.t
    known = times[np.isfinite(times)]
    (ax,) = panels.stacked("replicas", height=3.0,
                           x=units.label(r"time of collapse $t_c$", r"time of collapse $t_c\,/\,(l/2u_0)$"))
    bins = np.histogram_bin_edges(known, min(50, max(5, int(np.sqrt(len(known)) * 1.5))))
    ax.hist(known, bins, color=BLUE, edgecolor="white", lw=0.4)
    ax.axvline(np.median(known), color=ORANGE, lw=1.2, label=f"median {np.median(known):.5g}")
    ax.axvline(known.mean(), color=GREY, lw=1.2, ls="--", label=f"mean {known.mean():.5g}")
    note(ax, f"{len(known)} of {len(times)} replicas")
