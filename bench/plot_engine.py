#!/usr/bin/env python3
"""Picture of time per collision against the number of particles: plot_engine.py ENGINE.json MERGING.json OUT.png, of

    bench_engine --benchmark_filter=gas --benchmark_out=ENGINE.json --benchmark_out_format=json
    bench_merging --benchmark_filter=wet/cooling --benchmark_out=MERGING.json --benchmark_out_format=json

A line for each engine: a dry gas of N particles on a line, and wet particles that cool on a ring; points are medians of
repetitions.
"""
import json
import statistics
import sys

import matplotlib.pyplot as plt

ENGINES = {"cradle_two_threads": ("Cradle, two threads (by the clock)", "#D55E00", "o-"),
           "cradle_segments": ("Cradle", "#0072B2", "o-"),
           "cradle_gaps": ("Cradle, the plain loop", "#56B4E9", "o--"),
           "cradle": ("Cradle, the plain loop", "#56B4E9", "o--"),
           "time_slots": ("gaps and a table of time slots", "#3DA35D", "s-"),
           "tuned_heap": ("positions, tuned heap", "0.35", "^-"),
           "indexed_heap": ("positions, indexed heap", "0.6", "v-"),
           "conventional": ("positions, links, indexed heap", "0.6", "v-"),
           "scan": ("positions, all times compared", "#CC79A7", "x-")}


def read(path):
    """{engine: {particles: [ns per collision]}}"""
    found = {}
    with open(path, encoding="utf-8") as file:
        for run in json.load(file)["benchmarks"]:
            case, _, rest = run["name"].replace("wet/cooling/", "gas/").partition("/")
            if run.get("run_type") == "aggregate" or case != "gas":
                continue
            particles, engine, *_ = rest.split("/")
            found.setdefault(engine, {}).setdefault(int(particles), []).append(1e9 / run["collisions/s"])
    return found


def main(dry, wet, out):
    plt.switch_backend("Agg")
    figure, panels = plt.subplots(1, 2, figsize=(10.5, 5.4), layout="constrained", sharey=True)
    for axes, path, title in zip(panels, (dry, wet), ("dry gas on a line", "wet particles that cool on a ring")):
        found = read(path)
        for engine, (name, colour, style) in ENGINES.items():
            if engine in found:
                points = sorted((n, statistics.median(times)) for n, times in found[engine].items())
                axes.plot(*zip(*points), style, color=colour, label=name, markersize=5)
        axes.set(xscale="log", yscale="log", xlabel="particles $N$", title=title)
        axes.grid(True, which="both", color="0.92")
        axes.legend(frameon=False, fontsize=9, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.14))
    panels[0].set_ylabel("time per collision (ns)")
    figure.savefig(out, dpi=150)


if __name__ == "__main__":
    main(*sys.argv[1:])
