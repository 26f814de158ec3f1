# %% [markdown]
# # A collapse followed live
#
# A simulation is held in Python: advanced collision by collision or from time to time, read between, and observed.
# First three particles, whose infinitely many collisions end at a finite time; then the core of a shock; last the same
# shock with a restitution that is a function of the closing speed.

# %%
from collections import Counter

import matplotlib.pyplot as plt
import numpy as np

import cradle

# %% [markdown]
# ## Three particles
#
# At a restitution of 0.05 each collision shrinks gaps to 1/8, closing speeds to 2/5, and the time to the next collision
# to 5/16, up to the collapse at t = 12/7. Positions lose this after ten collisions; gaps do not.

# %%
sim = cradle.Simulation("collapse3")
seen = []
sim.on_collision(seen.append)
gaps = []
while not sim.over:
    sim.step()
    gaps.append(sim.gap.max())
interval = np.array([collision.interval for collision in seen])
speed = np.array([collision.closing_speed for collision in seen])
print(f"{sim.outcome} after {sim.collisions} collisions, at t = {sim.decimals('time')}; 12/7 = {12 / 7}")
print(f"ratios late in the collapse: gaps {gaps[-2] / gaps[-3]:.12g}, closing speeds {speed[-1] / speed[-2]:.12g}, "
      f"intervals {interval[-1] / interval[-2]:.12g}")

# %% [markdown]
# ## The core of a shock
#
# 400 particles in two rows meet. While the run advances in steps of time, the smallest gap is read, and, with
# `every`, the mean width of the gaps in the middle. A checkpoint of this moment is saved.

# %%
settings = {"initial.particles": 400, "law.restitution": 0.97, "law.cutoff": 0, "run.until": 440,
            "output.snapshots": [], "output.profiles.times": []}
shock = cradle.Simulation("fig2", set=settings)
core = []
shock.every(2, lambda s: core.append((s.time, np.median(s.gap))))
time, smallest = [], []
while shock.time < 150 or (shock.gap.min() > 1e-12 and shock.time < 400):
    shock.advance(shock.time + 1)
    time.append(shock.time)
    smallest.append(shock.gap.min())
shock.save("core.checkpoint")
shock

# %%
pairs = Counter()
shock.on_collision(lambda collision: pairs.update([collision.left]))
shock.step(20000)
busiest, collisions = pairs.most_common(1)[0]
print(f"t = {shock.time:.6g}: of the next 20000 collisions {collisions} were between particles {busiest} and "
      f"{busiest + 1}; {len(pairs)} pairs collided")

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.5), layout="constrained")
left.semilogy(time, smallest, label="smallest")
left.semilogy(*zip(*core), label="median")
left.set(xlabel="time in t", ylabel="gap in l")
left.legend()
right.bar(list(pairs), list(pairs.values()), width=1)
right.set(xlabel="number of the left particle", ylabel="collisions of 20000")
figure.savefig("live_collapse.png")

# %% [markdown]
# ## A restitution of one's own
#
# Viscoelastic spheres lose less the slower they meet, 1 - eps(w) proportional to w^(1/5). The scene is the same; slow
# collisions are nearly elastic, and the gaps stay wide.

# %%
soft = cradle.Simulation("fig2", set=settings, restitution=lambda w: 1 - 0.03 * w**0.2)
soft.advance(time[-1])
print(f"t = {soft.time:g}: smallest gap {soft.gap.min():.2g} l, with the constant restitution {smallest[-1]:.2g} l; "
      f"energy {soft.energy:.6g} instead of {cradle.Simulation.load('core.checkpoint').energy:.6g} m l^2/t^2")
