"""Checks that a result is unchanged before HDF5 reads it: HDF5 may crash on damaged files.

After HDF5's part a file has 24 more bytes: `CRADLES1`, the length of HDF5's part and the CRC-64/XZ of everything before
it. Python has no such CRC, but liblzma checks it after a block of an .xz file: so the file is passed to liblzma as such
a block, in uncompressed chunks.
"""
from __future__ import annotations

import lzma
import os
import struct
import zlib

from .errors import BAD_FILE, Error

MAGIC, SIZE = b"CRADLES1", 24
CHUNK = 1 << 16  # of LZMA2, at most


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


def hdf5_length(path: str) -> int | None:
    """The length of the file according to HDF5 (superblock of version 0, as the program and h5py write it), or None."""
    with open(path, "rb") as file:
        head = file.read(48)
    return struct.unpack_from("<Q", head, 40)[0] if len(head) == 48 and head[8] == 0 and head[13] == 8 else None


def damaged(path: str, found: str) -> Error:
    return Error(f"{path}: the file is damaged (found {found}): copy it again from where it was written, "
                 "or run its scene again", BAD_FILE)


def check_seal(path: str) -> bool:
    """Reads the file once, at some GB/s; False without a seal. Raises Error if the file is damaged."""
    seal = read_seal(path)
    if seal is None:
        return False
    length, checksum = seal
    flags, header = b"\0\x04", bytes([2, 0, 0x21, 1, 0x08, 0, 0, 0])  # CRC-64; one filter, LZMA2, 64 KiB
    checker = lzma.LZMADecompressor(lzma.FORMAT_XZ)
    try:
        checker.decompress(b"\xfd7zXZ\0" + flags + struct.pack("<I", zlib.crc32(flags))
                           + header + struct.pack("<I", zlib.crc32(header)))
        with open(path, "rb") as file:
            left = length + 16  # the CRC is of all before it: the seal's magic and length too
            while left:
                piece = file.read(min(CHUNK, left))
                if not piece:
                    raise damaged(path, "its end too early")
                first = left == length + 16
                checker.decompress(bytes([1 if first else 2]) + struct.pack(">H", len(piece) - 1) + piece)
                left -= len(piece)
        packed = length + 16 + 3 * -(-(length + 16) // CHUNK) + 1  # chunks, their headers, the end
        checker.decompress(b"\0" + bytes(-packed % 4) + struct.pack("<Q", checksum))
    except lzma.LZMAError:
        raise damaged(path, "another checksum than it was sealed with") from None
    return True
