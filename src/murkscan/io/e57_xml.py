"""The XML of an E57 file, looked at before any parser sees it."""

import struct
from pathlib import Path
from typing import BinaryIO

from ..errors import FormatError

_HEADER = struct.Struct("<8sIIQQQQ")
"""Signature, version, sizes and places (ASTM E2807, table 1)."""
_CHECKSUM = 4
"""Bytes at the end of each page that are no content."""
_MOST = 1 << 26
"""Bytes of XML; the descriptions of ten thousand scans need no more."""
_ENCODINGS = (b"utf-8", b"us-ascii", b"ascii")
_FORBIDDEN = {
    b"<!doctype": "a document type, which no E57 file needs and which may name files, addresses "
    "and texts that expand without end",
    b"<!entity": "entities, which no E57 file needs",
    b"schemalocation": "the place of a schema, which no E57 file needs and which would be opened",
}
"""Names in XML cannot be disguised: they stand as they are in any document in UTF-8."""


def check_e57_xml(path: Path) -> None:
    """Refuse XML that makes a parser read anything else, or grow beyond the file.

    Raises:
        FormatError: The file is no E57 file, is cut off, or its XML has a document type, names a
            schema, or is in another encoding than UTF-8.
        FileNotFoundError: There is no such file.
    """
    with path.open("rb") as file:
        text = _read_xml(file, path).lower()
    if text.startswith(b"\xef\xbb\xbf"):
        text = text[3:]
    declaration = text[: text.find(b">") + 1] if text.startswith(b"<?xml") else b""
    encoding = declaration.partition(b"encoding")[2].strip(b" \t\r\n=")
    is_plain = not encoding or encoding[1:].startswith(_ENCODINGS)
    if not text.startswith(b"<") or b"\0" in text or not is_plain:
        raise FormatError(f"{path} cannot be read as E57: its XML is no text in UTF-8.")
    for word, what in _FORBIDDEN.items():
        if word in text:
            raise FormatError(f"{path} is refused: its XML has {what}. Save it anew, or as .las.")


def _read_xml(file: BinaryIO, path: Path) -> bytes:
    """Read the XML out of its pages."""
    head = file.read(_HEADER.size)
    if len(head) < _HEADER.size or head[:8] != b"ASTM-E57":
        raise FormatError(f"{path} is not an E57 file.")
    *_, place, length, page = _HEADER.unpack(head)
    size = path.stat().st_size
    if page <= _CHECKSUM or not _HEADER.size <= place < size or length > min(size, _MOST):
        raise FormatError(
            f"{path} declares {length} bytes of XML from byte {place} on, but holds {size} bytes; "
            "it is cut off or damaged."
        )
    parts, left = list[bytes](), length
    while left:
        file.seek(place)
        part = file.read(min(left, page - _CHECKSUM - place % page))
        if not part:
            raise FormatError(f"{path} ends within its XML; it is cut off or damaged.")
        parts.append(part)
        left -= len(part)
        place = (place // page + 1) * page
    return b"".join(parts)
