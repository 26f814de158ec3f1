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

PICTURES = {  # what each one shows, and what to see in it, for a reader who has not run anything
    "shock": "Velocities of single particles, mean velocity and density at several times (paper, Figs. 2 and 6). Where "
             "the curves of one time cross the whole picture, the rows are passing through each other; where they turn "
             "steep and the density rises, particles pile up. Dashed: place and speed of the first particle of each "
             "row by the theory.",
    "structure": "Four nested zooms into a core that positions cannot resolve (Fig. 3). Each panel enlarges the "
                 "rectangle of the one before. Distances are sums of the gaps, which have all their digits however "
                 "small they are.",
    "energy": "Energy and number of collisions against time (as in Fig. 4). Above, the energy, which collisions take "
              "away and walls may change, beside the theory if there is one; below, how many collisions there have "
              "been. Where particles collapse, that curve turns upwards sharply.",
    "sticky": "The weak solution: step of velocity, rows and delta peak, mass of the cluster (Fig. 1). All particles "
              "that have met are one: the step between the rows is sharp, and the arrow in the density grows with the "
              "mass that has arrived.",
    "spacetime": "Paths of a few particles that stick or pass through each other (Fig. 5), or of the dense core. Time "
                 "runs upwards. Lines that cross have passed through each other, lines that join have stuck; a line is "
                 "the wider the heavier the particle.",
    "zone": "The interaction zone beside the linear model (Fig. 7); of a sweep its width (Fig. 8). Between the heavy "
            "clusters the incoming particles slow down. If the model is right, its lines pass through the points.",
    "clusters": "Positions and velocities of the two heaviest clusters (Figs. 9, 10, 11). The two heavy clusters pass "
                "through each other again and again, or stick; the insets divide out how they grow.",
    "scaling": "How the swings of the two heaviest clusters grow, and masses of all clusters. A straight line is a "
               "power law; the dashed one has the exponent of the theory.",
    "masses": "How many clusters are of a mass or heavier. A straight stretch is a power law of masses; the heaviest "
              "clusters are at its lower right end.",
    "cooling": "Energy on a ring beside the law of the sticky gas; of a sweep all its gases. A flat curve of the ratio "
               "to the sticky gas means that the gas cools as the law of that gas says.",
    "field": "Velocities on a stretch of a ring. Each dot is a particle or cluster. With time few, heavy clusters are "
             "left, in a saw-tooth.",
    "beyond": "Past the collapse: energy beside the sticky gas, the dense core, collisions per time. If the core "
              "behaves like sticky particles, the curves of different cut-offs agree.",
    "rates": "Collisions per time against the cut-off. If the curves of different cut-offs have one slope, the cut-off "
             "decides how often particles collide.",
    "distributions": "Velocities and gaps in the dense core. The dotted line is that of gaps without any order; what "
                     "lies above it is order between neighbours.",
    "particles": "Paths of a few particles, and how their gaps or intervals shrink. Where an axis is logarithmic, "
                 "straight lines are geometric series: each collision shrinks times, speeds and gaps by the same "
                 "factor.",
    "onset": "Part of the replicas of rings that collapse, against the number of particles. The part that collapses "
             "rises from none to all within a narrow range of particle numbers.",
    "bouncing": "A ball on a shaken floor: its height once a period against the strength of the shaking. A branch that "
                "splits is a period that doubles; the dashed line is where the first one does.",
    "column": "A column of beads on a shaken floor: its height against X = N (1 - r). Dashed: nearly elastic beads.",
    "blast": "A blast in a cold gas: its front, and profiles beside the exact solution of Euler's equations. Points on "
             "the lines agree with the exact solution for a continuous gas.",
    "domino": "Dominoes of two masses: when each heavy particle is first hit, against the closed form. Points on the "
              "line agree with the closed form.",
    "splash": "A kicked cold gas on a half-line: front, energy and their exponents. Straight lines are power laws, "
              "with the exponents named.",
    "walls": "A gas between walls: places, shares of the energy, what the walls have given. Whether the particles stay "
             "spread between the walls, or gather at one of them while a few hold the energy.",
    "averages": "Averages over time in bins, with standard errors; a heat current beside the exact one. Bars are "
                "standard errors; curves whose difference is less than a few bars do not differ.",
    "histograms": "What was counted, as densities; closing speeds in equilibrium beside the exact ones. Straight "
                  "stretches are power laws; a dashed line is the exact result in equilibrium.",
    "correlations": "Mean-square displacement and velocity autocorrelation of tagged particles, beside the exact ones. "
                    "Where the displacement turns from a parabola to a straight line, particles have begun to diffuse.",
    "structure_factor": "The structure factor, averaged and at times; 1 at independent places. Above 1, particles are "
                        "clustered at that wavelength; below 1, they are spread more evenly than at random.",
    "pair_distribution": "The pair distribution, averaged and at times; 1 at independent places. Above 1, pairs at "
                         "that distance are more frequent than at random.",
    "ensemble": "Means over replicas with their standard errors and extremes. The dark band, often no wider than the "
                "line, is the standard error of the mean; the light one spans all replicas.",
    "profiles": "Profiles of an ensemble, with standard errors and extremes. The dark band is the standard error of "
                "the mean; the light one spans all replicas.",
    "collapse": "When replicas collapsed. How much the time of the collapse depends on the random start.",
    "scenarios": "Whether two clusters pass or stick, against the loss. Where the curves leave 0 or 1, chance decides "
                 "whether the clusters pass or stick.",
    "regimes": "What the replicas have come to, in shares. One column for each point, one colour for each outcome.",
    "parameters": "What depends on the parameters that were varied. Each panel is one number of the result against "
                  "what was varied; bars are standard errors over replicas.",
    "words": "For which restitutions words of collapse exist, and where they are stable. A thick bar is where the "
             "motion is stable; an open end is not proved.",
    "threshold": "How a threshold was closed in: its distance from the values that were tried. The values tried come "
                 "closer to the threshold from both sides; blue ones have the outcome of the lower end.",
    "trust": "Digits that runs of rising precision share with the last one. A curve that falls shows digits being "
             "lost; up to its vertical line a run has made the right collisions.",
    "certificate": "Of a proof: smallest gap, and how well places and gaps are known. The proof holds while the bound "
                   "on the error of a gap, relative to the gap, stays below 0 in this logarithm.",
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
            return program.call(["theory", path, "--csv"]).stdout
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
        raise Error(f"{opened.path}: nothing to draw (found no two times, points or particles that make a picture): "
                    + ("wait until the run has recorded more" if opened.in_progress else
                       "give a result with a later run.until, or a sweep of more points"), BAD_INPUT)
    return paths


class Pictures(ModuleType):
    """This module: it can be called, and shows nothing but its functions."""

    def __call__(self, result: Result | str | os.PathLike, name: str | None = None, axes=None,
                 theory: bool = True) -> Figure:
        """The main picture of a result, or the one of this name; see the module. Returns the matplotlib figure."""
        found = drawings(result, theory)
        name = str(name or next(iter(found), "main"))
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
