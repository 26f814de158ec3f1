"""Pictures of a result file: plot FILE [-o OUT] [--theory CSV].

What is drawn follows from what the file holds, never from its name:
  beyond     past the collapse: energy beside the sticky gas, the dense core, contacts per time; of a sweep all points,
             and rates: contacts against the cut-off; of a run distributions of velocities and gaps, and spacetime where
             there are twenty snapshots
  sticky     the weak solution: step of velocity, rows and delta peak, mass of the cluster (paper, Fig. 1)
  shock      velocities, mean-velocity and density profiles at several times (Figs. 2 and 6)
  structure  four nested zooms into a core that positions cannot resolve (Fig. 3)
  energy     energy and contacts against time (Fig. 4)
  spacetime  paths of a few bodies that stick or pass through each other (Fig. 5)
  zone       the interaction zone beside the linear model (Fig. 7)
  clusters   positions and velocities of the two heaviest clusters (Figs. 9, 10, 11)
  scaling    how their oscillations grow, and masses of all clusters
  cooling    energy on a ring, beside the law of the sticky gas; field: velocities on a stretch of it; masses
  scenarios  whether two clusters pass or stick; when shocks collapse: replicas of a sweep
  sweep      what depends on the parameter that was varied (Fig. 8)
  ensemble   means with their standard errors and extremes
  certificate  of a proof: smallest gap, and how well places and gaps are known
  walls      a gas between walls: places, shares of the energy, what the walls have given (Du, Li and Kadanoff)
  bodies     paths of a few bodies, and how their gaps or intervals shrink
The first that applies goes to OUT (.png, .pdf or .svg; default FILE with .png), the others to OUT with -structure,
-energy and so on before the extension.
Two equal rows are drawn in the paper's units, x/l, v/2u0, t 2u0/l, E/(m (2u0)^2) (m = 1); other scenes as they are.
Exit status: 0 done, 2 bad arguments, 4 a file could not be read or written. Same file, same bytes.
"""
import argparse
import os
import sys

BAD_INPUT, BAD_FILE = 2, 4


class Parser(argparse.ArgumentParser):
    def error(self, message):
        complain(f"bad arguments ({message}): see {self.prog} --help")
        sys.exit(BAD_INPUT)


def complain(message):
    print(f"plot: {message}", file=sys.stderr)


def main():
    parser = Parser(prog="plot", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", metavar="FILE", help="result file (HDF5)")
    parser.add_argument("-o", dest="out", metavar="OUT", help="main picture; .png, .pdf or .svg")
    parser.add_argument("--theory", metavar="CSV", help="predictions, as `cradle theory SCENE --csv` writes them")
    options = parser.parse_args()
    base, extension = os.path.splitext(options.out or os.path.splitext(options.file)[0] + ".png")
    if extension.lower() not in (".png", ".pdf", ".svg"):
        complain(f"unknown kind of picture ({extension or 'no extension'}): use .png, .pdf or .svg")
        return BAD_INPUT
    try:
        import pictures
    except ImportError as error:
        return missing(error)
    try:
        for path in pictures.make(options.file, base, extension, options.theory):
            print(path)
    except pictures.PlotError as error:
        complain(error)
        return error.status
    return 0


def missing(error):
    """A module that is not there is named with its Debian package."""
    name = (error.name or "matplotlib").split(".")[0]
    complain(f"Python module {name} is missing ({sys.executable}: {error}): install the Debian package python3-{name}")
    return BAD_FILE


if __name__ == "__main__":
    sys.exit(main())
