"""The compiled part of live simulations."""
from __future__ import annotations

import contextlib
import glob
import importlib.machinery
import importlib.util
import os
import sys
from types import ModuleType

from . import __version__, program
from .errors import BAD_FILE, Error, argument

MODULE = f"{__package__}._live"
MOST_THREADS = 4096


def module() -> ModuleType:
    """The compiled part: beside this package where it is installed, or beside the program in its build folder.

    Raises Error if it is missing or cannot be used.
    """
    if MODULE in sys.modules:
        return sys.modules[MODULE]
    folders = [os.path.dirname(os.path.abspath(__file__))]
    with contextlib.suppress(Error):  # reported by who calls the program
        folders.append(os.path.dirname(os.path.realpath(program.find())))
    importlib.invalidate_caches()  # it may have been built just now
    spec = importlib.machinery.PathFinder.find_spec(MODULE, folders)
    if spec is None:
        others = [os.path.basename(path) for folder in folders for path in glob.glob(os.path.join(folder, "_live*.so"))]
        raise Error(f"the module for live simulations is missing (found {', '.join(others) or 'none'} in "
                    f"{' and '.join(folders)}, for {sys.executable} {sys.version.split()[0]}): install Debian's "
                    "python3-dev and pybind11-dev and build with tools/quickstart.sh, with CRADLE_PYTHON set to this "
                    "Python; cradle.run() does without", BAD_FILE)
    try:
        found = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(found)
    except ImportError as error:
        raise Error(f"{spec.origin}: cannot be loaded ({error}): build it on this machine, for this Python",
                    BAD_FILE) from None
    if found.version != __version__:
        raise Error(f"{spec.origin}: of another version (found {found.version}, here {__version__}): build it again",
                    BAD_FILE)
    sys.modules[MODULE] = found
    return found


def threads_of(threads: int | None) -> int:
    if threads is None:
        return 0
    with argument("threads", threads, "a number of threads",
                  f"give a whole number up to {MOST_THREADS}, 0 or None for all processors"):
        return range(MOST_THREADS + 1).index(threads)
