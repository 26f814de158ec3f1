"""Digits that runs of rising precision share with the last one, against time."""
from .style import plt, subplots


def pictures(result, _theory, _units):
    return [("trust", lambda axes=None: draw_trust(result, axes))] if result.trust else []


def draw_trust(result, axes=None):
    """Digits of energy and front, and until when the sequence of collisions is right."""
    figure, panels = subplots(axes, 2, 1, sharex=True, figsize=(6.4, 6.4), constrained_layout=True)
    for ax, name, label in zip(panels, ("energy_digits", "front_digits"),
                               ("digits of the energy", "digits of the front")):
        for run, colour in zip(result.trust[:-1], plt.rcParams["axes.prop_cycle"].by_key()["color"] * 4):
            line = "--" if run["coordinates"] == "absolute" else "-"
            ax.plot(run["time"], run[name], line, color=colour,
                    label=f"{run['precision']}, {run['coordinates']}")
            if not run["right_to_end"]:
                ax.axvline(run["collisions_right_until"], color=colour, linestyle=line, linewidth=0.8)
        ax.set_ylabel(label)
        ax.set_ylim(bottom=0)
    panels[0].legend(fontsize="small", title=f"against {result.trust[-1]['precision']}", ncols=2)
    panels[1].set_xlabel("time $t$   (vertical lines: until when the sequence of collisions is right)")
    return figure
