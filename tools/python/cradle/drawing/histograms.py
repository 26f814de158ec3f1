"""Histograms as densities: counts divided by their sum and by the width of the bin. Beside the closing speeds of an
elastic gas on a ring those of equilibrium, w/(2 T) exp(-w^2/(4 T)) for particles of mass 1."""
import numpy as np

from .style import BLUE, ORANGE, note

LABELS = {"free_flight": "time between two collisions of a particle ($t$)",
          "pair_flight": "time between two collisions of a pair ($t$)",
          "closing_speed": "closing speed ($l/t$)",
          "dissipative_closing_speed": "closing speed of dissipative collisions ($l/t$)",
          "collisions_per_particle": "collisions of a particle",
          "gap": "gap ($l$)", "cluster": "particles of a cluster"}


def pictures(result, _theory, _units):
    names = [name for name in LABELS if name in result.histograms and counted(result.histograms[name])[1].any()]
    if names:
        yield "histograms", draw, result, names


def counted(table):
    """Whether a bin has two edges other than 0, and the counts of a run, or their means and standard errors."""
    count = table["count"]
    mean, error = (count["mean"], count["sem"]) if "mean" in count else (count, np.sqrt(count))
    low, high = np.asarray(table["low"]), np.asarray(table["high"])
    drawn = np.isfinite(high) & (low > 0)
    return drawn, np.nan_to_num(np.asarray(mean, float)) * drawn, np.asarray(error, float)  # NaN: of no replica


def variance(result):
    """Of the velocities on a ring in equilibrium; None of others."""
    elastic = result.setting("law", "restitution", 0.0) == 1 and "masses" not in result.scene.get("initial", {})
    on_ring = result.word("initial", "type") == "ring" and result.word("initial", "velocities") == "gaussian"
    return result.setting("initial", "variance", 1.0) if elastic and on_ring else None


def draw(result, names, panels):
    axes = panels.stacked(*["density"] * len(names), height=2.2)
    for ax, name in zip(axes, names):
        table = result.histograms[name]
        drawn, count, error = counted(table)
        shown = drawn & (count > 0)
        low, high = np.asarray(table["low"])[shown], np.asarray(table["high"])[shown]
        scale = 1 / (count.sum() * (high - low))
        x = np.sqrt(low * high)
        ax.errorbar(x, count[shown] * scale, yerr=error[shown] * scale, fmt="o", ms=2.5, lw=0.8, color=BLUE)
        if name == "closing_speed" and (T := variance(result)) is not None:
            ax.plot(x, x / (2 * T) * np.exp(-x ** 2 / (4 * T)), "--", color=ORANGE, lw=1, label="equilibrium")
        ax.set(xscale="log", yscale="log", xlabel=LABELS[name])
    note(axes[0], f"counted at $t={table['from']:.5g}$ to ${table['until']:.5g}$")
