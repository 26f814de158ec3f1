"""Averages over time in bins, with standard errors. Beside the heat current of identical elastic particles between
thermal walls the exact one: they pass each other, so J = rho (T1 - T2) / (sqrt(pi/2) (T1^-1/2 + T2^-1/2)), m = 1."""
import numpy as np

from .style import BLUE, ORANGE, note

PANELS = {"density": "density $n$ ($1/l$)", "velocity": "mean velocity\n$u$ ($l/t$)",
          "temperature": "temperature\n$T$ ($m\\,l^2/t^2$)", "heat_current": "heat current\n$J$ ($m\\,l^2/t^3$)"}


def pictures(result, _theory, _units):
    if "x" in result.averages:
        yield "averages", draw, result


def with_error(table, name):
    """Values and standard errors (None: not known) of a quantity, of a run or of an ensemble."""
    quantity = table[name]
    return (quantity["mean"], quantity["sem"]) if "mean" in quantity else (quantity, table.get(name + "_sem"))


def draw_points(ax, x, table, name, shown=slice(None), **how):
    """The values of a quantity at these x, with bars for standard errors that are known."""
    value, error = (np.asarray(numbers, float)[shown] for numbers in with_error(table, name))
    ax.errorbar(x[shown], value, yerr=np.where(np.isfinite(error), error, 0), fmt="o", ms=3, lw=0.9, **how)


def exact_current(result):
    """The heat current of identical elastic particles between thermal walls at rest; without gravity. Else None."""
    temperatures = [result.setting("walls", f"{side}.temperature") for side in ("left", "right")]
    walls = result.scene.get("walls", {})
    moving = result.setting("gravity", "acceleration", 0.0) != 0 or any(
        result.setting("walls", f"{side}.speed", 0.0) or walls.get(side, {}).get("motion", "none") != "none"
        for side in ("left", "right"))
    masses = result.scene.get("initial", {}).get("masses", [1])
    if None in temperatures or moving or result.setting("law", "restitution", 0.0) != 1 or set(masses) != {1}:
        return None
    density, _ = with_error(result.averages, "density")
    left, right = temperatures
    return np.mean(density) * (left - right) / (np.sqrt(np.pi / 2) * (left ** -0.5 + right ** -0.5))


def draw(result, panels):
    table = result.averages
    x = np.asarray(table["x"])
    axes = panels.stacked(*PANELS.values(), x="position $x$ ($l$)", height=1.9)
    for ax, name in zip(axes, PANELS):
        draw_points(ax, x, table, name, color=BLUE)
    if (current := exact_current(result)) is not None:
        axes[-1].axhline(current, color=ORANGE, lw=1, ls="--", label=f"exact, {current:.4g}")
    note(axes[0], f"averages over $t={table['from']:.5g}$ to ${table['until']:.5g}$, bars: standard errors")
