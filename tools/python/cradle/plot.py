"""The pictures of results, as functions: `cradle.plot.shock(result)` draws one and returns its matplotlib figure;
`cradle.plot(result)` draws the main one.

The contents of a result decide which pictures it has: `cradle.plot.names(result)` lists them, the main one first;
`cradle.plot.save(result, "fig2.pdf")` writes all, as the program's `cradle plot` does. Two equal rows are drawn in the
paper's units, x/l, v/2u0, t 2u0/l, E/(m (2u0)^2) (m = 1); other scenes in their own units.

Every function takes
    result   an opened result, or a path
    axes     matplotlib axes, one for each panel of the picture (Error says how many); by default a new figure in the
             style of the program
    theory   False leaves out the paper's predictions, which come from the program (`cradle theory`)
and raises Error if the result does not have the data.
"""
from __future__ import annotations

import os
import sys
import warnings
from types import ModuleType
from typing import TYPE_CHECKING

from . import program
from .errors import BAD_FILE, BAD_INPUT, Error, path_of
from .files import check_replaced, made_from
from .result import Result, open

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURES = {
    "shock": "Velocities of single particles, mean velocity and density at several times (paper, Figs. 2 and 6).",
    "structure": "Four nested zooms into a core that positions cannot resolve (Fig. 3).",
    "energy": "Energy and number of collisions against time (Fig. 4).",
    "sticky": "The weak solution: step of velocity, rows and delta peak, mass of the cluster (Fig. 1).",
    "spacetime": "Paths of a few particles that stick or pass through each other (Fig. 5), or of the dense core.",
    "zone": "The interaction zone beside the linear model (Fig. 7); of a sweep its width (Fig. 8).",
    "clusters": "Positions and velocities of the two heaviest clusters (Figs. 9, 10, 11).",
    "scaling": "How the swings of the two heaviest clusters grow, and masses of all clusters.",
    "masses": "How many clusters are of a mass or heavier.",
    "cooling": "Energy on a ring beside the law of the sticky gas; of a sweep all its gases.",
    "field": "Velocities on a stretch of a ring.",
    "beyond": "Past the collapse: energy beside the sticky gas, the dense core, collisions per time.",
    "rates": "Collisions per time against the cut-off.",
    "distributions": "Velocities and gaps in the dense core.",
    "particles": "Paths of a few particles, and how their gaps or intervals shrink.",
    "onset": "Part of the replicas of rings that collapse, against the number of particles.",
    "blast": "A blast in a cold gas: its front, and profiles beside the exact solution of Euler's equations.",
    "domino": "Dominoes of two masses: when each heavy particle is first hit, against the closed form.",
    "splash": "A kicked cold gas on a half-line: front, energy and their exponents.",
    "walls": "A gas between walls: places, shares of the energy, what the walls have given.",
    "averages": "Averages over time in bins, with standard errors; a heat current beside the exact one.",
    "histograms": "What was counted, as densities; closing speeds in equilibrium beside the exact ones.",
    "correlations": "Mean-square displacement and velocity autocorrelation of tagged particles, beside the exact ones.",
    "structure_factor": "The structure factor, averaged and at times; 1 at independent places.",
    "pair_distribution": "The pair distribution, averaged and at times; 1 at independent places.",
    "ensemble": "Means over replicas with their standard errors and extremes.",
    "profiles": "Profiles of an ensemble, with standard errors and extremes.",
    "collapse": "When replicas collapsed.",
    "scenarios": "Whether two clusters pass or stick, against the loss.",
    "regimes": "What the replicas have come to, in shares.",
    "parameters": "What depends on the parameters that were varied.",
    "words": "For which restitutions words of collapse exist, and where they are stable.",
    "threshold": "How a threshold was closed in: its distance from the values that were tried.",
    "trust": "Digits that runs of rising precision share with the last one.",
    "certificate": "Of a proof: smallest gap, and how well places and gaps are known.",
}
__all__ = ["names", "save", *PICTURES]


def drawings(result: Result | str | os.PathLike, theory: bool = True) -> dict:
    """Names and functions of axes=None of all pictures of a result, the main one first."""
    from .drawing.pictures import available
    opened = result if isinstance(result, Result) else open(result)
    return available(opened, predictions(opened) if theory else "")


def predictions(result: Result) -> str:
    """The program's table for the result's scene; empty without the program, with a warning."""
    from .commands import scene_file
    try:
        with scene_file(result) as (path, _):
            return program.call(["theory", path, "--csv"]).out
    except Error as error:
        if error.status == BAD_FILE:
            warnings.warn(f"pictures are without predictions: {error}", stacklevel=3)
        return ""  # else the scene has none


def names(result: Result | str | os.PathLike) -> list[str]:
    """The names of the pictures of a result, the main one first."""
    return list(drawings(result, theory=False))


def save(result: Result | str | os.PathLike, output: str | os.PathLike, theory: bool = True,
         force: bool = True) -> list[str]:
    """Writes all pictures: the main one to output (.png, .pdf or .svg), others with their names before the extension.

    force: False replaces only pictures that were made from a result of the same name.
    Returns their paths. Same result, same bytes. Raises Error.
    """
    base, extension = os.path.splitext(path_of(output, "output"))
    if extension.lower() not in (".png", ".pdf", ".svg"):
        raise Error(f"unknown kind of picture ({extension or 'no extension'}): use .png, .pdf or .svg", BAD_INPUT)
    from .drawing.pictures import write_file
    opened = result if isinstance(result, Result) else open(result)
    found, mark = drawings(opened, theory), made_from("plot", opened.path)
    paths = [f"{base}-{name}{extension}" if number else base + extension for number, name in enumerate(found)]
    if not force:
        for path in paths:
            check_replaced(path, mark)
    for path, draw in zip(paths, found.values()):
        write_file(draw(), path, mark)
    if not paths:
        raise Error(f"{opened.path} holds nothing to draw (no series, snapshots or profiles): "
                    "give the file of a completed run", BAD_FILE)
    return paths


class Pictures(ModuleType):
    """This module: it can be called, and shows nothing but its functions."""

    def __call__(self, result: Result | str | os.PathLike, name: str | None = None, axes=None,
                 theory: bool = True) -> Figure:
        """The main picture of a result, or the one of this name; see the module. Returns the matplotlib figure."""
        found = drawings(result, theory)
        name = name or next(iter(found), "main")
        if name not in found:
            raise Error(f"no {name} picture of this result (found {', '.join(found) or 'none'}): "
                        "choose one of these, or the file of another run", BAD_INPUT)
        return found[name](axes)

    def __dir__(self) -> list[str]:
        return __all__


def _function(name: str, text: str):
    def picture(result: Result | str | os.PathLike, axes=None, theory: bool = True) -> Figure:
        return Pictures.__call__(module, result, name, axes, theory)

    picture.__name__ = picture.__qualname__ = name
    picture.__doc__ = f"{text} result, axes and theory as in cradle.plot; returns the matplotlib figure."
    return picture


globals().update({name: _function(name, text) for name, text in PICTURES.items()})
module = sys.modules[__name__]
module.__class__ = Pictures
