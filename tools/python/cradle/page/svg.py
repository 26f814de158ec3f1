"""Pictures inside the page, for light and for dark pages: SVG, or PNG if that is smaller."""
from __future__ import annotations

import base64
import html
import io

LARGEST = 1_500_000  # bytes of SVG; beyond it pixels are smaller, and browsers faster with them


def picture(draw, text: str) -> str:
    """The elements for a picture of cradle.plot.drawings: the style sheet shows the one that suits the page, and prints
    the light one. Same picture, same text."""
    return "".join(f'<img class="{name}" alt="{html.escape(text)}" src="{data_of(draw, name == "dark")}">'
                   for name in ("light", "dark"))


def data_of(draw, dark: bool) -> str:
    import matplotlib.pyplot as plt

    from ..drawing.pictures import write
    figure = draw(dark=dark, titled=False)  # the page has the title
    try:
        for extension, kind in (("svg", "svg+xml"), ("png", "png")):
            drawn = io.BytesIO()
            write(figure, drawn, extension, dark)
            if len(drawn.getvalue()) <= LARGEST:
                break
        return f"data:image/{kind};base64,{base64.b64encode(drawn.getvalue()).decode('ascii')}"
    finally:
        plt.close(figure)
