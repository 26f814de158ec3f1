"""What the laws beside results need of a scene: the time since run.start, and the masses of the particles."""
import numpy as np


def start_of(result):
    """When laws begin: at run.start, but in the model of two clusters, whose masses grow from t = 0 on, at 0."""
    return 0.0 if result.word("initial", "type") == "clusters" else result.setting("run", "start", 0.0)


def since_start(result, time):
    """Times of a result, counted from its initial state."""
    return np.asarray(time) - start_of(result)


def since_label(result, label="time ($t$)"):
    """The label of an axis of such times."""
    return label.replace("time", "time since the start", 1) if start_of(result) else label


def since_symbol(result, unit=1.0):
    """Such a time in a formula: t, or (t - 100)."""
    start = start_of(result) / unit
    return f"(t{-start:+.5g})" if start else "t"


def masses_of(result):
    """The masses of a scene: a pattern, those of a list, or the two between which they are drawn uniformly."""
    initial = result.scene.get("initial", {})
    given = initial.get("random_masses") or initial.get("masses") or initial.get("m") or [1]
    return [float(mass) for mass in given]


def mean_mass(result):
    return float(np.mean(masses_of(result)))


def mass_of(result):
    """The mass that all particles have; None if they differ. One between two rows is not among them."""
    masses = set(masses_of(result))
    return masses.pop() if len(masses) == 1 else None
