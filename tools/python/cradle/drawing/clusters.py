"""The late wet shock. Fig. 7: densities and velocities of right- and left-movers in the interaction zone, averaged over
time, and the linear model of section VI: equations (9) and (10) with 2L of (13) and k = sqrt 6. The measured width is
the length over which u+ falls from u0 to u_crit at its steepest slope; (13) counts the fall to 0. Figs. 9, 10 and 11:
the two heaviest clusters, which pass through each other back and forth. Their separation grows as t^(1/3), their speed
falls as t^(-1/3). A line follows a cluster, not a side."""
import numpy as np

from .settings import since_label, since_start, since_symbol
from .style import BLUE, GREY, ORANGE, beside, note, plt, shaded, thinned

DECADES, BINS, FIRST = 4.3, 13, 3  # maxima in so many logarithmic bins over the last decades; the fit begins in bin 3
EXCESS = np.sqrt(6.0)  # k = n~/n0, where (12) and (13) agree
ENOUGH = 20  # samples of a bin: of fewer the largest says nothing of the swing


def pictures(result, _theory, units):
    if "x" in result.table("zone"):
        yield "zone", draw_zone, result, units
    heaviest = result.means.get("heaviest", {})
    if "x" in heaviest and hold_the_mass(result):
        yield "clusters", draw_clusters, result, units
        if np.isfinite(heaviest["x"][len(heaviest["x"]) * 3 // 4:]).all(axis=1).any():
            yield "scaling", draw_scaling, result, units  # there still are two
    elif result.masses and result.word("initial", "type") == "ring":
        yield "masses", draw_masses_alone, result, units


def hold_the_mass(result):
    """Whether the two clusters contain most of the mass that has collided at the end; before they do, they are
    merely the first particles that have merged."""
    mass = result.means["heaviest"]["mass"].sum(axis=1)
    cloud = result.means.get("cloud_mass", mass)
    known = np.isfinite(mass) & (cloud > 0)
    return known.any() and np.median((mass[known] / cloud[known])[-100:]) > 0.5


def followed(heaviest):
    """The columns, reordered so that each follows one cluster, and where another cluster takes its place."""
    order = np.tile([0, 1], (len(heaviest["x"]), 1))
    broken = np.zeros(order.shape, bool)
    index = heaviest.get("index")
    if index is None:
        return heaviest, broken
    previous = index[0]
    for k, now in enumerate(index):
        straight, crossed = (now == previous).sum(), (now[::-1] == previous).sum()
        if crossed > straight:
            order[k], now = (1, 0), now[::-1]
        broken[k] = now != previous
        previous = now
    return {name: np.take_along_axis(values, order, axis=1) for name, values in heaviest.items()
            if np.shape(values) == order.shape}, broken


def draw_clusters(result, units, panels):
    force = result.table("force")
    tracks, broken = followed(result.means["heaviest"])
    time = result.means["time"] / units.t
    elapsed, t = since_start(result, result.means["time"]) / units.t, since_symbol(result, units.t)
    position, velocity = panels.stacked(units.position_label(), units.velocity_label(), x=units.time_label(),
                                        width=6.0, height=3.0)
    for ax, values in ((position, tracks["x"] / units.x), (velocity, tracks["v"] / units.v)):
        draw_tracks(ax, time, values, broken, 0.9)
        bound = 1.15 * largest(values, 0.02)  # the first swings are fast and would hide all others
        ax.axhline(0, color=GREY, lw=0.5, zorder=0)
        ax.axhline(bound, color="k", lw=0.7)
        ax.set_ylim(-bound, 2.9 * bound)  # insets stand above the curves
        ax.set_yticks([tick for tick in ax.get_yticks() if abs(tick) <= bound])
        ax.ticklabel_format(style="sci", scilimits=(-3, 5), useMathText=True)
        for line in ax.get_lines()[:2]:
            line.set_clip_path(plt.Rectangle((0, 0), 1, 2 / 3.9, transform=ax.transAxes))
    masses = room_above(position, (0.10, 0.65, 0.60, 0.32), units.time_label(), rf"$M_{{1,2}}\,/\,{t}$")
    share = tracks["mass"] / np.where(elapsed > 0, elapsed, np.nan)[:, None]
    draw_tracks(masses, time, share, broken, 0.7)
    masses.set_ylim(0, 1.15 * largest(share, 0.05))
    rescaled = room_above(velocity, (0.42, 0.65, 0.56, 0.32) if force else (0.10, 0.65, 0.88, 0.32),
                          rf"${t}^{{1/3}}$", rf"$v\,{t}^{{1/3}}$")
    swing = tracks["v"] / units.v * np.cbrt(elapsed)[:, None]
    draw_tracks(rescaled, np.cbrt(elapsed), swing, broken, 0.6)
    bound = 1.1 * largest(swing, 0.05)
    rescaled.set_ylim(-bound, bound)
    if force:
        draw_force(room_above(velocity, (0.10, 0.65, 0.22, 0.32), units.position_label(), r"$F_\Sigma$"), force, units)


def largest(values, left_out):
    """The largest magnitude after the first part of the samples; of all samples if none come after it."""
    late = np.abs(values[int(left_out * len(values)):])
    return np.nanmax(late if np.isfinite(late).any() else np.abs(values)) or 1.0


def draw_tracks(ax, time, values, broken, width):
    late = np.nan_to_num(np.abs(values[len(values) // 2:]))
    wide = np.argsort(-late.mean(axis=0), kind="stable")  # the smaller swing on top
    for k in wide:
        at = np.flatnonzero(broken[:, k])  # where another cluster takes over the line is interrupted
        ax.plot(np.insert(time, at, time[at]), np.insert(values[:, k].astype(float), at, np.nan),
                color=(BLUE, ORANGE)[k], lw=width)
    ax.margins(x=0)


def room_above(ax, box, x_label, y_label):
    inset = ax.inset_axes(box)
    inset.tick_params(labelsize=6.5)
    inset.set_xlabel(x_label, fontsize=7, labelpad=1)
    inset.set_ylabel(y_label, fontsize=7, labelpad=2)
    inset.ticklabel_format(style="sci", scilimits=(-3, 5), useMathText=True)
    inset.xaxis.get_offset_text().set_fontsize(6.5)
    return inset


def draw_force(ax, force, units):
    """The force (15): corrected, and dotted as printed."""
    for name, line in (("force", "k-"), ("force_printed", ":")):
        if name in force:
            ax.plot(force["x"] / units.x, force[name] * units.x / units.energy, line, lw=0.9)
    ax.margins(x=0)


def envelope(time, values, begin=0.0):
    """The envelope: the samples; centre and largest value of each bin of the logarithm of time; which bins are fitted
    (from FIRST on, after `begin`, with ENOUGH samples); the fit in logarithms, exponent first."""
    known = np.isfinite(values) & (values > 0) & (time > 0)
    time, values = time[known], values[known]
    edges = np.log10(time[-1]) - DECADES + DECADES * np.arange(BINS + 1) / BINS
    number = np.ceil((np.log10(time) - edges[0]) / (edges[1] - edges[0]) - 1e-9).astype(int)  # 1 .. BINS
    bins = [k for k in range(1, BINS + 1) if (number == k).any()]
    top = np.array([values[number == k].max() for k in bins])
    centre = 10 ** ((edges[np.array(bins) - 1] + edges[bins]) / 2)
    held = np.array([(number == k).sum() for k in bins])
    late = (np.array(bins) >= FIRST) & (10 ** edges[np.array(bins) - 1] >= begin) & (held >= ENOUGH)
    fit = np.polyfit(np.log(centre[late]), np.log(top[late]), 1) if late.sum() > 1 else None
    return time, values, centre, top, late, fit


def draw_scaling(result, units, panels):
    heaviest, time = result.means["heaviest"], since_start(result, result.means["time"]) / units.t
    x, v = heaviest["x"], heaviest["v"]
    met = since_start(result, result.table("meetings").get("time", ()))
    begin = min(met, default=0.0) / units.t  # before, each swings on its side
    apart, passing, *third = panels.stacked(
        units.label("separation", r"separation$\,/\,l$"), units.label("relative speed", r"relative speed$\,/\,2u_0$"),
        *[""] * bool(result.masses), height=2.3)
    draw_envelope(apart, time, np.abs(x[:, 1] - x[:, 0]) / units.x, 1 / 3, BLUE, begin)
    draw_envelope(passing, time, np.abs(v[:, 1] - v[:, 0]) / units.v, -1 / 3, ORANGE, begin)
    for ax in (apart, passing):
        ax.set_xlabel(since_label(result, units.time_label()))
    for ax in third:
        draw_masses(ax, result.masses, units)


def draw_envelope(ax, time, values, theory, colour, begin):
    time, values, centre, top, late, fit = envelope(time, values, begin)
    shown = time >= 10 ** (np.log10(time[-1]) - DECADES)
    ax.loglog(time[shown], values[shown], ".", ms=1.5, mew=0, color=GREY, rasterized=True, label="samples")
    ax.plot(centre[late], top[late], "o", ms=5, color=colour, label="maxima in logarithmic bins")
    ax.plot(centre[~late], top[~late], "o", ms=5, mfc="none", color=colour)  # not fitted
    if fit is not None:
        ends = centre[late][[0, -1]]
        ax.plot(ends, np.exp(fit[1]) * ends ** fit[0], color="k", lw=1.2, label=f"fit, exponent {fit[0]:.3f}")
        middle = np.exp(np.log(top[late]).mean() - theory * np.log(centre[late]).mean())
        ax.plot(ends, middle * ends ** theory, "k--", lw=1, label=f"section VI, exponent {theory:.3f}")
    ax.set(ylim=(top.min() / 300, None))
    ax.legend(loc="lower left", ncol=2)


def draw_masses(ax, masses, units):
    """The number of clusters with at least a given mass: there are too few clusters for a histogram."""
    for group, colour in shaded(thinned(masses, 6)):
        above = np.cumsum(group["clusters"][::-1].astype(float))[::-1]
        ax.step(group["mass"], above, where="pre", color=colour, label=units.at(group["time"]))
    ax.set(xscale="log", yscale="log", xlabel=r"mass $M\,/\,m$", ylabel="clusters heavier than $M$")
    beside(ax)


def draw_masses_alone(result, units, panels):
    ax = panels(figsize=(5.6, 2.9))
    draw_masses(ax, result.masses, units)


def model_width(speed, loss, spacing=1.0):
    """2L of equation (13); m = 1."""
    return speed ** 2 * spacing / (loss * (2 + EXCESS))


def draw_zone(result, units, panels):
    zone = result.table("zone")
    speed, loss = result.setting("initial", "speed", 0.5), result.setting("law", "loss", np.nan)
    spacing = result.setting("initial", "spacing", 1.0)
    x = zone["x"] / units.x
    half = model_width(speed, loss, spacing) / 2 / units.x
    measured, error = zone["width"] / units.x, zone["width_error"] / units.x
    velocity, density, mass = panels.stacked(
        units.velocity_label(), units.label("density $n$", r"density $n\,/\,n_0$"),
        units.label(r"mass density $\rho$", r"mass density $\rho\,/\,\rho_0$"), x=units.position_label(), height=2.1)
    slow = 2 * np.sqrt(loss)
    formed = bool(np.isfinite(measured))  # u+ has fallen to u_crit within the bins; before there is nothing to model
    for sign, index, name, colour, line in ((1, "+", "right", BLUE, "-"), (-1, "-", "left", ORANGE, "--")):
        inside = np.array([-half, half])
        u = (-(speed - slow) * inside / (2 * half) + sign * (speed + slow) / 2) / units.v
        n = 1 + EXCESS / 2 + sign * EXCESS * inside / (2 * half)
        outer = sign * np.array([min(x[0], -1.2 * half), -half])
        if formed:
            velocity.plot(outer, np.full(2, sign * speed / units.v), line, color="k", lw=0.9)
            velocity.plot(inside, u, line, color="k", lw=0.9, label=f"$u_{index}$, Eq. (9)")
            density.plot(outer, np.ones(2), line, color="k", lw=0.9)
            density.plot(inside, n, line, color="k", lw=0.9, label=f"$n_{index}$, Eq. (10)")
        moving = zone[f"density_{name}"] > 0
        dots = {"marker": "o" if sign > 0 else "s", "ls": "none", "ms": 3.2, "color": colour,
                "mfc": colour if sign > 0 else "none", "label": f"{name}-movers"}
        velocity.plot(x[moving], zone[f"velocity_{name}"][moving] / units.v, **dots)
        density.plot(x, zone[f"density_{name}"] * spacing, **dots)
    mass.plot(x, zone["mass_density"] * spacing, drawstyle="steps-mid", color=BLUE)
    mass.set_yscale("log")
    note(mass, "peaks: the heavy clusters; shaded: $2L$ of Eq. (13)" if formed else
         "no zone yet: $u_+$ has not fallen to $u_\\mathrm{crit}$")
    velocity.axhline(0, color=GREY, lw=0.6)
    if formed:
        for ax in (velocity, density, mass):
            ax.axvspan(-half, half, color=GREY, alpha=0.18, lw=0, zorder=0)
        bottom, top = velocity.get_ylim()
        velocity.set_ylim(1.05 * bottom, 2.55 * top)
        draw_width(velocity, measured, error, longer=measured / (1 - slow / speed) if slow < speed else np.nan,
                   model=2 * half, top=top)
    velocity.set_yticks([-speed / units.v, 0, speed / units.v])
    density.set_ylim(0, None)
    beside(velocity), beside(density)
    note(velocity, f"average over $t={zone['from'] / units.t:.5g}$ to {units.at(zone['until'], name='')}, "
                   f"{zone['samples']} samples")


def draw_width(ax, measured, error, longer, model, top):
    """The measured width as a bar above the curves, dotted to the point at which u+ would be 0."""
    ax.errorbar([-measured / 2, measured / 2], [1.3 * top] * 2, xerr=error / 2, color="k", lw=1, capsize=3)
    ax.plot([-longer / 2, longer / 2], [1.3 * top] * 2, "k:", lw=1)
    ax.text(0, 1.45 * top, rf"$2L={measured:.3g}\pm{error:.2g}$ from $u_0$ to $u_\mathrm{{crit}}$" + "\n"
            + rf"(dotted: to 0, ${longer:.3g}$); (13): ${model:.3g}$", ha="center", va="bottom", fontsize=8)
