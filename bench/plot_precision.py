#!/usr/bin/env python3
"""Picture of run time against error: plot_precision.py JSON OUT.png, with the JSON of bench_precision.

Panels: (a) three-particle collapse, (b) shock into the collapsed cluster, (c) time reversal, (d) speed on the long
shock. One marker per representation, one colour per type; the line is the Pareto front: no other point is both faster
and more accurate (by half a digit).
Errors run from 1 (no digit is right) to 1e-200 on an axis that is linear in the square root of the digits.
"""
import json
import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D

COLOURS = {"double": "#0072B2", "long double": "#56B4E9", "double-double": "#D55E00", "float128": "#E69F00",
           "mpfr 20": "#B9DEB0", "mpfr 34": "#7CC47F", "mpfr 50": "#3DA35D", "mpfr 100": "#1B7A3D",
           "mpfr 200": "#0B4A22", "cpp_bin_float": "#9467BD"}
NAMES = {"cpp_bin_float": "cpp_bin_float 100"}
BARS = {"double": "double (16 digits)", "tuned_heap": "conventional double, tuned heap",
        "indexed_heap": "conventional double, indexed heap", "long double": "long double (19)",
        "double-double": "double-double (31)", "float128": "float128 (34)"} | NAMES
MARKERS = {"gaps": "o", "absolute": "s"}
DIGIT_TICKS = [0, 1, 5, 10, 16, 31, 50, 75, 100, 150, 200]
# representation, type, offset of the label in points, alignment
MPFR_LABELS = [("gaps", "mpfr 50", -9, -5, "right"), ("gaps", "mpfr 100", -9, -5, "right"),
               ("gaps", "mpfr 200", -9, -4, "right")]
WIDE_LABELS = [("gaps", "double-double", -4, -13, "center"), ("gaps", "float128", 4, 11, "left"), *MPFR_LABELS]


def read(path):
    """{(scene, representation, type): {(quantity, time): value}}"""
    found = {}
    with open(path, encoding="utf-8") as file:
        for run in json.load(file)["benchmarks"]:
            *_, scene, representation, kind = run["name"].partition("/iterations")[0].split("/")
            engine = found.setdefault((scene, representation, kind if kind in BARS else kind.replace("_", " ")), {})
            for key, value in run.items():
                quantity, _, time = key.partition("@")
                engine[quantity, time] = value
    return found


def scatter(axes, points, unit, shown):
    """points: {(representation, type): (cost, right digits)}. Draws them with the Pareto front."""
    front = []
    for cost, digits in sorted(points.values(), key=lambda point: (point[0], -point[1])):
        if not front or digits > front[-1][1] + 0.5:
            front.append((cost, digits))
    axes.plot(*zip(*front), color="0.55", lw=1.2, zorder=1)
    for (representation, kind), point in points.items():
        axes.scatter(*point, marker=MARKERS[representation], color=COLOURS[kind], s=64, zorder=3,
                     edgecolor="black" if representation == "gaps" else "0.35", linewidth=0.8)
    for representation, kind, dx, dy, align in shown:
        axes.annotate(kind if representation == "gaps" else f"{kind}, absolute", points[representation, kind], (dx, dy),
                      ha=align, va="center", textcoords="offset points", fontsize=8.5, color="0.2")
    axes.set_yscale("function", functions=(lambda d: np.sqrt(np.maximum(d, 0)), lambda s: s ** 2))
    axes.set_yticks(DIGIT_TICKS, ["1" if d == 0 else f"$10^{{-{d}}}$" for d in DIGIT_TICKS])
    axes.set(xscale="log", xlabel=unit, ylim=(250, 0))
    axes.grid(color="0.92")
    axes.set_axisbelow(True)


def main(source, target):
    found = read(source)
    plt.switch_backend("Agg")
    plt.rcParams.update({"font.size": 10, "axes.titlesize": 10.5, "figure.dpi": 100})
    figure, ((a, b), (c, d)) = plt.subplots(2, 2, figsize=(12.4, 10.6))

    def points(scene, quantity, time="", cost=lambda values: values["ns_per_collision", ""]):
        return {(representation, kind): (cost(values), min(values[quantity, time], 240))
                for (name, representation, kind), values in found.items()
                if name == scene and (quantity, time) in values}

    scatter(a, points("three", "time_digits", cost=lambda v: v["ns_per_collision", ""] * v["collisions", ""] / 1e3),
            "microseconds for the whole run", [
                ("gaps", "double", 2, -13, "center"), ("absolute", "double", -4, 12, "left"),
                ("gaps", "double-double", -6, -10, "right"), *MPFR_LABELS])
    a.set(title="(a) collapse time of three particles, against 12/7", ylabel="relative error")

    end = max((time for (name, *_), values in found.items() if name == "shock"
               for quantity, time in values if quantity == "gap_digits"), key=float)
    scatter(b, points("shock", "gap_digits", end), "nanoseconds per collision", [
        ("gaps", "double", 2, -13, "center"), ("absolute", "double", 9, 0, "left"), *WIDE_LABELS])
    collisions = found["shock", "gaps", "double"]["collisions", ""]
    b.set_title(f"(b) median gap in the collapsed shock, N = 1000, t = {end},\n"
                f"after {collisions / 1e6:.1f} million collisions")

    scatter(c, points("reversal", "position_digits"), "nanoseconds per collision", [
        ("gaps", "double", 2, -13, "center"), *WIDE_LABELS])
    c.set(title="(c) positions of an elastic gas, there and back", ylabel="error")

    order = ["double", "tuned_heap", "indexed_heap"] + list(COLOURS)[1:]
    labels = []
    for y, kind in enumerate(order):
        labels.append(BARS.get(kind, kind))
        for representation, height in (("gaps", -0.2), ("absolute", 0.2), ("conventional", 0)):
            values = found.get(("speed", representation, kind))
            if not values:
                continue
            rate = 1e3 / values["ns_per_collision", ""]
            plain = representation == "conventional"
            d.barh(y + height, rate, 0.5 if plain else 0.38, color="0.6" if plain else COLOURS[kind],
                   hatch="////" if representation == "absolute" else None, edgecolor="white", lw=0)
            d.annotate(f"{rate:.1f}" if rate >= 1 else f"{rate:.2f}", (rate, y + height), (3, 0),
                       textcoords="offset points", va="center", fontsize=8)
    d.set(xscale="log", xlim=(0.2, 60), xlabel="million collisions per second, one core",
          title="(d) shock of N = 8000 to t = 4000; hatched: absolute positions")
    d.set_xticks([0.3, 1, 3, 10, 30], ["0.3", "1", "3", "10", "30"])
    d.minorticks_off()
    d.set_yticks(range(len(order)), labels)
    d.invert_yaxis()
    d.grid(color="0.92", axis="x")
    d.set_axisbelow(True)

    handles = [Line2D([], [], ls="", marker="o", ms=8, mfc=colour, mec="black", label=NAMES.get(kind, kind))
               for kind, colour in COLOURS.items()]
    handles += [Line2D([], [], ls="", marker="o", ms=8, mfc="white", mec="black", label="gaps"),
                Line2D([], [], ls="", marker="s", ms=8, mfc="white", mec="0.35", label="absolute positions"),
                Line2D([], [], color="0.55", label="Pareto front")]
    figure.legend(handles=handles, loc="lower center", ncol=7, frameon=False)
    figure.tight_layout(rect=(0, 0.06, 1, 1), h_pad=2)
    figure.savefig(target, metadata={"Software": None})


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
