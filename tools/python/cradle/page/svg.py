"""Pictures inside the page: SVG with names of its own, so that many stand in one document; PNG where it is smaller."""
from __future__ import annotations

import base64
import html
import io
import re

LARGEST = 1_500_000  # characters of SVG; beyond it pixels are smaller, and browsers faster with them


def picture(figure, number: int, text: str) -> str:
    """An element for a matplotlib figure, which is closed. Same figure, same text."""
    import matplotlib.pyplot as plt

    from ..drawing.pictures import write
    try:
        drawn = io.StringIO()
        write(figure, drawn, "svg")
        if len(drawn.getvalue()) <= LARGEST:
            return inline(drawn.getvalue(), f"p{number}-", text)
        pixels = io.BytesIO()
        write(figure, pixels, "png")
        width = figure.get_size_inches()[0] * 72
        data = base64.b64encode(pixels.getvalue()).decode("ascii")
        return f'<img alt="{html.escape(text)}" style="width:{width:.0f}pt" src="data:image/png;base64,{data}">'
    finally:
        plt.close(figure)


def inline(svg: str, prefix: str, text: str) -> str:
    """An SVG document as an element of HTML: no prologue, no metadata, a prefix to every id that is referred to."""
    svg = svg[svg.index("<svg"):]
    svg = re.sub(r"<metadata>.*?</metadata>\s*", "", svg, flags=re.DOTALL)
    svg = re.sub(r"<style type=\"text/css\">.*?</style>\s*", "", svg, flags=re.DOTALL)  # page.css has it
    svg = re.sub(r"<!--.*?-->\s*", "", svg, flags=re.DOTALL)
    named = set(re.findall(r'\bhref="#([^"]+)"', svg)) | set(re.findall(r"url\(#([^)]+)\)", svg))

    def renamed(match: re.Match) -> str:
        if match[1] not in named:  # nobody asks for it, or it has been given: equal definitions have equal names
            return ""
        named.remove(match[1])
        return f' id="{prefix}{match[1]}"'

    svg = re.sub(r'\sid="([^"]*)"', renamed, svg)
    svg = re.sub(r'\bhref="#', f'href="#{prefix}', svg)
    svg = re.sub(r"url\(#", f"url(#{prefix}", svg)
    return svg.replace("<svg", f'<svg role="img" aria-label="{html.escape(text)}"', 1).strip()
