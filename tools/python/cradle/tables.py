"""Groups and datasets of a result as tables and columns with names, units and descriptions, read on first use."""
from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np

from .errors import BAD_FILE, BAD_INPUT, Error, argument, imported

if TYPE_CHECKING:
    import pandas
    import xarray

UNREADABLE = (OSError, KeyError, ValueError, RuntimeError, TypeError)  # of h5py, on files that are damaged or closed


def reading(place: str, read):
    """Runs read(); turns exceptions of h5py into an Error that names the place."""
    try:
        return read()
    except UNREADABLE as error:
        raise Error(f"{place}: cannot be read ({str(error).strip() or type(error).__name__}): the file has been closed "
                    "or is damaged, open it again or run its scene again", BAD_FILE) from None


def text_of(value: Any) -> Any:
    """Attributes as Python types: texts, whole numbers, floats."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    return value.item() if isinstance(value, np.generic) else value


class Column(np.lib.mixins.NDArrayOperatorsMixin):
    """A dataset: an array of float64 or uint64, or of texts, with a name, a unit and a description.

    It is read on first use: `column[:10]` reads ten rows; arithmetic and numpy read all of it, once. Results of
    arithmetic are plain arrays, since their units are not the column's. Raises Error if it cannot be read.
    """

    def __init__(self, dataset: h5py.Dataset, place: str):
        self._dataset, self._place = dataset, place
        self.name: str = dataset.name.rsplit("/", 1)[-1]
        self.shape: tuple[int, ...] = dataset.shape
        self.dtype: np.dtype = dataset.dtype

    @cached_property
    def attributes(self) -> dict[str, Any]:
        return reading(self._place, lambda: {name: text_of(value) for name, value in self._dataset.attrs.items()})

    @property
    def unit(self) -> str:
        """In m (mass of a particle), l (length) and t (time) of the scene; "1" for pure numbers."""
        return self.attributes.get("unit", "")

    @property
    def description(self) -> str:
        return self.attributes.get("description", "")

    @property
    def is_text(self) -> bool:
        return self.dtype.kind in "SO"

    def _texts(self, values: Any) -> Any:
        if not self.is_text:
            return values
        return np.array([text_of(value) for value in np.ravel(values)], dtype=str).reshape(np.shape(values))

    @cached_property
    def values(self) -> np.ndarray:
        """All values, as a read-only array."""
        values = reading(self._place, lambda: self._texts(self._dataset[()]))
        values.flags.writeable = False
        return values

    def __getitem__(self, index):
        rows = isinstance(index, slice) and (index.step or 1) > 0
        if "values" in self.__dict__ or not (rows or isinstance(index, (int, np.integer))):
            return self.values[index]
        wanted = index if rows else range(self.shape[0])[index]  # IndexError as lists have it
        return reading(self._place, lambda: self._texts(self._dataset[wanted])[()])

    def __array__(self, dtype=None, copy=None):
        return np.array(self.values, dtype=dtype) if dtype is not None or copy else self.values

    def __array_ufunc__(self, ufunc, method, *inputs, **options):
        plain = [item.values if isinstance(item, Column) else item for item in inputs]
        return getattr(ufunc, method)(*plain, **options)

    def __getattr__(self, name: str):
        if name.startswith("_") or not hasattr(np.ndarray, name):
            raise AttributeError(f"{name}: neither of a column nor of an array")
        return getattr(self.values, name)  # max(), mean(), sum(): what arrays can do

    def __len__(self) -> int:
        return self.shape[0] if self.shape else 1

    def __iter__(self) -> Iterator:
        return iter(self.values)

    def fractions(self) -> list:
        """Every number exactly: the decimal of a text, the stored binary number of a float64.

        Columns of width two give a list for each row. NaN raises ValueError, as in Python.
        """
        return [[Fraction(v) for v in row] if np.ndim(row) else Fraction(row) for row in self.values.tolist()]

    def mpmath(self, digits: int | None = None) -> list:
        """The same as mpmath.mpf with the given digits, by default those of the longest text (17 for float64).

        They are rounded here; mpmath rounds sums and products to mpmath.mp.dps, which is not changed.
        """
        mpmath = imported("mpmath")
        lengths = map(len, self.values.ravel().tolist()) if self.is_text else ()
        with mpmath.workdps(digits or max(lengths, default=17)):
            return [[mpmath.mpf(v) for v in row] if np.ndim(row) else mpmath.mpf(row) for row in self.values.tolist()]

    def __repr__(self) -> str:
        unit = "" if self.unit in ("", "1") else f" in {self.unit}"
        size = " x ".join(map(str, self.shape))
        return f"{self.name}: {size} {'texts' if self.is_text else self.dtype}{unit}; {self.description}"


class Table(Mapping):
    """A group: columns, inner tables and attributes by name, `table["energy"]` or `table.energy`; inner ones also by
    path, `table["energy/mean"]`.

    Iterates over the names of columns and tables; `table.columns` has only those of the columns.
    """

    def __init__(self, group: h5py.Group | None, place: str):
        self._group, self._place = group, place
        self._seen: dict[str, Column | Table] = {}

    @cached_property
    def attributes(self) -> dict[str, Any]:
        if self._group is None:
            return {}
        return reading(self._place, lambda: {name: text_of(value) for name, value in self._group.attrs.items()})

    @cached_property
    def _names(self) -> tuple[str, ...]:
        return () if self._group is None else reading(self._place, lambda: tuple(self._group))

    @property
    def columns(self) -> list[str]:
        return [name for name in self._names if isinstance(self[name], Column)]

    def __getitem__(self, name: str) -> Any:
        name, _, rest = name.partition("/")
        if rest:
            return self[name][rest]
        if name not in self._names:
            if name in self.attributes:
                return self.attributes[name]
            raise KeyError(f"{name}: not in {self._place}, which has "
                           f"{', '.join((*self._names, *self.attributes)) or 'nothing'}")
        if name not in self._seen:
            item, place = reading(self._place, lambda: self._group[name]), f"{self._place}/{name}"
            self._seen[name] = Column(item, place) if isinstance(item, h5py.Dataset) else type(self)(item, place)
        return self._seen[name]

    def __getattr__(self, name: str):
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __dir__(self):
        return [*super().__dir__(), *self._names, *self.attributes]

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)

    def _flat(self, before: str = "") -> Iterator[tuple[str, Column]]:
        """Names and columns, those of inner tables too."""
        for name, item in self.items():
            if isinstance(item, Column):
                yield before + name, item
            else:
                yield from item._flat(f"{before}{name}.")

    def to_pandas(self) -> pandas.DataFrame:
        """A pandas.DataFrame of all columns, those of inner tables as `energy.mean`, of columns of width two `x[0]`,
        `x[1]`; shorter ones (gaps) end with NaN. `frame.attrs["units"]` has the units by column."""
        pandas = imported("pandas")
        columns, units = {}, {}
        for name, column in self._flat():
            wide = [(f"{name}[{k}]", side) for k, side in enumerate(column.values.T)] if column.ndim > 1 else []
            for label, values in wide or [(name, column.values)]:
                columns[label], units[label] = pandas.Series(values), column.unit
        frame = pandas.DataFrame(columns)
        frame.attrs.update(self.attributes, units=units)
        return frame

    def to_xarray(self) -> xarray.Dataset:
        """An xarray.Dataset of all columns, those of inner tables as `energy.mean`, over `time`, `index`, `x` or the
        row's number, with units as attributes."""
        xarray = imported("xarray")
        columns = dict(self._flat())
        length = max((len(column) for column in columns.values()), default=0)
        along = next((name for name in ("time", "index", "x") if name in columns and columns[name].ndim == 1), "row")
        variables = {}
        for name, column in columns.items():
            # Gaps lie between particles: one fewer.
            dims = (along if len(column) == length else f"between_{along}", "side")[:column.ndim]
            about = {key: value for key, value in (("units", column.unit), ("long_name", column.description)) if value}
            variables[name] = (dims, column.values, about)
        return xarray.Dataset(variables, attrs=dict(self.attributes))

    def __repr__(self) -> str:
        lines = [f"{self._place}:"]
        lines += [f"  {name} = {value}" for name, value in self.attributes.items()]
        for name in self._names:
            item = self[name]
            lines.append(f"  {item!r}" if isinstance(item, Column) else f"  {name}: table of {', '.join(item)}")
        return "\n".join(lines)


class Means(Table):
    """A table of an ensemble with the means of its quantities as columns, like the table of a run."""

    def __getitem__(self, name: str) -> Any:
        item = super().__getitem__(name)
        return item["mean"] if isinstance(item, Table) and "mean" in item else item


class Tables(Sequence):
    """Tables in order; snapshots, profiles and masses in order of time: `tables[0]`, `tables.times`, `tables.at(t)`."""

    def __init__(self, group: h5py.Group | None, place: str, kind: type[Table] = Table):
        names = () if group is None else reading(place, lambda: sorted(group, key=lambda name: (len(name), name)))
        self._place = place
        self._tables = {name: kind(reading(place, lambda name=name: group[name]), f"{place}/{name}") for name in names}

    @cached_property
    def times(self) -> np.ndarray:
        """Shape (len(tables),), in t."""
        return np.array([table.attributes.get("time", np.nan) for table in self], float)

    def at(self, time: float, method: str | None = None) -> Table:
        """The table of this time, to the 12th digit; with method="nearest" that of the nearest time.

        Raises Error, with the nearest time, if there is none.
        """
        if method not in (None, "nearest"):
            raise Error(f"not a method (found {method!r}): give \"nearest\", or none for exact times", BAD_INPUT)
        if not len(self):
            raise Error(f"{self._place} is empty: the scene does not request it "
                        "(see output.* of `cradle scenes --keys`)", BAD_INPUT)
        with argument("at", time, "a time", "give a number"):
            time = float(time)
            nearest = int(np.nanargmin(np.abs(self.times - time)))
        found = float(self.times[nearest])
        if method is None and abs(found - time) > 1e-12 * max(abs(found), abs(time)):
            raise Error(f"{self._place}: none at t = {time:g} (the nearest is at t = {found:.15g}): give one of its "
                        "times, or method=\"nearest\"", BAD_INPUT)
        return self[nearest]

    def to_pandas(self) -> pandas.DataFrame:
        """A pandas.DataFrame of all tables, one below the other, with the column `time` first."""
        pandas = imported("pandas")
        frames = [table.to_pandas() for table in self]
        for frame, time in zip(frames, self.times):
            if "time" not in frame:
                frame.insert(0, "time", time)
        return pandas.concat(frames, ignore_index=True) if frames else pandas.DataFrame()

    def __getitem__(self, index):
        """By number, slice or, `tables["0001/gap"]`, path."""
        if isinstance(index, str):
            name, _, rest = index.partition("/")
            if name not in self._tables:
                raise KeyError(f"{name}: not in {self._place}, which has {', '.join(self._tables) or 'nothing'}")
            return self._tables[name][rest] if rest else self._tables[name]
        return list(self._tables.values())[index]

    def __len__(self) -> int:
        return len(self._tables)

    def __repr__(self) -> str:
        shown = ", ".join(f"{time:.6g}" for time in self.times[:8]) + (", ..." if len(self) > 8 else "")
        return f"{self._place}: {len(self)} at times {shown}" if len(self) else f"{self._place}: none"
