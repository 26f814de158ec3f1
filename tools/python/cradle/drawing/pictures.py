"""Which pictures a result has, and writing them. Every kind is a module with pictures(result, theory, units), which
yields a name, the function that draws the picture, and its arguments before `panels`; nothing without the data."""
import contextlib
import os

import matplotlib.pyplot as plt

from ..errors import BAD_FILE, Error
from ..files import whole
from . import (averages, beyond, blast, clusters, cooling, correlations, domino, energy, ensemble, floors, histograms,
               onset, particles, places, proof, scenarios, shock, spacetime, splash, sticky, structure, sweep,
               threshold, walls, words, zone)
from .finish import finish
from .style import Panels, Units, style
from .theory import Theory

CLASSICS = (onset, floors, blast, domino, splash, walls)
# The first of these that has something to show is all there is.
ALONE = (words, threshold, proof, *CLASSICS, scenarios, sweep, ensemble, spacetime, particles)
TOGETHER = (beyond, sticky, cooling, zone, clusters, shock, structure, energy)
MEASURED = (averages, histograms, correlations, places)  # behind the others


def pictures_of(result, theory, units):
    """The pictures, the main one first and a proof last."""
    last = [picture for kind in MEASURED for picture in kind.pictures(result, theory, units)]
    last += proof.certificates(result, units)
    for kind in ALONE:
        if found := list(kind.pictures(result, theory, units)):
            return found + last
    return [picture for kind in TOGETHER for picture in kind.pictures(result, theory, units)] + last


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
        figure.savefig(file, format=extension, metadata=stamps[extension])
