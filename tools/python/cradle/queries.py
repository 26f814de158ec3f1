"""The program's commands that compute no result: what scenes there are, what one says, costs and predicts, a scene to
start from, two results compared, a result as CSV."""
from __future__ import annotations

import csv
import io
import os
import re
from typing import Any, NamedTuple, Union, overload

import h5py
import numpy as np

from . import program
from .commands import Scene, Settings, scene_file, words_of
from .errors import DIFFERS, DONE, path_of
from .result import Result
from .scene import parse_toml
from .tables import Table

File = Union[str, os.PathLike, Result]


@overload
def scenes() -> dict[str, str]: ...


@overload
def scenes(name: str) -> str: ...


def scenes(name=None):
    """The titles of the bundled scenes by their names; with a name the text of that scene, which run() takes."""
    if name is not None:
        return program.call(["scenes", name]).stdout
    return dict(re.split(r"\s+", line, maxsplit=1) for line in program.call(["scenes"]).stdout.splitlines())


def new(path: str | os.PathLike = "shock.toml", scene: Scene | None = None) -> str:
    """Writes a scene file to start from, with every key that it could use, explained; returns its path.

    scene: whose values it has, as in run(); by default a small shock. Raises Error if the file exists.
    """
    path = path_of(path, "new")
    if scene is None:
        program.call(["new", path])
    else:
        with scene_file(scene) as (source, _):
            program.call(["new", path, "--from", source])
    return path


class Check(dict[str, Any]):
    """Values of a scene by key, defaults included, `{"law.restitution": 0.999, ...}`; printed, the program's text.

    text: the output of `cradle check`, with what the run is expected to cost.
    collisions, seconds, megabytes: the same as numbers; None if not known beforehand.
    """

    def __init__(self, text: str):
        self.text = text
        values, _, cost = text.partition("\n\n")
        super().__init__((key, value_of(value)) for key, _, value in
                         (line.partition(" = ") for line in values.splitlines()))
        self.collisions, self.seconds, self.megabytes = (
            float(found[1]) if (found := re.search(rf"^{name}[^:]*: about ([\d.e+-]+)", cost, re.MULTILINE)) else None
            for name in ("collisions", "time", "memory"))

    def __repr__(self) -> str:
        return self.text.rstrip("\n")


def value_of(text: str) -> Any:
    try:
        return parse_toml(f"value = {text}")["value"]
    except (ValueError, KeyError):  # a bare word, or a long list shown by its ends
        return text


def check(scene: Scene, set: Settings = None, *, seed: int | None = None) -> Check:
    """Validates a scene without running it; returns its effective values and the expected cost. Arguments as in run().

    Raises Error, as run() would, for whatever is wrong with it.
    """
    with scene_file(scene) as (path, _):
        return Check(program.call(["check", path, *words_of(set=set, seed=seed)]).stdout)


def theory(scene: Scene, set: Settings = None, *, seed: int | None = None) -> Table:
    """The predictions for a scene: columns `quantity`, `equation`, `form`, `t` and `value`, shape (rows,) each.

    `t` is NaN for single numbers; `value` is in the scene's m, l and t. `form` is "continuous" (the paper's formula,
    corrected), "discrete" (the exact recursion) or "printed" (with the misprint). No rows: nothing is predicted.
    """
    with scene_file(scene) as (path, name):
        out = program.call(["theory", path, "--csv", *words_of(set=set, seed=seed)]).stdout
    rows = list(csv.DictReader(io.StringIO(out)))
    memory = h5py.File(f"theory of {name}", "w", driver="core", backing_store=False, track_order=True)
    for column in ("quantity", "equation", "form"):
        memory.create_dataset(column, data=[row[column] for row in rows], dtype=h5py.string_dtype())
    for column in ("t", "value"):
        memory[column] = np.array([row[column] or "nan" for row in rows], float)
    memory["t"].attrs["unit"] = "t"
    return Table(memory, memory.filename)


class Difference(NamedTuple):
    """Where two results differ, and how: the first difference there, its size, and how many more there are."""
    place: str
    what: str


class Differences(list[Difference]):
    """A list of Difference, empty and so false if two results are the same. Printed, it is the program's summary."""

    def __init__(self, text: str):
        lines = text.splitlines()
        found = [line[2:].split(": ", 1) for line in lines if line.startswith("  ")]
        super().__init__(Difference(*line) for line in found)
        self.text = "\n".join(line for line in lines if not line.startswith("  "))

    def __repr__(self) -> str:
        return self.text


def diff(first: File, second: File, rtol: float = 0) -> Differences:
    """Compares everything in two results, to the bit.

    rtol: numbers a and b with |a - b| <= rtol max(|a|, |b|) are the same.
    """
    words = ["diff", path_of(first, "diff"), path_of(second, "diff"), "--all", *words_of(rtol=rtol)]
    return Differences(program.call(words, (DONE, DIFFERS)).stdout)


def export(result: File, folder: str | os.PathLike, force: bool = False) -> list[str]:
    """Writes a result as CSV, one file per group with all digits, and its scene; returns their paths.

    force: True replaces what the folder holds, also what was exported from another result.
    """
    words = ["export", path_of(result, "export"), "--to", path_of(folder, "folder"), *words_of(force=force)]
    return program.call(words).stdout.splitlines()
