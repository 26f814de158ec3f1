"""The elements of the page: texts, numbers, sortable tables."""
from __future__ import annotations

import html
import math
from collections.abc import Iterable, Sequence
from decimal import Decimal, localcontext
from typing import Any

MOST_DIGITS = 40  # of a proved number that are shown; the file has all


def text(value: Any) -> str:
    return html.escape(str(value), quote=False)


def code(value: Any) -> str:
    return f"<code>{text(value)}</code>"


def number(value: Any, digits: int = 12) -> str:
    """1.9e+07 as 1.9 × 10<sup>7</sup>, whole numbers in groups of three, NaN as a dash."""
    if isinstance(value, str):
        return text(value)
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int) or (isinstance(value, float) and value.is_integer() and abs(value) < 1e15):
        return f"{int(value):,}".replace(",", "\u202f")
    if not math.isfinite(value):
        return "–" if math.isnan(value) else ("∞" if value > 0 else "−∞")
    return powers(f"{value:.{digits}g}")


def count_of(count: int, noun: str) -> str:
    """1 particle, 2 particles."""
    return f"{number(int(count))} {noun}" + "s" * (count != 1)


def measured(value: float, error: float) -> str:
    """A mean with its standard error: both to the same place, with two digits of the error."""
    if not (math.isfinite(value) and math.isfinite(error) and error > 0):
        return number(value, 8)
    place = 1 - math.floor(math.log10(error))
    if -3 <= place <= 9 and abs(value) < 1e12:
        return f"{value:.{max(0, place)}f} <small>± {error:.{max(0, place)}f}</small>".replace("-", "−")
    digits = max(2, math.floor(math.log10(abs(value))) + place + 1) if value else 2
    return f"{powers(f'{value:.{digits}g}')} <small>± {powers(f'{error:.2g}')}</small>"


def powers(decimal: str) -> str:
    """Formats exponents as powers of ten, and uses true minus signs."""
    mantissa, _, exponent = decimal.lower().partition("e")
    mantissa = mantissa.replace("-", "−")
    if not exponent:
        return mantissa
    return (f"{mantissa} × " * (mantissa != "1") + f"10<sup>{int(exponent)}</sup>").replace("-", "−")


def enclosed(low: str, high: str) -> tuple[str, int]:
    """A number with proved bounds, as decimals: the right digits and the radius, and the number of right digits."""
    with localcontext() as context:
        context.prec = 2 * max(len(low), len(high)) + 10
        below, above = Decimal(low), Decimal(high)
        middle, radius = (below + above) / 2, (above - below) / 2
        if radius == 0:
            return powers(str(middle.normalize())), len(middle.normalize().as_tuple().digits)
        right = max(0, middle.adjusted() - radius.adjusted() - 1) if middle != 0 else 0
        shown = f"{middle:.{max(0, min(right, MOST_DIGITS) - 1)}e}"
    if -5 <= int(shown.partition("e")[2]) < min(right, MOST_DIGITS):
        shown = f"{Decimal(shown):f}"
    mantissa, e, exponent = shown.partition("e")
    shown = mantissa + "…" * (right > MOST_DIGITS) + e + exponent
    return f"{powers(shown)} ± {powers(f'{radius:.1e}')}", right


def valued(shown: str, symbols: str) -> str:
    """A number with its unit."""
    return f"{shown}&nbsp;{unit(symbols).replace(' ', '&nbsp;')}" if unit(symbols) else shown


def unit(symbols: str) -> str:
    """m l^2/t^2 as m l²/t²."""
    return "" if symbols in ("", "1") else text(symbols.replace("^2", "²").replace("^3", "³"))


def tag(known: str) -> str:
    """How well a number is known: proved, estimated or unknown."""
    return f'<span class="tag {known}">{known}</span>'


def rows(entries: Iterable[tuple[str, str, str]]) -> str:
    """A table of names, values and notes, each of which is HTML."""
    lines = [f"<tr><th scope=row>{name}<td>{value}<td>{note}" for name, value, note in entries]
    return '<table class="facts"><tbody>\n' + "\n".join(lines) + "\n</tbody></table>\n"


def sortable(caption: str, heads: Sequence[str], rows: Iterable[Sequence[tuple[Any, str]]]) -> str:
    """A table that is sorted by a column when its head is pressed. Cells are pairs: sort key, HTML."""
    lines = [f'<div class="wide"><table class="sortable"><caption>{caption}</caption>\n<thead><tr>'
             + "".join(f'<th scope=col aria-sort="none"><button type="button">{head}</button>' for head in heads)
             + "</thead>\n<tbody>"]
    for cells in rows:
        keyed = ((by if isinstance(by, str) else repr(float(by)), shown) for by, shown in cells)
        lines.append("<tr>" + "".join(f'<td data-by="{html.escape(key)}">{shown}' for key, shown in keyed))
    return "\n".join(lines) + "\n</tbody></table></div>\n"


def section(name: str, title: str, content: str) -> str:
    return f'<section id="{name}">\n<h2>{title}</h2>\n{content}</section>\n' if content else ""


def preformatted(value: str) -> str:
    return f"<pre>{text(value)}</pre>\n"
