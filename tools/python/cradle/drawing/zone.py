"""Fig. 7: densities and velocities of right- and left-movers in the interaction zone of the late wet shock, averaged
over time, and the linear model of section VI: equations (9) and (10) with 2L of (13) and k = sqrt 6. The measured
width is the length over which u+ falls from u0 to u_crit at its steepest slope; (13) counts the fall to 0."""
import numpy as np

from .style import BLUE, GREY, ORANGE, beside, note

EXCESS = np.sqrt(6.0)  # k = n~/n0, where (12) and (13) agree


def pictures(result, _theory, units):
    if "x" in result.table("zone"):
        yield "zone", draw_zone, result, units


def model_width(speed, loss, spacing=1.0):
    """2L of equation (13); m = 1."""
    return speed ** 2 * spacing / (loss * (2 + EXCESS))


def draw_zone(result, units, panels):
    zone = result.table("zone")
    speed, loss = result.setting("initial", "speed", 0.5), result.setting("law", "loss", np.nan)
    spacing = result.setting("initial", "spacing", 1.0)
    x = zone["x"] / units.x
    half = model_width(speed, loss, spacing) / 2 / units.x
    measured, error = zone["width"] / units.x, zone["width_error"] / units.x
    velocity, density, mass = panels.stacked(
        units.velocity_label(), units.label("density $n$", r"density $n\,/\,n_0$"),
        units.label(r"mass density $\rho$", r"mass density $\rho\,/\,\rho_0$"), x=units.position_label(), height=2.1)
    slow = 2 * np.sqrt(loss)
    formed = bool(np.isfinite(measured))  # u+ has fallen to u_crit within the bins; before there is nothing to model
    for sign, index, name, colour, line in ((1, "+", "right", BLUE, "-"), (-1, "-", "left", ORANGE, "--")):
        inside = np.array([-half, half])
        u = (-(speed - slow) * inside / (2 * half) + sign * (speed + slow) / 2) / units.v
        n = 1 + EXCESS / 2 + sign * EXCESS * inside / (2 * half)
        outer = sign * np.array([min(x[0], -1.2 * half), -half])
        if formed:
            velocity.plot(outer, np.full(2, sign * speed / units.v), line, color="k", lw=0.9)
            velocity.plot(inside, u, line, color="k", lw=0.9, label=f"$u_{index}$, Eq. (9)")
            density.plot(outer, np.ones(2), line, color="k", lw=0.9)
            density.plot(inside, n, line, color="k", lw=0.9, label=f"$n_{index}$, Eq. (10)")
        moving = zone[f"density_{name}"] > 0
        dots = {"marker": "o" if sign > 0 else "s", "ls": "none", "ms": 3.2, "color": colour,
                "mfc": colour if sign > 0 else "none", "label": f"{name}-movers"}
        velocity.plot(x[moving], zone[f"velocity_{name}"][moving] / units.v, **dots)
        density.plot(x, zone[f"density_{name}"] * spacing, **dots)
    mass.plot(x, zone["mass_density"] * spacing, drawstyle="steps-mid", color=BLUE)
    mass.set_yscale("log")
    note(mass, "peaks: the heavy clusters; shaded: $2L$ of Eq. (13)" if formed else
         "no zone yet: $u_+$ has not fallen to $u_\\mathrm{crit}$")
    velocity.axhline(0, color=GREY, lw=0.6)
    if formed:
        for ax in (velocity, density, mass):
            ax.axvspan(-half, half, color=GREY, alpha=0.18, lw=0, zorder=0)
        bottom, top = velocity.get_ylim()
        velocity.set_ylim(1.05 * bottom, 2.55 * top)
        draw_width(velocity, measured, error, longer=measured / (1 - slow / speed) if slow < speed else np.nan,
                   model=2 * half, top=top)
    velocity.set_yticks([-speed / units.v, 0, speed / units.v])
    density.set_ylim(0, None)
    beside(velocity), beside(density)
    note(velocity, f"average over $t={zone['from'] / units.t:.5g}$ to {units.at(zone['until'], name='')}, "
                   f"{zone['samples']} samples")


def draw_width(ax, measured, error, longer, model, top):
    """The measured width as a bar above the curves, dotted to the point at which u+ would be 0."""
    ax.errorbar([-measured / 2, measured / 2], [1.3 * top] * 2, xerr=error / 2, color="k", lw=1, capsize=3)
    ax.plot([-longer / 2, longer / 2], [1.3 * top] * 2, "k:", lw=1)
    ax.text(0, 1.45 * top, rf"$2L={measured:.3g}\pm{error:.2g}$ from $u_0$ to $u_\mathrm{{crit}}$" + "\n"
            + rf"(dotted: to 0, ${longer:.3g}$); (13): ${model:.3g}$", ha="center", va="bottom", fontsize=8)
