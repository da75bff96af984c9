"""Bags of ROS 2 that are kept in SQLite."""

import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

from ...errors import FormatError
from .messages import Message, Tell, Topic


def read_ros2(path: Path, start: int, topics: dict[int, Topic], tell: Tell) -> Iterator[Message]:
    """Read the messages of a database in the order in which they were written; see `read_mcap`."""
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as base:
            base.text_factory = lambda text: text.decode("utf-8", "replace")
            _read_topics(base, topics)
            rows = base.execute(
                "SELECT id, topic_id, timestamp, data FROM messages WHERE id >= ? ORDER BY id",
                (start,),
            )
            for place, topic, time, data in rows:
                if topic in topics:
                    yield Message(place, 0, topics[topic], time, time, data)
    except (sqlite3.DatabaseError, UnicodeDecodeError) as error:
        # SQLite says what is wrong in the file's own words, which may be no text.
        if not topics:
            raise FormatError(f"{path} is not a bag of ROS 2: {error}.") from error
        tell(f"{path.name} is damaged and read up to there ({error})")


def _read_topics(base: sqlite3.Connection, topics: dict[int, Topic]) -> None:
    tables = {name for (name,) in base.execute("SELECT name FROM sqlite_master")}
    schemas: dict[str, str] = {}
    if "message_definitions" in tables:
        schemas = dict(
            base.execute("SELECT topic_type, encoded_message_definition FROM message_definitions")
        )
    found = base.execute("SELECT id, name, type, serialization_format FROM topics")
    for number, name, kind, encoding in found:
        topics.setdefault(number, Topic(name, kind, encoding, schemas.get(kind, "")))
