# %% [markdown]
# # Ensemble statistics
#
# How much does the energy of the shock depend on the perturbation of its rows? When this is run again with more
# replicas, only the new ones are computed.

# %%
import matplotlib.pyplot as plt
import numpy as np

import cradle

replicas = 20
print(f"{replicas} replicas of 400 particles; those that replicas.h5 has already are not run again", flush=True)

# %%
result = cradle.ensemble("fig4", replicas, output="replicas.h5", spread=["energy=0:60:60"],
                         set={"initial.particles": 400, "law.restitution": 0.98, "run.until": 300})
energy, time = result.series.energy, result.series.time
last = len(time) - 1
print(f"{replicas} replicas at t = {time[last]:.6g}: energy {energy.mean[last]:.6g} +- {energy.sem[last]:.2g} "
      f"{energy.mean.unit}, from {energy['min'][last]:.6g} to {energy['max'][last]:.6g}")

# %% [markdown]
# The same from the single replicas, each of which can be run alone: `set={"initial.replica": 7}`.

# %%
values = np.asarray(result.replicas.energy)
print(f"from the table of replicas: {values.mean():.6g} +- {values.std(ddof=1) / np.sqrt(len(values)):.2g}")

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.5), layout="constrained")
left.plot(time, energy.mean, label="mean")
left.fill_between(time, energy["min"], energy["max"], alpha=0.3, label="extremes")
left.set(xlabel=f"time in {time.unit}", ylabel=f"energy in {energy.mean.unit}")
left.legend()
right.hist(values, bins=12)
right.set(xlabel=f"energy at the end in {energy.mean.unit}", ylabel="replicas")
figure.savefig("replicas.png")

# %%
print("report:", cradle.report(result))
