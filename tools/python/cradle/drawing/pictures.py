"""Which pictures a result has, what every picture gets, and writing them. For each kind a function of (result, theory,
units) yields a name, the function that draws the picture, and its arguments before `panels`; nothing without the data.
"""
import contextlib
import os
import re
import textwrap

import matplotlib.pyplot as plt
from matplotlib.axis import Axis
from matplotlib.backend_bases import get_registered_canvas_class
from matplotlib.font_manager import findfont, get_font
from matplotlib.text import Text
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from ..errors import BAD_FILE, Error
from ..files import whole
from . import (beyond, clusters, cold, energy, ensemble, measured, particles, proof, scenarios, shock, sticky, sweep,
               walls)
from .style import FONT, Panels, Units, style
from .theory import Theory

# The first of these that has something to show is all there is.
ALONE = (proof.pictures, scenarios.onsets, walls.shaken, cold.pictures, walls.pictures, scenarios.pictures,
         sweep.pictures, ensemble.pictures, particles.pictures)
TOGETHER = (beyond.pictures, sticky.pictures, energy.cooling, clusters.pictures, shock.pictures, shock.structures,
            energy.pictures)
LAST = (measured.pictures, proof.certificates)  # behind the others
PAPER = "Equations and sections: Zaburdaev and Herminghaus, Phys. Rev. E 75, 031304 (2007)"
CITED = re.compile(r"Eqs?\. \(|\(1?\d\)(,|$)|^section [IV]")
WIDE, LINES = 12, 3  # characters of a title per inch, and its lines


def pictures_of(result, theory, units):
    """The pictures, the main one first and a proof last."""
    def all_of(kinds):
        return [picture for kind in kinds for picture in kind(result, theory, units)]
    alone = next(filter(None, (all_of([kind]) for kind in ALONE)), None)
    return (alone or all_of(TOGETHER)) + all_of(LAST)


def available(result, predictions):
    """Names and functions of the pictures of an opened result, the main one first. A function draws on new or given
    axes and returns the figure. predictions: the output of `cradle theory --csv`. Raises Error."""
    title = str(result.scene.get("title") or result.attributes.get("name", ""))
    with lacking(result.path):
        return {name: drawing(result.path, name, draw, arguments, title)
                for name, draw, *arguments in pictures_of(result, Theory(predictions), Units.of(result))}


def drawing(path, name, draw, arguments, title):
    def drawn(axes=None, dark=False, titled=True):
        with style(dark), lacking(path, f" for the {name} picture"):
            panels = Panels(axes)
            draw(*arguments, panels)
            panels.add_legends()
            return panels.figure if axes is not None else finish(panels.figure, title if titled else "")
    return drawn


def finish(figure, title):
    """Adds the title of its scene, "" for none, labels on axes of less than a decade, and the name of a cited paper."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            label_ticks(axis)
    own = getattr(figure, "_suptitle", None)
    lines = textwrap.wrap(title, int(WIDE * figure.get_figwidth()), max_lines=LINES, placeholder=" ...")
    known = get_font(findfont(FONT)).get_char_index
    lines = ["".join(c if known(ord(c)) else "\ufffd" for c in line).replace("$", r"\$") for line in lines]
    if own is not None:
        lines.append(own.get_text())
    if lines:
        figure.suptitle("\n".join(lines), fontsize=9)
    parts = [*figure.texts, *(part for axes in figure.axes for part in (
        *axes.get_children(), axes.xaxis.label, axes.yaxis.label) if not isinstance(part, Axis))]  # without ticks
    if any(CITED.search(text.get_text()) for part in parts for text in part.findobj(Text)):
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


@contextlib.contextmanager
def lacking(path, purpose=""):
    """Turns the exceptions for missing groups and datasets into a message."""
    try:
        yield
    except (KeyError, IndexError, ValueError) as error:
        found = " ".join(str(error).split())
        raise Error(f"{path} lacks data{purpose} ({type(error).__name__}: {found}): give the file of a completed run",
                    BAD_FILE) from None


def write_file(figure, path, made_by):
    """Writes beside the final place, then renames, so that no incomplete picture is left; closes the figure."""
    try:
        with whole(path) as part:
            write(figure, part, os.path.splitext(path)[1][1:].lower(), made_by=made_by)
    finally:
        plt.close(figure)


def write(figure, file, extension, dark=False, made_by=None):
    """Writes PNG, PDF or SVG to a file or a file-like object. The same figure gives the same bytes: no time stamps.
    made_by: a mark in the file, by which the same command knows its own pictures."""
    stamps = {"png": {"Software": None, "Source": made_by}, "svg": {"Date": None, "Source": made_by},
              "pdf": {"CreationDate": None, "ModDate": None, "Subject": made_by}}
    with style(dark):
        figure.dpi = plt.rcParams["savefig.dpi"]
        # figure.savefig would draw twice, the first time for the layout alone.
        getattr(get_registered_canvas_class(extension)(figure), f"print_{extension}")(file, metadata=stamps[extension])
