"""The exception for all errors, and the meanings of the program's exit statuses."""
from __future__ import annotations

import contextlib
import importlib
import os
import re
import reprlib
import sys
from collections.abc import Iterator
from typing import Any

DONE, DIFFERS, BAD_INPUT, COLLAPSE, BAD_FILE, LOST = 0, 1, 2, 3, 4, 5


class Error(Exception):
    """An error whose message says `what is wrong (what was found): what to do`.

    message: the text, which may come from the program.
    status: the exit status: 2 bad input, 4 a file could not be read or written, 5 resolution or order
        lost or a replica failed, 130 and 143 interrupted.
    result: the incomplete result, or None.
    """

    def __init__(self, message: str, status: int = BAD_INPUT, result=None):
        super().__init__(message)
        self.message, self.status, self.result = message, status, result


def shown(value) -> str:
    """A value of the caller's for a message: some are long, and some cannot say what they are."""
    try:
        return reprlib.repr(value)
    except Exception:
        return f"a value of type {type(value).__name__}"


@contextlib.contextmanager
def argument(name: str, value, wanted: str, advice: str) -> Iterator[None]:
    """Turns exceptions of a block that makes words or numbers of an argument into an Error that names it."""
    try:
        yield
    except (ArithmeticError, AttributeError, RecursionError, TypeError, ValueError):
        raise Error(f"{name}: not {wanted} (found {shown(value)}): {advice}", BAD_INPUT) from None


def path_of(value, what: str) -> str:
    """A path, or that of an opened result, as text. Raises Error for what is none."""
    with argument(what, value, "a path", "give a text or a pathlib.Path"):
        path = os.fspath(getattr(value, "path", value))
        if isinstance(path, bytes) or b"\0" in os.fsencode(path):
            raise ValueError
        return path


def callable_of(function, what: str):
    """Raises Error for what cannot be called."""
    with argument(what, function, "a function", "give one, or anything that can be called"):
        if not callable(function):
            raise TypeError
        return function


def in_python(message: str) -> str:
    """A message of the program with the arguments of functions in place of options; commands in it stay as they are."""
    parts = message.split("`")
    parts[::2] = [re.sub(r"(?<![\w-])--([a-z]+)", r"\1", part.replace("--force", "force=True").replace(
        "-o FILE", "output").replace("--to DIR", "folder")) for part in parts[::2]]
    return "`".join(parts)


def imported(module: str) -> Any:
    """A module that not everybody has. Raises Error without it."""
    try:
        return importlib.import_module(module)
    except ImportError:
        raise missing(module) from None


def missing(module: str) -> Error:
    return Error(f"Python module {module} is missing (in {sys.executable}): install the Debian package "
                 f"python3-{module} for /usr/bin/python3, or {module} with pip", BAD_FILE)
