"""What a result holds, as arrays by name, and the table of predictions. Every picture starts from these."""
import csv
import io
import re
from dataclasses import dataclass, field

import h5py
import numpy as np

from ..errors import BAD_FILE, Error
from ..scene import parse_toml
from ..tables import UNREADABLE


@dataclass
class Contents:
    """A run, an ensemble or a sweep. Lists are in order of time, each of their entries has its `time`.

    statistics: of an ensemble, by name of the series, arrays `mean`, `sem`, `min`, `max`; `series` then has the means.
    points: of a sweep, a Contents each, in the order of the columns of `sweep`.
    """
    scene: dict
    attributes: dict = field(default_factory=dict)
    series: dict = field(default_factory=dict)
    heaviest: dict = field(default_factory=dict)
    snapshots: list = field(default_factory=list)
    profiles: list = field(default_factory=list)
    masses: list = field(default_factory=list)
    zone: dict = field(default_factory=dict)
    force: dict = field(default_factory=dict)
    meetings: dict = field(default_factory=dict)
    events: dict = field(default_factory=dict)
    trust: list = field(default_factory=list)
    certificate: dict = field(default_factory=dict)
    statistics: dict = field(default_factory=dict)
    profile_statistics: list = field(default_factory=list)
    replicas: dict = field(default_factory=dict)
    sweep: dict = field(default_factory=dict)
    points: list = field(default_factory=list)

    def text(self, table, key):
        return str(self.scene.get(table, {}).get(key, ""))

    def setting(self, table, key, default=None):
        """A number of the scene (numbers may be quoted; keys may be dotted), or the default."""
        value = self.scene.get(table, {})
        for part in key.split("."):
            value = value.get(part) if isinstance(value, dict) else None
        try:
            return float(default if value is None else value)
        except (TypeError, ValueError):
            return default

    @property
    def law(self):
        return self.text("law", "type")


def arrays(group):
    """Datasets by name; in an ensemble each quantity is a group: its mean."""
    both = {name: item if isinstance(item, h5py.Dataset) else item.get("mean") for name, item in group.items()}
    return {name: item[()] for name, item in both.items() if item is not None}


def attributes(group):
    return {name: value.decode() if isinstance(value, bytes) else value for name, value in group.attrs.items()}


def statistics(group):
    """Of each quantity of an ensemble its mean, sem, min and max; what is common to all replicas as it stands."""
    return {name: item[()] if isinstance(item, h5py.Dataset) else arrays(item)
            for name, item in group.items() if isinstance(item, h5py.Dataset) or "mean" in item}


def timed(root, name, read=arrays):
    groups = [read(group) | {"time": float(group.attrs["time"])} for group in root.get(name, {}).values()]
    return sorted(groups, key=lambda group: group["time"])


def read_tree(root):
    """A run or an ensemble: the root of a file, or a point of a sweep."""
    ensemble = root.get("ensemble")
    means = root if ensemble is None else ensemble
    about = attributes(means) | attributes(root)
    result = Contents(parse_toml(str(about.get("scene", ""))), about)
    if "series" in means:
        result.series = arrays(means["series"])
        result.heaviest = arrays(means["series"].get("heaviest", {}))
    result.snapshots, result.profiles = timed(root, "snapshots"), timed(means, "profiles")
    result.masses = timed(root, "masses")
    if "zone" in root:
        result.zone = arrays(root["zone"]) | attributes(root["zone"])
    result.force, result.meetings = arrays(root.get("force", {})), arrays(root.get("meetings", {}))
    result.events = arrays(root.get("events", {}))
    if "certificate" in root:
        about = attributes(root["certificate"])
        about["collisions_of_run"] = about.pop("collisions", 0)
        result.certificate = about | arrays(root["certificate"])
    if ensemble is not None:
        result.statistics = statistics(ensemble.get("series", {}))
        result.profile_statistics = timed(ensemble, "profiles", statistics)
        result.replicas = arrays(root.get("replicas", {}))
    return result


def read_result(result):
    """All of an opened result (cradle.open); Error where it cannot be read."""
    try:
        root = result.file
        contents = read_tree(root)
        contents.trust = [arrays(group) | attributes(group) for _, group in sorted(root.get("trust", {}).items())]
        contents.points = [read_tree(group) for _, group in sorted(root.get("points", {}).items())]
        if "sweep" in root:
            contents.sweep, labels = arrays(root["sweep"]), attributes(root["sweep"])
            for number, point in enumerate(contents.points):
                point.attributes.setdefault("label", labels.get(f"label_{number:04}", ""))
        return contents
    except UNREADABLE as error:
        raise Error(f"{result.path} cannot be read as a result ({error}): give a file written by `cradle run`",
                    BAD_FILE) from None


class Theory:
    """Predictions in long format: quantity, equation, form, t, value; an empty t marks a number."""

    def __init__(self, path=None, text=""):
        self.rows = []
        try:
            with open(path, newline="", encoding="utf-8") if path is not None else io.StringIO(text) as file:
                for row in csv.DictReader(file):
                    self.rows.append((row["quantity"], row["form"], float(row["t"]) if row["t"] else None,
                                      float(row["value"]), row["equation"]))
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            raise Error(f"{path} cannot be read ({error}): give the output of `cradle theory --csv`",
                            BAD_FILE) from None
        except (KeyError, TypeError, ValueError) as error:
            raise Error(f"{path} is not a table of predictions ({type(error).__name__}: {error}): "
                            "give the output of `cradle theory --csv`", BAD_FILE) from None

    def _pick(self, quantity, with_time):
        for form in ("continuous", "discrete", ""):  # never the misprinted one
            found = [(t, value) for name, kind, t, value, _ in self.rows
                     if name == quantity and kind == form and (t is not None) == with_time]
            if found:
                return sorted(found) if with_time else found
        return []

    def curve(self, quantity):
        """Times and values, both empty where there is no prediction."""
        points = self._pick(quantity, True)
        return np.array([t for t, _ in points]), np.array([value for _, value in points])

    def number(self, quantity):
        points = self._pick(quantity, False)
        return points[0][1] if points else None

    def equation(self, *quantities):
        """How the table cites them, as `Eq. (7)` or `Eqs. (4), (5)`; without a number, as it stands."""
        cited = [next((row[4] for row in self.rows if row[0] == quantity), "") or quantity for quantity in quantities]
        numbers = [re.search(r"\d+", text) for text in cited]
        if not all(numbers):
            return ", ".join(dict.fromkeys(cited))
        numbers = list(dict.fromkeys(f"({number[0]})" for number in numbers))
        return ("Eqs. " if len(numbers) > 1 else "Eq. ") + ", ".join(numbers)
