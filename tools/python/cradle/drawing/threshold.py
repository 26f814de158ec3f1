"""How a threshold was closed in: the values that were tried, by their distance from it, on either side."""
import numpy as np

from .style import BLUE, GREY, ORANGE


def pictures(result, _theory, _units):
    table = result.table("threshold")
    if len(table.get("value", ())):
        yield "threshold", draw, table


def draw(table, panels):
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
