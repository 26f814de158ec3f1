#!/usr/bin/env python3
"""Picture of time per collision against the number of particles: plot_engine.py JSON OUT.png, with the JSON of

    bench_engine --benchmark_filter=gas --benchmark_out=JSON --benchmark_out_format=json

One line per engine: a gas of N particles, all of them active; points are medians of repetitions.
"""
import json
import statistics
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

ENGINES = {"cradle_two_threads": ("Cradle, two threads (wall time)", "#D55E00", "o-"),
           "cradle_segments": ("Cradle in segments, one thread", "#0072B2", "o-"),
           "cradle_gaps": ("Cradle, the plain loop", "#56B4E9", "o--"),
           "time_slots": ("gaps and a table of time slots", "#3DA35D", "s-"),
           "tuned_heap": ("positions, tuned heap", "0.35", "^-"),
           "indexed_heap": ("positions, indexed heap", "0.6", "v-")}


def read(path):
    """{engine: {particles: [ns per collision]}}"""
    found = {}
    with open(path, encoding="utf-8") as file:
        for run in json.load(file)["benchmarks"]:
            if run.get("run_type") == "aggregate" or not run["name"].startswith("gas/"):
                continue
            _, particles, engine, *_ = run["name"].split("/")
            found.setdefault(engine, {}).setdefault(int(particles), []).append(1e9 / run["collisions/s"])
    return found


def main(path, out):
    found = read(path)
    figure, axes = plt.subplots(figsize=(7.2, 4.6), layout="constrained")
    for engine, (name, colour, style) in ENGINES.items():
        if engine in found:
            points = sorted((n, statistics.median(times)) for n, times in found[engine].items())
            axes.plot(*zip(*points), style, color=colour, label=name, markersize=5)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("particles $N$")
    axes.set_ylabel("time per collision (ns)")
    axes.grid(True, which="both", color="0.92")
    axes.legend(frameon=False, fontsize=9)
    figure.savefig(out, dpi=150)


if __name__ == "__main__":
    main(*sys.argv[1:])
