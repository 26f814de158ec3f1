"""A splash: the outermost particle of a cold gas on a half-line is kicked. Front and energy at x > 0 against time, with
exponents fitted for every point of a sweep over seeds, and those of Euler's equations (bench/results/classics.md)."""
import numpy as np

from .style import BLUE, ORANGE

FRONT, ENERGY = 0.627952, -0.116144
LAST = 0.1  # exponents are fitted over the last decade of time


def pictures(result, _theory, _units):
    if points := [p for p in (result.points or [result]) if is_splash(p)]:
        yield "splash", draw, points


def is_splash(point):
    initial = point.scene.get("initial", {})
    one_bin = len(point.mean_profiles) > 2 and all(len(p["x"]) == 1 and p["x"][0] > 0 for p in point.mean_profiles)
    return initial.get("type") == "cold" and initial.get("place") == "left" and one_bin


def energies(point):
    """Times, and M (theta + u^2)/2 of the single bin, which begins at x = 0."""
    time = np.array([p["time"] for p in point.mean_profiles])
    width = np.array([2 * p["x"][0] for p in point.mean_profiles])
    mass, speed, temperature = (np.array([p[name][0] for p in point.mean_profiles])
                                for name in ("mass_density", "velocity", "temperature"))
    return time, mass * width * (temperature + speed ** 2) / 2


def fit(time, value):
    late = (time >= LAST * time[-1]) & (time > 0) & (value > 0)
    return np.polyfit(np.log(time[late]), np.log(value[late]), 1)[0]


def draw(points, panels):
    axes = panels(2, 2, figsize=(7.2, 5.2), sharex="col", width_ratios=(1.6, 1))
    fronts = [(p.means["time"], p.means["front_right"]) for p in points]
    inside = [energies(p) for p in points]
    for row, (curves, known, label, colour) in enumerate(((fronts, FRONT, "front $R$ ($l$)", BLUE),
                                                          (inside, ENERGY, r"energy at $x>0$ ($m\,l^2/t^2$)", ORANGE))):
        left, right = axes[row]
        for time, value in curves:
            seen = (time > 0) & np.isfinite(value) & (value > 0)
            left.loglog(time[seen], value[seen], ".-" if row else "-", color=colour, lw=0.7, ms=3, alpha=0.6)
        time = np.geomspace(*(curves[0][0][-1] * np.array([1e-3, 1])), 50)
        left.plot(time, curves[0][1][-1] * (time / time[-1]) ** known, "k--", lw=1, label=f"$t^{{{known}}}$")
        left.set_ylabel(label)
        left.legend(loc="lower right" if row == 0 else "upper right")
        slopes = np.array([fit(*curve) for curve in curves])
        mean = slopes.mean()
        error = slopes.std(ddof=1) / np.sqrt(len(slopes)) if len(slopes) > 1 else np.nan
        right.plot(np.arange(len(slopes)), slopes, "o", ms=4, color=colour)
        right.axhline(known, color="k", ls="--", lw=1, label="Euler's equations")
        right.legend()
        if np.isfinite(error):
            right.axhspan(mean - 2 * error, mean + 2 * error, color=colour, alpha=0.2, lw=0)
        right.set_title(f"{mean:.5f} ± {error:.5f}" if np.isfinite(error) else f"{mean:.5f}", fontsize=8)
        right.set_ylabel("exponent, last decade")
    axes[1, 0].set_xlabel("time ($t$)")
    axes[1, 1].set_xlabel("ensemble")
