"""Pictures inside the page: SVG, or PNG if that is smaller."""
from __future__ import annotations

import base64
import html
import io

LARGEST = 1_500_000  # bytes of SVG; beyond it pixels are smaller, and browsers faster with them


def picture(figure, text: str) -> str:
    """An element for a matplotlib figure, which is closed. Same figure, same text."""
    import matplotlib.pyplot as plt

    from ..drawing.pictures import write
    try:
        for extension, kind in (("svg", "svg+xml"), ("png", "png")):
            drawn = io.BytesIO()
            write(figure, drawn, extension)
            if len(drawn.getvalue()) <= LARGEST:
                break
        data = base64.b64encode(drawn.getvalue()).decode("ascii")
        return f'<img alt="{html.escape(text)}" src="data:image/{kind};base64,{data}">'
    finally:
        plt.close(figure)
