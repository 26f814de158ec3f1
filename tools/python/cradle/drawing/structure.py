"""Fig. 3: four nested zooms into a core that positions cannot resolve, drawn from the gaps."""
import numpy as np

from .style import BLUE, RED, note, plt

CORE_GAP = 1e-2       # of the spacing: a quarter of the gaps below this makes a core
CORE_SHARE = 16       # the innermost zoom holds one particle in so many
CORE_PARTICLES = 60      # but at least these


def pictures(result, _theory, units):
    if (core := core_of(result, units)) is not None:
        yield "structure", draw_structure, core, units


def core_of(result, units):
    """The last snapshot in which a quarter of the gaps are far below the spacing, or None."""
    for snapshot in reversed(result.snapshots):
        gap = snapshot.get("gap", ())
        if len(gap) > 2 * CORE_PARTICLES and np.quantile(gap, 0.25) < CORE_GAP * units.x:
            return snapshot
    return None


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
