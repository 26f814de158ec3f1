"""Results: `cradle.open(path)` and what it gives."""
from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property
from typing import Any

import h5py

from . import program
from .errors import BAD_FILE, Error, path_of
from .opening import is_sealed, open_file, stored_in
from .scene import parse_toml
from .tables import Means, Table, Tables, reading


def open(path: str | os.PathLike, check: bool | None = None) -> Result:
    """Opens a result, or the rows so far of a run in progress (FILE.part, which the program reads: `cradle export`).

    check: read the whole file and compare it with its checksum; by default only files of up to
    64 MiB, so that large ones open at once. Columns are read on first use.
    Raises Error (status 4) if the file is missing, empty, incomplete, damaged, or not a result of this program.
    """
    path = path_of(path, "open")
    if stored_in(path) == "result":
        sealed = is_sealed(path, check)
        return Result(path, open_file(path), sealed)
    with tempfile.TemporaryDirectory(prefix="cradle-") as folder:  # it may be removed once the file is open
        rows = os.path.join(folder, "so_far.h5")
        program.call(["export", path, "--result", rows])
        return Result(path, open_file(rows), sealed=True, in_progress=True)


def part(kind, name: str, text: str) -> Any:
    """A property of a result: its group of this name, or that of an ensemble's statistics, as a table of this kind."""
    def read(result: Result):
        return kind(result._group(name, f"ensemble/{name}"), f"{result.path}: {name}")
    read.__doc__ = text
    return cached_property(read)


class Result:
    """A run, an ensemble, a sweep, or one point of a sweep. Use it in `with`, or close() it.

    path: of the file.
    file: the h5py.File; for a point its h5py.Group.
    in_progress: the run had not ended when the file was read.
    sealed: the file has the program's seal, so it is unchanged (see open).
    text, status: the program's output and exit status if run() or a similar function made it; else "" and 0.
    """

    def __init__(self, path: str, root: h5py.Group, sealed: bool = False, in_progress: bool = False, label: str = ""):
        self.path, self.file, self.sealed, self.in_progress, self.label = path, root, sealed, in_progress, label
        self.text, self.status = "", 0

    def close(self, *_) -> None:
        if isinstance(self.file, h5py.File):
            self.file.close()

    def __enter__(self) -> Result:
        return self

    __exit__ = close

    def _group(self, *names: str) -> h5py.Group | None:
        """The first of these groups that exists."""
        found = (reading(self.path, lambda name=name: self.file.get(name)) for name in names)
        return next((group for group in found if isinstance(group, h5py.Group)), None)

    # ---- what was run

    @cached_property
    def attributes(self) -> dict[str, Any]:
        """The attributes of the file: cradle_version, name, precision, outcome, simultaneous_collisions, ..."""
        whole = Table(self.file, self.path).attributes
        return Table(self._group("ensemble"), self.path).attributes | whole

    @property
    def kind(self) -> str:
        """"run", "ensemble", "sweep", "trust", "words", "threshold" or "point"."""
        if self.label:
            return "point"
        return self.attributes.get("kind") or ("trust" if len(self.trust) else "run")

    @property
    def scene_text(self) -> str:
        """The effective scene, as TOML: run() takes it."""
        return str(self.attributes.get("scene", ""))

    @cached_property
    def scene(self) -> dict[str, Any]:
        """The same as nested dicts, `result.scene["law"]["restitution"]`; numbers as floats."""
        return reading(self.path, lambda: parse_toml(self.scene_text))

    def word(self, table: str, key: str) -> str:
        """A value of the scene, "" if it has none."""
        return str(self.scene.get(table, {}).get(key, ""))

    def setting(self, table: str, key: str, default: float | None = None) -> Any:
        """A number of the scene (numbers may be quoted; keys may be dotted), or the default."""
        value = self.scene.get(table, {})
        for part in key.split("."):
            value = value.get(part) if isinstance(value, dict) else None
        try:
            return float(default if value is None else value)
        except (TypeError, ValueError):
            return default

    @property
    def law(self) -> str:
        return self.word("law", "type")

    @property
    def outcome(self) -> str:
        return "in progress" if self.in_progress else str(self.attributes.get("outcome", ""))

    # ---- what came out

    series: Table = part(Table, "series", """Columns of shape (samples,): `time`, `energy`, `collisions`, `front_right`,
        ...; `heaviest` is a table inside. In an ensemble each quantity is a table: `result.series.energy.mean`, `.sem`,
        `.min`, `.max`.""")
    means: Table = part(Means, "series", "The same; of an ensemble the means, as a run has them.")
    snapshots: Tables = part(Tables, "snapshots", """Particles at times: `x`, `v`, `m`, `index` of shape (particles,),
        `gap`, `closing_speed` of shape (particles - 1,).""")
    profiles: Tables = part(Tables, "profiles", """Averages over bins at times: `x`, `velocity`, `density`, ... of shape
        (bins,); of an ensemble tables.""")
    mean_profiles: Tables = part(lambda *group: Tables(*group, Means), "profiles", "The same; of an ensemble means.")
    averages: Table = part(Table, "averages", """Averages over time in bins: `x`, `density`, `temperature`,
        `heat_current`, ... of shape (bins,), with `_sem`; of an ensemble tables.""")
    histograms: Table = part(Table, "histograms", """What a run counted, a table each: `result.histograms.free_flight`
        has `low`, `high` and `count` of shape (bins,); of an ensemble `count` is a table.""")
    correlations: Table = part(Table, "correlations", """Of tagged particles: `lag`, `msd` (mean-square displacement),
        `vacf` (velocity autocorrelation) of shape (lags,), with `_sem`; of an ensemble tables.""")
    structure: Tables = part(Tables, "structure", """The structure factor at times: `k`, `s` of shape (waves,); of an
        ensemble `s` is a table.""")
    structure_average: Table = part(Table, "structure_average", "The same, averaged over times, with `s_sem`.")
    pair_distribution: Tables = part(Tables, "pair_distribution", """The pair distribution at times: `distance`,
        `pair_distribution` of shape (bins,); of an ensemble the latter is a table.""")
    pair_distribution_average: Table = part(Table, "pair_distribution_average",
                                            "The same, averaged over times, with `pair_distribution_sem`.")
    masses: Tables = part(Tables, "masses", "Distributions of cluster masses at times.")
    events: Table = part(Table, "events", """Every collision, shape (collisions,): `left`, `right`, `time` (add
        `time_low`), `interval`, `closing_speed`, `kind`.""")
    sequence: Table = part(Table, "sequence", """The order of the collisions (output.word), one row for each repetition:
        `letters`, `repeats`, `first`, `time`; attributes `word`, `periods`, `kept`, `left_at`.""")
    replicas: Table = part(Table, "replicas", "One row per replica: `index`, `outcome`, `collisions`, `energy`, ...")
    sweep: Table = part(Table, "sweep", """One row per point: the keys that vary, then every number with `_error` and
        `_replicas`.""")
    trust: Tables = part(Tables, "trust", """One table per precision of a comparison: attributes `precision`,
        `collisions_right_until`, ...""")
    threshold: Table = part(Table, "threshold", """One row per value that was tried: `value`, `value_digits`, `outcome`,
        `how`, `collisions`; attributes `key`, `low_digits`, `high_digits`, `low_proved`, ...""")
    certificate: Table = part(Table, "certificate", """Of a proof: attributes `verdict`, `collisions`, `digits`, ...;
        columns `time`, `gap`, `widest`, ...""")
    exact: Table = part(Table, "exact", """Decimal texts: all digits of a run in a type wider than double,
        `result.exact.series.energy.mpmath()`, and what a proof knows, `result.exact.series.energy_low.fractions()`.""")

    @cached_property
    def points(self) -> list[Result]:
        """The points of a sweep, an ensemble each."""
        groups = self._group("points")
        if groups is None:
            return []
        labels = self.sweep.attributes
        return [Result(f"{self.path}: points/{name}", groups[name], self.sealed, False,
                       str(labels.get(f"label_{name}", name))) for name in sorted(groups)]

    @cached_property
    def collapse(self) -> dict[str, Any]:
        """`time`, `uncertainty`, `gap`, ... if the run ended at inelastic collapse; else empty."""
        return self.table("collapse").attributes

    def keys(self) -> list[str]:
        """The names of the groups in the file, those of statistics of an ensemble without `ensemble/`."""
        inner = self._group("ensemble")
        return [name for name in (*reading(self.path, lambda: list(self.file)), *(inner or ())) if name != "ensemble"]

    def __getitem__(self, path: str) -> Any:
        """By path, as in the file: `result["series/energy"]`, `result["snapshots/0001/gap"]`; of an ensemble
        `result["series/energy/mean"]`. Raises KeyError if the file does not have it."""
        name, _, rest = path.partition("/")
        if name not in self.keys() and name != "ensemble":
            raise KeyError(f"{name}: not in {self.path}, which has {', '.join(self.keys())}")
        found = getattr(self, name, None)
        if not isinstance(found, (Table, Tables)):
            found = self.table(name) if name in self.file else self.table(f"ensemble/{name}")
        return found[rest] if rest else found

    def __contains__(self, path: object) -> bool:
        try:
            return isinstance(path, str) and self[path] is not None
        except KeyError:
            return False

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    _ipython_key_completions_ = keys

    def table(self, name: str) -> Table:
        """Any group by its path, `"zone"`, `"scenario"`, `"meetings"`; empty if it does not exist."""
        return Table(self._group(name), f"{self.path}: {name}")

    def enclosure(self, name: str) -> tuple[list, list]:
        """Proved lower and upper bounds of a quantity of the series, as two lists of Fractions.

        name: "energy", "front_left", "front_right", "wall_left_energy", "wall_left_lost" and so on; NaN where there is
            none, as of a front before the first collision. Raises Error if the file has no proof of it.
        """
        exact = self.exact.get("series", {})
        if f"{name}_low" not in exact:
            proved = ", ".join(column[:-4] for column in exact if column.endswith("_low"))
            raise Error(f"{self.path}: no bounds of {name} in its series: " + (
                f"it has those of {proved}; bounds of places and velocities are in exact/snapshots" if proved else
                "`cradle certify` writes such files"), BAD_FILE)
        low, high = ([math.nan if v == "nan" else Fraction(v) for v in exact[f"{name}_{end}"].values.tolist()]
                     for end in ("low", "high"))
        return low, high

    def __repr__(self) -> str:
        parts = [("series", len(self.series)), ("snapshots", len(self.snapshots)), ("profiles", len(self.profiles)),
                 ("events", len(self.events)), ("points", len(self.points)), ("trust", len(self.trust))]
        held = [what if what in ("series", "events") else f"{count} {what}" for what, count in parts if count]
        about = self.attributes
        end = f"{about.get('replicas', 0)} replicas" if self.label else f"{self.outcome}; {about.get('precision', '')}"
        return f"<{self.kind} {self.label or about.get('name', '')}: {end}; {', '.join(held) or 'empty'}>"


def fronts(result: Result) -> list[str]:
    """The fronts that run into something: none towards a wall, so that a gas, which is between two, has none."""
    return [f"front_{side}" for side in ("left", "right") if side not in result.scene.get("walls", {})]
