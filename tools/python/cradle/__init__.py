"""Results of Cradle, event-driven granular gases in one dimension, in Python; also calls the program.

    import cradle
    shock = cradle.run("fig2", set={"run.until": 2000})     # or cradle.open("fig2.h5")
    shock.series.energy                                      # float64 in m l^2/t^2, read when it is used
    shock.snapshots.at(2000).gap                             # between neighbours, exact however small
    cradle.plot(shock)                                       # a matplotlib figure; cradle.plot.energy(shock) another
    cradle.report(shock)                                     # one HTML page

Errors are cradle.Error with `message` and `status`. h5py and numpy are required, and matplotlib for pictures and
reports; all are imported on first use.
"""
from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from .errors import Error, missing

if TYPE_CHECKING:
    from .commands import certify, ensemble, resume, run, sweep, threshold, trust
    from .page.page import report
    from .plot import Pictures
    from .queries import check, diff, export, new, scenes, theory
    from .result import Result, open
    from .simulation import Collision, Simulation
    from .tables import Column, Table, Tables

    plot: Pictures

__version__ = "0.1.0"  # the program's

_WHERE = {name: module for module, names in {
    "commands": ("certify", "ensemble", "resume", "run", "sweep", "threshold", "trust"),
    "page.page": ("report",), "plot": ("plot",), "queries": ("check", "diff", "export", "new", "scenes", "theory"),
    "result": ("Result", "open"), "simulation": ("Collision", "Simulation"),
    "tables": ("Column", "Table", "Tables")}.items() for name in names}
__all__ = ["Error", *(name for name in _WHERE if name != "open")]  # `from cradle import *` keeps Python's open


def __getattr__(name: str):
    if name not in _WHERE:
        raise AttributeError(f"module cradle has no {name}: it has {', '.join(__dir__())}")
    try:
        module = importlib.import_module(f".{_WHERE[name]}", __name__)
    except ModuleNotFoundError as error:
        if error.name not in ("h5py", "numpy"):
            raise
        raise missing(error.name) from None
    found = module if name == "plot" else getattr(module, name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return ["Error", *_WHERE]
