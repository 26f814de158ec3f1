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
from .errors import BAD_INPUT, COLLAPSE, DONE, LOST, Error, argument, in_python, path_of
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
    return compute("run", ".h5", scene, set, {}, **common)


def ensemble(scene: Scene, replicas: int, set: Settings = None, *, first: int = 0, spread: Sequence[str] = (),
             **common) -> Result:
    """Runs replicas first to first + replicas - 1 and their statistics; continues an existing file of the same scene.

    spread: "NAME=FROM:TO:BINS", quantities of the series whose values are counted in bins. Other arguments as in run().
    Raises Error; if replicas failed (5) its `result` has the others.
    """
    options = {"replicas": replicas, "first": first, "spread": spread}
    return compute("ensemble", "-ensemble.h5", scene, set, options, **common)


def sweep(scene: Scene, vary: Settings = None, set: Settings = None, *, cuts: bool = False,
          points: Sequence[Mapping[str, Any]] = (), replicas: int | None = None, first: int = 0, **common) -> Result:
    """Runs an ensemble at each of many points; `result.points` are the ensembles, `result.sweep` has one row for each.

    vary: values of keys, `{"law.loss": [0.005, 0.01], "initial.speed": "0.5:2:4:log"}`, in all combinations, or, with
        cuts, one at a time. points: single points, `{"law.loss": 0.01, "initial.speed": 1}` each.
        Without both, the scene says what to sweep. Other arguments as in run().
    """
    options = {"vary": vary, "points": points, "cuts": cuts, "replicas": replicas, "first": first}
    return compute("sweep", "-sweep.h5", scene, set, options, **common)


def trust(scene: Scene, set: Settings = None, *, digits: Sequence[int] = (), both: bool = False, **common) -> Result:
    """Runs a scene at rising precision; `result.trust` has a table for each precision, compared with the last.

    digits: the precisions to compare, the reference last; by default they rise until two runs agree. both: also runs
    in positions. Other arguments as in run().
    """
    return compute("trust", "-trust.h5", scene, set, {"digits": digits, "both": both}, **common)


def certify(scene: Scene, set: Settings = None, *, digits: Sequence[int] = (), replicas: int | None = None,
            **common) -> Result:
    """Runs a scene and proves its collisions; `result.certificate.verdict` is "proved" or "undecided" (status 5).

    digits: of the proof, tried in turn. replicas: how many to prove; writes their statistics. Others as in run().
    """
    return compute("certify", "-certified.h5", scene, set, {"digits": digits, "replicas": replicas}, **common)


def threshold(scene: Scene, vary: Settings, set: Settings = None, *, outcome: str | None = None,
              digits: int | None = None, proof: bool = True, **common) -> Result:
    """Finds the value of a key at which the outcome of a run changes; `result.threshold.attributes` has `low_digits`
    and `high_digits`, between which it does, with `low_outcome`, `low_proved`, ...; its rows are the values tried.

    vary: the key and its range, `{"law.restitution": "0.05:0.1"}`. outcome: what is compared. digits: of the value.
    proof: whether the last two outcomes are to be proved. Other arguments as in run().
    """
    options = {"range": vary, "outcome": outcome, "digits": digits, "no-proof": not proof}
    return compute("threshold", "-threshold.h5", scene, set, options, **common)


def resume(path: str | os.PathLike, until: Any = None, *, threads: int | None = None,
           progress: bool | Show | None = None) -> Result:
    """Continues a run, an ensemble or a sweep that was stopped, or, with `until`, extends it; returns its result."""
    path = path_of(path, "resume")
    return called(["resume", path, *words_of(until=until)], path, threads, progress)


# How arguments become options. Others have the value as it is, and none for None and for an empty list.
FLAGS = ("both", "cuts", "force", "no-proof")
REPEATED = {"set": lambda set: ("--set", assignments(set)), "spread": lambda values: ("--spread", values),
            "vary": lambda vary: ("--vary", pairs(vary, ",")), "range": lambda vary: ("--vary", pairs(vary, ":")),
            "points": lambda points: ("--point", [" ".join(pairs(point)) for point in points])}


def words_of(**arguments) -> list[str]:
    """Arguments of a function as words for the program. Raises Error for one of which none can be made."""
    words: list[str] = []
    for name, value in arguments.items():
        with argument(name.replace("range", "vary"), value, "what this argument takes",
                      "give keys and values as a dict, {'run.until': 5} for instance; help() says what else there is"):
            if name in FLAGS:
                words += [f"--{name}"] * bool(value)
            elif name in REPEATED:
                option, values = REPEATED[name]({} if value is None else value)
                words += [word for each in values for word in (option, each)]
            elif (word := bare(() if value is None else value, ",")) or isinstance(value, str):
                words += [f"--{name}", word]
            "".join(words).encode()
    return words


def pairs(table: Mapping[str, Any], between: str = "") -> list[str]:
    return [f"{key}={bare(value, between)}" for key, value in table.items()]


def compute(command, ending, scene, set, options, *, output: str | os.PathLike | None = None, force: bool = False,
            seed: int | None = None, threads: int | None = None, progress: bool | Show | None = None,
            **unknown) -> Result:
    if unknown:
        raise Error(f"{command}: no such argument (found {', '.join(unknown)}): give keys of the scene in set, "
                    f"set={{'law.restitution': 0.9}} for instance; help(cradle.{command}) has the arguments", BAD_INPUT)
    with scene_file(scene) as (path, name):
        output = path_of(output, "output") if output is not None else name + ending
        words = [command, path, "-o", output, *words_of(**options, seed=seed, set=set, force=force)]
        return called(words, output, threads, progress)


def assignments(set: Mapping[str, Any], table: str = "") -> list[str]:
    """The arguments of --set. The keys of a nested table are set one by one; a table under a dotted key replaces it."""
    found = []
    for key, value in set.items():
        if isinstance(value, Mapping) and "." not in key:
            found += assignments(value, f"{table}{key}.")
        else:
            found.append(f"{table}{key}={'' if value is None else bare(value)}")
    return found


def called(words: list[str], output: str, threads: int | None, progress: bool | Show | None) -> Result:
    warned, level = "", 3 if words[0] == "resume" else 4  # of the caller's line

    def warn(messages: str) -> None:  # at once: a run may have no known end
        nonlocal warned
        warned += messages
        warnings.warn(in_python(messages.strip()), RuntimeWarning, stacklevel=level + 2)

    with program.shown(progress) as show:
        done = program.call(words + words_of(threads=threads), (DONE, COLLAPSE, LOST), show, warn)
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
    with argument("scene", scene, "a scene",
                  "give a file, the name of a bundled scene, a text with line breaks, nested dicts or a result"):
        text = scene_text(scene) if isinstance(scene, Mapping) else os.fspath(scene)
        if "\n" not in text:
            return path_of(text, "scene"), "scene"
        text.encode()
        return text, "scene"


def bare(value: Any, between: str = "") -> str:
    """A value as in --set, with texts unquoted; in options the values of a list are separated by `between`."""
    if isinstance(value, str):
        return value
    return between.join(map(bare, value)) if between and isinstance(value, Iterable) else value_text(value)
