"""Bags of ROS 1, record by record, with or without their index."""

import bz2
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from ...errors import FormatError
from .messages import Message, Tell, Topic, require_extra

_MAGIC = b"#ROSBAG V2.0\n"
_MESSAGE, _CHUNK, _CONNECTION = 0x02, 0x05, 0x07
Fields = dict[bytes, bytes]
_NEEDED = {_CONNECTION: {b"conn", b"topic"}, _MESSAGE: {b"conn", b"time"}}
"""What a record of a kind must state."""


def read_ros1(path: Path, start: int, topics: dict[int, Topic], tell: Tell) -> Iterator[Message]:
    """Read the messages of a bag in the order in which they were written; see `read_mcap`.

    References:
        Bag format 2.0, https://wiki.ros.org/Bags/Format/2.0.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        if file.read(len(_MAGIC)) != _MAGIC:
            raise FormatError(f"{path} is not a bag of ROS 1, version 2.0.")
        file.seek(max(start, len(_MAGIC)))
        while (place := file.tell()) < size:
            head = _read_sized(file, size)
            data = None if head is None else _read_sized(file, size)
            if head is None or data is None:
                tell(f"{path.name} was cut off: it is read to its last whole chunk")
                return
            fields = _fields(head)
            whole = [(fields, data)]
            if fields.get(b"op") == bytes([_CHUNK]):
                whole = _open_chunk(path, fields, data, place, tell)
            yield from _take(_sound(path, whole, place, tell), place, topics)


def _read_sized(file: BinaryIO, size: int) -> bytes | None:
    """Read what a length of four bytes announces; None where the file ends before."""
    length = file.read(4)
    if len(length) < 4 or (count := int.from_bytes(length, "little")) > size:
        return None
    data = file.read(count)
    return data if len(data) == count else None


def _fields(head: bytes) -> Fields:
    fields, at = Fields(), 0
    while at + 4 <= len(head):
        end = at + 4 + int.from_bytes(head[at : at + 4], "little")
        name, _, value = head[at + 4 : end].partition(b"=")
        fields[name], at = value, end
    return fields


def _open_chunk(
    path: Path, fields: Fields, data: bytes, place: int, tell: Tell
) -> list[tuple[Fields, bytes]]:
    compression = fields.get(b"compression", b"none").decode("ascii", "replace")
    try:
        if compression == "bz2":
            data = bz2.decompress(data)
        elif compression == "lz4":
            data = _decompress_lz4(data)
        elif compression != "none":
            raise FormatError(
                f"{path} is compressed by {compression!r}, which is not known here; write it anew "
                "with `rosbag decompress`."
            )
        return _cut(data)
    except (ValueError, RuntimeError, OSError, EOFError, struct.error) as error:
        if isinstance(error, FormatError):
            raise
        tell(f"a chunk of {path.name} at byte {place:,} is damaged and left out ({error})")
        return []


def _decompress_lz4(data: bytes) -> bytes:
    try:
        import lz4.frame
    except ImportError as error:
        raise require_extra(error, "dive", "bags") from error
    return lz4.frame.decompress(data)


def _cut(data: bytes) -> list[tuple[Fields, bytes]]:
    """Cut a chunk into its records."""
    records, at = list[tuple[Fields, bytes]](), 0
    while at < len(data):
        parts = []
        for _ in range(2):
            (length,) = struct.unpack_from("<I", data, at)
            parts.append(data[at + 4 : at + 4 + length])
            at += 4 + length
        records.append((_fields(parts[0]), parts[1]))
    if at > len(data):
        raise ValueError("its last record is cut off")
    return records


def _sound(
    path: Path, records: list[tuple[Fields, bytes]], place: int, tell: Tell
) -> list[tuple[Fields, bytes]]:
    """Leave out records that lack what their kind has, and say so."""
    sound = []
    for fields, data in records:
        op = fields.get(b"op") or b"\0"
        if _NEEDED.get(op[0], set()) <= fields.keys() and len(fields.get(b"time", bytes(8))) == 8:
            sound.append((fields, data))
        else:
            tell(f"a record of {path.name} at byte {place:,} is damaged and left out")
    return sound


def _take(
    records: list[tuple[Fields, bytes]], place: int, topics: dict[int, Topic]
) -> Iterator[Message]:
    number = 0
    for fields, data in records:
        op = (fields.get(b"op") or b"\0")[0]
        if op == _CONNECTION:
            known = _fields(data)
            topics.setdefault(
                int.from_bytes(fields[b"conn"], "little"),
                Topic(
                    fields[b"topic"].decode("utf-8", "replace"),
                    known.get(b"type", b"").decode("utf-8", "replace"),
                    "ros1",
                    known.get(b"message_definition", b"").decode("utf-8", "replace"),
                ),
            )
        elif op == _MESSAGE:
            topic = topics.get(int.from_bytes(fields[b"conn"], "little"))
            seconds, nanoseconds = struct.unpack("<II", fields[b"time"])
            time = seconds * 1_000_000_000 + nanoseconds
            if topic is not None:
                yield Message(place, number, topic, time, time, data)
                number += 1
