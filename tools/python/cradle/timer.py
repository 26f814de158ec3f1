"""Times at which a live simulation calls functions: decimals, so that they do not drift."""
from __future__ import annotations

import decimal
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Union

from .errors import BAD_INPUT, Error

if TYPE_CHECKING:
    from .simulation import Simulation

Time = Union[float, int, str, decimal.Decimal]
EXACT = decimal.Context(prec=4096)  # for sums of times; wide types have many digits


class Timer:
    """A function that is called at times start + k step."""

    def __init__(self, start: decimal.Decimal, step: decimal.Decimal, function: Callable[[Simulation], Any]):
        self.start, self.step, self.function, self.count = start, step, function, 1

    @property
    def due(self) -> decimal.Decimal:
        return EXACT.add(self.start, EXACT.multiply(self.step, self.count))

    def call(self, simulation: Simulation) -> None:
        self.count += 1  # first: the function may raise, and is not called again at this time
        self.function(simulation)


def decimal_of(value: Time) -> decimal.Decimal:
    try:
        number = decimal.Decimal(str(value))
    except decimal.InvalidOperation:
        number = decimal.Decimal("nan")
    if not number.is_finite():
        raise Error(f"not a time (found {value}): give a number", BAD_INPUT)
    return number
