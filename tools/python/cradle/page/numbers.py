"""The important numbers of a result, with the digits that are proved or trusted, and warnings."""
from __future__ import annotations

import os
import shlex
from collections.abc import Iterator

import numpy as np

from ..result import Result, fronts
from ..tables import Table
from .elements import code, count_of, enclosed, number, rows, tag, text, valued

END = {"energy": "energy at the end", "front_left": "left front at the end", "front_right": "right front at the end"}
MOST_FAILURES = 5  # of an ensemble that are named
COLLAPSE = {"time": "collapse", "last_collision": "last collision", "gap": "smallest gap", "interval": "last interval",
            "ratio": "ratio of intervals"}
Entries = Iterator[tuple[str, str, str]]  # names, values and notes


def numbers(result: Result) -> str:
    """The HTML of the numbers; for ensembles and sweeps see tables.py."""
    known = list(proved(result))
    measured = (entry for entry in ends(result) if entry[0] not in {label for label, *_ in known})
    entries = [*known, *threshold(result), *sequence(result), *measured, *collapse(result), *snapshots(result),
               *zone(result), *scenario(result)]
    proof = certificate(result) if result.certificate.attributes else ""
    return proof + (rows(entries) if entries else "")


def counted(result: Result) -> str:
    """How well the number of collisions is known: not, unless all of them are proved."""
    return tag("proved" if result.certificate.attributes.get("verdict") == "proved" else "unknown")


def threshold(result: Result) -> Entries:
    """The two values between which the outcome changes."""
    if found := result.threshold.attributes:
        for end in ("low", "high"):
            about = text(f"{found[f'{end}_outcome']}: {found[f'{end}_how']}")
            yield str(found["key"]), text(found[f"{end}_digits"]), about


def sequence(result: Result) -> Entries:
    """How far the collisions follow the word of the scene."""
    found = result.sequence.attributes
    if "word" in found:
        about = "followed to the end" if found["follows"] else f"left at t = {number(found['left_at'])}"
        yield f"periods of {text(found['word'])}", number(found["periods"]), about


def last(table: Table, name: str):
    """The last value of a column of the series, or None."""
    column = table.get(name)
    return column[-1].item() if column is not None and not isinstance(column, Table) and len(column) else None


def errors_may_grow(scene: dict) -> bool:
    """Whether errors may have grown that the estimate of right digits does not know (files.md, energy_digits)."""
    initial, run, walls = scene["initial"], scene["run"], scene.get("walls", {}).values()
    return ("gravity" in scene or any("temperature" in wall or "motion" in wall for wall in walls)
            or scene["law"]["type"] != "inelastic"
            or run.get("collapse") == "merge" or run.get("coordinates") == "absolute"
            or "random_masses" in initial or any(mass != 1 for mass in initial.get("m", initial.get("masses", []))))


def ends(result: Result) -> Entries:
    """The first and the last samples of the series of a run."""
    series = result.series
    if "time" not in series or not len(series["time"]) or isinstance(series["energy"], Table):  # of an ensemble
        return
    time, first, energy = last(series, "time"), series["energy"][0].item(), last(series, "energy")
    yield "time reached", valued(number(time), "t"), ""
    yield "energy at the start", valued(number(first), "m l^2/t^2"), ""
    lost = last(series, "energy_lost")
    alone = not {"walls", "gravity"} & result.scene.keys()  # else energy comes from elsewhere, too
    share = "" if not lost else f" · {valued(number(lost), 'm l^2/t^2')} lost in collisions" if not alone else \
        f" · {100 * lost / (energy + lost):.4g} % lost in collisions"
    digits = result.attributes.get("energy_digits")
    known = tag("estimated" if digits is not None and digits >= 1 else "unknown")
    about = "" if digits is None else " rounding, no digits" if digits < 1 else \
        f" about {count_of(round(digits), 'digit')}, from rounding and the number of collisions" + (
            ", unless errors have grown (cradle trust)" if errors_may_grow(result.scene) else "")
    shown = number(energy, min(12, max(1, int(digits if digits is not None else 12))))
    yield END["energy"], valued(shown, "m l^2/t^2"), f"{known}{about}{share}"
    collisions, slow = last(series, "collisions"), last(series, "collisions_below_cutoff")
    share = f"{100 * slow / collisions:.4g} % of them below the cut-off" if collisions and slow else ""
    yield "collisions", number(collisions or 0), f"{counted(result)} {share}"
    if merges := last(series, "merges"):
        yield "merges", number(merges), counted(result)
    for name in fronts(result):
        value = last(series, name)
        if value is not None and np.isfinite(value):
            yield END[name], valued(number(value), "l"), tag("unknown")
    heaviest = series.get("heaviest")
    if heaviest is not None and np.isfinite(heaviest["mass"][-1]).all():
        mass = " and ".join(number(float(value)) for value in heaviest["mass"][-1])
        yield "two heaviest clusters", valued(mass, "m"), tag("unknown")


def resolved(value: float, error: float) -> int:
    """The significant digits of a double with this error: two digits of the error, 17 at most."""
    if not (np.isfinite(error) and error > 0 and value):
        return 17
    return int(np.clip(np.floor(np.log10(abs(value))) - np.floor(np.log10(error)) + 2, 2, 17))


def collapse(result: Result) -> Entries:
    found = result.collapse
    for name, label in COLLAPSE.items():
        if name in found and np.isfinite(found[name]):
            error = found.get({"time": "uncertainty", "ratio": "ratio_uncertainty"}.get(name, ""), np.nan)
            known = np.isfinite(error)
            digits = resolved(found[name], error) if known else 17 if name == "last_collision" else 6
            within = f" ± {number(error, 2)}" if known else ""
            shown = valued(number(found[name], digits), {"gap": "l", "ratio": ""}.get(name, "t"))
            yield label, shown, tag("estimated" if known else "unknown") + within


def snapshots(result: Result) -> Entries:
    """The smallest gap of all, and the rounding errors accumulated up to the last snapshot."""
    gaps = [(table.attributes["gap_min"], table.attributes["time"]) for table in result.snapshots
            if "gap_min" in table.attributes]
    if not gaps:
        return
    gap, time = min(gaps)
    held = "" if gap else ": two particles in collision"
    yield "smallest gap of the snapshots", valued(number(gap, 6), "l"), f"{tag('unknown')} at t = {number(time)}{held}"
    for name, label, symbol, meaning in (
            ("closure_gap", "closure error of gaps", "l", "by what the sum of all gaps has come to differ from "
                                                          "the distance of the outermost particles, through rounding"),
            ("closure_speed", "closure error of speeds", "l/t", "the same of closing speeds")):
        if name in result.snapshots[-1].attributes:
            yield label, valued(number(result.snapshots[-1].attributes[name], 3), symbol), meaning


def zone(result: Result) -> Entries:
    about = result.table("zone").attributes
    if np.isfinite(about.get("width", np.nan)):
        width = f"{number(about['width'], 6)} ± {number(about['width_error'], 2)}"
        within = f"from t = {number(about['from'])} to {number(about['until'])}, {about['samples']} samples"
        yield "width of the interaction zone", valued(width, "l"), f"{tag('estimated')} {within}"


def scenario(result: Result) -> Entries:
    for name, value in result.table("scenario").attributes.items():
        yield text(name.replace("_", " ")), number(value, 6), tag("unknown")


def certificate(result: Result) -> str:
    about = result.certificate.attributes
    if about.get("verdict") == "proved":
        message = (f"<p class=proved><b>Proved</b>: each of the {count_of(about['collisions'], 'collision')} is that "
                   "of the exact system, the one with the scene's decimals as they are written, and none is missing. ")
    else:
        message = (f"<p class=open><b>Undecided</b> after {count_of(about.get('collisions', 0), 'collision')}: "
                   f"{text(about.get('undecided', ''))}. ")
    return message + f"Run in {text(about['precision'])}, proved with {number(about['digits'])} digits.</p>\n"


def proved(result: Result) -> Entries:
    """Energy and fronts at the end, with the digits that are proved."""
    exact = result.exact.get("series", {})
    for name, label in END.items():
        if name.startswith("front") and name not in fronts(result):
            continue
        if f"{name}_low" in exact and len(exact[f"{name}_low"]):
            low, high = (exact[f"{name}_{side}"] for side in ("low", "high"))
            bounds = str(low[-1]), str(high[-1])
            if not all(np.isfinite(float(bound)) for bound in bounds):
                continue
            shown, right = enclosed(*bounds)
            known = f"{tag('proved')} {count_of(right, 'digit')}"
            yield label, valued(f'<span class="digits">{shown}</span>', low.unit), known


def failures(result: Result, place: str = "") -> Iterator[str]:
    """For an ensemble, or a point at `place` in its file: which replicas failed, why, and how to run one again."""
    failed = result.table("replicas/failed")
    if not len(failed.get("index", ())):
        return
    count, first = len(failed["index"]), int(failed["index"][0])
    messages = str(failed.attributes.get("messages", "")).split("\n")
    more = f" and {number(count - MOST_FAILURES)} more in {code(f'/{place}replicas/failed')}"
    file = os.path.basename(result.path.removesuffix(f": {place.rstrip('/')}"))
    folder = os.path.splitext(file)[0] if os.path.splitext(file)[1] else file + "-scenes"
    command = (f"cradle export {shlex.quote(file)} --to {shlex.quote(folder)} && cradle run "
               f"{shlex.quote(folder)}/{place}scene.toml --set initial.replica={first} -o replica.h5")
    yield ((f"{text(result.label)}: " if place else "") + f"{number(count)} replica{'s' * (count > 1)} failed: "
           + ", ".join(code(message) for message in messages[:MOST_FAILURES]) + more * (count > MOST_FAILURES)
           + f". The first of them again, alone: {code(command)}")


def warnings(result: Result, version: str) -> Iterator[str]:
    """The reasons to doubt numbers of this result, as HTML; version: of the program, "" if unknown."""
    about = result.attributes
    if result.in_progress:
        yield "The run is in progress: this page shows what it had recorded when the page was made."
    if not result.sealed:
        yield "The file has no seal: it was changed since the program wrote it, or written by an older version."
    if "collapse of many particles" in result.outcome and result.kind == "run":
        yield ("The run ended in a collapse of many particles, before <code>run.until</code>; that it is an "
               "inelastic collapse is not proved.")
    elif "inelastic collapse" in result.outcome and result.kind == "run":
        yield "The run ended at inelastic collapse, before <code>run.until</code>."
    elif result.outcome == "a gap below run.stop_gap":
        yield ("The run ended where a gap fell below <code>run.stop_gap</code>, before <code>run.until</code>; "
               "that it is an inelastic collapse is not proved.")
    elif result.outcome in ("order of collisions lost", "resolution exhausted"):
        yield (f"The run ended early: {text(result.outcome)}. More digits (<code>run.precision</code>) reach "
               "further, but not on an inelastic floor: give that a <code>rest_speed</code>.")
    for name, message in (
            ("order_lost", "collisions came too late by more than rounding"),
            ("unresolved_gaps", "collisions beside a gap that positions do not resolve: take "
                                "<code>run.coordinates = \"gaps\"</code>"),
            ("simultaneous_collisions", "collisions at which three particles met within rounding, decided by the tie "
                                        "rule")):
        if about.get(name):
            yield f"{number(about[name])} {message}."
    if "uncertain_from" in about:
        yield (f"Collisions are certain up to t = {number(about['uncertain_from'])} only: from there on rounding "
               "may have decided which one was next. More digits (<code>run.precision</code>) reach further.")
    yield from failures(result)
    for place, point in enumerate(result.points):
        yield from failures(point, f"points/{place:04}/")
    if result.certificate.attributes.get("verdict") == "undecided":
        yield "The proof is undecided: what comes after its place is not proved."
    smallest = min((t.attributes["gap_min"] for t in result.snapshots if "gap_min" in t.attributes), default=1.0)
    if smallest < 0:
        yield "A snapshot has a gap below zero, by less than the rounding of the moment: collisions are in order."
    if version and about.get("cradle_version") and version != about["cradle_version"]:
        yield f"Written by cradle {text(about['cradle_version'])}, this page by {text(version)}."
