"""Files that are written whole or not at all."""
from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from urllib.parse import quote

from .errors import BAD_FILE, BAD_INPUT, Error


def made_from(command: str, path: str) -> str:
    """The mark in what `cradle plot` and `cradle report` make of a result."""
    return f"[cradle {command} {quote(os.fsencode(os.path.basename(path.removesuffix('.part'))))}]"


def check_replaced(path: str, mark: str) -> None:
    """Raises Error if there is a file that the same command would not make again: one without this mark."""
    if not os.path.isfile(path):
        return
    with open(path, "rb") as file:
        content = file.read()
    if content and mark.encode() not in content:
        raise Error(f"{path}: not what `{mark[1:-1]}` makes again (found something else): give another -o FILE, or "
                    "--force to replace it", BAD_INPUT)


@contextlib.contextmanager
def whole(path: str) -> Iterator[str]:
    """A temporary path beside the final one; the file is renamed when the block ends. Raises Error."""
    part = f"{path}.part"
    try:
        yield part
        os.replace(part, path)
    except OSError as error:
        folder = os.path.dirname(path) or "."
        found = error.strerror or error if os.path.isdir(folder) else f"no folder {folder}"
        raise Error(f"{path}: cannot be written (found {found}): give a place in a folder that can be written to",
                    BAD_FILE) from None
    finally:
        if os.path.exists(part):
            os.remove(part)
