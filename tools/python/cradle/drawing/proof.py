"""The reliability of a run: the digits that runs of rising precision share with the last one, against time; and a
proof in time: the smallest gap, and the radii of positions and gaps."""
import numpy as np

from .style import BLUE, GREEN, ORANGE, note, plt


def pictures(result, _theory, _units):
    if result.trust:
        yield "trust", draw_trust, result


def certificates(result, units):
    if len(result.certificate.get("time", ())) > 1:
        yield "certificate", draw_certificate, result, units


def draw_trust(result, panels):
    shown = [name for name in ("energy", "front")  # there is no front on a ring
             if any(np.isfinite(run[f"{name}_digits"]).any() for run in result.trust)]
    axes = np.atleast_1d(panels(len(shown), 1, sharex=True, figsize=(6.4, 1.2 + 2.6 * len(shown))))
    for ax, name in zip(axes, shown):
        for run, colour in zip(result.trust[:-1], plt.rcParams["axes.prop_cycle"].by_key()["color"] * 4):
            line = "--" if run["coordinates"] == "absolute" else "-"
            label = f"{run['precision']}, {run['coordinates']}"
            ax.plot(run["time"], run[f"{name}_digits"], line, color=colour, label=label)
            if not run["right_to_end"]:
                ax.axvline(run["collisions_right_until"], color=colour, linestyle=line, linewidth=0.8)
        ax.set(ylabel=f"right digits of the {name}", ylim=(0, None))
    axes[0].legend(fontsize="small", title=f"against {result.trust[-1]['precision']}", ncols=2)
    if not all(run["right_to_end"] for run in result.trust[:-1]):
        note(axes[0], "vertical lines: up to there the sequence of collisions is right")
    axes[-1].set_xlabel("time ($t$)")


def draw_certificate(result, units, panels):
    """The smallest gap, the largest radius of a place, and the ratio of a gap's radius to the gap: it stays below 1."""
    proof = result.certificate
    collapsing = len(result.collapse) > 0  # there time says nothing: all collisions are at its end
    time = proof["collisions"].astype(float) if collapsing else proof["time"] / units.t
    top, below = panels(2, 1, sharex=True, figsize=(5.6, 5.4), height_ratios=(3, 2))
    for name, colour, label in (("gap", BLUE, "smallest gap"), ("widest", ORANGE, "largest radius of a place"),
                                ("widest_of_gap", GREEN, "largest radius of a gap, against the gap")):
        known = np.isfinite(proof[name])
        top.plot(time[known], proof[name][known], color=colour, label=label)
    top.axhline(0, color="k", lw=0.8, ls=":")
    top.set_ylabel(r"$\log_{10}$")
    about = proof.attributes
    top.set_title(f"{about['verdict']}: {int(about['collisions']):,} collisions, run in {about['precision']}, "
                  f"proved with {int(about['digits'])} digits", fontsize="medium")
    top.legend(fontsize="small")
    below.plot(time, proof["time"] / units.t if collapsing else proof["collisions"], color=BLUE)
    if not collapsing and proof["collisions"].max() > 1000:
        below.set_yscale("symlog")
    names = ["collisions proved", units.time_label()]
    below.set(xlabel=names[not collapsing], ylabel=names[collapsing])
