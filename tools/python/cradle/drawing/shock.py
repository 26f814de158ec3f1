"""A shock at several times, Figs. 2 and 6: velocities, mean velocity and density (of mass, if particles merge). Of a
core that positions cannot resolve, Fig. 3: four nested zooms, drawn from the gaps."""
import numpy as np

from .style import BLUE, GREY, RED, beside, note, plt, thinned, times_of

MOST = 8              # snapshots and profiles; those of Figs. 2 and 6 are all drawn
BIN_PARTICLES = 25    # bins of mean velocity are merged to hold so many: the two rows alternate, and fewer alias
CORE_GAP = 1e-2       # of the spacing: a quarter of the gaps below this makes a core
CORE_SHARE = 16       # the innermost zoom holds one particle in so many
CORE_PARTICLES = 60   # but at least these


def pictures(result, theory, units):
    if result.word("initial", "type") == "ring" or (result.law == "sticky" and result.snapshots):
        return  # these have pictures of their own: cooling, sticky
    if profiles_of(result) or len(result.snapshots) > 1 or (result.snapshots and core_of(result, units) is None):
        yield "shock", draw_shock, result, theory, units


def structures(result, _theory, units):
    if (core := core_of(result, units)) is not None:
        yield "structure", draw_structure, core, units


def core_of(result, units):
    """The last snapshot in which a quarter of the gaps are far below the spacing, or None."""
    for snapshot in reversed(result.snapshots):
        gap = snapshot.get("gap", ())
        if len(gap) > 2 * CORE_PARTICLES and np.quantile(gap, 0.25) < CORE_GAP * units.x:
            return snapshot
    return None


def profiles_of(result):
    """The profiles; one with a single bin averages over everything and is not drawn."""
    return [profile for profile in result.mean_profiles if len(profile["x"]) > 1]


def averaged(snapshot, bins=50):
    """A profile of a snapshot: mass-weighted mean velocity and number density."""
    x, mass = snapshot["x"], snapshot["m"]
    edges = np.linspace(x.min(), x.max(), bins + 1)
    count, weight = np.histogram(x, edges)[0], np.histogram(x, edges, weights=mass)[0]
    momentum = np.histogram(x, edges, weights=mass * snapshot["v"])[0]
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = momentum / weight
    width = np.diff(edges)
    return {"time": snapshot["time"], "x": (edges[1:] + edges[:-1]) / 2, "velocity": mean, "density": count / width,
            "mass_density": weight / width}


def merged(profile):
    """Bin centres and mean velocities. Bins are merged, to five at least, until half of them have BIN_PARTICLES."""
    x, count = profile["x"], profile["density"] * (profile["x"][1] - profile["x"][0])
    if not (count > 0).any():
        return x[:0], x[:0]
    factor = int(np.clip(np.ceil(BIN_PARTICLES / np.median(count[count > 0])), 1, max(1, np.count_nonzero(count) // 5)))
    weight = np.nan_to_num(profile.get("mass_density", profile["density"]))
    momentum = weight * np.nan_to_num(profile["velocity"])
    starts = np.arange(0, len(x), factor)
    total, moment = np.add.reduceat(weight, starts), np.add.reduceat(weight * x, starts)
    full = total > 0
    return moment[full] / total[full], np.add.reduceat(momentum, starts)[full] / total[full]


def draw_shock(result, theory, units, panels):
    snapshots = thinned(result.snapshots, MOST)
    profiles = profiles_of(result) or [averaged(s) for s in snapshots if len(s["x"]) > 2 and np.ptp(s["x"]) > 0]
    common = [p for p in profiles if p["time"] in {s["time"] for s in snapshots}]
    profiles = thinned(common if len(common) > 1 else profiles, MOST)
    colour, name = times_of(snapshots + profiles, units)
    heavy = result.law == "wet" and all("mass_density" in p for p in profiles)
    averages = units.mean_velocity_label(), ("mass " if heavy else "") + units.density_label()
    axes = panels.stacked(*[units.velocity_label()] * bool(snapshots), *averages * bool(profiles),
                          x=units.position_label(), width=6.4, height=2.5, margin=0.5)
    density = "mass_density" if heavy else "density"
    named = {group["time"] for group in snapshots}
    if snapshots:
        if len(snapshots) < len(result.snapshots):
            note(axes[0], f"{len(snapshots)} of {len(result.snapshots)} snapshots")
        draw_velocities(axes.pop(0), snapshots, theory, units, colour, name)
    if profiles:
        for group in profiles:
            label = None if group["time"] in named else name[group["time"]]
            x, mean = merged(group)
            if 2 * len(x) <= np.count_nonzero(group["density"]) + 1:
                axes[0].set_title(f"bins with fewer than {BIN_PARTICLES} particles merged", loc="right", fontsize=7)
            axes[0].plot(x / units.x, mean / units.v, "-", lw=1.1, marker=".", ms=3, color=colour[group["time"]],
                         label=label)
            axes[1].plot(group["x"] / units.x, group[density] * units.x, drawstyle="steps-mid", lw=1.1,
                         color=colour[group["time"]])
        draw_slope(axes[0], profiles, theory, units)
        beside(axes[0])
        filled = np.concatenate([p[density][p[density] > 0] for p in profiles])
        if len(filled) and filled.max() > 30 * np.median(filled):
            axes[1].set(yscale="log", ylim=(0.5 * filled.min(), None))
        else:
            axes[1].set_ylim(bottom=0)


def draw_velocities(ax, snapshots, theory, units, colour, name):
    """Single particles, and the front's path (x_f, u_f) with its mirror image."""
    for group in snapshots:
        size = np.clip(1.6 * (3000 / len(group["x"])) ** 0.25, 1.6, 3.5)
        ax.plot(group["x"] / units.x, group["v"] / units.v, ".", ms=size, mew=0, color=colour[group["time"]],
                label=name[group["time"]], rasterized=True)
    if units.rows:
        for v in (0.5, -0.5):
            ax.axhline(v, color=GREY, lw=0.8, zorder=0, label="incoming rows" if v > 0 else None)
    time, front = theory.curve("front_position")
    speed_time, speed = theory.curve("front_velocity")
    if len(front) and len(speed):
        speed = np.interp(time, speed_time, speed)
        known = (time <= max(group["time"] for group in snapshots)) & (front >= 0)
        cited = theory.equation("front_velocity", "front_position")
        for sign in (1, -1):
            ax.plot(sign * front[known] / units.x, sign * speed[known] / units.v, "k--", lw=1,
                    label="front, " + cited if sign > 0 else None)
    legend = beside(ax)
    for handle in getattr(legend, "legend_handles", None) or legend.legendHandles:
        if handle.get_linestyle() == "None":
            handle.set_markersize(7)


def draw_slope(ax, profiles, theory, units):
    slope = theory.number("mean_velocity_slope")
    if slope is None:
        time, value = theory.curve("mean_velocity_slope")
        slope = np.interp(profiles[0]["time"], time, value) if len(time) else None
    if slope is not None:
        span = max(np.abs(p["x"]).max() for p in profiles)
        ends = np.array([-1, 1]) * min(theory.number("maximal_front") or span, span)
        ax.plot(ends / units.x, ends * slope / units.v, color=GREY, lw=5, alpha=0.55, zorder=0, solid_capstyle="butt",
                label="slope, " + theory.equation("mean_velocity_slope"))


def distances(gap, particle):
    """The distance of every particle from one of them: sums of gaps outwards, which are more precise than positions."""
    right = np.concatenate([[0.0], np.cumsum(gap[particle:])])
    left = np.cumsum(gap[:particle][::-1])[::-1]
    return np.concatenate([-left, right])


def densest(gap, particles):
    """The particle in the middle of the narrowest group of so many neighbours (at least 2), and the width of the group.

    Differences of one running sum would lose the small gaps beside large ones. So each group is the end of one block
    plus the beginning of the next, and both sums are of small terms only.
    """
    size = particles - 1
    blocks = np.concatenate([gap, np.zeros(-len(gap) % size)]).reshape(-1, size)
    ends = np.cumsum(blocks[:, ::-1], axis=1)[:, ::-1].ravel()
    starts = np.cumsum(blocks, axis=1).ravel()
    first = np.arange(len(gap) - size + 1)
    width = ends[first] + np.where(first % size == 0, 0.0, starts[first + size - 1])
    best = int(np.argmin(width))
    return best + particles // 2, float(width[best])


def draw_structure(snapshot, units, panels):
    """Each panel is the rectangle in the one before; all distances are from one particle of the core."""
    v = snapshot["v"]
    gap = snapshot["gap"][:len(v) - 1]  # a ring has one more, across x = 0
    inmost = max(CORE_PARTICLES, len(v) // CORE_SHARE)
    particle, width = densest(gap, inmost)
    x = distances(gap, particle)
    whole = 1.05 * max(-x[0], x[-1])
    core = 1.05 * max(width / 2, -x[particle - inmost // 2], x[particle + (inmost - 1) // 2])
    boxes = []
    steps = np.arange(4) / 3
    # between equal ratios of width and equal ratios of number: a collapsed core would leave middle panels empty
    held = (len(x) * (inmost / len(x)) ** steps).astype(int)
    by_number = np.sort(np.abs(x))[held - 1] * 1.05
    for half in np.sqrt(whole * (core / whole) ** steps * by_number):
        inside = np.abs(x) <= half
        # the first panel shows all; in the others a few fast particles passing by would hide the rest
        low, high = np.quantile(v[inside], (0.01, 0.99) if boxes else (0, 1))
        pad = 0.12 * (high - low) or 1e-3 * units.v
        boxes.append((half, low - pad, high + pad, inside))
    reference = rf"x_{{{int(snapshot['index'][particle])}}}"
    axes = panels(2, 2, figsize=(7.2, 5.6))
    dotted = False
    for k, (ax, (half, low, high, inside)) in enumerate(zip(axes.flat, boxes)):
        size = np.clip(1.6 * (3000 / inside.sum()) ** 0.25, 1.6, 4)
        ax.plot(x[inside] / units.x, v[inside] / units.v, ".", color=BLUE, ms=size, mew=0, rasterized=True)
        ax.set(xlim=(-half / units.x, half / units.x), ylim=(low / units.v, high / units.v))
        if k < 3:
            inner, bottom, top, _ = boxes[k + 1]
            wide, tall = max(inner, 0.012 * half), max(top - bottom, 0.024 * (high - low))  # never too small to see
            enlarged = wide > inner or tall > top - bottom
            ax.add_patch(plt.Rectangle((-wide / units.x, ((bottom + top - tall) / 2) / units.v), 2 * wide / units.x,
                                       tall / units.v, fill=False, ec=RED, lw=1.2, zorder=3,
                                       ls=":" if enlarged else "-"))
            dotted = dotted or enlarged
        ax.set(xlabel=units.label(rf"$x-{reference}$", rf"$(x-{reference})\,/\,l$"), ylabel=units.velocity_label())
        ax.ticklabel_format(axis="both", style="sci", scilimits=(-2, 3), useMathText=True)
        note(ax, rf"$\bf({'abcd'[k]})$  {int(inside.sum())} particles")
    length = units.label("", r"$\,l$")
    place = snapshot["x"][particle] / units.x
    title = (rf"{units.at(snapshot['time'], 6)},  ${reference}={place:.6g}${length},  "
             f"smallest gap {gap.min() / units.x:.1e}{length};  rectangle: the next panel"
             + (" (dotted: drawn larger)" if dotted else ""))
    if panels.given is None:  # else it is the caller's figure
        panels.figure.suptitle(title, fontsize=9)
