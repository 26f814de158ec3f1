"""Live simulations: a run that Python holds, advances, reads between and observes."""
from __future__ import annotations

import decimal
import html
import inspect
import os
import re
import warnings
from collections.abc import Callable
from numbers import Integral
from typing import TYPE_CHECKING, Any, NamedTuple

from .commands import Scene, Settings, source_of, words_of
from .compiled import module, threads_of
from .errors import BAD_INPUT, Error, argument, callable_of, imported, path_of
from .result import Result, open
from .scene import parse_toml, value_text
from .timer import EXACT, Time, Timer, decimal_of

if TYPE_CHECKING:
    import numpy as np

REACHED = "reached the end"
DIGITS = ("time", "energy", "x", "v", "m", "gap", "closing_speed")  # quantities that decimals() has
MOST_COLLISIONS = 2 ** 64 - 1  # in a call of step: as many as a run can count
PART, MOST_EVENTS, EVENT = 2 ** 20, 10 ** 7, 56  # collisions; bytes of one event
MOST_CALLS = 1e9


class Collision(NamedTuple):
    """What functions of on_collision() get: a collision that is about to be made.

    left, right: numbers of the two particles at the start. time: in t. interval: since the collision before it (or the
    start), more precise than a difference of times. closing_speed: in l/t, positive.
    """
    left: int
    right: int
    time: float
    interval: float
    closing_speed: float


def of_run(name: str, convert: Callable[[Any], Any] = lambda value: value) -> Any:
    """A property of a simulation, read from the run that it holds."""
    return property(lambda simulation: convert(getattr(simulation._run, name)))


def documented(simulation: type) -> type:
    """Gives properties their lines of the class's documentation, in which the manual's site finds them."""
    for name, text in re.findall(r"^(\w+): (.+)$", inspect.cleandoc(simulation.__doc__ or ""), re.MULTILINE):
        if isinstance(of_class := vars(simulation).get(name), property):
            of_class.__doc__ = text
    return simulation


@documented
class Simulation:
    """A run of a scene that advances when asked to, with the bits of `cradle run`.

        sim = cradle.Simulation("fig2", set={"initial.particles": 400, "law.restitution": 0.97})
        sim.advance(50)             # to t = 50
        sim.step(1000)              # the next 1000 collisions
        sim.time, sim.collisions, sim.energy, sim.gap.min()
        sim.advance()               # to run.until
        result = sim.write("shock.h5")   # the file that `cradle run` writes, to the byte

    scene, set, seed, threads: as in cradle.run(): a scene file, the name of a bundled scene, nested dicts, a text, or a
        result; keys and values that replace those of the scene.
    restitution: a function of the closing speed (a positive float, in l/t) that returns a number from 0 to 1. It
        replaces law.restitution and law.cutoff of an inelastic scene in double and gaps; such a run has no file.

    Arrays are those of a snapshot: of the n particles that have collided and the next one on each side, from left to
    right (before the first collision those that are about to collide; on a ring all). They are read-only float64 copies
    in units of m (mass of a particle), l (length) and t (time) of the scene; decimals() and mpmath() have all digits
    of wider types. Between calls the state is that at `time`, after all collisions until then.

    time: in t
    until: the end, run.until, in t
    collisions: since the start, all, those below the cut-off and merges included
    merges: since the start
    energy: kinetic, in m l^2/t^2, of all particles of the scene, also those that the front has not reached
    outcome: "in progress", then how the run ended, as in results: "reached the end", "inelastic collapse", ...
    over: whether the run has ended, so that write() has a result
    x: positions in l, shape (n,)
    v: velocities in l/t, shape (n,)
    m: masses in m, shape (n,)
    gap: distances between neighbours in l, exact however small: shape (n - 1,), on a ring (n,)
    closing_speed: velocity of the left minus that of the right neighbour, in l/t: shape (n - 1,), on a ring (n,)
    index: numbers of the particles at the start, from 0, as int64 of shape (n,); of merged ones the first
    name: the scene's name
    precision: the type of the numbers, "double", "mpfr, 50 digits", ...
    scene_text: the effective scene, as TOML
    scene: the effective scene as nested dicts, numbers as floats

    Ctrl-C stops a call at a collision, and so does an exception in a function: it arrives here, and the run can
    continue. A call without functions lets other threads of Python run. One call at a time: others raise Error.
    """

    def __init__(self, scene: Scene, set: Settings = None, *, seed: int | None = None, threads: int | None = None,
                 restitution: Callable[[float], float] | None = None):
        source, name = source_of(scene)
        settings = words_of(set=set)[1::2] + [f"initial.seed={value_text(word)}" for word in words_of(seed=seed)[1:]]
        restitution = None if restitution is None else callable_of(restitution, "restitution")
        self._begin(module().Run(os.fsencode(source), "\n" in source, name, settings, threads_of(threads),
                                 restitution is not None), restitution)

    def _begin(self, run, restitution=None) -> None:
        self._run, self._restitution = run, restitution
        self._observers: list[Callable[[Collision], Any]] = []
        self._timers: list[Timer] = []
        self._computing = self._warned = False
        self._events = bool(self.scene.get("output", {}).get("events"))  # to be warned of

    # ---- advancing

    def advance(self, until: Time | None = None) -> None:
        """Makes all collisions at times <= until (in t, not before `time`), by default up to run.until.

        A float means the decimal that it prints; for more digits give a text or a Decimal. The call ends earlier if
        the run does (see `outcome`). Raises Error for a time in the past or after run.until, and if the run is over.
        """
        self._compute(decimal_of(self._run.until if until is None else until))

    def step(self, n: int = 1) -> None:
        """Makes the next n collisions, or all until run.until if these are fewer; the state is that after the last."""
        with argument("step", n, "a number of collisions", "give a whole number from 0 on"):
            if not isinstance(n, Integral) or n < 0:
                raise ValueError
        self._compute(decimal_of(self._run.until), min(int(n), MOST_COLLISIONS))

    def stop(self) -> None:
        """Ends the run at its last collision, with the outcome "interrupted", so that write() writes what has been
        recorded. Raises Error if it is over."""
        self._run.stop()

    def _compute(self, wanted: decimal.Decimal, n: int | None = None) -> None:
        if self._computing:
            raise Error(f"{self.name}: the simulation is in a call already: let it end first", BAD_INPUT)
        self._computing = True
        try:
            while True:
                to = min((timer.due for timer in self._timers if timer.due < wanted), default=wanted)
                if n is None:
                    self._advance(str(to))
                else:
                    n = self._run.step(n, str(to), self._observer(), self._restitution)
                self._warn_at_end()
                if n == 0 or self.over and self._run.over[0] != REACHED:
                    return
                for timer in [timer for timer in self._timers if timer.due <= to]:
                    timer.call(self)
                if to == wanted:
                    return
        finally:
            self._computing = False

    def _advance(self, to: str) -> None:
        """In parts while a warning of what events take may be due: all of them are kept in memory."""
        while self._events:
            left = self._run.step(PART, to, self._observer(), self._restitution)
            if self.collisions > MOST_EVENTS:
                self._events = False
                size = self.collisions * EVENT / 1e9
                warnings.warn(f"the {self.collisions} events so far take {size:.2g} GB of memory: take output.events "
                              "out of the scene and use on_collision(), or cradle.run(), which writes them to the disk",
                              RuntimeWarning, stacklevel=4)
            if left > 0 or self.over:
                return
        self._run.advance(to, self._observer(), self._restitution)

    def _observer(self) -> Callable[[Collision], Any] | None:
        observers = tuple(self._observers)
        if len(observers) < 2:
            return observers[0] if observers else None
        return lambda collision: [observe(collision) for observe in observers] and None

    def _warn_at_end(self) -> None:
        if self.over and not self._warned:
            self._warned = True
            if text := self._run.over[3].strip():
                warnings.warn(text, RuntimeWarning, stacklevel=4)

    # ---- functions that are called

    def on_collision(self, f: Callable[[Collision], Any]) -> Callable[[Collision], Any]:
        """Calls f(collision) before every collision from now on; returns f, so that it may decorate one.

        f gets a Collision: left, right, time, interval, closing_speed. It cannot read the simulation, which is within a
        call; functions of every() can. If f raises, the collision has not been made.
        """
        self._observers.append(callable_of(f, "on_collision"))
        return f

    def every(self, dt: Time, f: Callable[[Simulation], Any]) -> Callable[[Simulation], Any]:
        """Calls f(simulation) at times spaced by dt (in t), the first one dt from now; returns f.

        The times are `time` + k dt in decimals, without accumulated rounding. Checkpoints do not have such functions.
        """
        step = decimal_of(dt)
        if not step > 0:
            raise Error(f"every: no positive time (found {dt}): give the time between two calls", BAD_INPUT)
        start = decimal_of(self._run.time_text)
        calls = EXACT.subtract(decimal_of(self._run.until), start) / step
        if calls > MOST_CALLS:
            raise Error(f"every: too many calls (found {dt}, which makes {calls:.3g} of them until run.until): give a "
                        f"longer time, {MOST_CALLS:.0g} calls at most", BAD_INPUT)
        self._timers.append(Timer(EXACT.add(start, step), step, callable_of(f, "every")))
        return f

    def remove(self, f: Callable) -> None:
        """Calls f no more. Raises Error if it is not called."""
        known = len(self._observers) + len(self._timers)
        self._observers = [other for other in self._observers if other is not f]
        self._timers = [timer for timer in self._timers if timer.function is not f]
        if known == len(self._observers) + len(self._timers):
            raise Error("remove: not a function of this simulation: give one that on_collision() or every() got",
                        BAD_INPUT)

    # ---- the state

    time: float = of_run("time")
    until: float = of_run("until", float)
    collisions: int = of_run("collisions")
    merges: int = of_run("merges")
    energy: float = of_run("energy")
    outcome: str = of_run("over", lambda over: over[0] if over else "in progress")
    over: bool = of_run("over", bool)
    x: np.ndarray = of_run("x")
    v: np.ndarray = of_run("v")
    m: np.ndarray = of_run("m")
    gap: np.ndarray = of_run("gap")
    closing_speed: np.ndarray = of_run("closing_speed")
    index: np.ndarray = of_run("index")
    name: str = of_run("name")
    precision: str = of_run("precision")
    scene_text: str = of_run("scene")
    scene: dict[str, Any] = of_run("scene", parse_toml)

    def decimals(self, name: str) -> str | list[str]:
        """A quantity of the state with all digits of the run's type, as decimal texts.

        name: "time" or "energy": one text; "x", "v", "m", "gap" or "closing_speed": a list.
        """
        if name not in DIGITS:
            raise Error(f"decimals: no such quantity (found {name}): give {', '.join(DIGITS)}", BAD_INPUT)
        return getattr(self._run, f"{name}_text")

    def mpmath(self, name: str, digits: int | None = None):
        """What decimals() gives as mpmath.mpf, one or a list; digits: by default those of the longest text."""
        mpmath = imported("mpmath")
        texts = self.decimals(name)
        one = isinstance(texts, str)
        with mpmath.workdps(digits or max(map(len, [texts] if one else texts), default=17)):
            return mpmath.mpf(texts) if one else [mpmath.mpf(text) for text in texts]

    # ---- files

    def write(self, output: str | os.PathLike | None = None, *, force: bool = False) -> Result:
        """Writes the result of a run that is over and opens it: the bytes of `cradle run`.

        output: by default the scene's name with .h5 in the working folder. force: replaces what output holds, also what
            the same run would not make again. Raises Error before the end, which is run.until, a collapse or stop().
        """
        output = self.name + ".h5" if output is None else path_of(output, "write")
        self._run.write(os.fsencode(output), words_of(force=force) != [])
        result = open(output)
        _, result.status, report, warning = self._run.over
        result.text = report + warning
        return result

    def save(self, path: str | os.PathLike, *, force: bool = False) -> None:
        """Saves a checkpoint, from which load() continues with the same bits. It replaces a checkpoint, and with force
        whatever else is there, a result for instance. Raises Error if the run is over."""
        self._run.save(os.fsencode(path_of(path, "save")), words_of(force=force) != [])

    @classmethod
    def load(cls, path: str | os.PathLike, *, threads: int | None = None) -> Simulation:
        """A simulation at the place where save() was called; the file stays. Raises Error."""
        loaded = cls.__new__(cls)
        loaded._begin(module().Run(os.fsencode(path_of(path, "load")), threads_of(threads)))
        return loaded

    def __reduce_ex__(self, protocol):  # for copy.copy() and copy.deepcopy() too
        raise Error(f"{self.name}: a simulation cannot be copied or pickled (found one at t = {self.time:g}): save it "
                    "with save(), and load() the file as often as you need it", BAD_INPUT)

    # ---- shown

    def __repr__(self) -> str:
        return (f"<simulation {self.name}: t = {self.time:.6g} of {self.until:.6g}, {self.collisions} collisions, "
                f"energy {self.energy:.6g}; {self.precision}; {self.outcome}>")

    def _repr_html_(self) -> str:
        rows = {"time": f"{self.time:.6g} of {self.until:.6g} t", "collisions": f"{self.collisions:,}",
                "energy": f"{self.energy:.6g} m l<sup>2</sup>/t<sup>2</sup>", "particles": f"{len(self.index):,}",
                "type": html.escape(self.precision), "outcome": html.escape(self.outcome)}
        cells = "".join(f"<tr><th style='text-align:left'>{name}</th><td style='text-align:left'>{value}</td></tr>"
                        for name, value in rows.items())
        return f"<table><caption>simulation {html.escape(self.name)}</caption>{cells}</table>"
