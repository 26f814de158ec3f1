"""What kind of file there is at a path, whether it is whole, and opening it.

HDF5 may crash on damaged files, so a result is checked before HDF5 reads it. After HDF5's part a file has 24 more
bytes: `CRADLES1`, the length of HDF5's part and the CRC-64/XZ of everything before it.
"""
from __future__ import annotations

import lzma
import os
import stat
import struct
import zlib

import h5py

from .errors import BAD_FILE, Error

FORMAT = 2
CHECKED = 64 << 20  # bytes of a file whose checksum is checked without a request: a tenth of a second
STORED = {b"CRADLEJ": "journal", b"CRADLER": "journal", b"CRADLEC": "checkpoint"}
STORED_FORMAT = 4  # the last letter of how these files begin
MAGIC, SIZE = b"CRADLES1", 24  # of a seal
CHUNK = 1 << 16  # of LZMA2, at most


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
        size, seal = os.path.getsize(path), read_seal(path)
        if seal and (check or check is None and size <= CHECKED):
            check_seal(path, *seal)
        if not seal and (length := hdf5_length(path)) not in (None, size):
            raise damaged(path, f"{size} bytes, HDF5 wrote {length}")
    except OSError as error:
        raise unreadable(path, error) from None
    return seal is not None


def read_seal(path: str) -> tuple[int, int] | None:
    """The length of the sealed part and its CRC-64; None without a seal. Raises Error if it does not fit the file."""
    with open(path, "rb") as file:
        length = file.seek(0, os.SEEK_END)
        file.seek(max(0, length - SIZE))
        magic, sealed, checksum = struct.unpack("<8sQQ", file.read(SIZE).rjust(SIZE, b"\0"))
    if magic != MAGIC:
        return None
    if sealed != length - SIZE:
        raise damaged(path, f"{length} bytes, sealed with {sealed + SIZE}")
    return sealed, checksum


def check_seal(path: str, length: int, checksum: int) -> None:
    """Reads the sealed part once, at some GB/s. Raises Error if it has another checksum.

    Python has no such CRC, but liblzma checks it after a block of an .xz file: so the file is passed to liblzma as such
    a block, in uncompressed chunks.
    """
    flags, header = b"\0\x04", bytes([2, 0, 0x21, 1, 0x08, 0, 0, 0])  # CRC-64; one filter, LZMA2, 64 KiB
    checker = lzma.LZMADecompressor(lzma.FORMAT_XZ)
    covered = length + 16  # the CRC is of all before it: the seal's magic and length too
    try:
        checker.decompress(b"\xfd7zXZ\0" + flags + struct.pack("<I", zlib.crc32(flags))
                           + header + struct.pack("<I", zlib.crc32(header)))
        with open(path, "rb") as file:
            for at in range(0, covered, CHUNK):
                size = min(CHUNK, covered - at)
                if len(piece := file.read(size)) < size:
                    raise damaged(path, "its end too early")
                checker.decompress(bytes([2 if at else 1]) + struct.pack(">H", size - 1) + piece)
        packed = covered + 3 * -(-covered // CHUNK) + 1  # chunks, their headers, the end
        checker.decompress(b"\0" + bytes(-packed % 4) + struct.pack("<Q", checksum))
    except lzma.LZMAError:
        raise damaged(path, "another checksum than it was sealed with") from None


def hdf5_length(path: str) -> int | None:
    """The length of the file according to HDF5 (superblock of version 0, as the program and h5py write it), or None."""
    with open(path, "rb") as file:
        head = file.read(48)
    return struct.unpack_from("<Q", head, 40)[0] if len(head) == 48 and head[8] == 0 and head[13] == 8 else None


def damaged(path: str, found: str) -> Error:
    return Error(f"{path}: the file is damaged (found {found}): copy it again from where it was written, "
                 "or run its scene again", BAD_FILE)


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
