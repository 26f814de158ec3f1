"""How a page begins: two sentences on what was simulated and by what, for a reader who knows neither the scene nor the
program; then the units, and what the marks beside the numbers mean."""
from __future__ import annotations

from ..result import Result
from .elements import code, number, tag, text


def introduction(result: Result) -> str:
    """The HTML of the first paragraphs."""
    if result.kind == "words":
        about = result.table("words").attributes
        return paragraph(f"For which restitutions do {text(about['system'])} repeat one order of collisions for ever, "
                         "in an inelastic collapse? The answers, with proofs, are by Cradle, a program that computes "
                         "granular gases on a line collision by collision.")
    sentences = f"{particles(result)}{law(result)}. {program(result)}."
    return paragraph(sentences) + paragraph(units(result), "note") + marks(result)


def paragraph(content: str, kind: str = "intro") -> str:
    return f"<p class={kind}>{content}</p>\n"


def given(result: Result, table: str, key: str):
    """A setting as a number; None if there is none, or if the points of a sweep differ in it."""
    scenes = result.points or [result]
    found = {scene.setting(table, key) for scene in scenes}
    return found.pop() if len(found) == 1 else None


def whole(value, unknown: str = "some") -> str:
    return unknown if value is None else number(int(value))


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
        return f"Two rows of {whole(count and count / 2, '')} particles run into each other" \
               + (f", each at the speed {number(speed)}&nbsp;l/t" if speed is not None else "")
    if kind == "rows":
        sides = [whole(given(result, "initial", f"{side}.particles")) for side in ("left", "right")]
        return f"Two rows of {sides[0]} and {sides[1]} particles run into each other"
    if kind == "ring":
        return f"{whole(count, 'Several')} particles with random velocities move on a ring"
    if kind == "gas":
        return f"{whole(count, 'Several')} particles with random velocities move between two walls{where}"
    if kind == "cold":
        hot = given(result, "initial", "hot")
        moved = "one is" if hot == 1 else f"{whole(hot)} are"
        return f"{whole(count, 'Several')} particles stand in a line; {moved} set in motion{where}"
    return f"{whole(len(initial.get('x', ())))} particles start from given positions with given velocities{where}"


def law(result: Result) -> str:
    """What a collision does."""
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
        return "; they bounce without losing energy"
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
