"""Reports: `cradle.report(result)` writes the settings and results of a run as one HTML page that can be sent."""
from __future__ import annotations

import os
from builtins import open as builtins_open  # hidden by ours

from ..files import check_replaced, made_from, whole
from ..result import Result, open


def report(result: Result | str | os.PathLike, output: str | os.PathLike | None = None, force: bool = True) -> str:
    """Writes one HTML file that needs nothing else and returns its path: light and dark, prints; same file, same bytes.

    result: an opened result, its path, or FILE.part of a run in progress.
    output: by default the result's path with .html. Written beside its place and renamed.
    force: False replaces only a page that was made from a result of the same name.
    Raises Error if the result cannot be read or the page cannot be written.
    """
    opened = result if isinstance(result, Result) else open(result)
    output = os.fspath(output or os.path.splitext(opened.path.removesuffix(".part"))[0] + ".html")
    if not force:
        check_replaced(output, made_from("report", opened.path))
    from .page import page  # matplotlib, late
    text = page(opened)
    with whole(output) as part, builtins_open(part, "w", encoding="utf-8", newline="\n") as file:
        file.write(text)
    return output
