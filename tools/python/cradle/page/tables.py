"""Sortable tables of ensembles, sweeps and comparisons of precision."""
from __future__ import annotations

import numpy as np

from ..result import Result
from ..tables import Column, Table
from .elements import count_of, measured, number, rows, sortable, text, unit

MOST_ROWS = 1000  # of replicas: more are shown by their statistics
BESIDE = ("_error", "_replicas")
QUANTILES = (0, 0.05, 0.25, 0.5, 0.75, 0.95, 1)


def tables(result: Result) -> str:
    """The HTML of the tables, empty if there are none."""
    if len(result.trust):
        return precisions(result)
    if len(result.sweep):
        return points(result)
    if len(result.replicas):
        return means(result) + replicas(result)
    return ""


def cell(value) -> tuple[object, str]:
    value = value.item() if isinstance(value, np.generic) else value
    return value, number(value, 6)


def head(name: str, symbols: str) -> str:
    return text(name.replace("_", " ")) + (f" <small>{unit(symbols)}</small>" if unit(symbols) else "")


def means(result: Result) -> str:
    """Every quantity of an ensemble at the end: mean and standard error over the replicas."""
    entries = []
    for name in result.series:
        quantity = result.series[name]
        if (isinstance(quantity, Column) or "mean" not in quantity or quantity["mean"].ndim != 1
                or not np.isfinite(quantity["mean"][-1])):
            continue
        mean, sem, low, high = (quantity[what][-1].item() for what in ("mean", "sem", "min", "max"))
        entries.append((text(name.replace("_", " ")), measured(mean, sem),
                        f"{unit(quantity['mean'].unit)} from {number(low, 6)} to {number(high, 6)}"))
    time = result.series["time"][-1].item() if "time" in result.series else np.nan
    return f"<p>Means at t = {number(time)} with their standard errors, and the extremes.</p>\n" + rows(entries)


def replicas(result: Result) -> str:
    table = result.replicas
    names = [name for name in table.columns if table[name].ndim == 1]
    count = len(table["index"]) if "index" in table else 0
    heads = [head(name, table[name].unit) for name in names]
    if count <= MOST_ROWS:
        outcomes = outcome_texts(table)
        rows = ([(int(value), text(outcomes[int(value)])) if name == "outcome" and int(value) in outcomes else
                 cell(value) for name in names for value in (table[name].values[row],)] for row in range(count))
        return sortable(count_of(count, "replica"), heads, rows)
    names, heads = zip(*((name, head) for name, head in zip(names, heads) if name not in ("index", "outcome")))
    columns = [np.asarray(table[name], float) for name in names]
    columns = [values[np.isfinite(values)] for values in columns]
    rows = ([(share, f"{100 * share:g} %"), *(cell(np.quantile(known, share) if known.size else np.nan)
                                              for known in columns)] for share in QUANTILES)
    return sortable(f"quantiles of {number(count)} replicas (the file has all)", ["quantile", *heads], rows)


def outcome_texts(table: Table) -> dict[int, str]:
    """The texts for the numbers in the column of outcomes: "0 reached the end, 1 inelastic collapse, ..."."""
    said = table["outcome"].description.split(", ") if "outcome" in table else []
    return {int(word): meaning for word, _, meaning in (one.partition(" ") for one in said) if word.isdigit()}


def points(result: Result) -> str:
    """One row per point: the varied values, then means with their standard errors."""
    table = result.sweep
    names = [name for name in table.columns if not name.endswith(BESIDE)]
    labels = [point.label for point in result.points]
    texts = sorted({word.split("=", 1)[0] for label in labels for word in label.split()} - set(names))
    heads = [*map(text, texts), *(head(name, table[name].unit) for name in names)]
    rows = []
    for row, label in enumerate(labels):
        said, point = dict(word.split("=", 1) for word in label.split() if "=" in word), result.points[row]
        rows.append([cell(said.get(name) or setting(point, name)) for name in texts])
        for name in names:
            value = table[name].values[row]
            if "." in name and not np.isfinite(value):  # not set by this point: the scene's
                rows[-1].append(cell(setting(point, name)))
                continue
            error = table[name + "_error"].values[row] if name + "_error" in table else np.nan
            by, shown = cell(value)
            rows[-1].append((by, measured(by, error.item()) if np.isfinite(error) else shown))
    return sortable(f"{count_of(len(labels), 'point')}; means over replicas with their standard errors "
                    "(–: no replica has a value)", heads, rows)


def setting(point: Result, key: str):
    """The value of a key in the scene of a point: a number where it is one, "none" where it does not apply."""
    table, _, name = key.partition(".")
    number_there = point.setting(table, name)
    return number_there if isinstance(number_there, float) else str(point.scene.get(table, {}).get(name, "none"))


def precisions(result: Result) -> str:
    """One row per precision: the time until which it was right, and digits at the end."""
    heads = ["precision", "coordinates", "outcome", "collisions right", "until t", "counts right until t",
             "6 digits until t", "proved until t", "digits of energy at the end", "digits of front at the end"]
    rows = []
    for row, table in enumerate(result.trust):
        about, reference = table.attributes, row == len(result.trust) - 1
        whole = "to the end" if about.get("right_to_end") else ""
        six, proved = (about.get(name, np.nan) for name in ("six_digits_until", "proved_until"))
        digits = [table[name][-1].item() if len(table[name]) else np.nan for name in ("energy_digits", "front_digits")]
        rows.append([(row, text(about["precision"])),
                     *(cell(about[name]) for name in ("coordinates", "outcome", "collisions_right")),
                     (about["collisions_right_until"], whole or number(about["collisions_right_until"], 10)),
                     (about["counts_right_until"], number(about["counts_right_until"], 10)),
                     (six, number(six, 10) if np.isfinite(six) else "–"),
                     (proved, "to the end" if about.get("proved_to_end") else
                      (number(proved, 10) if np.isfinite(proved) else "–")),
                     *((value, "reference" if reference else number(value, 3)) for value in digits)])
    return sortable("the same run at rising precision, each compared with the last", heads, rows)
