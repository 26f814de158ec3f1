"""A gas between walls: the positions of its particles, their energies, and the energy from the walls (Du, Li and
Kadanoff, Phys. Rev. Lett. 74, 1268, 1995)."""
import numpy as np

from .particles import MARKED, few
from .style import BLUE, GREY, ORANGE

FEW = 12  # snapshots, for quantiles against time to mean something


def pictures(result, _theory, _units):
    if given_by(result.means) and len(result.snapshots) >= FEW and not few(result):
        yield "walls", draw, result


def given_by(series):
    """The names of the columns with the energy that each wall has given."""
    return [name for name in ("wall_left_energy", "wall_right_energy") if name in series]


def draw(result, panels):
    series, snapshots = result.means, result.snapshots
    axes = panels.stacked("position $x$ ($l$)", "share of the energy\nthat one particle has", r"energy ($m\,l^2/t^2$)",
                          x="time ($t$)", height=2.2)
    times = np.array([s["time"] for s in snapshots])
    places = np.array([np.quantile(s["x"], (0.1, 0.5, 0.9)) for s in snapshots])
    energies = [0.5 * s["m"] * s["v"] ** 2 for s in snapshots]
    fastest = np.array([s["x"][e.argmax()] for s, e in zip(snapshots, energies)])
    share = np.array([e.max() / e.sum() if e.sum() > 0 else np.nan for e in energies])
    axes[0].fill_between(times, places[:, 0], places[:, 2], color=BLUE, alpha=0.3, lw=0, label="80 % of the particles")
    axes[0].plot(times, places[:, 1], color=BLUE, lw=1.2, label="median")
    axes[0].plot(times, fastest, "o", color=ORANGE, ms=3 if len(times) <= MARKED else 1.5,
                 label="the particle with most energy")
    low, high = axes[0].get_ylim()
    axes[0].set_ylim(low - 0.2 * (high - low), high)  # room for the legend
    axes[0].legend(loc="lower left", ncol=3, fontsize=7)
    axes[1].plot(times, share, "o-" if len(times) <= MARKED else "-", color=ORANGE, ms=3, lw=0.8)
    axes[1].axhline(1 / len(snapshots[-1]["x"]), color=GREY, lw=0.8, ls="--", label="equal shares")
    axes[1].set_ylim(0, min(1.05, 1.6 * np.nanmax(share)))
    axes[1].legend(fontsize=7)
    positive = series["energy"] > 0
    axes[2].semilogy(series["time"][positive], series["energy"][positive], color=BLUE, lw=0.8, label="energy")
    given = sum(np.asarray(series[name]) for name in given_by(series))
    for sign, line, label in ((1, "-", "given by the walls"), (-1, "--", "taken by the walls")):
        if (there := sign * given > 0).any():
            axes[2].semilogy(series["time"][there], sign * given[there], line, color=ORANGE, lw=1.2, label=label)
    axes[2].legend(fontsize=7)
