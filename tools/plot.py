#!/usr/bin/env python3
"""Pictures of a result file: plot.py FILE [-o OUT] [--theory CSV].

What is drawn follows from what the file holds, never from its name:
  shock      velocities, mean-velocity and density profiles at several times (paper, Fig. 2)
  structure  four nested zooms into a core that positions cannot resolve (Fig. 3)
  energy     energy and contacts against time (Fig. 4)
  bodies     paths of a few bodies, and how their gaps or intervals shrink
The first that applies goes to OUT (.png, .pdf or .svg; default FILE with .png), the others to OUT with -structure and
-energy before the extension.
Two rows are drawn in the paper's units, x/l, v/2u0, t 2u0/l, E/(m (2u0)^2) (m = 1); other scenes as they are.
Exit status: 0 done, 2 bad arguments, 4 a file could not be read or written. Same file, same bytes.
"""
import argparse
import csv
import os
import re
import sys
from dataclasses import dataclass, field

BAD_INPUT, BAD_FILE = 2, 4
FEW_BODIES = 20       # up to here every body has a path of its own
CORE_GAP = 1e-2       # of the spacing: a quarter of the gaps below this makes a core
CORE_SHARE = 16       # the innermost zoom holds one body in so many
CORE_BODIES = 60      # but at least these
BIN_BODIES = 25       # bins of mean velocity are merged to hold so many: the two rows alternate, and fewer alias
BLUE, ORANGE, GREEN, RED, GREY = "#0072B2", "#E69F00", "#009E73", "#D55E00", "0.6"  # Okabe and Ito


class PlotError(Exception):
    """`what is wrong (what was found): what to do`, with the exit status it leads to."""

    def __init__(self, message, status):
        super().__init__(message)
        self.status = status


def load_modules():
    """h5py, numpy and matplotlib without a display; a missing one is named with its Debian package."""
    global np, h5py, plt
    try:
        import numpy as np
        import h5py
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
    except ImportError as error:
        name = (error.name or "matplotlib").split(".")[0]
        raise PlotError(f"Python module {name} is missing ({sys.executable}: {error}): "
                        f"install the Debian package python3-{name}", BAD_FILE) from error


# ---- reading ----

def parse_toml(text):
    """The scene as nested dicts; without tomllib (Python < 3.11) only tables of single-line scalars."""
    try:
        import tomllib
        return tomllib.loads(text)
    except ImportError:
        pass
    root, table = {}, None
    table = root
    for line in text.splitlines():
        if header := re.match(r"\s*\[([\w.\- ]+)\]", line):
            table = root
            for key in header[1].split("."):
                table = table.setdefault(key.strip(), {})
        elif entry := re.match(r"\s*([\w\-]+)\s*=\s*(\"[^\"]*\"|[^\s#]+)", line):
            table[entry[1]] = entry[2].strip('"')
    return root


@dataclass
class Result:
    """What a file holds: arrays by dataset name; snapshots and profiles in order of time, each with its `time`."""
    scene: dict
    series: dict = field(default_factory=dict)
    snapshots: list = field(default_factory=list)
    profiles: list = field(default_factory=list)
    events: dict = field(default_factory=dict)
    trust: list = field(default_factory=list)

    def setting(self, table, key, default=None):
        """A number of the scene (numbers may be quoted), or the default."""
        try:
            return float(self.scene.get(table, {}).get(key, default))
        except (TypeError, ValueError):
            return default


def read_result(path):
    """Reads a result file; PlotError where it is none."""
    def arrays(group):  # in an ensemble each quantity is a group: its mean
        both = {name: item if isinstance(item, h5py.Dataset) else item.get("mean") for name, item in group.items()}
        return {name: item[()] for name, item in both.items() if item is not None}

    def timed(root, name):
        groups = [arrays(group) | {"time": float(group.attrs["time"])} for group in root.get(name, {}).values()]
        return sorted(groups, key=lambda group: group["time"])

    try:
        with h5py.File(path, "r", **({"locking": False} if h5py.version.version_tuple >= (3, 5) else {})) as root:
            scene = root.attrs.get("scene", "")
            scene = parse_toml(scene.decode() if isinstance(scene, bytes) else str(scene))
            means = root.get("ensemble", root)
            trust = [arrays(group) | {name: value for name, value in group.attrs.items()}
                     for _, group in sorted(root.get("trust", {}).items())]
            return Result(scene, arrays(means.get("series", {})), timed(root, "snapshots"), timed(means, "profiles"),
                          arrays(root.get("events", {})), trust)
    except (OSError, KeyError, ValueError) as error:
        raise PlotError(f"{path} cannot be read as a result ({error}): give a file written by `cradle run`",
                        BAD_FILE) from error


class Theory:
    """Predictions in long format: quantity, equation, form, t, value; an empty t marks a number."""

    def __init__(self, path=None):
        self.rows = []
        if path is None:
            return
        try:
            with open(path, newline="", encoding="utf-8") as file:
                for row in csv.DictReader(file):
                    self.rows.append((row["quantity"], row["form"], float(row["t"]) if row["t"] else None,
                                      float(row["value"]), row["equation"]))
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            raise PlotError(f"{path} cannot be read ({error}): give the output of `cradle theory --csv`",
                            BAD_FILE) from error
        except (KeyError, TypeError, ValueError) as error:
            raise PlotError(f"{path} is not a table of predictions ({type(error).__name__}: {error}): "
                            "give the output of `cradle theory --csv`", BAD_FILE) from error

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

    def equation(self, *quantities):
        """How the table cites them, as `Eq. (7)` or `Eqs. (4), (5)`; without a number, as it stands."""
        cited = [next((row[4] for row in self.rows if row[0] == quantity), "") or quantity for quantity in quantities]
        numbers = [re.search(r"\d+", text) for text in cited]
        if not all(numbers):
            return ", ".join(dict.fromkeys(cited))
        numbers = list(dict.fromkeys(f"({number[0]})" for number in numbers))
        return ("Eqs. " if len(numbers) > 1 else "Eq. ") + ", ".join(numbers)

    def number(self, quantity):
        points = self._pick(quantity, False)
        return points[0][1] if points else None


@dataclass
class Units:
    """What to divide by, and the axis labels that say so."""
    x: float = 1.0
    v: float = 1.0
    rows: bool = False

    @classmethod
    def of(cls, result):
        spacing, speed = result.setting("initial", "spacing", 1.0), result.setting("initial", "speed", 0.5)
        equal_rows = result.scene.get("initial", {}).get("type") == "rows" and "left" not in result.scene["initial"]
        return cls(spacing, 2 * speed, True) if equal_rows and spacing > 0 and speed > 0 else cls()

    @property
    def t(self):
        return self.x / self.v

    @property
    def energy(self):
        return self.v ** 2

    def label(self, plain, scaled):
        return scaled if self.rows else plain

    def time_label(self):
        return self.label(r"time $t$", r"time $t\,/\,(l/2u_0)$")

    def velocity_label(self):
        return self.label(r"velocity $v$", r"velocity $v\,/\,2u_0$")


# ---- drawing ----

def style():
    plt.rcdefaults()
    plt.rcParams.update({
        "font.family": "DejaVu Sans", "font.size": 9, "axes.labelsize": 9, "legend.fontsize": 7.5,
        "axes.linewidth": 0.7,
        "xtick.direction": "in", "ytick.direction": "in", "xtick.top": True, "ytick.right": True,
        "legend.frameon": True, "legend.framealpha": 0.85, "legend.edgecolor": "none", "lines.linewidth": 1.2,
        "axes.prop_cycle": plt.cycler(color=[BLUE, ORANGE, GREEN, RED, "#CC79A7", "#56B4E9", "k"]), "figure.dpi": 100,
        "savefig.dpi": 200, "svg.hashsalt": "cradle", "pdf.fonttype": 42, "axes.formatter.limits": (-4, 5),
    })


def panel_letter(axes, letter):
    axes.set_title(f"({letter})", loc="left", fontsize=9, fontweight="bold")


def shades(count):
    """Dark to light with time: also readable in grey and by colour-blind eyes; the palest yellow is left out."""
    return plt.get_cmap("viridis")(np.linspace(0.0, 0.88, max(count, 2)))[:count]


def thinned(items, most=7):
    """At most so many, evenly chosen, first and last kept."""
    if len(items) <= most:
        return items
    return [items[i] for i in np.unique(np.linspace(0, len(items) - 1, most).round().astype(int))]


def averaged(snapshot, bins=50):
    """A profile of a snapshot: mass-weighted mean velocity and number density."""
    x, mass = snapshot["x"], snapshot["m"]
    edges = np.linspace(x.min(), x.max(), bins + 1)
    count, weight = np.histogram(x, edges)[0], np.histogram(x, edges, weights=mass)[0]
    momentum = np.histogram(x, edges, weights=mass * snapshot["v"])[0]
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = momentum / weight
    width = np.diff(edges)
    return {"time": snapshot["time"], "x": (edges[1:] + edges[:-1]) / 2, "velocity": mean, "density": count / width,
            "mass_density": weight / width}


def merged(profile):
    """Bin centres and mean velocities, bins merged until half of them hold BIN_BODIES, but not below five bins."""
    x, count = profile["x"], profile["density"] * (profile["x"][1] - profile["x"][0])
    if not (count > 0).any():
        return x[:0], x[:0]
    factor = int(np.clip(np.ceil(BIN_BODIES / np.median(count[count > 0])), 1, max(1, np.count_nonzero(count) // 5)))
    weight = np.nan_to_num(profile.get("mass_density", profile["density"]))
    momentum = weight * np.nan_to_num(profile["velocity"])
    starts = np.arange(0, len(x), factor)
    total, moment = np.add.reduceat(weight, starts), np.add.reduceat(weight * x, starts)
    full = total > 0
    return moment[full] / total[full], np.add.reduceat(momentum, starts)[full] / total[full]


def beside(axes):
    """A legend to the right of the panel; returns it, or None where there is nothing to name."""
    if axes.get_legend_handles_labels()[0]:
        return axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return None


def draw_shock(result, theory, units):
    """Fig. 2: velocities of single bodies, averaged velocities, density of bodies."""
    snapshots = thinned(result.snapshots)
    profiles = result.profiles or [averaged(s) for s in snapshots if len(s["x"]) > 2 and np.ptp(s["x"]) > 0]
    common = [p for p in profiles if p["time"] in {s["time"] for s in snapshots}]
    profiles = thinned(common if len(common) > 1 else profiles)
    times = sorted({group["time"] for group in snapshots + profiles})
    colour = dict(zip(times, shades(len(times))))
    name = {time: rf"$t={time / units.t:.5g}$" for time in times}
    panels = "abc"[:bool(snapshots) + 2 * bool(profiles)]
    figure, axes = plt.subplots(len(panels), 1, sharex=True, figsize=(6.4, 2.5 * len(panels) + 0.5),
                                layout="constrained")
    axes = list(np.atleast_1d(axes))
    for letter, ax in zip(panels, axes):
        panel_letter(ax, letter)
    axes[-1].set_xlabel(units.label(r"position $x$", r"position $x\,/\,l$"))
    named = set()
    if snapshots:
        named = {group["time"] for group in snapshots}
        draw_velocities(axes.pop(0), snapshots, theory, units, colour, name)
    if profiles:
        for group in profiles:
            label = None if group["time"] in named else name[group["time"]]
            x, mean = merged(group)
            if 2 * len(x) <= np.count_nonzero(group["density"]) + 1:
                axes[0].set_title(f"bins with fewer than {BIN_BODIES} bodies merged", loc="right", fontsize=7)
            axes[0].plot(x / units.x, mean / units.v, "-", lw=1.1, marker=".", ms=3, color=colour[group["time"]],
                         label=label)
            axes[1].plot(group["x"] / units.x, group["density"] * units.x, drawstyle="steps-mid", lw=1.1,
                         color=colour[group["time"]])
        draw_slope(axes[0], profiles, theory, units)
        axes[0].set_ylabel(units.label(r"mean velocity $\langle v\rangle$",
                                       r"mean velocity $\langle v\rangle\,/\,2u_0$"))
        axes[1].set_ylabel(units.label("density", r"density $\rho\,/\,\rho_0$"))
        beside(axes[0])
        filled = np.concatenate([p["density"][p["density"] > 0] for p in profiles])
        if len(filled) and filled.max() > 30 * np.median(filled):
            axes[1].set_yscale("log")
            axes[1].set_ylim(bottom=0.5 * filled.min())
        else:
            axes[1].set_ylim(bottom=0)
    return figure


def draw_velocities(ax, snapshots, theory, units, colour, name):
    """Single bodies, and the front's path (x_f, u_f) with its mirror image."""
    for group in snapshots:
        size = np.clip(1.6 * (3000 / len(group["x"])) ** 0.25, 1.6, 3.5)
        ax.plot(group["x"] / units.x, group["v"] / units.v, ".", ms=size, mew=0, color=colour[group["time"]],
                label=name[group["time"]], rasterized=True)
    if units.rows:
        for v in (0.5, -0.5):
            ax.axhline(v, color=GREY, lw=0.8, zorder=0, label="incoming rows" if v > 0 else None)
    time, front = theory.curve("front_position")
    speed_time, speed = theory.curve("front_velocity")
    if len(front) and len(speed):
        speed = np.interp(time, speed_time, speed)
        known = (time <= max(group["time"] for group in snapshots)) & (front >= 0)
        cited = theory.equation("front_velocity", "front_position")
        for sign in (1, -1):
            ax.plot(sign * front[known] / units.x, sign * speed[known] / units.v, "k--", lw=1,
                    label="front, " + cited if sign > 0 else None)
    ax.set_ylabel(units.velocity_label())
    legend = beside(ax)
    for handle in getattr(legend, "legend_handles", None) or legend.legendHandles:
        if handle.get_linestyle() == "None":
            handle.set_markersize(7)


def draw_slope(ax, profiles, theory, units):
    slope = theory.number("mean_velocity_slope")
    if slope is None:
        time, value = theory.curve("mean_velocity_slope")
        slope = np.interp(profiles[0]["time"], time, value) if len(time) else None
    if slope is not None:
        span = max(np.abs(p["x"]).max() for p in profiles)
        ends = np.array([-1, 1]) * min(theory.number("maximal_front") or span, span)
        ax.plot(ends / units.x, ends * slope / units.v, color=GREY, lw=5, alpha=0.55, zorder=0, solid_capstyle="butt",
                label="slope, " + theory.equation("mean_velocity_slope"))


def core_of(result, units):
    """The last snapshot in which a quarter of the gaps are far below the spacing, or None."""
    for snapshot in reversed(result.snapshots):
        gap = snapshot.get("gap", ())
        if len(gap) > 2 * CORE_BODIES and np.quantile(gap, 0.25) < CORE_GAP * units.x:
            return snapshot
    return None


def distances(gap, body):
    """Distance of every body from one of them, summed gap by gap outwards: below any resolution of the positions."""
    right = np.concatenate([[0.0], np.cumsum(gap[body:])])
    left = np.cumsum(gap[:body][::-1])[::-1]
    return np.concatenate([-left, right])


def densest(gap, bodies):
    """The body in the middle of the narrowest run of so many bodies (at least 2), and that run's width.

    Differences of one running sum would lose the small gaps behind the large: each window is the end of one block plus
    the beginning of the next, both summed from small terms only.
    """
    size = bodies - 1
    blocks = np.concatenate([gap, np.zeros(-len(gap) % size)]).reshape(-1, size)
    ends = np.cumsum(blocks[:, ::-1], axis=1)[:, ::-1].ravel()
    starts = np.cumsum(blocks, axis=1).ravel()
    first = np.arange(len(gap) - size + 1)
    width = ends[first] + np.where(first % size == 0, 0.0, starts[first + size - 1])
    best = int(np.argmin(width))
    return best + bodies // 2, float(width[best])


def draw_structure(snapshot, units):
    """Fig. 3: each panel is the rectangle of the one before; all distances are from one body of the core."""
    gap, v = snapshot["gap"], snapshot["v"]
    inmost = max(CORE_BODIES, len(v) // CORE_SHARE)
    body, width = densest(gap, inmost)
    x = distances(gap, body)
    whole, core = 1.05 * max(-x[0], x[-1]), 1.05 * max(width / 2, -x[body - inmost // 2], x[body + (inmost - 1) // 2])
    boxes = []
    steps = np.arange(4) / 3
    # between equal ratios of width and equal ratios of number: a collapsed core would leave middle panels empty
    held = (len(x) * (inmost / len(x)) ** steps).astype(int)
    by_number = np.sort(np.abs(x))[held - 1] * 1.05
    for half in np.sqrt(whole * (core / whole) ** steps * by_number):
        inside = np.abs(x) <= half
        # the first panel shows all; in the others a few fast bodies passing by would hide the rest
        low, high = np.quantile(v[inside], (0.01, 0.99) if boxes else (0, 1))
        pad = 0.12 * (high - low) or 1e-3 * units.v
        boxes.append((half, low - pad, high + pad, inside))
    reference = rf"x_{{{int(snapshot['index'][body])}}}"
    figure, axes = plt.subplots(2, 2, figsize=(7.2, 5.6), layout="constrained")
    dotted = False
    for k, ax in enumerate(axes.flat):
        half, low, high, inside = boxes[k]
        size = np.clip(1.6 * (3000 / inside.sum()) ** 0.25, 1.6, 4)
        ax.plot(x[inside] / units.x, v[inside] / units.v, ".", color=BLUE, ms=size, mew=0, rasterized=True)
        ax.set(xlim=(-half / units.x, half / units.x), ylim=(low / units.v, high / units.v))
        if k < 3:
            inner, bottom, top, _ = boxes[k + 1]
            wide, tall = max(inner, 0.012 * half), max(top - bottom, 0.024 * (high - low))  # never too small to see
            enlarged = wide > inner or tall > top - bottom
            ax.add_patch(plt.Rectangle((-wide / units.x, ((bottom + top - tall) / 2) / units.v), 2 * wide / units.x,
                                       tall / units.v, fill=False, ec=RED, lw=1.2, zorder=3,
                                       ls=":" if enlarged else "-"))
            dotted = dotted or enlarged
        ax.set(xlabel=units.label(rf"$x-{reference}$", rf"$(x-{reference})\,/\,l$"), ylabel=units.velocity_label())
        ax.ticklabel_format(axis="both", style="sci", scilimits=(-2, 3), useMathText=True)
        ax.set_title(rf"$\bf({'abcd'[k]})$  {int(inside.sum())} bodies", fontsize=8, loc="right")
    length = units.label("", r"$\,l$")
    place = snapshot["x"][body] / units.x
    figure.suptitle(rf"$t={snapshot['time'] / units.t:.6g}$,  ${reference}={place:.6g}${length},  "
                    f"smallest gap {gap.min() / units.x:.1e}{length};  rectangle: the next panel"
                    + (" (dotted: drawn larger)" if dotted else ""), fontsize=9)
    return figure


def draw_energy(result, theory, units):
    """Fig. 4: energy, with equation (7) dotted and the sticky gas dashed; below it the number of contacts."""
    series = result.series
    time = series["time"] / units.t
    figure, (top, below) = plt.subplots(2, 1, sharex=True, figsize=(5.6, 5.4), layout="constrained",
                                       gridspec_kw={"height_ratios": (3, 2)})
    energy = series["energy"] / units.energy
    top.plot(time, energy, color=BLUE, lw=1.6, label="simulation")
    for quantity, line, label in (("energy", ":", theory.equation("energy")), ("energy_sticky", "--", "sticky gas")):
        t, value = theory.curve(quantity)
        if quantity == "energy" and len(t):  # the linear profiles are meant for the expanding front
            shown = t <= 1.3 * (theory.number("turnover_time") or np.inf)
            t, value = t[shown], value[shown]
        if len(t):
            top.plot(t / units.t, value / units.energy, "k" + line, lw=1.3, label=label)
    onset = theory.number("collapse_onset_time")
    if onset and onset <= series["time"][-1]:
        for ax in (top, below):
            ax.axvline(onset / units.t, color=GREY, lw=1, zorder=0, label="onset of collapse" if ax is top else None)
    top.set_xlim(time[0], time[-1])
    top.set_ylim(0, 1.05 * energy.max() if energy.max() > 0 else 1)
    top.set_ylabel(units.label(r"kinetic energy $E$", r"energy $E\,/\,m(2u_0)^2$"))
    top.legend(loc="best")
    draw_contacts(below, series, time)
    below.set_xlabel(units.time_label())
    for letter, ax in zip("ab", (top, below)):
        panel_letter(ax, letter)
    return figure


def draw_contacts(ax, series, time):
    for name, line, colour, label in (("contacts", "-", BLUE, "contacts"), ("merges", "-.", GREEN, "merges"),
                                      ("contacts_below_cutoff", "--", ORANGE, "below the cut-off")):
        count = series.get(name)
        if count is not None and count.max() > 0:
            count = count.astype(float)
            ax.plot(time[count > 0], count[count > 0], line, color=colour, label=label)
    counts = series.get("contacts")
    if counts is not None and counts.max() > 1000:
        ax.set_yscale("log")
    ax.set_ylabel("number")
    if ax.get_lines():
        ax.legend(loc="best")


def draw_bodies(result, units):
    """A few bodies: their paths, energy and contacts, and how intervals (from events) or gaps shrink."""
    shrinking = {"interval", "closing_speed"} <= result.events.keys()
    gaps = not shrinking and len(result.snapshots) > 1
    rows = 2 + (shrinking or gaps)
    figure, axes = plt.subplots(rows, 1, figsize=(5.6, 2.4 * rows + 0.3), layout="constrained")
    paths = {}
    for snapshot in result.snapshots:
        for body, x in zip(snapshot["index"], snapshot["x"]):
            paths.setdefault(int(body), []).append((snapshot["time"], x))
    for (body, path), colour in zip(sorted(paths.items()), shades(len(paths))):
        axes[0].plot(*(np.array(path) / (units.t, units.x)).T, "o-", ms=3, color=colour, label=f"body {body}")
    series = result.series
    for name, line in (("front_left", ":"), ("front_right", "--")):
        if name in series:
            axes[0].plot(series["time"] / units.t, series[name] / units.x, line, color="k", lw=0.8, zorder=0,
                         label="outermost" if line == ":" else None)
    axes[0].set(xlabel=units.time_label(), ylabel=units.label(r"position $x$", r"position $x\,/\,l$"))
    if axes[0].get_lines() and len(paths) <= 8:
        axes[0].legend(loc="best", ncol=2)
    if series:
        time = series["time"] / units.t
        axes[1].plot(time, series["energy"] / units.energy, color=BLUE, drawstyle="steps-post")
        axes[1].set(ylabel=units.label(r"energy $E$", r"energy $E\,/\,m(2u_0)^2$"), xlabel=units.time_label())
        axes[1].set_ylim(bottom=0)
        if "contacts" in series:
            other = axes[1].twinx()
            other.plot(time, series["contacts"], color=RED, ls="--", drawstyle="steps-post")
            other.set_ylabel("contacts (dashed)", color=RED)
    if shrinking:
        count = np.arange(1, len(result.events["interval"]) + 1)
        for name, mark, colour in (("interval", "o", BLUE), ("closing_speed", "^", ORANGE)):
            value = result.events[name]
            axes[2].semilogy(count, np.where(value > 0, value, np.nan), mark, ms=3, color=colour,
                             label=name.replace("_", " "))
        axes[2].set(xlabel="contact", ylabel="interval, closing speed")
        axes[2].legend(loc="best")
    elif gaps:
        for pair in range(min(len(s["gap"]) for s in result.snapshots)):
            points = [(s["time"], s["gap"][pair]) for s in result.snapshots if s["gap"][pair] > 0]
            points = np.array(points).reshape(-1, 2)
            axes[2].semilogy(points[:, 0] / units.t, points[:, 1] / units.x, "o-", ms=3, label=f"gap {pair}")
        axes[2].set(xlabel=units.time_label(), ylabel=units.label("gap", r"gap$\,/\,l$"))
        axes[2].legend(loc="best")
    for letter, ax in zip("abc", axes):
        panel_letter(ax, letter)
    return figure


def draw_trust(result):
    """Digits that runs of rising precision share with the last one, against time; and until when their contacts are right."""
    figure, panels = plt.subplots(2, 1, sharex=True, figsize=(6.4, 6.4), constrained_layout=True)
    for ax, name, label in zip(panels, ("energy_digits", "front_digits"), ("digits of the energy", "digits of the front")):
        for run, colour in zip(result.trust[:-1], plt.rcParams["axes.prop_cycle"].by_key()["color"] * 4):
            line = "--" if run["coordinates"] == "absolute" else "-"
            shown = run[name] < 100  # all digits of the comparison: nothing to draw
            ax.plot(run["time"][shown], run[name][shown], line, color=colour,
                    label=f"{run['precision']}, {run['coordinates']}")
            if not run["right_to_end"]:
                ax.axvline(run["contacts_right_until"], color=colour, linestyle=line, linewidth=0.8)
        ax.set_ylabel(label)
        ax.set_ylim(bottom=0)
    panels[0].legend(fontsize="small", title=f"against {result.trust[-1]['precision']}", ncols=2)
    panels[1].set_xlabel("time $t$   (vertical lines: until when the sequence of contacts is right)")
    return figure


# ---- which pictures, and writing them ----

def figures_of(result, theory, units):
    """Pairs of suffix and drawing function, the main picture first."""
    if result.trust:
        return [("trust", lambda: draw_trust(result))]
    pictures = []
    most = max((len(s["x"]) for s in result.snapshots), default=0)
    core = core_of(result, units)
    few = 0 < most <= FEW_BODIES and not theory.curve("front_position")[0].size and not result.profiles
    if few:
        return [("bodies", lambda: draw_bodies(result, units))]
    if result.profiles or len(result.snapshots) > 1 or (result.snapshots and core is None):
        pictures.append(("shock", lambda: draw_shock(result, theory, units)))
    if core is not None:
        pictures.append(("structure", lambda: draw_structure(core, units)))
    if len(result.series.get("time", ())) > 1 and "energy" in result.series:
        pictures.append(("energy", lambda: draw_energy(result, theory, units)))
    return pictures


def save(figure, path):
    """Written beside its place and renamed, so that no half a picture is left; no time stamps."""
    extension = os.path.splitext(path)[1][1:].lower()
    stamps = {"png": {"Software": None}, "pdf": {"CreationDate": None, "ModDate": None}, "svg": {"Date": None}}
    part = f"{path}.part"
    try:
        figure.savefig(part, format=extension, metadata=stamps[extension])
        os.replace(part, path)
    except OSError as error:
        if os.path.exists(part):
            os.remove(part)
        raise PlotError(f"{path} cannot be written ({error.strerror or error}): choose another place with -o",
                        BAD_FILE) from error
    finally:
        plt.close(figure)


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise PlotError(f"bad arguments ({message}): see {self.prog} --help", BAD_INPUT)


def main(arguments=None):
    parser = Parser(prog="plot.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", metavar="FILE", help="result file (HDF5)")
    parser.add_argument("-o", dest="out", metavar="OUT", help="main picture; .png, .pdf or .svg")
    parser.add_argument("--theory", metavar="CSV", help="predictions, as `cradle theory SCENE --csv` writes them")
    try:
        options = parser.parse_args(arguments)
        base, extension = os.path.splitext(options.out or os.path.splitext(options.file)[0] + ".png")
        if extension.lower() not in (".png", ".pdf", ".svg"):
            raise PlotError(f"unknown kind of picture ({extension or 'no extension'}): use .png, .pdf or .svg",
                            BAD_INPUT)
        load_modules()
        style()
        result, theory = read_result(options.file), Theory(options.theory)
        pictures = figures_of(result, theory, Units.of(result))
        if not pictures:
            raise PlotError(f"{options.file} holds nothing to draw (no series, snapshots or profiles): "
                            "give the file of a completed run", BAD_FILE)
        for number, (name, draw) in enumerate(pictures):
            path = f"{base}-{name}{extension}" if number else base + extension
            try:
                figure = draw()
            except (KeyError, IndexError) as error:
                raise PlotError(f"{options.file} lacks data for the {name} picture ({type(error).__name__}: {error}): "
                                "give the file of a completed run", BAD_FILE) from error
            save(figure, path)
            print(path)
        return 0
    except PlotError as error:
        print(f"plot.py: {error}", file=sys.stderr)
        return error.status


if __name__ == "__main__":
    sys.exit(main())
