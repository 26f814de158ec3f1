"""What every picture gets: the title of its scene, labels on axes of less than a decade, the name of a cited paper."""
import re
import textwrap

import matplotlib.text
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

PAPER = "Equations and sections: Zaburdaev and Herminghaus, Phys. Rev. E 75, 031304 (2007)"
CITED = re.compile(r"Eqs?\. \(|\(1?\d\)(,|$)|^section [IV]")
WIDE = 12  # characters of a title per inch


def finish(figure, title):
    """title: of the scene, "" for none."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            label_ticks(axis)
    own = getattr(figure, "_suptitle", None)
    lines = textwrap.wrap(title.replace("$", r"\$"), int(WIDE * figure.get_figwidth()))
    if own is not None:
        lines.append(own.get_text())
    if lines:
        figure.suptitle("\n".join(lines), fontsize=9)
    if any(CITED.search(text.get_text()) for text in figure.findobj(matplotlib.text.Text)):
        figure.supxlabel(PAPER, fontsize=6.5, x=0.99, ha="right", color="0.5")
    return figure


def label_ticks(axis):
    """A logarithmic axis on which fewer than two powers of ten are in sight gets labels between them."""
    if axis.get_scale() != "log" or not axis.get_visible():
        return
    low, high = sorted(axis.get_view_interval())
    locators = [axis.get_major_locator(), LogLocator(subs=(1, 2, 5)), LogLocator(subs=(1, 2, 3, 4, 5, 6, 8)),
                MaxNLocator(4)]
    for locator in locators:
        seen = [tick for tick in locator.tick_values(low, high) if low <= tick <= high]
        if len(seen) > 1:
            break
    if locator is not locators[0]:
        axis.set_major_locator(locator)
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.4g}"))
        axis.set_minor_formatter(NullFormatter())
