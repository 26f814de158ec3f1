"""The table of predictions, as `cradle theory --csv` prints it."""
import csv
import io
import re

import numpy as np


class Theory:
    """Predictions in long format: quantity, equation, form, t, value; an empty t marks a number."""

    def __init__(self, text):
        self.rows = list(csv.DictReader(io.StringIO(text)))

    def _pick(self, quantity, with_time):
        for form in ("continuous", "discrete", ""):  # never the misprinted one
            found = [(float(row["t"] or 0), float(row["value"])) for row in self.rows
                     if (row["quantity"], row["form"], row["t"] != "") == (quantity, form, with_time)]
            if found:
                return sorted(found) if with_time else found
        return []

    def curve(self, quantity):
        """Times and values, both empty where there is no prediction."""
        return np.array(self._pick(quantity, True)).reshape(-1, 2).T

    def number(self, quantity):
        points = self._pick(quantity, False)
        return points[0][1] if points else None

    def equation(self, *quantities):
        """How the table is cited, `Eq. (7)` or `Eqs. (4), (5)`; what is not of the paper by its text, `Haff 1983`."""
        equations = {row["quantity"]: row["equation"] for row in reversed(self.rows)}  # the first of each
        cited = [equations.get(quantity) or quantity for quantity in quantities]
        numbers = [re.search(r"\((\d+)\)", text) for text in cited]
        if not all(numbers):
            return ", ".join(dict.fromkeys(cited))
        numbers = list(dict.fromkeys(number[0] for number in numbers))
        return ("Eqs. " if len(numbers) > 1 else "Eq. ") + ", ".join(numbers)
