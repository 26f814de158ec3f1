"""Files that are written whole or not at all."""
from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator

from .errors import BAD_FILE, Error


@contextlib.contextmanager
def whole(path: str) -> Iterator[str]:
    """A temporary path beside the final one; the file is renamed when the block ends. Raises Error."""
    part = f"{path}.part"
    try:
        yield part
        os.replace(part, path)
    except OSError as error:
        raise Error(f"{path} cannot be written ({error.strerror or error}): choose another place with -o",
                    BAD_FILE) from None
    finally:
        if os.path.exists(part):
            os.remove(part)
