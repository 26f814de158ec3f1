"""The exception for all errors, and the meanings of the program's exit statuses."""
from __future__ import annotations

import sys

DONE, DIFFERS, BAD_INPUT, COLLAPSE, BAD_FILE, LOST = 0, 1, 2, 3, 4, 5


class Error(Exception):
    """An error whose message says `what is wrong (what was found): what to do`.

    message: the text, which may come from the program.
    status: the exit status: 2 bad input, 4 a file could not be read or written, 5 resolution or order
        lost or a replica failed, 130 and 143 interrupted.
    result: the incomplete result, or None.
    """

    def __init__(self, message: str, status: int = BAD_INPUT, result=None):
        super().__init__(message)
        self.message, self.status, self.result = message, status, result


def missing(module: str) -> Error:
    return Error(f"Python module {module} is missing (in {sys.executable}): install the Debian package "
                 f"python3-{module} for /usr/bin/python3, or {module} with pip", BAD_FILE)
