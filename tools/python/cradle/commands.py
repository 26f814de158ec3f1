"""The program's commands as functions. Each calls the program, shows its progress and returns the opened result."""
from __future__ import annotations

import contextlib
import os
import re
import tempfile
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Union

from . import program
from .errors import BAD_INPUT, COLLAPSE, DONE, LOST, Error, in_python, path_of
from .program import Show
from .result import Result, open
from .scene import scene_text, value_text

Scene = Union[str, os.PathLike, Mapping[str, Any], Result]
Settings = Union[Mapping[str, Any], None]


def run(scene: Scene, set: Settings = None, **common) -> Result:
    """Runs a scene and returns the result, also if it ended at inelastic collapse (`result.status` is then 3).

    scene: a scene file, the name of a bundled scene, nested dicts as result.scene has them, or the text of a scene
        (with line breaks), as result.scene_text. In the last two initial.file is relative to the working folder.
    set: keys and values that replace those of the scene, `{"law.restitution": 0.9, "run.until": 500}`; the same as
        nested dicts, `{"law": {"restitution": 0.9}}`, which leave the other keys of a table; None unsets a key.
    Common to all commands, as keywords:
    output: the result file; by default the scene's name with .h5 in the working folder, as in the program.
    force: True replaces what output holds, also what this call would not make again.
    seed: replaces the scene's.
    threads: how many at most; by default all processors. It never changes a result.
    progress: True, False, or a function of the finished share and a line of text; by default on terminals and in
        notebooks.
    Raises Error with the program's message and status; if collisions were lost (5) its `result` is the incomplete one.
    What the program says on the way is a RuntimeWarning: until when collisions are certain, what acts on nothing.
    """
    return compute("run", ".h5", scene, set, [], **common)


def ensemble(scene: Scene, replicas: int, set: Settings = None, *, first: int = 0, spread: Sequence[str] = (),
             **common) -> Result:
    """Runs replicas first to first + replicas - 1 and their statistics; continues an existing file of the same scene.

    spread: "NAME=FROM:TO:BINS", quantities of the series whose values are counted in bins. Other arguments as in run().
    Raises Error; if replicas failed (5) its `result` has the others.
    """
    options = ["--replicas", replicas, "--first", first, *repeated("--spread", spread)]
    return compute("ensemble", "-ensemble.h5", scene, set, options, **common)


def sweep(scene: Scene, vary: Settings = None, set: Settings = None, *, cuts: bool = False,
          points: Sequence[Mapping[str, Any]] = (), replicas: int | None = None, first: int = 0, **common) -> Result:
    """Runs an ensemble at each of many points; `result.points` are the ensembles, `result.sweep` has one row for each.

    vary: values of keys, `{"law.loss": [0.005, 0.01], "initial.speed": "0.5:2:4:log"}`, in all combinations, or, with
        cuts, one at a time. points: single points, `{"law.loss": 0.01, "initial.speed": 1}` each.
        Without both, the scene says what to sweep. Other arguments as in run().
    """
    options = repeated("--vary", (f"{key}={bare(values, ',')}" for key, values in (vary or {}).items()))
    options += repeated("--point", (" ".join(f"{key}={bare(value)}" for key, value in point.items())
                                    for point in points))
    options += ["--cuts"] * cuts + option("--replicas", replicas) + ["--first", first]
    return compute("sweep", "-sweep.h5", scene, set, options, **common)


def trust(scene: Scene, set: Settings = None, *, digits: Sequence[int] = (), both: bool = False, **common) -> Result:
    """Runs a scene at rising precision; `result.trust` has a table for each precision, compared with the last.

    digits: the precisions to compare, the reference last; by default they rise until two runs agree. both: also runs
    in positions. Other arguments as in run().
    """
    options = option("--digits", ",".join(map(str, digits)) or None) + ["--both"] * both
    return compute("trust", "-trust.h5", scene, set, options, **common)


def certify(scene: Scene, set: Settings = None, *, digits: Sequence[int] = (), replicas: int | None = None,
            **common) -> Result:
    """Runs a scene and proves its collisions; `result.certificate.verdict` is "proved" or "undecided" (status 5).

    digits: of the proof, tried in turn. replicas: how many to prove; writes their statistics. Others as in run().
    """
    options = option("--digits", ",".join(map(str, digits)) or None) + option("--replicas", replicas)
    return compute("certify", "-certified.h5", scene, set, options, **common)


def threshold(scene: Scene, vary: Settings, set: Settings = None, *, outcome: str | None = None,
              digits: int | None = None, proof: bool = True, **common) -> Result:
    """Finds the value of a key at which the outcome of a run changes; `result.threshold.attributes` has `low_digits`
    and `high_digits`, between which it does, with `low_outcome`, `low_proved`, ...; its rows are the values tried.

    vary: the key and its range, `{"law.restitution": "0.05:0.1"}`. outcome: what is compared. digits: of the value.
    proof: whether the last two outcomes are to be proved. Other arguments as in run().
    """
    (key, values), = vary.items()
    options = ["--vary", f"{key}={bare(values, ':')}", *option("--outcome", outcome), *option("--digits", digits)]
    return compute("threshold", "-threshold.h5", scene, set, options + ["--no-proof"] * (not proof), **common)


def resume(path: str | os.PathLike, until: Any = None, *, threads: int | None = None,
           progress: bool | Show | None = None) -> Result:
    """Continues a run, an ensemble or a sweep that was stopped, or, with `until`, extends it; returns its result."""
    path = path_of(path, "resume")
    return called(["resume", path, *option("--until", until)], path, threads, progress)


def option(name: str, value: Any) -> list[str]:
    return [] if value is None else [name, str(value)]


def repeated(name: str, values: Iterable[str]) -> list[str]:
    return [word for value in values for word in (name, value)]


def compute(command, ending, scene, set, options, *, output: str | os.PathLike | None = None, force: bool = False,
            seed: int | None = None, threads: int | None = None, progress: bool | Show | None = None,
            **unknown) -> Result:
    if unknown:
        raise Error(f"{command}: no such argument (found {', '.join(unknown)}): give keys of the scene in set, "
                    f"set={{'law.restitution': 0.9}} for instance; help(cradle.{command}) has the arguments", BAD_INPUT)
    with scene_file(scene) as (path, name):
        output = path_of(output, "output") if output is not None else name + ending
        words = [command, path, *map(str, options), "-o", output, *option("--seed", seed), *settings(set)]
        return called(words + ["--force"] * force, output, threads, progress)


def assignments(set: Settings, table: str = "") -> list[str]:
    """The arguments of --set. The keys of a nested table are set one by one; a table under a dotted key replaces it."""
    found = []
    if not isinstance(set, Mapping) and set is not None:
        raise Error(f"set: not keys and values (found {set!r}): give a dict, {{'run.until': 5}} for instance",
                    BAD_INPUT)
    for key, value in (set or {}).items():
        if isinstance(value, Mapping) and "." not in key:
            found += assignments(value, f"{table}{key}.")
        else:
            found.append(f"{table}{key}={'' if value is None else bare(value)}")
    return found


def settings(set: Settings) -> list[str]:
    return repeated("--set", assignments(set))


def called(words: list[str], output: str, threads: int | None, progress: bool | Show | None) -> Result:
    warned, level = "", 3 if words[0] == "resume" else 4  # of the caller's line

    def warn(messages: str) -> None:  # at once: a run may have no known end
        nonlocal warned
        warned += messages
        warnings.warn(in_python(messages.strip()), RuntimeWarning, stacklevel=level + 2)

    with program.shown(progress) as show:
        done = program.call(words + option("--threads", threads), (DONE, COLLAPSE, LOST), show, warn)
    said = in_python(done.stderr.strip().removeprefix("cradle: ") or done.stdout.strip())
    try:
        result = open(output)
    except Error:
        if done.returncode == LOST:  # and nothing was written
            raise Error(said, LOST) from None
        raise
    result.text, result.status = done.stdout + done.stderr, done.returncode
    if done.returncode == LOST and words[0] != "certify":
        raise Error(said, LOST, result)
    if later := done.stderr.removeprefix(warned).strip():
        warnings.warn(in_python(later), RuntimeWarning, stacklevel=level)
    return result


@contextlib.contextmanager
def scene_file(scene) -> Iterator[tuple[str, str]]:
    """What to give the program as SCENE, and the name for its results."""
    scene, name = source_of(scene)
    if "\n" not in scene:
        yield scene, os.path.splitext(os.path.basename(scene))[0]
        return
    with tempfile.TemporaryDirectory(prefix="cradle-") as folder:
        path = Path(folder, name + ".toml")
        # There is no scene file to which initial.file could be relative: it is relative to the working folder.
        path.write_text(re.sub(r"""(\bfile *= *)(["'])(.+?)\2""",
                               lambda found: found[1] + value_text(os.path.abspath(found[3])), scene), "utf-8")
        yield str(path), name


def source_of(scene) -> tuple[str, str]:
    """A scene's file, its name if bundled, or its text, which has line breaks; and what to call it. Raises Error."""
    if isinstance(scene, Result):
        return scene.scene_text, str(scene.attributes.get("name", "scene"))
    if isinstance(scene, (str, os.PathLike)):
        return path_of(scene, "scene"), "scene"
    if isinstance(scene, Mapping):
        return scene_text(scene), "scene"
    raise Error(f"not a scene (found {scene!r}): give a file, the name of a bundled scene, a text with line breaks, "
                "nested dicts or a result", BAD_INPUT)


def bare(value: Any, between: str = "") -> str:
    """A value as in --set, with texts unquoted; for --vary the values of a list are separated by commas (`between`)."""
    if isinstance(value, str):
        return value
    return between.join(map(bare, value)) if between else value_text(value)
