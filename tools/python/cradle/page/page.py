"""The page of a report: the sections and their contents. It contains everything and needs no network."""
from __future__ import annotations

import base64
import hashlib
import html
import io
import json
import os
import shlex
import re

from .. import microscope as canvas
from .. import program
from ..commands import scene_file
from ..errors import Error, path_of
from ..files import check_replaced, made_from, whole
from ..opening import read_seal
from ..plot import PICTURES, drawings
from ..result import Result
from ..result import open as open_result
from .elements import code, count_of, number, preformatted, rows, section, text
from .intro import introduction
from .numbers import Entries, last, numbers, warnings
from .tables import tables

# The browser may load nothing that is not in the page.
POLICY = ("default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data: blob:; "
          "connect-src data: blob:; worker-src blob:")
SCHEMES = ("light", "dark")  # in which every picture is drawn: the style sheet shows one
LARGEST = 1_500_000  # bytes of SVG; beyond it pixels are smaller, and browsers faster with them
LONGEST_SCENE = 100_000  # characters; listed particles may be many


def report(result: Result | str | os.PathLike, output: str | os.PathLike | None = None, force: bool = True) -> str:
    """Writes one HTML file that needs nothing else and returns its path: light and dark, prints; same file, same bytes.

    result: an opened result, its path, or FILE.part of a run in progress.
    output: by default the result's path with .html. Written beside its place and renamed.
    force: False replaces only a page that was made from a result of the same name.
    Raises Error if the result cannot be read or the page cannot be written.
    """
    opened = result if isinstance(result, Result) else open_result(result)
    output = path_of(output or os.path.splitext(opened.path.removesuffix(".part"))[0] + ".html", "output")
    if not force:
        check_replaced(output, made_from("report", opened.path))
    content = page(opened)
    with whole(output) as part, open(part, "w", encoding="utf-8", newline="\n") as file:
        file.write(content)
    return output


def page(result: Result) -> str:
    """The HTML text of a result's report."""
    version = of_program(["--version"])
    # Warnings come first, before a reader takes the numbers for granted.
    sections = [("numbers", "Numbers", numbers(result)), ("tables", "Tables", tables(result)),
                ("pictures", "Pictures", pictures(result)), ("microscope", "Microscope", microscope(result)),
                ("again", "Run it again", again(result)), ("cost", "Cost", rows(cost(result))),
                ("provenance", "Provenance", rows(provenance(result, version))),
                ("cite", "Cite", "<p>The paper for the model, the program together with the scene:</p>\n"
                 + preformatted(beside(os.path.join("..", "cite.bib"))))]
    warned = list(warnings(result, version.split("\n")[0].removeprefix("cradle ")))
    title = text(result.attributes.get("name", "")) + " – " + text(result.scene.get("title") or result.kind)
    links = " ".join(f'<a href="#{name}">{head}</a>' for name, head, content in sections if content)
    body = [f"<header>\n<h1>{text(result.scene.get('title') or result.attributes.get('name', ''))}</h1>\n"
            f"<p class=lead>{lead(result)}</p>\n{introduction(result)}<nav>{links}</nav>\n</header>\n<main>\n"]
    if warned:
        body.append('<ul class="warnings">' + "".join(f"<li>{caption}" for caption in warned) + "</ul>\n")
    body += [section(*entry) for entry in sections]
    return (f"<!DOCTYPE html>\n<html lang=en>\n<head>\n<meta charset=utf-8>\n<title>{title}</title>\n"
            f'<meta name=generator content="{made_from("report", result.path)}">\n'
            f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">\n'
            '<meta name=viewport content="width=device-width, initial-scale=1">\n<link rel=icon href="data:,">\n'
            f"<style>\n{beside('page.css')}</style>\n</head>\n<body>\n{''.join(body)}</main>\n"
            f"<script>\n{beside('page.js')}</script>\n</body>\n</html>\n")


def beside(name: str) -> str:
    """The text of a file in this folder; the closing tags of scripts and styles are escaped in it."""
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), name), encoding="utf-8") as file:
        return re.sub("</(?=script|style)", r"<\\/", file.read(), flags=re.IGNORECASE)


def of_program(words: list[str]) -> str:
    """The program's output; empty if there is no program."""
    try:
        return program.call(words).stdout.strip()
    except Error:
        return ""


def lead(result: Result) -> str:
    """One line that describes the result."""
    initial, about = result.scene.get("initial", {}), result.attributes
    parts = [result.kind if result.kind != "trust" else "comparison of precisions"]
    if initial.get("type") != "clusters":
        particles = initial.get("particles") or len(initial.get("x", ())) or sum(
            int(float(initial.get(side, {}).get("particles", 0))) for side in ("left", "right"))
        coordinates = text(result.word("run", "coordinates"))
        parts += [f"{result.law} law", f"{count_of(float(particles), 'particle')} in {coordinates}"]
    if about.get("replicas"):
        parts.append(count_of(about["replicas"], "replica"))
    parts += [text(about.get("precision", "")), f"<b>{text(result.outcome)}</b>"]
    return " · ".join(part for part in parts if part)


def data_of(draw, dark: bool) -> str:
    """A picture as an address: SVG, or PNG if that is smaller."""
    import matplotlib.pyplot as plt

    from ..drawing.pictures import write
    figure = draw(dark=dark, titled=False)  # the page has the title
    try:
        for extension, kind in (("svg", "svg+xml"), ("png", "png")):
            drawn = io.BytesIO()
            write(figure, drawn, extension, dark)
            if len(drawn.getvalue()) <= LARGEST:
                break
        return data_url(f"image/{kind}", drawn.getvalue())
    finally:
        plt.close(figure)


def data_url(kind: str, content: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode('ascii')}"


def pictures(result: Result) -> str:
    found, cites = [], False
    for name, draw in drawings(result).items():
        caption = PICTURES[name]
        cites = cites or re.search(r"\bFigs?\. ", caption)
        images = "".join(f'<img class="{scheme}" alt="{html.escape(caption)}" src="{data_of(draw, scheme == "dark")}">'
                         for scheme in SCHEMES)
        found.append(f'<figure class="picture" id="picture-{name}">{images}\n'
                     f"<figcaption>{text(caption)} <span class=screen>{code(f'cradle.plot.{name}')}</span></figcaption>"
                     "</figure>\n")
    paper = ("<p class=note>Figures, equations and sections are those of the paper, Zaburdaev and Herminghaus, "
             "Phys. Rev. E <b>75</b>, 031304 (2007).</p>\n")
    return (paper if cites else "") + "".join(found)


def microscope(result: Result) -> str:
    """The canvas in which world lines are explored, if the result has the data."""
    data = canvas.data(result)
    if data is None:
        return ""
    style, script = ("\n".join(beside(os.path.join("..", name)) for name in names)
                     for names in (("microscope.css",), canvas.SCRIPTS))
    content = json.dumps(data, separators=(",", ":"), sort_keys=True).replace("<", "\\u003c")
    return ("<p>The paths of the particles, position against time. Zoom in to see collisions that no picture resolves: "
            "each gap is drawn from its own number, not from a difference of positions.</p>\n"
            f'<style>\n{style}</style>\n<div id="microscope-canvas"></div>\n'
            f'<script type="application/json" id="microscope-data">{content}</script>\n<script>\n{script}\n'
            'cradleMicroscope(document.getElementById("microscope-canvas"), '
            'JSON.parse(document.getElementById("microscope-data").textContent));\n</script>\n')


def commands_of(result: Result) -> list[list[str]]:
    """The words after `cradle` that make this result from its scene; several commands of replicas that were merged."""
    name = str(result.attributes.get("name", "scene"))
    output = os.path.basename(result.path.removesuffix(".part"))
    about = result.attributes
    made_by = about.get("command") or (
        "certify" if result.certificate.attributes else "trust" if len(result.trust) else "")
    if made_by:  # with its options
        command, *options = shlex.split(str(made_by))
        words = [command, f"{name}.toml", *options]
    elif result.kind in ("words", "threshold"):
        words = shlex.split(str(result.table(result.kind).attributes["command"]))
    elif result.kind == "sweep":
        words = ["sweep", f"{name}.toml"]
        planned = result.scene.get("sweep", {})
        if not planned.get("vary") and not planned.get("points"):
            words += [word for point in result.points for word in ("--point", point.label)]
        return replicas_of(result.points, words, output)
    elif result.kind == "ensemble":
        words = ["ensemble", f"{name}.toml"]
        for quantity, spread in result.table("ensemble/spread/series").items():
            low, high = (repr(float(spread.attributes[end])).removesuffix(".0") for end in ("from", "to"))
            words += ["--spread", f"{quantity}={low}:{high}:{spread.attributes['bins']}"]
        return replicas_of([result], words, output)
    else:
        words = ["run", f"{name}.toml"]
    return [[*words, "-o", output]]


def replicas_of(ensembles: list[Result], words: list[str], output: str) -> list[list[str]]:
    """A command for the replicas of each range without gaps, and one that merges them."""
    held = {int(number) for one in ensembles for number in one.replicas["index"].values}
    begins, ends = (sorted(number for number in held if number + step not in held) for step in (-1, 1))
    ranges = [(first, last + 1 - first) for first, last in zip(begins, ends)]
    stem, extension = os.path.splitext(output)
    parts = [f"{stem}-{first}{extension}" for first, _ in ranges] if len(ranges) > 1 else [output]
    commands = [[*words, "--replicas", str(count), *["--first", str(first)] * (first > 0), "-o", part]
                for (first, count), part in zip(ranges, parts)]
    return commands + [["merge", *parts, "-o", output]] * (len(parts) > 1)


def again(result: Result) -> str:
    """The command and the scene, which give the same bytes."""
    scene, name = result.scene_text, str(result.attributes.get("name", "scene"))
    command = "\n".join(shlex.join(["cradle", *words]) for words in commands_of(result))
    version = text(result.attributes.get("cradle_version", ""))
    caption = (f"<p>With this scene as {code(name + '.toml')} the same cradle, {version}, gives the same bytes:</p>\n"
               + preformatted(command))
    if len(scene) > LONGEST_SCENE:
        export = f"cradle export {os.path.basename(result.path)} --to DIR"
        return caption + f"<p>The scene has {number(len(scene))} characters: {code(export)} writes it.</p>\n"
    link = data_url("application/toml", scene.encode())
    return caption + ('<p class=screen><button type="button" class="copy" data-of="scene">copy the scene</button> '
                      f'<a download="{html.escape(name)}.toml" href="{link}">save it</a></p>\n'
                   + preformatted(scene).replace("<pre>", '<pre id="scene">', 1))


def cost(result: Result) -> Entries:
    """The work that was done, and the program's estimate; results do not store wall times."""
    collisions = last(result.series, "collisions")
    counts = [each.replicas["collisions"].values.sum() for each in (result, *result.points)
              if "collisions" in each.replicas]
    if collisions is None and counts:
        collisions = int(sum(counts))
    if collisions is not None:
        yield "collisions", number(collisions), "of all replicas" if result.attributes.get("replicas") else ""
    if not result.in_progress:
        yield "file", number(os.path.getsize(result.path)), "bytes"
    else:
        for line in of_program(["info", result.path]).splitlines():
            if line.startswith(("time ", "collisions/s ", "computing ", "smallest gap ", "checkpoint ")):
                yield text(line[:24].strip()), text(line[24:]), "when this page was made"
    if result.kind == "run":
        with scene_file(result) as (path, _):
            expected = of_program(["check", path]).splitlines()
        for line in expected:
            if line.startswith(("time: ", "memory: ")):
                name, _, value = line.partition(": ")
                yield f"{text(name)} expected", text(value), "by cradle check"


def provenance(result: Result, version: str) -> Entries:
    about = result.attributes
    yield ("written by", f"cradle {text(about.get('cradle_version', ''))}",
           f"format {text(about.get('format_version', ''))}")
    yield "precision", text(about.get("precision", "")), ""
    yield "scene, SHA-256", code(hashlib.sha256(result.scene_text.encode()).hexdigest()), ""
    if "scene_checksum" in result.certificate.attributes:
        yield "scene, in the proof", code(result.certificate.attributes["scene_checksum"]), "CRC-64"
    if "identity" in about:
        yield "identity", code(f"{int(about['identity']):016x}"), "of scenes and what is recorded"
    if not result.in_progress and (seal := read_seal(result.path)):
        yield "file", code(f"{seal[1]:016x}"), "its seal, CRC-64/XZ"
    for line in version.splitlines():
        name, _, value = line.partition(": ")
        yield ("this page by", text(line), "") if not value else (text(name), text(value), "")
    import matplotlib
    yield "pictures", f"matplotlib {text(matplotlib.__version__)}", ""
