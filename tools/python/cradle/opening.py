"""What kind of file there is at a path, whether it is whole, and opening it."""
from __future__ import annotations

import os
import stat

import h5py

from .errors import BAD_FILE, Error
from .seal import check_seal, damaged, hdf5_length, read_seal

FORMAT = 2
CHECKED = 64 << 20  # bytes of a file whose checksum is checked without a request: a tenth of a second
STORED = {b"CRADLEJ": "journal", b"CRADLER": "journal", b"CRADLEC": "checkpoint"}
STORED_FORMAT = 4  # the last letter of how these files begin


def stored_in(path: str) -> str:
    """"result" or "journal". Raises Error for any other file."""
    try:
        if not stat.S_ISREG(os.stat(path).st_mode) and not os.path.isdir(path):
            raise OSError("a FIFO or device")  # to read one might wait for ever
        with open(path, "rb") as file:
            head = file.read(8)
    except (OSError, ValueError) as error:
        raise unreadable(path, error) from None
    stored = STORED.get(head[:7]) if head[7:].isdigit() else None
    if stored and int(head[7:]) != STORED_FORMAT:
        raise other_format(path, int(head[7:]), STORED_FORMAT)
    if stored == "checkpoint":
        raise Error(f"{path}: a checkpoint, not a result: open the result beside it, or continue from it with `cradle "
                    "resume` (cradle.Simulation.load if a simulation saved it)", BAD_FILE)
    if not stored and head != b"\x89HDF\r\n\x1a\n":
        raise Error(f"{path}: not a result ({'an empty file' if not head else 'no HDF5 file'}): "
                    "give a file written by `cradle run`", BAD_FILE)
    return stored or "result"


def is_sealed(path: str, check: bool | None) -> bool:
    """Whether a result has the program's seal. Raises Error if it is damaged; see cradle.open for `check`."""
    try:
        size = os.path.getsize(path)
        sealed = bool(check_seal(path) if check or check is None and size <= CHECKED else read_seal(path))
        if not sealed and (length := hdf5_length(path)) not in (None, size):
            raise damaged(path, f"{size} bytes, HDF5 wrote {length}")
    except OSError as error:
        raise unreadable(path, error) from None
    return sealed


def unreadable(path: str, error: OSError | ValueError) -> Error:
    return Error(f"{path}: not a file that can be read ({getattr(error, 'strerror', None) or error}): "
                 "give a file written by `cradle run`", BAD_FILE)


def other_format(path: str, found: int, here: int = FORMAT) -> Error:
    return Error(f"{path}: a file of {'an earlier' if found < here else 'a later'} version of cradle (found format "
                 f"{found}, here {here}): read it with the version that wrote it, or remove it and run its scene "
                 "again", BAD_FILE)


def open_file(path: str) -> h5py.File:
    try:
        file = opened(path)
    except (OSError, ValueError, RuntimeError) as error:
        raise Error(f"{path}: not a result that can be read ({error}): it is damaged or half-written, "
                    "run its scene again", BAD_FILE) from None
    version = file.attrs.get("format_version")
    if version is None or "scene" not in file.attrs:
        file.close()
        raise Error(f"{path}: an HDF5 file, but no result (no scene in it): give a file written by `cradle run`",
                    BAD_FILE)
    if int(version) != FORMAT:
        file.close()
        raise other_format(path, int(version))
    return file


def opened(path: str) -> h5py.File:
    """Opens the file without locks, which some cluster file systems lack; if the caller has it open, as it did."""
    try:
        return h5py.File(path, "r", locking=False)
    except OSError as error:
        if "locking flag" not in str(error):
            raise
        return h5py.File(path, "r")
