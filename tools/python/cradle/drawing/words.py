"""Words of collapse: for which restitutions each word has a self-similar state, and where that is stable."""
import numpy as np

from .style import BLUE, GREY, ORANGE, beside

MOST = 60  # words in one picture: those that exist up to the largest restitutions


def pictures(result, _theory, _units):
    words = result.table("words")
    if len(words.get("word", ())):
        yield "words", draw, words


def draw(words, panels):
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
