"""Fig. 1: rows of sticky particles and the weak solution. The velocity is a fixed step u_l, 0, u_r. The density is that
of the rows and a delta peak of mass m_0 + sqrt(rho_l rho_r) (u_l - u_r) t, m_0 + 2 rho_0 u_0 t for equal rows."""
import numpy as np

from .settings import mass_of, since_start, since_symbol
from .style import BLUE, GREY, ORANGE, note, times_of, thinned


def pictures(result, _theory, units):
    if result.law == "sticky" and result.word("initial", "type") == "rows" and result.snapshots:
        yield "sticky", draw_sticky, result, units


def rows_of(result):
    """Density and velocity of the left and of the right row; mass and velocity of the particle between them."""
    if "left" not in result.scene["initial"]:
        density, speed = 1 / result.setting("initial", "spacing", 1.0), result.setting("initial", "speed", 0.5)
        return (density, speed), (density, -speed), (0.0, 0.0)
    return [(result.setting("initial", f"{part}.{key}", default), result.setting("initial", f"{part}.speed", speed))
            for part, key, default, speed in (("left", "density", 1.0, 0.5), ("right", "density", 1.0, -0.5),
                                              ("centre", "mass", 0.0, 0.0))]


def peak(snapshot):
    """Position, velocity and mass of the heaviest particle."""
    k = int(np.argmax(snapshot["m"]))
    return snapshot["x"][k], snapshot["v"][k], snapshot["m"][k]


def draw_sticky(result, units, panels):
    (left, u_left), (right, u_right), (core, _) = rows_of(result)
    snapshots, profiles = thinned(result.snapshots, 5), thinned(result.mean_profiles, 5)
    colour, name = times_of(snapshots + profiles, units)
    velocity, density, mass = panels.stacked(
        units.velocity_label(), units.label(r"density $\rho$", r"density $\rho\,/\,\rho_0$"), "", height=2.3)
    roots = np.sqrt([left, right])
    front = (roots[0] * u_left + roots[1] * u_right) / roots.sum()  # velocity of the peak, 0 for equal rows
    span = max([np.abs(p["x"][p["density"] > 0]).max() for p in profiles if (p["density"] > 0).any()], default=1.0)
    last = max(name)
    elapsed = since_start(result, last)

    if mass_of(result):  # the solution is that of equal masses
        step = np.array([-span, front * elapsed, front * elapsed, span]) / units.x
        velocity.plot(step, np.array([u_left, u_left, u_right, u_right]) / units.v, color=GREY, lw=7, alpha=0.5,
                      zorder=0, solid_capstyle="butt", label="weak solution")
        velocity.plot(front * elapsed / units.x, front / units.v, "o", color=GREY, ms=9, alpha=0.5, mew=0, zorder=0)
        taken = [max(-span, (front - u_left) * elapsed), min(span, (front - u_right) * elapsed)]
        hatched = {"fc": "none", "ec": "0.75", "hatch": "////", "lw": 0}
        density.fill_between(np.array([taken[0], 0]) / units.x, left * units.x, label=f"taken up until {name[last]}",
                             **hatched)
        density.fill_between(np.array([0, taken[1]]) / units.x, right * units.x, **hatched)
    for order, profile in enumerate(profiles):
        x, time = profile["x"], profile["time"]
        middle = front * since_start(result, time)
        at = [peak(s)[0] for s in snapshots if s["time"] == time]
        width = x[1] - x[0]
        rows = (profile["density"] > 0) & (np.abs(x - (at[0] if at else middle)) > width / 2)
        line = 3.4 - 0.7 * order  # one inside the other: the rows get shorter, the profile stays
        for side, u in ((x < middle, u_left), (x > middle, u_right)):
            velocity.plot(x[rows & side] / units.x, profile["velocity"][rows & side] / units.v, lw=line,
                          color=colour[time], solid_capstyle="butt", label=name[time] if u == u_left else None)
            density.plot(x[rows & side] / units.x, profile["density"][rows & side] * units.x, lw=line,
                         color=colour[time], solid_capstyle="butt", drawstyle="steps-mid")
    tall = max(peak(s)[2] for s in snapshots)
    rows = max(left, right) * units.x
    shares = np.array([peak(s)[2] / tall for s in snapshots])
    # the heaviest peak ends here, none at the line of the rows; arrows are to scale with each other
    high = rows * max((2.6, 3.2, 3.8), key=lambda factor: np.abs(factor * shares - 1).min())
    for snapshot in reversed(snapshots):
        x, v, m = peak(snapshot)
        velocity.plot(x / units.x, v / units.v, "o", ms=4, color=colour[snapshot["time"]])
        density.annotate("", (x / units.x, high * m / tall), (x / units.x, 0), zorder=4,
                         arrowprops={"arrowstyle": "-|>", "color": colour[snapshot["time"]], "lw": 1.6, "shrinkA": 0,
                                     "shrinkB": 0})
        density.annotate(rf"$M={m:.6g}$ at {name[snapshot['time']]}", (x / units.x, high * m / tall), (6, 1),
                         textcoords="offset points", fontsize=7.5, va="bottom",
                         bbox={"fc": "white", "ec": "none", "alpha": 0.85, "pad": 0.8})
    for sign, u in ((-1, u_left), (1, u_right)):
        velocity.annotate("", (sign * 0.45 * span / units.x, 0.62 * u / units.v),
                          (sign * 0.75 * span / units.x, 0.62 * u / units.v), arrowprops={"arrowstyle": "->", "lw": 1})
        velocity.text(sign * 0.6 * span / units.x, 0.5 * u / units.v, "row", ha="center",
                      va="top" if u > 0 else "bottom")
    velocity.set_xlabel(units.position_label())
    velocity.legend(loc="upper right", ncol=2)
    density.set(xlabel=units.position_label(), ylim=(0, 1.15 * high), xlim=velocity.get_xlim())
    if mass_of(result):
        density.legend(loc="upper left")
    note(density, "arrows: delta peak, as high as it is heavy")
    if "cloud_mass" in result.means:
        equal = left == right and u_left == -u_right
        t = since_symbol(result, units.t)
        formula = rf"$m_0+2{t}\rho_0u_0$" if equal else rf"$m_0+\sqrt{{\rho_l\rho_r}}\,(u_l-u_r)\,{t}$"
        draw_mass(mass, result, units, formula if equal or not core else formula + " (asymptotic)", core,
                  roots[0] * roots[1] * (u_left - u_right))


def draw_mass(ax, result, units, formula, core, growth):
    """growth: of mass by time, for particles of mass 1."""
    time, cloud, mass = result.means["time"], result.means["cloud_mass"], mass_of(result)
    collided = cloud > 0
    if mass:
        law = core + mass * growth * since_start(result, time)
        ax.plot(time / units.t, law, color=GREY, lw=5, alpha=0.5,
                label=rf"{formula}, ${core:.4g}+{mass * growth * units.t:.4g}\,{since_symbol(result, units.t)}$")
    ax.plot(time[collided] / units.t, cloud[collided], color=BLUE, label="simulation")
    times, heaviest = np.array([(s["time"], peak(s)[2]) for s in result.snapshots]).T
    ax.plot(times / units.t, heaviest, "o", color=ORANGE, ms=5, label="heaviest particle of the snapshots")
    off = np.abs(cloud - law)[collided] if mass else np.array([])
    ax.legend(loc="upper left", title=f"largest difference {off.max():.2g}" if off.size else None, title_fontsize=7.5)
    ax.set(xlabel=units.time_label(), ylabel="mass of the cluster $M$", ylim=(0, None),
           xlim=(time[0] / units.t, time[-1] / units.t))
