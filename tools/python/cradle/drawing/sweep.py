"""Sweeps: energies of rings beside the sticky one's; the width of the interaction zone of wet shocks (Fig. 8); every
number of the summary against what was varied, of rings if that is one key or a grid of two."""
import numpy as np

from . import beyond
from .clusters import model_width
from .energy import cooled, sticky_law
from .settings import since_label, since_start
from .style import BLUE, GREY, ORANGE, distinct, logarithmic, note, plt, shades

SPEED, LOSS = "initial.speed", "law.loss"
BESIDE = ("_error", "_replicas")  # what goes with a number of the summary
MOST = 9  # numbers in one picture


def pictures(result, theory, units):
    if not result.sweep:
        return
    yield from beyond.pictures(result, theory, units)
    keys = varied(result)
    if len(cooling_points(result)) > 1:
        yield "cooling", draw_cooling, result
    if "zone_width" in result.sweep and {SPEED, LOSS} & set(keys):
        yield "zone", draw_widths, result, keys
    if numbers(result) and (len(keys) == 1 or is_grid(keys) or not cooling_points(result)):
        yield "parameters", draw_map if is_grid(keys) else draw_cuts, result, keys


def is_grid(keys):
    """Whether two keys are varied in all combinations."""
    points = set(zip(*keys.values()))
    return len(keys) == 2 and len(points) == np.prod([len(np.unique(values)) for values in keys.values()])


def varied(result):
    """The values of each key that varies; a point that does not set it has the scene's value."""
    keys = {name: np.array(column, float) for name, column in result.sweep.items() if "." in name}
    for name, values in keys.items():
        for number in np.flatnonzero(np.isnan(values)):
            if number < len(result.points):
                values[number] = result.points[number].setting(*name.split(".", 1), np.nan)
    return {name: values for name, values in keys.items() if len(np.unique(values)) > 1}


def numbers(result):
    """The columns with results that differ; those that every run has come last."""
    found = [name for name, column in result.sweep.items()
             if "." not in name and name not in ("point", "replicas") and not name.endswith(BESIDE)
             and len(np.unique(column[np.isfinite(column)])) > 1]
    return sorted(found, key=lambda name: name in ("collisions", "energy", "merges"))[:MOST]


def error_of(result, name):
    """Error bars; none if errors are not known, as for a mean over one replica."""
    error = result.sweep.get(name + "_error")
    return None if error is None else np.nan_to_num(error)


# ---- free cooling

def cooling_points(result):
    return [p for p in result.points if p.word("initial", "type") == "ring" and len(p.means.get("time", ())) > 1]


def label_of(point):
    """The law with its parameter."""
    parameter, symbol = {"wet": ("loss", r"E_\mathrm{loss}"), "inelastic": ("restitution", r"r")}.get(
        point.law, ("", ""))
    cutoff, exponent = point.setting("law", "cutoff", 0.0), point.setting("law", "cutoff_exponent")
    slow = "" if exponent is None else rf", $\delta={cutoff:.4g}$, $\sigma={exponent:.4g}$"
    return point.law + (rf", ${symbol}={point.setting('law', parameter):.4g}$" if parameter else "") + slow


def draw_cooling(result, panels):
    points = cooling_points(result)
    reference = next((p for p in points if p.law == "sticky"), None)
    others = [p for p in points if p is not reference]
    shown = others + ([reference] if reference else [])
    labels = distinct(map(label_of, shown), shown)
    time = since_start(points[0], points[0].means["time"])
    asymptotic = sticky_law(points[0], time)
    applies = bool(np.isfinite(asymptotic).any())
    top, *below = panels.stacked(
        r"energy per particle $E\,/\,N$", *[r"$E\,/\,E_{\mathrm{sticky}}$"] * (applies or reference is not None),
        x=since_label(points[0]), height=2.9)
    for point, colour, label in zip(shown, [*shades(len(others)), "k"], labels):
        _, at, energy, law = cooled(point)
        line = "--" if point.law == "inelastic" and reference else "-"  # beside wet and sticky particles
        top.plot(at, energy, line, color=colour, label=label, zorder=3 if point is reference else 2)
        if reference is not None:
            _, seen, known, _ = cooled(reference)
            law = np.exp(np.interp(np.log(at), np.log(seen), np.log(known), left=np.nan, right=np.nan))
        for ax in below:
            ax.plot(at, energy / law, line, color=colour)
    logarithmic(top, *below)
    if applies:
        top.plot(time, asymptotic, ":", color="k", lw=1.4, label=r"$0.2214\,s^2(st/a)^{-2/3}$")
    for ax in below:
        ax.axhline(1, color=GREY, lw=0.8, zorder=0)
    top.legend(loc="lower left")


# ---- the width of the interaction zone

def draw_widths(result, keys, panels):
    """Fig. 8. The bar shows the width to u_crit; the upper bar extends to u0/|slope|, where u+ is 0 as in (13)."""
    width = result.sweep["zone_width"]
    first = result.points[0] if result.points else result
    speed = keys.get(SPEED, np.full(len(width), first.setting("initial", "speed", 0.5)))
    loss = keys.get(LOSS, np.full(len(width), first.setting("law", "loss", np.nan)))
    spacing = first.setting("initial", "spacing", 1.0)
    error = error_of(result, "zone_width")
    ax = panels(figsize=(5.2, 4.2))
    other = ax.twiny()
    for axes, values, fixed, model, given, label, mark, line, colour in (
            (ax, speed, loss, lambda u0, lost: model_width(u0, lost, spacing), r"$E_\mathrm{loss}=%.4g$",
             r"$u_0$ in $l/t$ (circles)", "o", "--", BLUE),
            (other, loss, speed, lambda lost, u0: model_width(u0, lost, spacing), "$u_0=%.4g$",
             r"$E_\mathrm{loss}$ in $m\,l^2/t^2$ (squares)", "s", "-", ORANGE)):
        at = commonest(fixed)
        cut = (fixed == at) & np.isfinite(width)
        if len(np.unique(values[cut])) < 2:
            axes.xaxis.set_visible(False)
            continue
        slow = np.minimum(2 * np.sqrt(loss) / speed, 0.99)  # u_crit/u0
        upper = np.maximum(error, width * slow / (1 - slow))[cut]
        axes.errorbar(values[cut], width[cut], yerr=[error[cut], upper], fmt=mark, color=colour, capsize=3, lw=1, ms=5,
                      label=given % at)
        fine = np.geomspace(values[cut].min(), values[cut].max(), 200)
        axes.plot(fine, model(fine, at), line, color=colour, label=f"Eq. (13), {given % at}")
        axes.set_xlabel(label, color=colour)
        axes.set(xscale="log", yscale="log")
    ax.set_ylabel(r"width of the zone $2L$" if spacing != 1 else r"width of the zone $2L\,/\,l$")
    handles = [item for axes in (ax, other) for item in zip(*axes.get_legend_handles_labels())]
    ax.legend(*zip(*handles), loc="upper center", ncol=2)
    ax.set_ylim(top=3 * ax.get_ylim()[1])  # room for the legend
    for axes in (ax, other):
        axes.xaxis.set_minor_formatter(plt.NullFormatter())
        axes.xaxis.set_major_locator(plt.matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter(plt.FuncFormatter(lambda value, _: f"{value:.3g}"))


def commonest(values):
    found, counts = np.unique(values, return_counts=True)
    return found[np.argmax(counts)]


# ---- anything else

def draw_cuts(result, keys, panels):
    """Each number of the summary against each key, with the other keys at their most frequent values (NaN: the key does
    not apply); without keys, against the number of the point."""
    names = numbers(result)
    columns = dict(list(keys.items())[:3]) or {"point": np.arange(len(result.sweep[names[0]]))}
    size = (max(5.6, 3 * len(columns)), 1.9 * len(names) + 0.3)
    axes = panels(len(names), len(columns), figsize=size, squeeze=False, sharex="col", sharey="row")
    for column, (key, x) in enumerate(columns.items()):
        cut = np.isfinite(x)
        for values in (values for name, values in keys.items() if name != key):
            usual = commonest(values)
            cut &= np.isnan(values) if np.isnan(usual) else values == usual
        at = np.flatnonzero(cut)
        at = at[np.argsort(x[at], kind="stable")]
        for ax, name in zip(axes[:, column], names):
            error = error_of(result, name)
            ax.errorbar(x[at], result.sweep[name][at], yerr=None if error is None else error[at], fmt="o-", ms=4,
                        lw=0.8, capsize=2, color=BLUE)
            spread(ax.set_yscale, result.sweep[name])
        spread(axes[-1, column].set_xscale, x, 8)
        axes[-1, column].set_xlabel(key)
    if any(error is not None and error.any() for error in (error_of(result, name) for name in names)):
        note(axes[0, -1], "bars: standard errors over replicas")
    for ax, name in zip(axes[:, 0], names):
        unit = result.sweep[name].unit
        ax.set_ylabel(name.replace("_", " ") + (f" (${unit}$)" if unit not in ("", "1") else ""))


def wide(values, ratio=30):
    values = values[np.isfinite(values)]
    return values.size > 0 and values.min() > 0 and values.max() > ratio * values.min()


def spread(scale, values, ratio=30):
    if wide(values, ratio):
        scale("log")


def draw_map(result, keys, panels):
    """Numbers in the plane of two keys; a cross marks a missing one."""
    names, (x_key, y_key) = numbers(result), sorted(keys, key=lambda key: -len(np.unique(keys[key])))
    columns = min(2 if len(names) < 5 else 3, len(names))
    rows = -(-len(names) // columns)
    axes = panels(rows, columns, figsize=(3.4 * columns, 2.8 * rows), squeeze=False, letters=True)
    x, y, shade = keys[x_key], keys[y_key], plt.matplotlib.colors.ListedColormap(shades(256))
    for k, ax in enumerate(axes.flat):
        if k >= len(names):
            ax.set_visible(False)
            continue
        values = result.sweep[names[k]].astype(float)
        known = np.isfinite(values)
        norm = plt.matplotlib.colors.LogNorm() if wide(values) else None
        dots = ax.scatter(x[known], y[known], c=values[known], norm=norm, marker="s", s=60, cmap=shade)
        ax.plot(x[~known], y[~known], "x", color=GREY)
        panels.figure.colorbar(dots, ax=ax, label=names[k].replace("_", " "))
        spread(ax.set_xscale, x, 8)
        spread(ax.set_yscale, y, 8)
        ax.set(xlabel=x_key, ylabel=y_key)
