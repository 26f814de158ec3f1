"""Which pictures a result gets, and their files. Every kind is a module with pictures(result, theory, units): pairs of
a name and a function that draws it, none where the result does not hold what the picture shows."""
import contextlib
import os

import beyond
import bodies
import certificate
import clusters
import cooling
import energy
import ensemble
import scenarios
import shock
import spacetime
import sticky
import structure
import sweep
import trust
import walls
import zone
from reading import BAD_FILE, PlotError, Theory, read_result
from style import Units, plt, style

ALONE = (trust, scenarios, sweep, ensemble, walls, spacetime, bodies)  # the first that has something to show is all there is
TOGETHER = (beyond, sticky, cooling, zone, clusters, shock, structure, energy)


def pictures_of(result, theory, units):
    """The main picture first; a proof comes last."""
    proof = certificate.pictures(result, theory, units)
    for kind in ALONE:
        if found := kind.pictures(result, theory, units):
            return found + proof
    return [picture for kind in TOGETHER for picture in kind.pictures(result, theory, units)] + proof


def make(file, base, extension, theory_file):
    """Writes all pictures and yields the name of each; raises PlotError."""
    style()
    result, theory = read_result(file), Theory(theory_file)
    with lacking(file):
        pictures = pictures_of(result, theory, Units.of(result))
    if not pictures:
        raise PlotError(f"{file} holds nothing to draw (no series, snapshots or profiles): "
                        "give the file of a completed run", BAD_FILE)
    for number, (name, draw) in enumerate(pictures):
        path = f"{base}-{name}{extension}" if number else base + extension
        with lacking(file, f" for the {name} picture"):
            figure = draw()
        save(figure, path)
        yield path


@contextlib.contextmanager
def lacking(file, purpose=""):
    """What pictures stumble over where a group or dataset is not there, as the message."""
    try:
        yield
    except (KeyError, IndexError, ValueError) as error:
        raise PlotError(f"{file} lacks data{purpose} ({type(error).__name__}: {error}): "
                        "give the file of a completed run", BAD_FILE) from error


def save(figure, path):
    """Written beside its place and renamed, so that no half a picture is left; no time stamps."""
    extension = os.path.splitext(path)[1][1:].lower()
    stamps = {"png": {"Software": None}, "pdf": {"CreationDate": None, "ModDate": None}, "svg": {"Date": None}}
    part = f"{path}.part"
    try:
        figure.savefig(part, format=extension, metadata=stamps[extension])
        os.replace(part, path)
    except OSError as error:
        if os.path.exists(part):
            os.remove(part)
        raise PlotError(f"{path} cannot be written ({error.strerror or error}): choose another place with -o",
                        BAD_FILE) from error
    finally:
        plt.close(figure)
