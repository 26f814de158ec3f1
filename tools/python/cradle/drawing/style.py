"""The style of all pictures: colours, fonts, units, panel letters, legends. Nothing here needs a display."""
import contextlib
from dataclasses import dataclass

import matplotlib
import matplotlib.pyplot as plt
import numpy as np

from ..errors import BAD_INPUT, Error

BLUE, ORANGE, GREEN, RED, GREY = "#0072B2", "#E69F00", "#009E73", "#D55E00", "0.6"  # Okabe and Ito
PURPLE, SKY = "#CC79A7", "#56B4E9"

SETTINGS = {
    "font.family": "DejaVu Sans", "font.size": 9, "axes.labelsize": 9, "legend.fontsize": 7.5,
    "axes.linewidth": 0.7,
    "xtick.direction": "in", "ytick.direction": "in", "xtick.top": True, "ytick.right": True,
    "legend.frameon": True, "legend.framealpha": 0.85, "legend.edgecolor": "none", "lines.linewidth": 1.2,
    "axes.prop_cycle": plt.cycler(color=[BLUE, ORANGE, GREEN, RED, PURPLE, SKY, "k"]), "figure.dpi": 100,
    "savefig.dpi": 200, "svg.hashsalt": "cradle", "pdf.fonttype": 42, "axes.formatter.limits": (-4, 5),
}


@contextlib.contextmanager
def style():
    """Applies the style while pictures are drawn and written; then restores the caller's settings."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(SETTINGS)
        yield


@dataclass
class Units:
    """The numbers to divide by, and the axis labels for them."""
    x: float = 1.0
    v: float = 1.0
    rows: bool = False

    @classmethod
    def of(cls, result):
        spacing, speed = result.setting("initial", "spacing", 1.0), result.setting("initial", "speed", 0.5)
        equal_rows = result.word("initial", "type") == "rows" and "left" not in result.scene["initial"]
        return cls(spacing, 2 * speed, True) if equal_rows and spacing > 0 and speed > 0 else cls()

    @property
    def t(self):
        return self.x / self.v

    @property
    def energy(self):
        return self.v ** 2

    def label(self, plain, scaled):
        return scaled if self.rows else plain

    def named(plain, scaled):
        return lambda self: self.label(plain, scaled)

    time_label = named(r"time $t$", r"time $t\,/\,(l/2u_0)$")
    position_label = named(r"position $x$", r"position $x\,/\,l$")
    velocity_label = named(r"velocity $v$", r"velocity $v\,/\,2u_0$")
    mean_velocity_label = named(r"mean velocity $\langle v\rangle$", r"mean velocity $\langle v\rangle\,/\,2u_0$")
    density_label = named("density", r"density $\rho\,/\,\rho_0$")
    rate_label = named("collisions per unit of time", r"collisions per $l/2u_0$")
    energy_label = named(r"energy $E$", r"energy $E\,/\,m(2u_0)^2$")


def subplots(axes, rows=1, columns=1, squeeze=True, **options):
    """The figure and axes of a picture: new ones as plt.subplots makes them, or the given ones, one for each panel."""
    if axes is None:
        return plt.subplots(rows, columns, squeeze=squeeze, layout="constrained", **options)
    given = np.array(axes, dtype=object).ravel()
    if given.size != rows * columns:
        raise Error(f"not as many axes as the picture has panels (found {given.size}): "
                    f"give {rows * columns}, {rows} below each other and {columns} side by side", BAD_INPUT)
    if squeeze and given.size == 1:
        return given[0].figure, given[0]
    return given[0].figure, given.reshape(-1) if squeeze and 1 in (rows, columns) else given.reshape(rows, columns)


def stacked(axes, count, width=5.6, height=2.4, **options):
    """A column of panels with their letters."""
    figure, axes = subplots(axes, count, 1, figsize=(width, height * count + 0.3), **options)
    return figure, lettered(np.atleast_1d(axes))


def lettered(axes):
    for letter, ax in zip("abcdefghi", axes):
        ax.set_title(f"({letter})", loc="left", fontsize=9, fontweight="bold")
    return list(axes)


def shades(count):
    """Colours from dark to light with time, readable in grey and by colour-blind eyes; the palest yellow is left
    out."""
    return plt.get_cmap("viridis")(np.linspace(0.0, 0.88, max(count, 2)))[:count]


def power(value, digits=5):
    """A number in a formula: 1.9e+07 as 1.9 times 10^7."""
    mantissa, _, exponent = f"{value:.{digits}g}".partition("e")
    if not exponent:
        return mantissa
    return (r"" if mantissa == "1" else mantissa + r"\times ") + f"10^{{{int(exponent)}}}"


def thinned(items, most=7):
    """At most so many, evenly chosen, with the first and the last."""
    if len(items) <= most:
        return list(items)
    return [items[i] for i in np.unique(np.linspace(0, len(items) - 1, most).round().astype(int))]


def beside(axes, **options):
    """Adds a legend to the right of the panel; returns it, or None if there is nothing to name."""
    if axes.get_legend_handles_labels()[0]:
        return axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), **options)
    return None
