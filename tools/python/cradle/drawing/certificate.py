"""A proof in time: how small gaps get, and how well places and gaps are known."""
import numpy as np

from .style import BLUE, GREEN, ORANGE, subplots


def pictures(result, _theory, units):
    if len(result.certificate.get("time", ())) > 1:
        return [("certificate", lambda axes=None: draw_certificate(result, units, axes))]
    return []


def draw_certificate(result, units, axes=None):
    """The smallest gap, the largest radius of a place, and that of a gap against the gap, which must stay below 1."""
    proof = result.certificate
    time = proof["time"] / units.t
    figure, (top, below) = subplots(axes, 2, 1, sharex=True, figsize=(5.6, 5.4), layout="constrained",
                                       gridspec_kw={"height_ratios": (3, 2)})
    for name, colour, label in (("gap", BLUE, "smallest gap"), ("widest", ORANGE, "largest radius of a place"),
                                ("widest_of_gap", GREEN, "largest radius of a gap, against the gap")):
        known = np.isfinite(proof[name])
        top.plot(time[known], proof[name][known], color=colour, label=label)
    top.axhline(0, color="k", lw=0.8, ls=":")
    top.set_ylabel(r"$\log_{10}$")
    about = proof.attributes
    top.set_title(f"{about['verdict']}: {int(about['collisions']):,} collisions, run in {about['precision']}, "
                  f"proved with {int(about['digits'])} digits", fontsize="medium")
    top.legend(loc="best", fontsize="small")
    below.plot(time, proof["collisions"], color=BLUE)
    if proof["collisions"].max() > 1000:
        below.set_yscale("symlog")
    below.set_ylabel("collisions proved")
    below.set_xlabel(units.time_label())
    return figure
