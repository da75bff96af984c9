"""What picture files say beside the picture: how many pages, and which way up it was held."""

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

_HEAD = 1 << 16
"""Bytes at a JPEG's beginning in which its notes stand."""
_ORIENTATION = 0x0112
_TURNS = {3: 180, 6: 90, 8: 270}
"""Clockwise turns [deg] that a picture is to be shown with, by the value of the note."""
_MOST_PAGES = 1_000_000


def count_pages(path: Path) -> int:
    """Count the pages of a TIFF file; 1 where it is none, or damaged.

    References:
        Adobe, TIFF Revision 6.0, 1992, section 2; BigTIFF as in libtiff's design note.
    """
    try:
        with path.open("rb") as file:
            return max(sum(1 for _ in _pages(file)), 1)
    except (OSError, struct.error, OverflowError):
        return 1


def find_turn(path: Path) -> int:
    """Give by how much a note asks to turn the picture, clockwise [deg]; 0 where none does.

    References:
        CIPA DC-008 (Exif 2.32), tag 0x0112.
    """
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD)
            begin = head.find(b"Exif\0\0")
            tiff = head[begin + 6 :] if begin >= 0 else head
            if tiff[:4] not in (b"II*\0", b"MM\0*"):
                return 0
            order = "<" if tiff[:2] == b"II" else ">"
            (place,) = struct.unpack_from(order + "I", tiff, 4)
            (count,) = struct.unpack_from(order + "H", tiff, place)
            for number in range(count):
                tag, kind, _, value = struct.unpack_from(
                    order + "HHIH", tiff, place + 2 + 12 * number
                )
                if tag == _ORIENTATION and kind == 3:
                    return _TURNS.get(value, 0)
    except (OSError, struct.error):
        pass
    return 0


def _pages(file: BinaryIO) -> Iterator[int]:
    """Give where the directory of each page stands, each once."""
    head = file.read(16)
    order = {b"II": "<", b"MM": ">"}.get(head[:2])
    if order is None:
        return
    (version,) = struct.unpack_from(order + "H", head, 2)
    if version not in (42, 43):
        return
    counts, entry, places = ("H", 12, "I") if version == 42 else ("Q", 20, "Q")
    (place,) = struct.unpack_from(order + places, head, 4 if version == 42 else 8)
    seen = set[int]()
    while place and place not in seen and len(seen) < _MOST_PAGES:
        seen.add(place)
        yield place
        file.seek(place)
        size = struct.calcsize(counts)
        (number,) = struct.unpack(order + counts, file.read(size))
        file.seek(place + size + entry * number)
        (place,) = struct.unpack(order + places, file.read(struct.calcsize(places)))
