"""Topics and messages, of whatever file they come from."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from ...errors import MissingDependency
from ..clock_times import read_moment

Tell = Callable[[str], None]
"""Is told what of a file cannot be read."""


@dataclass(frozen=True)
class Topic:
    """What messages of one kind are called, and how they are written."""

    name: str
    type: str
    """Name of their schema, as the file has it."""
    encoding: str
    """json, cdr, ros1, mavlink, or what else the file says."""
    schema: str = ""
    """Their definition, where the file has it."""

    @property
    def kind(self) -> str:
        """The last word of the type: CompressedVideo of foxglove.CompressedVideo."""
        return self.type.replace(".", "/").rsplit("/", 1)[-1]


class Message(NamedTuple):
    """One message; a plain tuple, since there are millions of them."""

    place: int
    """Where to start reading for it: a byte of the file, or a row of the database."""
    number: int
    """Its number among the messages that are read from there."""
    topic: Topic
    log_time: int
    """When it was written down [ns]."""
    publish_time: int
    """When it was sent [ns]; as the first where the file does not tell."""
    data: Any
    """Its bytes; what is decoded already, for MAVLink."""


def require_extra(missing: ImportError, extra: str, what: str) -> MissingDependency:
    """Say what has to be installed for a kind of file."""
    package = (missing.name or "more").partition(".")[0]
    return MissingDependency.of(f"Reading {what}", package, extra)


def look_up(value: Any, path: str) -> Any:
    """Give a field of a decoded message, such as pose.position; None where it has none."""
    for name in path.split("."):
        value = value.get(name) if isinstance(value, Mapping) else getattr(value, name, None)
        if value is None:
            return None
    return value


def read_stamp(stamp: Any) -> int | None:
    """Give a message's own time [ns since 1970]; None where it has none."""
    if isinstance(stamp, str):
        try:
            return round(read_moment(stamp) * 1e9)
        except ValueError:
            return None
    seconds = next((s for n in ("sec", "secs") if (s := look_up(stamp, n)) is not None), None)
    parts = (look_up(stamp, name) for name in ("nanosec", "nsec", "nsecs"))
    nanoseconds = next((part for part in parts if part is not None), 0)
    if not isinstance(seconds, int) or seconds <= 0:
        return None
    return seconds * 1_000_000_000 + int(nanoseconds)
