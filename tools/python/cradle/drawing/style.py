"""The style of all pictures: colours, fonts, units, panel letters, legends. Nothing here needs a display."""
import contextlib
from dataclasses import dataclass

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib import textpath

from ..errors import BAD_INPUT, Error

# Colours by names of our own, since they differ on dark pages: those of Okabe and Ito, and brighter ones.
BLUE, ORANGE, GREEN = "cradle:blue", "cradle:orange", "cradle:green"
RED, PURPLE, SKY = "cradle:red", "cradle:purple", "cradle:sky"
GREY = "0.6"
INK, PAPER = "#e3e7eb", "#14171a"  # of dark pages (page/page.css)
LIGHT = {BLUE: "#0072b2", ORANGE: "#e69f00", GREEN: "#009e73", RED: "#d55e00", PURPLE: "#cc79a7", SKY: "#56b4e9",
         "k": "#000000", "black": "#000000", "w": "#ffffff", "white": "#ffffff"}
DARK = {BLUE: "#58b1ee", ORANGE: "#f2b33d", GREEN: "#45cfa2", RED: "#f58a52", PURPLE: "#e59ac6", SKY: "#a3dcff",
        "k": INK, "black": INK, "w": PAPER, "white": PAPER}

FONT = "DejaVu Sans"
SETTINGS = {
    "font.family": FONT, "font.size": 9, "axes.labelsize": 9, "legend.fontsize": 7.5,
    "axes.linewidth": 0.7, "xtick.direction": "in", "ytick.direction": "in", "xtick.top": True, "ytick.right": True,
    "legend.frameon": True, "legend.framealpha": 0.85, "legend.edgecolor": "none", "lines.linewidth": 1.2,
    "axes.prop_cycle": plt.cycler(color=[BLUE, ORANGE, GREEN, RED, PURPLE, SKY, "k"]), "figure.dpi": 100,
    "savefig.dpi": 200, "svg.hashsalt": "cradle", "pdf.fonttype": 42, "axes.formatter.limits": (-4, 7),
}


def name_colours(colours):
    for name, colour in colours.items():
        matplotlib.colors.get_named_colors_mapping()[name] = colour


name_colours(LIGHT)


@contextlib.contextmanager
def style(dark=False):
    """Applies the style while pictures are drawn and written; then restores the caller's settings. Pictures for dark
    pages are bright lines on the colour of the page."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(SETTINGS)
        name_colours(DARK if dark else LIGHT)
        made, textpath.TextToPath = textpath.TextToPath, lambda: textpath.text_to_path  # parses each formula once
        try:
            yield
        finally:
            name_colours(LIGHT)
            textpath.TextToPath = made


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

    def at(self, time, digits=5, name="t="):
        """A time with its unit, for legends."""
        unit = self.label("", r"\,l/2u_0")
        return f"${name}{power(time / self.t, digits)}{unit}$"

    def label(self, plain, scaled):
        return scaled if self.rows else plain

    def named(plain, scaled):
        return lambda self: self.label(plain, scaled)

    time_label = named("time ($t$)", r"time $t\,/\,(l/2u_0)$")
    position_label = named("position $x$ ($l$)", r"position $x\,/\,l$")
    velocity_label = named("velocity $v$ ($l/t$)", r"velocity $v\,/\,2u_0$")
    mean_velocity_label = named(r"mean velocity $\langle v\rangle$ ($l/t$)",
                                r"mean velocity $\langle v\rangle\,/\,2u_0$")
    density_label = named("density ($1/l$)", r"density $\rho\,/\,\rho_0$")
    rate_label = named("collisions per unit of time", r"collisions per $l/2u_0$")
    energy_label = named("energy $E$ ($m\\,l^2/t^2$)", r"energy $E\,/\,m(2u_0)^2$")


class Panels:
    """Makes the panels of a picture, once: called like plt.subplots it returns new axes, or those that were given."""

    def __init__(self, given=None):
        self.given, self.figure = given, None

    def __call__(self, rows=1, columns=1, squeeze=True, letters=False, **options):
        if self.given is None:
            self.figure, axes = plt.subplots(rows, columns, squeeze=False, layout="constrained", **options)
        else:
            axes = np.array(self.given, dtype=object).ravel()
            if axes.size != rows * columns:
                raise Error(f"not as many axes as the picture has panels (found {axes.size}): "
                            f"give {rows * columns}, {rows} below each other and {columns} side by side", BAD_INPUT)
            self.figure, axes = axes[0].figure, axes.reshape(rows, columns)
        self.axes = axes.ravel()
        for letter, ax in zip("abcdefghi", self.axes if letters else ()):
            ax.set_title(f"({letter})", loc="left", fontsize=9, fontweight="bold")
        if squeeze and 1 in (rows, columns):
            return self.axes if rows * columns > 1 else self.axes[0]
        return axes

    def stacked(self, *labels, x="", width=5.6, height=2.4, margin=0.3, **options):
        """A column of panels with their letters and the labels of their y axes, as a list. x: of the axis that they
        share; without it each has its own."""
        self(len(labels), figsize=(width, height * len(labels) + margin), letters=True, sharex=bool(x), **options)
        for ax, label in zip(self.axes, labels):
            ax.set_ylabel(label)
        self.axes[-1].set_xlabel(x)
        return list(self.axes)

    def add_legends(self):
        """To panels that have none and name a few things that no legend names yet."""
        legends = [legend for ax in self.axes if (legend := ax.get_legend())]
        named = {text.get_text() for legend in legends for text in legend.get_texts()}
        for ax in self.axes:
            labels = ax.get_legend_handles_labels()[1]
            if ax.get_legend() is None and len(labels) <= 8 and not named.issuperset(labels):
                ax.legend()
                named.update(labels)


def shades(count):
    """Colours from dark to light with time, readable in grey and by colour-blind eyes: the part of a colour map that
    stands out, without the palest yellow, on dark pages without the darkest violet."""
    part = (0.38, 1.0) if matplotlib.colors.to_hex("white") == PAPER else (0.0, 0.88)
    return plt.get_cmap("viridis")(np.linspace(*part, max(count, 2)))[:count]


def shaded(items):
    """Items, each with its shade."""
    items = list(items)
    return zip(items, shades(len(items)))


def times_of(groups, units):
    """The shades and the names of the times of snapshots or profiles, by time and in its order."""
    times = sorted({group["time"] for group in groups})
    return dict(shaded(times)), {time: units.at(time) for time in times}


def logarithmic(*axes):
    """Makes those axes of panels logarithmic that have positive values: others cannot be."""
    for ax in axes:
        for name, axis in (("x", ax.xaxis), ("y", ax.yaxis)):
            if np.isfinite(axis.get_minpos()):
                ax.set(**{name + "scale": "log"})


def ends(values):
    """The first and the last value, as limits of an axis; none if they are one."""
    return (values[0], values[-1]) if values[0] < values[-1] else (None, None)


def note(ax, text):
    """Adds a line above a panel, on the right."""
    ax.set_title(text, loc="right", fontsize=8)


def distinct(labels, points):
    """Labels of points of a sweep; equal ones with the settings that not all of them have, or with their numbers."""
    labels = list(labels)
    words = [set(point.label.split()) for point in points]

    def longer(k):
        others = [words[j] for j in range(len(points)) if j != k and labels[j] == labels[k]]
        own = sorted(word for word in words[k] if any(word not in other for other in others))
        return ", ".join([labels[k], *own] + [f"point {k}"] * (words[k] in others))
    return [longer(k) for k in range(len(points))]


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


def beside(axes):
    """Adds a legend to the right of the panel; returns it, or None if there is nothing to name."""
    if axes.get_legend_handles_labels()[0]:
        return axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return None
