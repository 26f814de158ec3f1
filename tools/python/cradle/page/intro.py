"""How a page begins: two sentences on what was simulated and by what, for a reader who knows neither the scene nor the
program; then the units, and what the marks beside the numbers mean."""
from __future__ import annotations

from collections.abc import Iterator

from ..result import Result
from .elements import code, count_of, number, tag, text, valued


def introduction(result: Result) -> str:
    """The HTML of the first paragraphs."""
    if result.kind == "words":
        about = result.table("words").attributes
        return paragraph(f"For which restitutions do {text(about['system'])} repeat one order of collisions for ever, "
                         "in an inelastic collapse? The answers, with proofs, are by Cradle, a program that computes "
                         "granular gases on a line collision by collision.")
    around = "".join(surroundings(result))
    sentences = f"{particles(result)}{masses(result)}{law(result)}. {around}{program(result)}."
    return paragraph(sentences) + paragraph(units(result), "note") + marks(result)


def paragraph(content: str, kind: str = "intro") -> str:
    return f"<p class={kind}>{content}</p>\n"


def given(result: Result, table: str, key: str):
    """A setting as a number; None if there is none, or if the points of a sweep differ in it."""
    scenes = result.points or [result]
    found = {scene.setting(table, key) for scene in scenes}
    return found.pop() if len(found) == 1 else None


def some(value) -> str:
    return "Several particles" if value is None else count_of(value, "particle")


def moved(count, verb: str) -> str:
    """`moves` of one particle, `move` of more."""
    return verb + "s" * (count == 1)


def particles(result: Result) -> str:
    """Which particles, and how they move at the start."""
    initial, falls = result.scene.get("initial", {}), "gravity" in result.scene
    kind, where = initial.get("type"), " under gravity" if falls else ""
    count = given(result, "initial", "particles")
    if kind == "clusters":
        return "Two heavy clusters swing through each other in the force of the particles around them, which are not " \
               "simulated but modelled"
    if kind == "rows" and "left" not in initial:
        speed = given(result, "initial", "speed")
        return f"Two rows of {some(count and count / 2).lower()} run into each other" \
               + (f", each at the speed {number(speed)}&nbsp;l/t" if speed is not None else "")
    if kind == "rows":
        rows = [some(given(result, "initial", f"{side}.particles")).lower() for side in ("left", "right")]
        speeds = [given(result, "initial", f"{side}.speed") for side in ("left", "right")]
        at = f", at the velocities {number(speeds[0])} and {number(speeds[1])}&nbsp;l/t" if None not in speeds else ""
        mass, speed = given(result, "initial", "centre.mass"), given(result, "initial", "centre.speed")
        if mass == 0:
            return f"A row of {rows[0]} and one of {rows[1]} run into each other{at}"
        centre = "a particle" + (f" of mass {number(mass)}" if mass is not None else "")
        resting = "at rest" if speed == 0 else f"at {number(speed)}&nbsp;l/t" if speed is not None else "that moves"
        return f"A row of {rows[0]} on the left and one of {rows[1]} on the right meet {centre} {resting} between " \
               f"them{at}"
    if kind == "ring":
        return f"{some(count)} with random velocities {moved(count, 'move')} on a ring"
    if kind == "gas":
        return f"{some(count)} with random velocities {moved(count, 'move')} between two walls{where}"
    if kind == "cold":
        hot = given(result, "initial", "hot")
        start = "one is" if hot == 1 else "some are" if hot is None else f"{number(int(hot))} are"
        return f"{some(count)} {moved(count, 'stand')} in a line; {start} set in motion{where}"
    listed = len(initial.get("x", ()))
    return f"{some(listed)} {moved(listed, 'start')} from given positions with given velocities{where}"


def masses(result: Result) -> str:
    """What is said of masses that are not all 1; those of a list in the order of its particles."""
    initial = result.scene.get("initial", {})
    if drawn := initial.get("random_masses"):
        return f", with random masses from {number(float(drawn[0]))} to {number(float(drawn[1]))}"
    found = [float(mass) for mass in initial.get("masses") or initial.get("m") or ()]
    if not any(mass != 1 for mass in found):
        return ""
    if len(set(found)) == 1:
        return f", each of mass {number(found[0])}"
    if len(found) > 6:
        return f", with masses from {number(min(found))} to {number(max(found))}"
    return f", with the masses {', '.join(map(number, found))}" + ", repeated" * ("masses" in initial)


def surroundings(result: Result) -> Iterator[str]:
    """Sentences on gravity and walls: where they are, how they move, and what a collision with them does."""
    acceleration = given(result, "gravity", "acceleration") if "gravity" in result.scene else 0
    if acceleration:
        side = "right" if acceleration > 0 else "left"
        yield f"Particles fall to the {side}, at {number(abs(acceleration))}&nbsp;l/t². "
    elif acceleration is None:
        yield "Their acceleration varies. "
    for side in ("left", "right"):
        if side in result.scene.get("walls", {}):
            yield f"The {side} wall {wall(result, side)}. "


def wall(result: Result, side: str) -> str:
    def value(key: str, symbols: str = "") -> str:
        found = given(result, "walls", f"{side}.{key}")
        return "a value that varies" if found is None else valued(number(found), symbols)

    def there(key: str) -> bool:
        return given(result, "walls", f"{side}.{key}") not in (None, 0) or any(
            key in scene.scene.get("walls", {}).get(side, {}) and given(scene, "walls", f"{side}.{key}") != 0
            for scene in result.points)
    own = result.scene["walls"][side]
    parts = [f"is at x = {value('position', 'l')}"]
    if there("speed"):
        parts = [f"starts at x = {value('position', 'l')} and moves at {value('speed', 'l/t')}"]
    motion = own.get("motion", "none")
    if motion != "none":
        parts.append(f"is shaken as a {text(motion)} of amplitude {value('amplitude', 'l')} and angular frequency "
                     f"{value('frequency', '1/t')}")
    if there("temperature"):
        parts.append(f"has the temperature {value('temperature', 'm l^2/t^2')}")
    elif given(result, "walls", f"{side}.restitution") == 1:
        parts.append("reflects without loss")
    else:
        parts.append(f"reflects with the restitution {value('restitution')}")
    if there("rest_speed"):
        parts.append(f"holds what comes more slowly than {value('rest_speed', 'l/t')}")
    return ", ".join(parts[:-1]) + " and " + parts[-1]


def law(result: Result) -> str:
    """What a collision of particles does; nothing is said of a single one."""
    if 1 in (given(result, "initial", "particles"), len(result.scene.get("initial", {}).get("x", ()))):
        return ""
    kinds = {point.law for point in result.points or [result]}
    if len(kinds) > 1:
        return f"; what a collision does is compared for several laws ({', '.join(sorted(kinds))})"
    if result.law == "sticky":
        return "; particles that meet stick together"
    if result.law == "wet":
        loss = given(result, "law", "loss")
        cost = f"the energy {number(loss)}&nbsp;m&nbsp;l²/t²" if loss is not None else "energy"
        return f"; each collision costs two particles {cost}, and those that do not have it stick together"
    if result.law != "inelastic":
        return ""
    restitution, cutoff = given(result, "law", "restitution"), given(result, "law", "cutoff")
    if restitution == 1:
        return "; two that collide lose no energy"
    part = "a part of" if restitution is None else f"{number(restitution)} times"
    varied = " (about: it depends on the speed)" if "cutoff_exponent" in result.scene["law"] else ""
    slow = f", or without loss if that was below {number(cutoff)}&nbsp;l/t" if cutoff and not varied else ""
    return f"; two that collide part at {part} the speed at which they met{slow}{varied}"


def program(result: Result) -> str:
    """What computed it, how often, and how far."""
    about, replicas = result.attributes, result.attributes.get("replicas")
    often = ""
    if result.kind == "sweep":
        keys = [code(name) for name in result.sweep.columns if "." in name]
        often = f" at {number(len(result.points))} settings" + (f" of {' and '.join(keys)}" if keys else "")
    elif len(result.trust):
        often = f" {number(len(result.trust))} times with rising precision"
    if replicas:
        often += f", {number(replicas)} runs in all, which differ in their random numbers"
    until = given(result, "run", "until")
    collapsed = "time" in result.collapse
    end = f", until it collapsed at t&nbsp;=&nbsp;{number(result.collapse['time'], 6)}" if collapsed else \
        f", up to t&nbsp;=&nbsp;{number(until)}" if until is not None else ""
    digits = "" if len(result.trust) else f" in {text(about.get('precision', ''))} precision"
    return ("It was computed by Cradle, a program that follows granular gases on a line collision by collision"
            f"{digits}{often}{end}")


def units(result: Result) -> str:
    initial = result.scene.get("initial", {})
    scaled = initial.get("type") == "rows" and "left" not in initial
    spacing = f" (neighbours in a row start {number(float(initial['spacing']))}&nbsp;l apart)" if scaled else ""
    return ("<b>Units.</b> m is the mass of a particle of mass 1; l and t are the scene's own units of length"
            f"{spacing} and of time. So speeds are in l/t, energies in m&nbsp;l²/t²."
            + (" Pictures of two equal rows divide by what the rows give: lengths by their spacing l, speeds by "
               "2u₀, where u₀ is the speed of a row, times by l/2u₀." if scaled else ""))


def marks(result: Result) -> str:
    if result.kind != "run" or len(result.trust):
        return ""
    return ('<p class="note"><b>How well numbers are known.</b> '
            f"{tag('proved')} enclosed by the proof in this file; {tag('estimated')} with an error that the run itself "
            f"estimates; {tag('unknown')} computed, but it is not known how many of the digits are right: "
            "<code>cradle trust</code> and <code>cradle certify</code> find out.</p>\n")
