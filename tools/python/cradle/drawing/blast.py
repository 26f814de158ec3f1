"""A blast in a cold gas: the positions of the fronts and (A E t^2/rho)^(1/3), and profiles over x/R with the exact
solution of Euler's equations for gamma = 3 (derived in bench/results/classics.md; arXiv:2010.15868)."""
import numpy as np

from .style import BLUE, GREY, power, shades

AMPLITUDE = 1071 / 152


def pictures(result, _theory, _units):
    if (result.word("initial", "type") == "cold" and result.word("initial", "place") != "left"
            and result.setting("initial", "hot", 1) >= 2 and result.setting("law", "restitution") == 1):
        yield "blast", draw, result


def solution(size=400):
    """xi, density, velocity relative to the front's, and temperature relative to its square, for V from 1/3 to 1/2."""
    v = 1 / 3 + np.linspace(1e-3, 1, size) ** 3 / 6
    xi = (6 * v - 2) ** 0.4 * (2 * v) ** (-2 / 3) * (3 - 4 * v) ** (-11 / 15)
    density = 2 * (2 - 2 * v) ** 2 * (6 * v - 2) ** 0.2 * (3 - 4 * v) ** (-11 / 5)
    return xi, density, xi * v, (xi * v) ** 2 * (1 - v) / (3 * v - 1)


def draw(result, panels):
    masses = [float(mass) for mass in result.scene["initial"].get("masses", [1])]
    energy, rho = result.setting("initial", "energy"), np.mean(masses) / result.setting("initial", "spacing", 1.0)
    axes = panels(2, 2, figsize=(7.2, 5.6))
    draw_front(axes[0, 0], result, energy, rho)
    others, (xi, *solutions) = axes.flat[1:], solution()
    for profile, spread, colour in zip(result.mean_profiles, result.profiles, shades(len(result.profiles))):
        time = profile["time"]
        front = np.cbrt(AMPLITUDE * energy * time ** 2 / rho)
        speed = 2 * front / (3 * time)
        place = profile["x"] / front
        shown = np.abs(place) < 1.3
        for ax, name, unit in zip(others, ("mass_density", "velocity", "temperature"), (rho, speed, speed ** 2)):
            mean = profile[name] / unit
            ax.plot(place[shown], mean[shown], color=colour, lw=0.9, label=f"$t={power(time)}$")
            if result.replicas:
                error = spread[name]["sem"] / unit
                ax.fill_between(place[shown], (mean - error)[shown], (mean + error)[shown], color=colour, alpha=0.2,
                                lw=0)
    for ax, exact, odd, label, top in zip(others, solutions, (False, True, False), (
            r"density $\rho\,/\,\rho_0$", r"velocity $u\,/\,\dot R$", r"temperature $\theta\,/\,\dot R^2$"),
            (2.4, 0.75, 1.5)):
        ax.plot(xi, exact, "k--", lw=1, zorder=3, label="Euler, exact")
        ax.plot(-xi, -exact if odd else exact, "k--", lw=1, zorder=3)
        ax.set(xlabel=r"$x\,/\,R(t)$", ylabel=label, xlim=(-1.3, 1.3), ylim=(-top if odd else 0, top))
    others[0].legend(loc="upper center", ncol=2)


def draw_front(ax, result, energy, rho):
    """R^3 rho/(E t^2) of both fronts; it tends to A as the gas forgets its initial state."""
    series = result.means
    later = series["time"] > 0
    time = series["time"][later]
    front = (series["front_right"][later] - series["front_left"][later]) / 2
    value = front ** 3 * rho / (energy * time ** 2)
    seen = np.isfinite(value) & (value < 4 * AMPLITUDE)
    ax.semilogx(time[seen], value[seen], color=BLUE, lw=1.4, label="outermost particles")
    if result.replicas:
        sem = np.hypot(result.series["front_right"]["sem"], result.series["front_left"]["sem"])[later] / 2
        error = 3 * value * sem / front
        ax.fill_between(time[seen], (value - error)[seen], (value + error)[seen], color=BLUE, alpha=0.25, lw=0)
    ax.axhline(AMPLITUDE, color="k", ls="--", label="$A=1071/152$")
    ax.axhspan(0.98 * AMPLITUDE, 1.02 * AMPLITUDE, color=GREY, alpha=0.3, lw=0, label=r"$\pm 2\,\%$")
    ax.set(xlabel="time ($t$)", ylabel=r"$R^3\rho_0\,/\,(Et^2)$", ylim=(0, 2.5 * AMPLITUDE))
    ax.legend(loc="upper right")
