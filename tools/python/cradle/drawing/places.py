"""The places of particles: structure factor and pair distribution, averaged with standard errors and at times; of a
sweep those of all points, a panel for each time. The line, 1, is that of independent places, as in equilibrium."""
from .averages import draw_points as draw_mean, with_error
from .style import ORANGE, beside, distinct, shaded, shades, thinned
from .sweep import label_of

PICTURES = (("structure_factor", "structure", "s", "k", "wave number $k$ ($1/l$)", "structure factor $S(k)$",
             {"xscale": "log", "yscale": "log"}),
            ("pair_distribution", "pair_distribution", "pair_distribution", "distance", "distance $r$ ($l$)",
             "pair distribution $g(r)$", {}))


def pictures(result, _theory, _units):
    for name, group, *labels in PICTURES:
        if result.sweep and any(len(getattr(p, group)) for p in result.points):
            yield name, draw_points, result, group, *labels
        elif not result.sweep and (len(getattr(result, group)) or getattr(result, group + "_average")):
            yield name, draw, result, group, *labels


def draw(result, group, name, along, xlabel, ylabel, scales, panels):
    ax = panels(figsize=(5.6, 3.2))
    for table, colour in shaded(thinned(getattr(result, group))):
        ax.plot(table[along], with_error(table, name)[0], color=colour, lw=1, label=f"$t={table['time']:.5g}$")
    if mean := getattr(result, group + "_average"):
        draw_mean(ax, mean[along], mean, name, color="k", label=f"${mean['from']:.5g}$ to ${mean['until']:.5g}$")
    ax.axhline(1, color=ORANGE, lw=1, ls="--", label="independent")
    ax.set(**scales, xlabel=xlabel, ylabel=ylabel)
    beside(ax)


def draw_points(result, group, name, along, xlabel, ylabel, scales, panels):
    points = [p for p in result.points if len(getattr(p, group))]
    times = thinned(getattr(points[0], group).times)
    axes = panels.stacked(*[ylabel] * len(times), x=xlabel, height=2.4)
    for ax, time in zip(axes, times):
        for point, colour, label in zip(points, shades(len(points)), distinct(map(label_of, points), points)):
            table = getattr(point, group).at(time, "nearest")
            ax.plot(table[along], with_error(table, name)[0], color=colour, lw=1, label=label)
        ax.axhline(1, color=ORANGE, lw=1, ls="--")
        ax.set(**scales, title=f"$t={time:.5g}$")
    axes[0].legend(fontsize=7)
