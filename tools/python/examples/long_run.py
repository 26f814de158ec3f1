"""A long inelastic run: when does the shock collapse, and what follows?

    python long_run.py [PARTICLES] [UNTIL]

Rows of 400 particles by default, which takes a second; 8000 particles to t = 9000 are the paper's shock past its
collapse (some minutes). You may stop the run with Ctrl-C and start the script again: it continues the run.
"""
import os
import sys

import numpy as np

import cradle

particles = int(sys.argv[1]) if len(sys.argv) > 1 else 400
until = float(sys.argv[2]) if len(sys.argv) > 2 else 1.1 * particles
output = "long.h5"

if os.path.exists(output + ".part"):
    result = cradle.resume(output)
else:
    # A restitution at which N is larger than the critical number N_c of section III.
    result = cradle.run("beyond", output=output, set={
        "initial.particles": particles, "law.restitution": 0.999 if particles >= 8000 else 0.97, "run.until": until,
        "output.snapshots": [0.6 * until, 0.8 * until, until]})

series = result.series
width = series.core_width.values
collapsed = np.flatnonzero(width < 1e-2)
print(f"{int(series.collisions[-1])} collisions, {int(series.collisions_below_cutoff[-1])} of them below the cut-off")
if len(collapsed):
    print(f"half of the mass is in less than l/100 from t = {series.time[int(collapsed[0])]:.6g} on")
for snapshot in result.snapshots:
    print(f"t = {snapshot.time:.6g}: smallest gap {snapshot.gap_min:.3g} l, median {snapshot.gap_median:.3g} l, "
          f"rounding accumulated {snapshot.attributes.get('closure_gap', 0):.1g} l")
print("pictures:", *cradle.plot.save(result, "long.png"))
print("report:", cradle.report(result))
