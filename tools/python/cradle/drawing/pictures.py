"""Which pictures a result has, and writing them. Every kind is a module with pictures(result, theory, units): pairs
of a name and a function that draws the picture; none if the result does not have the data."""
import contextlib
import os

import matplotlib.pyplot as plt

from ..errors import BAD_FILE, Error
from ..files import whole
from . import (averages, beyond, blast, clusters, cooling, correlations, domino, energy, ensemble, histograms, onset,
               particles, places, proof, scenarios, shock, spacetime, splash, sticky, structure, sweep, threshold,
               walls, words, zone)
from .style import Units, style
from .theory import Theory

CLASSICS = (onset, blast, domino, splash, walls)
# The first of these that has something to show is all there is.
ALONE = (words, threshold, proof, *CLASSICS, scenarios, sweep, ensemble, spacetime, particles)
TOGETHER = (beyond, sticky, cooling, zone, clusters, shock, structure, energy)
MEASURED = (averages, histograms, correlations, places)  # behind the others


def pictures_of(result, theory, units):
    """The pictures, the main one first and a proof last."""
    last = [picture for kind in MEASURED for picture in kind.pictures(result, theory, units)]
    last += proof.certificates(result, units)
    for kind in ALONE:
        if found := kind.pictures(result, theory, units):
            return found + last
    return [picture for kind in TOGETHER for picture in kind.pictures(result, theory, units)] + last


def available(result, predictions):
    """Names and functions of the pictures of an opened result, the main one first. A function draws on new or given
    axes and returns the figure. predictions: the output of `cradle theory --csv`. Raises Error."""
    with lacking(result.path):
        return {name: drawing(result.path, name, draw)
                for name, draw in pictures_of(result, Theory(predictions), Units.of(result))}


def drawing(path, name, draw):
    def drawn(axes=None):
        with style(), lacking(path, f" for the {name} picture"):
            return draw(axes)
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


def write_file(figure, path):
    """Writes beside the final place, then renames, so that no incomplete picture is left; closes the figure."""
    try:
        with whole(path) as part:
            write(figure, part, os.path.splitext(path)[1][1:].lower())
    finally:
        plt.close(figure)


def write(figure, file, extension):
    """Writes PNG, PDF or SVG to a file or a file-like object. The same figure gives the same bytes: no time stamps."""
    stamps = {"png": {"Software": None}, "pdf": {"CreationDate": None, "ModDate": None}, "svg": {"Date": None}}
    with style():
        figure.savefig(file, format=extension, metadata=stamps[extension])
