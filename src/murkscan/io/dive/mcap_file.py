"""MCAP, chunk by chunk, with or without its index."""

import struct
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

from ...errors import FormatError
from .messages import Message, Tell, Topic, require_extra

_MAGIC = b"\x89MCAP0\r\n"
_FOOTER, _SCHEMA, _CHANNEL, _MESSAGE, _CHUNK, _DATA_END = 0x02, 0x03, 0x04, 0x05, 0x06, 0x0F
_KNOWN = range(0x01, 0x80)
"""Opcodes of records; those from 0x80 on are a writer's own, 0 is none."""
_COMPRESSIONS = ("", "zstd", "lz4")


def read_mcap(path: Path, start: int, topics: dict[int, Topic], tell: Tell) -> Iterator[Message]:
    """Read the messages of an MCAP file in the order in which they were written.

    The index at the end is not needed: a recorder that was cut off leaves none. A damaged chunk is
    passed over, and what follows the last whole record is not there.

    Args:
        path: The file.
        start: Byte to start at, a place that a message has; 0 for the beginning.
        topics: Topics by channel; what is found is added, and needed to start later.
        tell: Is told of damage.

    Raises:
        FormatError: It is no MCAP, or compressed in a way that is not known.
        MissingDependency: mcap is not installed.

    References:
        MCAP format specification, https://mcap.dev/spec.
    """
    size = path.stat().st_size
    schemas: dict[int, Any] = {}
    with path.open("rb") as file:
        if file.read(8) != _MAGIC:
            raise FormatError(f"{path} is not an MCAP file; its first bytes are not MCAP's.")
        file.seek(max(start, 8))
        while True:
            place = file.tell()
            head = file.read(9)
            opcode, length = (head[0], int.from_bytes(head[1:], "little")) if head else (0, 0)
            if opcode in (_DATA_END, _FOOTER):
                return
            if len(head) < 9 or opcode == 0 or place + 9 + length > size:
                tell(f"{path.name} was cut off: it is read to its last whole chunk")
                return
            if opcode not in (_SCHEMA, _CHANNEL, _MESSAGE, _CHUNK):
                file.seek(length, 1)
                continue
            records = _read_records(path, opcode, file.read(length), place, tell)
            yield from _take(records, place, schemas, topics)


def _read_records(path: Path, opcode: int, data: bytes, place: int, tell: Tell) -> list[Any]:
    try:
        from mcap import records
        from mcap.data_stream import ReadDataStream
        from mcap.exceptions import McapError
        from mcap.stream_reader import breakup_chunk
        from zstandard import ZstdError
    except ImportError as error:
        raise require_extra(error, "dive", "MCAP") from error
    stream = ReadDataStream(BytesIO(data))
    try:
        if opcode == _SCHEMA:
            return [records.Schema.read(stream)]
        if opcode == _CHANNEL:
            return [records.Channel.read(stream)]
        if opcode == _MESSAGE:
            return [records.Message.read(stream, len(data))]
        chunk = records.Chunk.read(stream)
        if chunk.compression in _COMPRESSIONS:
            return breakup_chunk(chunk, validate_crc=True)
    except (ValueError, RuntimeError, EOFError, struct.error, McapError, ZstdError) as error:
        tell(f"a chunk of {path.name} at byte {place:,} is damaged and left out ({error})")
        return []
    raise FormatError(
        f"{path} is compressed by {chunk.compression!r}, which is not known here; write it anew "
        "with zstd, as `mcap compress` does."
    )


def _take(
    records: list[Any], place: int, schemas: dict[int, Any], topics: dict[int, Topic]
) -> Iterator[Message]:
    """Give the messages among some records, and learn their topics."""
    number = 0
    for record in records:
        kind = type(record).__name__
        if kind == "Schema":
            schemas[record.id] = record
        elif kind == "Channel":
            schema = schemas.get(record.schema_id)
            name, text = (schema.name, schema.data) if schema else ("", b"")
            topics.setdefault(
                record.id,
                Topic(record.topic, name, record.message_encoding, text.decode("utf-8", "replace")),
            )
        elif record.channel_id in topics:
            topic = topics[record.channel_id]
            yield Message(place, number, topic, record.log_time, record.publish_time, record.data)
            number += 1
