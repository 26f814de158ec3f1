"""Which pictures a result gets, and their files. Every kind is a module with pictures(result, theory, units): pairs of
a name and a function that draws it, none where the result does not hold what the picture shows."""
import contextlib
import os

import matplotlib.pyplot as plt

from ..errors import BAD_FILE, Error
from ..files import whole
from . import (beyond, blast, clusters, cooling, domino, energy, ensemble, onset, particles, proof, scenarios, shock,
               spacetime, splash, sticky, structure, sweep, walls, zone)
from .style import Units, style
from .theory import Theory

CLASSICS = (onset, blast, domino, splash, walls)
# The first of these that has something to show is all there is.
ALONE = (proof, *CLASSICS, scenarios, sweep, ensemble, spacetime, particles)
TOGETHER = (beyond, sticky, cooling, zone, clusters, shock, structure, energy)


def pictures_of(result, theory, units):
    """The main picture first; a proof comes last."""
    last = proof.certificates(result, units)
    for kind in ALONE:
        if found := kind.pictures(result, theory, units):
            return found + last
    return [picture for kind in TOGETHER for picture in kind.pictures(result, theory, units)] + last


def available(result, predictions):
    """Names and functions of the pictures of an opened result, the main one first: each draws on new axes, or on those
    that it is given, and returns the figure. predictions: as `cradle theory --csv` prints them. Raises Error."""
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
    """What pictures stumble over where a group or dataset is not there, as the message."""
    try:
        yield
    except (KeyError, IndexError, ValueError) as error:
        found = " ".join(str(error).split())
        raise Error(f"{path} lacks data{purpose} ({type(error).__name__}: {found}): give the file of a completed run",
                    BAD_FILE) from None


def write_file(figure, path):
    """Written beside its place and renamed, so that no half a picture is left; closes the figure."""
    try:
        with whole(path) as part:
            write(figure, part, os.path.splitext(path)[1][1:].lower())
    finally:
        plt.close(figure)


def write(figure, file, extension):
    """As PNG, PDF or SVG, into a file or what can be written like one: same figure, same bytes, no time stamps."""
    stamps = {"png": {"Software": None}, "pdf": {"CreationDate": None, "ModDate": None}, "svg": {"Date": None}}
    with style():
        figure.savefig(file, format=extension, metadata=stamps[extension])
