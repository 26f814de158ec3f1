"""Times at which a live simulation calls functions: decimals, so that they do not drift."""
from __future__ import annotations

import decimal
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Union

from .errors import argument

if TYPE_CHECKING:
    from .simulation import Simulation

Time = Union[float, int, str, decimal.Decimal]
EXACT = decimal.Context(prec=4096)  # for sums of times; wide types have many digits


@dataclass
class Timer:
    """A function that is called at times due + k step."""
    due: decimal.Decimal
    step: decimal.Decimal
    function: Callable[[Simulation], Any]

    def call(self, simulation: Simulation) -> None:
        self.due = EXACT.add(self.due, self.step)  # first: if the function raises, it is not called again at this time
        self.function(simulation)


def decimal_of(value: Time) -> decimal.Decimal:
    with argument("time", value, "a time", "give a number"):
        number = decimal.Decimal(str(value))
        if not number.is_finite():
            raise ValueError
        return number
