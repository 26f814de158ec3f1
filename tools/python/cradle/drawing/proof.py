"""What is proved or compared at several precisions: the restitutions at which words of collapse exist and are stable;
how a threshold was closed in; the digits that runs of rising precision share with the last one; a proof in time."""
import numpy as np

from .style import BLUE, GREEN, GREY, ORANGE, beside, note, plt

MOST = 60  # words in one picture: those that exist up to the largest restitutions


def pictures(result, _theory, _units):
    words = result.table("words")
    if len(words.get("word", ())):
        yield "words", draw_words, words
    if len(result.threshold.get("value", ())):
        yield "threshold", draw_threshold, result.threshold
    if result.trust:
        yield "trust", draw_trust, result


def certificates(result, _theory, units):
    if len(result.certificate.get("time", ())) > 1:
        yield "certificate", draw_certificate, result, units


def draw_words(words, panels):
    """One bar for each range of a word: thick where the state is stable, open where existence is not proved."""
    low, high = np.array(words["low"]), np.array(words["high"])
    order = np.argsort(high, kind="stable")[-MOST:]
    ax = panels(figsize=(6.4, 1.2 + 0.17 * max(len(order), 4)))
    for row, k in enumerate(order):
        ax.plot([low[k], high[k]], [row, row], color=GREY, lw=1.5, solid_capstyle="butt", zorder=1)
        ax.plot([max(words["proved_from"][k], low[k]), min(words["proved_to"][k], high[k])], [row, row], color=BLUE,
                lw=3, solid_capstyle="butt", zorder=2)
        if np.isfinite(words["stable_from"][k]):
            ax.plot([words["stable_from"][k], words["stable_to"][k]], [row, row], color=ORANGE, lw=6,
                    solid_capstyle="butt", zorder=3)
        ax.plot(high[k], row, "o", ms=4, color=BLUE, mfc=BLUE if words["high_proved"][k] == 1 else "white", zorder=4)
    ax.set_yticks(range(len(order)), [words["word"][k] for k in order], family="monospace", fontsize=7)
    ax.set(xlabel="restitution $r$", xlim=(0, None), ylim=(-0.8, len(order) - 0.2))
    for colour, width, label in ((BLUE, 3, "exists (proved)"), (GREY, 1.5, "exists (seen)"),
                                 (ORANGE, 6, "stable (seen)")):
        ax.plot([], [], color=colour, lw=width, label=label)
    ax.plot([], [], "o", ms=4, color=BLUE, label="the end is proved")
    beside(ax)
    ax.set_title(words.attributes["system"], fontsize="medium")


def draw_threshold(table, panels):
    """Distances are from the middle of the last two values, which bound the threshold: half of what lies between them
    is the least. They are differences of the decimals, since doubles do not resolve all of them."""
    about = table.attributes
    values = table["value_digits"].fractions()
    low, high = (values[table["value_digits"].tolist().index(about[f"{end}_digits"])] for end in ("low", "high"))
    distance = np.array([float(abs(value - (low + high) / 2)) for value in values])
    like_low = table["outcome"].values == about["low_outcome"]
    closed = table["how"].values == "closed form"
    ax = panels(figsize=(6.4, 3.6))
    tried = np.arange(1, len(values) + 1)
    ax.plot(tried, distance, color=GREY, lw=0.8, zorder=1)
    for side, colour, label in ((like_low, BLUE, about["low_outcome"]), (~like_low, ORANGE, "otherwise")):
        for which, fill, how in ((closed, colour, ", closed form"), (~closed, "white", ", run")):
            if (side & which).any():
                ax.plot(tried[side & which], distance[side & which], "o", ms=5, color=colour, mfc=fill, zorder=2,
                        label=f"{label}{how}")
    ax.set(yscale="log", xlabel="value tried", ylabel="distance from the threshold")
    ax.legend(loc="lower left")
    lines = "\n" if len(about["low_digits"]) > 20 else " "
    ax.set_title(f"{about['key']} = {about['low_digits']}{lines}to {about['high_digits']}", fontsize="medium")


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
