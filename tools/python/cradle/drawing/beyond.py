"""After the collapse of a run, or of a sweep of cut-offs and of what replaces them: the energy and that of the
sticky gas, the dense core (core/observe/configuration_statistics.hpp), and the rate of collisions in it."""
import numpy as np

from .settings import mean_mass, start_of
from .style import BLUE, GREY, ORANGE, distinct, plt, shaded, shades

MANY = 20         # snapshots that make a picture in space and time
PATHS = 80        # of particles in it
NARROW = 1e-2     # of the spacing: a core is there once half of the mass is in less
EXCESS = r"$(E-E_\mathrm{sticky})\,/\,E_0$"
ARRIVING = 0.97   # rows are taken to last for this share of the time at which the sticky gas has all
SETTLED = 100     # units of time after which rates are averaged


def pictures(result, _theory, units):
    points = [p for p in result.points if has_core(p)]
    since = min((onset(p) for p in points), default=np.inf)
    if np.isfinite(since):
        yield "beyond", draw_points, points, since, units
        if len(with_rates(points, since, units)) > 1:
            yield "rates", draw_rates, points, since, units
    if result.points or result.replicas or not has_core(result) or not np.isfinite(onset(result)):
        return
    yield "beyond", draw_run, result, units
    dense = [s for s in result.snapshots if s["time"] >= onset(result) and len(core_of(s)[0]) > 2]
    if dense and slowest(result):
        yield "distributions", draw_distributions, dense, slowest(result), units
    if len(dense) >= MANY:
        yield "spacetime", draw_spacetime, dense, units


def has_core(result):
    return np.isfinite(result.means.get("core_width", ())).sum() > 2


def slowest(result):
    """The closing speed below which a collision loses nothing (or everything: merge_speed); 0 if there is none."""
    merging = result.word("run", "collapse") == "merge"
    return result.setting("run", "merge_speed", 0.0) if merging else result.setting("law", "cutoff", 0.0)


def label_of(result):
    policy = result.word("run", "collapse")
    if policy == "contact-time":
        return rf"contact time {result.setting('run', 'contact_time'):.4g}"
    return rf"merge below {slowest(result):.4g}" if policy == "merge" else rf"$\delta=${slowest(result):.4g}"


def onset(result):
    """The first of the samples, up to the narrowest core, in which less than NARROW contains half of the mass."""
    width = result.means["core_width"]
    if not np.isfinite(width).any():
        return np.inf
    narrowest = int(np.nanargmin(width))
    wide = np.flatnonzero(~(width[:narrowest + 1] < NARROW * result.setting("initial", "spacing", 1.0)))
    first = wide[-1] + 1 if len(wide) else 0
    return result.means["time"][first] if first <= narrowest else np.inf


def excess(result, kind="mean"):
    """The energy minus that of the sticky gas, in units of the energy at the start."""
    start = result.means["energy"][0] + result.means["energy_lost"][0]
    return (result.means["sticky_excess"] if kind == "mean" else result.series["sticky_excess"][kind]) / start


def collision_rates(result):
    """Times midway between samples; dissipative and elastic collisions per unit of time there."""
    time = result.means["time"]
    apart = np.diff(time) > 0
    every, elastic = (np.diff(np.asarray(result.means[name], float))[apart] / np.diff(time)[apart]
                      for name in ("collisions", "collisions_below_cutoff"))
    return ((time[1:] + time[:-1]) / 2)[apart], every - elastic, elastic


def rates(result, since, units):
    """Dissipative and elastic collisions per l/2u0: mean and standard deviation, from SETTLED after `since` until the
    rows end."""
    time, *kinds = collision_rates(result)
    lasting = result.setting("initial", "particles", np.nan) * units.t  # the sticky gas has the last of equal rows
    late = (time > since + SETTLED * units.t) & (time - start_of(result) < ARRIVING * lasting)
    return [(np.mean(values[late]) * units.t, np.std(values[late]) * units.t) if late.any() else (np.nan, np.nan)
            for values in kinds]


def most_frequent(result, cutoff):
    """Dissipative collisions per l/2u0 if all of them have the closing speed of the cut-off: one particle arrives
    with m u0^2/2, and each collision dissipates (1 - eps^2) m delta^2/4."""
    restitution, speed = result.setting("law", "restitution", 1.0), result.setting("initial", "speed", 0.5)
    return 2 * speed ** 2 / ((1 - restitution ** 2) * cutoff ** 2) if restitution < 1 else np.inf


def draw_excess(ax, result, since, units, colour, label=None, line="-"):
    late = result.means["time"] >= since
    time = result.means["time"][late] / units.t
    ax.plot(time, excess(result)[late], line, color=colour, label=label)
    if result.replicas:
        ax.fill_between(time, excess(result, "min")[late], excess(result, "max")[late], color=colour, alpha=0.2, lw=0)
    ax.set_yscale("symlog", linthresh=1.000001e-5)  # of 1e-5 the logarithm is rounded down, to ticks at 1e-6
    ax.axhline(0, color=GREY, lw=0.8, zorder=0)


def positive(ax, time, values, **how):
    """A logarithmic axis, if there are positive values."""
    shown = values > 0
    if shown.any():
        ax.plot(time[shown], values[shown], **how)
        ax.set_yscale("log")


# ---- a run

def draw_run(result, units, panels):
    series, scale = result.means, slowest(result)
    late = series["time"] >= onset(result)
    time = series["time"][late] / units.t
    axes = panels.stacked(EXCESS, "core", units.label("core", r"core$\,/\,l$"), units.rate_label(),
                          x=units.time_label(), width=5.8, height=2.1)
    draw_excess(axes[0], result, onset(result), units, BLUE)
    positive(axes[1], time, series["core_velocity_range"][late] / (scale or units.v), color=BLUE,
             label="velocity range" + (rf" / {scale:.4g}" if scale else ""))
    whole = result.setting("initial", "particles", 1.0) * mean_mass(result)
    positive(axes[1], time, series["core_mass"][late] / whole, color=ORANGE, label="share of all mass")
    positive(axes[2], time, series["core_width"][late] / units.x, color=BLUE, label="length with half of the mass")
    positive(axes[2], time, series["core_gap"][late] / units.x, color=ORANGE, label="median gap")
    middle, dissipative, elastic = collision_rates(result)
    shown = middle >= onset(result)
    for values, colour, label in ((elastic, ORANGE, "elastic"), (dissipative, BLUE, "dissipative")):
        positive(axes[3], middle[shown] / units.t, values[shown] * units.t, color=colour, label=label)


def core_of(snapshot):
    """The slice of the particles in the core, as in configuration_statistics.hpp, and their gaps."""
    x, m = snapshot["x"], snapshot["m"]
    held = np.concatenate([[0.0], np.cumsum(m)])
    last = np.searchsorted(held, held[:-1] + held[-1] / 2 * (1 + 1e-12), side="right") - 1  # from each particle on
    first = np.flatnonzero(last < len(x))
    width = x[last[first]] - x[first]
    best = int(np.argmin(width))
    low, high = x[first[best]] - width[best], x[last[first[best]]] + width[best]
    inside = np.flatnonzero((x >= low) & (x <= high))
    return np.arange(inside[0], inside[-1] + 1), snapshot["gap"][inside[0]:inside[-1]]


def draw_distributions(snapshots, scale, units, panels):
    left, right = panels(1, 2, figsize=(7.2, 3.4), letters=True)
    chosen = snapshots[::max(1, len(snapshots) // 6)]
    for snapshot, colour in shaded(chosen):
        particles, gap = core_of(snapshot)
        v = (snapshot["v"][particles] - np.median(snapshot["v"][particles])) / scale
        density, edges = np.histogram(v, bins=50, range=(-0.75, 0.75))
        left.stairs(density / len(v) / (edges[1] - edges[0]), edges, color=colour, label=units.at(snapshot["time"]))
        gap = gap[gap > 0] / gap.mean()
        density, edges = np.histogram(gap, bins=np.geomspace(1e-3, 1e2, 41))
        right.stairs(density / len(gap) / np.diff(edges), edges, color=colour)
    left.set(xlabel=rf"velocity in the core, from its median$\,/\,{scale:.4g}$", ylabel="probability density")
    gap = np.geomspace(1e-3, 30, 200)
    right.plot(gap, np.exp(-gap), "k:", label=r"$e^{-g/\langle g\rangle}$, no order")
    right.set(xscale="log", yscale="log", ylim=(1e-5, 10), xlabel=r"gap $g\,/\,\langle g\rangle$")


def draw_spacetime(snapshots, units, panels):
    """Paths of particles evenly spread over the core at the end, relative to the middle one. All keep their order."""
    core, _ = core_of(snapshots[-1])
    particles = snapshots[-1]["index"][core][::max(1, len(core) // PATHS)]
    ax = panels(figsize=(5.8, 4.6))
    time = np.array([s["time"] for s in snapshots]) / units.t
    middle = int(snapshots[-1]["index"][core[len(core) // 2]])
    places = [dict(zip(s["index"].tolist(), s["x"] / units.x)) for s in snapshots]
    for particle, colour in shaded(particles.tolist()):
        ax.plot(time, [at.get(particle, np.nan) - at.get(middle, np.nan) for at in places], color=colour, lw=0.6)
    reach = max(np.ptp(s["x"][core_of(s)[0]]) for s in snapshots) / units.x
    ax.set(xlabel=units.time_label(), xlim=(time[0], time[-1]), ylim=(-0.7 * reach, 0.7 * reach),
           ylabel=units.label(rf"$x-x_{{{middle}}}$", rf"$(x-x_{{{middle}}})\,/\,l$"))


# ---- a sweep

def draw_points(points, since, units, panels):
    length = "length with half of the mass"
    axes = panels.stacked(EXCESS, "velocity range\n/ cut-off or merging speed",
                          units.label(length, length + r"$\,/\,l$"), x=units.time_label(), width=7.2, height=2.7)
    replaced = [p for p in points if p.word("run", "collapse") in ("merge", "contact-time")]
    others = [p for p in points if p not in replaced]
    how = [(p, colour, "-") for p, colour in zip(others, shades(len(others)))]
    warm = plt.get_cmap("autumn")(np.linspace(0, 0.8, len(replaced)))
    how += [(p, colour, "--") for p, colour in zip(replaced, warm)]
    labels = distinct((label_of(point) for point, *_ in how), [point for point, *_ in how])
    for (point, colour, line), label in zip(how, labels):
        late = point.means["time"] >= since
        time = point.means["time"][late] / units.t
        draw_excess(axes[0], point, since, units, colour, label, line)
        if slowest(point):
            positive(axes[1], time, point.means["core_velocity_range"][late] / slowest(point), color=colour, ls=line)
        positive(axes[2], time, point.means["core_width"][late] / units.x, color=colour, ls=line)
    axes[0].legend(loc="upper left", bbox_to_anchor=(1.01, 1))


def with_rates(points, since, units):
    return [p for p in points if p.word("run", "collapse") not in ("merge", "contact-time") and slowest(p)
            and np.isfinite(rates(p, since, units)[0][0])]


def draw_rates(points, since, units, panels):
    points = sorted(with_rates(points, since, units), key=slowest)
    cutoff = np.array([slowest(p) for p in points])
    found = np.array([rates(p, since, units) for p in points])
    ax = panels(figsize=(5.2, 4))
    for k, (name, colour) in enumerate((("dissipative", BLUE), ("elastic", ORANGE))):
        ax.errorbar(cutoff, found[:, k, 0], yerr=found[:, k, 1], fmt="o-", color=colour, capsize=3,
                    label=name + ", and how it varies")
    ax.plot(cutoff, [most_frequent(p, slowest(p)) for p in points], "k:",
            label=r"all that arrives lost at the cut-off, $2u_0^2/(1-r^2)\delta^2$")
    ax.set(xscale="log", yscale="log", xlabel=r"cut-off $\delta$", ylabel=units.rate_label())
