"""Which pictures a result gets, and their files. Every kind is a module with pictures(result, theory, units): pairs of
a name and a function that draws it, none where the result does not hold what the picture shows."""
import contextlib
import os

import matplotlib.pyplot as plt

from ..errors import BAD_FILE, Error
from ..files import whole
from . import (beyond, blast, certificate, clusters, cooling, domino, energy, ensemble, onset, particles, scenarios,
               shock, spacetime, splash, sticky, structure, sweep, trust, walls, zone)
from .style import Units, style

CLASSICS = (onset, blast, domino, splash, walls)
# The first of these that has something to show is all there is.
ALONE = (trust, *CLASSICS, scenarios, sweep, ensemble, spacetime, particles)
TOGETHER = (beyond, sticky, cooling, zone, clusters, shock, structure, energy)


def pictures_of(result, theory, units):
    """The main picture first; a proof comes last."""
    proof = certificate.pictures(result, theory, units)
    for kind in ALONE:
        if found := kind.pictures(result, theory, units):
            return found + proof
    return [picture for kind in TOGETHER for picture in kind.pictures(result, theory, units)] + proof


def available(result, theory):
    """Names and functions of the pictures of an opened result, the main one first: each draws on new axes, or on those
    that it is given, and returns the figure. Raises Error."""
    with lacking(result.path):
        return {name: drawing(result.path, name, draw)
                for name, draw in pictures_of(result, theory, Units.of(result))}


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


def make(result, base, extension, theory):
    """Writes all pictures of an opened result and yields the name of each; raises Error."""
    pictures = available(result, theory)
    if not pictures:
        raise Error(f"{result.path} holds nothing to draw (no series, snapshots or profiles): "
                    "give the file of a completed run", BAD_FILE)
    for number, (name, draw) in enumerate(pictures.items()):
        path = f"{base}-{name}{extension}" if number else base + extension
        figure = draw()
        with lacking(result.path, f" for the {name} picture"):
            save(figure, path)
        yield path


def save(figure, path):
    """Written beside its place and renamed, so that no half a picture is left; no time stamps."""
    extension = os.path.splitext(path)[1][1:].lower()
    try:
        with whole(path) as part:
            write(figure, part, extension)
    finally:
        plt.close(figure)


def write(figure, file, extension):
    """As PNG, PDF or SVG, into a file or what can be written like one: same figure, same bytes."""
    stamps = {"png": {"Software": None}, "pdf": {"CreationDate": None, "ModDate": None}, "svg": {"Date": None}}
    with style():
        figure.savefig(file, format=extension, metadata=stamps[extension])
