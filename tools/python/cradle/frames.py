"""Tables as pandas.DataFrame and xarray.Dataset, both optional. Inner tables are flattened, `energy.mean`."""
from __future__ import annotations

import importlib
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from .errors import missing

if TYPE_CHECKING:
    import pandas
    import xarray

    from .tables import Column, Table


def imported(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError:
        raise missing(name) from None


def flat(table: Table, before: str = "") -> Iterator[tuple[str, Column]]:
    """Names and columns, those of inner tables too."""
    for name, item in table.items():
        if name in table.columns:
            yield before + name, item
        else:
            yield from flat(item, f"{before}{name}.")


def data_frame(table: Table) -> pandas.DataFrame:
    """See Table.to_pandas."""
    module = imported("pandas")
    columns, units = {}, {}
    for name, column in flat(table):
        wide = [(f"{name}[{k}]", side) for k, side in enumerate(column.values.T)] if column.ndim > 1 else []
        for label, values in wide or [(name, column.values)]:
            columns[label], units[label] = module.Series(values), column.unit
    frame = module.DataFrame(columns)
    frame.attrs.update(table.attributes, units=units)
    return frame


def data_set(table: Table) -> xarray.Dataset:
    """See Table.to_xarray."""
    module = imported("xarray")
    columns = dict(flat(table))
    length = max((len(column) for column in columns.values()), default=0)
    along = next((name for name in ("time", "index", "x") if name in columns and columns[name].ndim == 1), "row")
    variables = {}
    for name, column in columns.items():
        # Gaps lie between particles: one fewer.
        first = along if len(column) == length else f"between_{along}"
        dims = (first, "side")[:column.ndim]
        about = {key: value for key, value in (("units", column.unit), ("long_name", column.description)) if value}
        variables[name] = (dims, column.values, about)
    return module.Dataset(variables, attrs=dict(table.attributes))
