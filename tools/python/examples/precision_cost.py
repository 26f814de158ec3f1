# %% [markdown]
# # Precision against cost
#
# How many digits of the energy does each number type give, and what does it take? The reference is the proved bounds
# of the energy (`cradle.certify`), as exact fractions; times are of this machine.

# %%
import time
from fractions import Fraction
from math import log10

import cradle

particles = 60
scene = {"initial.particles": particles, "law.restitution": 0.9, "law.cutoff": 0, "run.until": 0.5 * particles,
         "output.snapshots": [], "output.profiles.times": [], "output.series.points": 20}

# %%
proof = cradle.certify("fig2", set=scene, output="proof.h5", digits=[50, 100, 200])
low, high = (bounds[-1] for bounds in proof.enclosure("energy"))
print(f"{proof.certificate.verdict}: energy at the end {float((low + high) / 2):.17g} +- {float(high - low) / 2:.1g}, "
      f"{proof.certificate.attributes['collisions']} collisions")

# %% [markdown]
# Results hold float64; `cradle trust` compares more than 16 digits. Positions lose the order of collisions, and say so.

# %%
print(f"{'type':>15} {'positions':>10} {'seconds':>8} {'digits right':>12}")
for precision, coordinates in (("double", "gaps"), ("double", "absolute"), ("long double", "gaps"),
                               ("double-double", "gaps")):
    started = time.perf_counter()
    try:
        run = cradle.run("fig2", output="run.h5", force=True, progress=False,
                         set=scene | {"run.precision": precision, "run.coordinates": coordinates})
    except cradle.Error as error:
        print(f"{precision:>15} {coordinates:>10} {'':>8} {error.message.splitlines()[0]}")
        continue
    seconds = time.perf_counter() - started
    energy = Fraction(float(run.series.energy[-1]))
    wrong = max(abs(energy - low), abs(energy - high)) / high
    digits = min(16.0, -log10(wrong)) if wrong else 16.0
    print(f"{precision:>15} {coordinates:>10} {seconds:8.3f} {digits:12.1f}")
    run.close()

# %%
print("report:", cradle.report(proof))
