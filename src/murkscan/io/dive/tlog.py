"""MAVLink's telemetry log: packets, each behind its time of arrival."""

from collections.abc import Iterator
from pathlib import Path

from .messages import Message, Tell, Topic, require_extra


def read_tlog(path: Path, start: int, topics: dict[int, Topic], tell: Tell) -> Iterator[Message]:
    """Read the messages of a .tlog in order; they are decoded already. See `read_mcap`.

    References:
        https://mavlink.io/en/guide/serialization.html; each packet follows eight bytes, big-endian
        microseconds since 1970.
    """
    try:
        from pymavlink import mavutil
    except ImportError as error:
        raise require_extra(error, "tlog", "a .tlog") from error
    known: dict[str, Topic] = {topic.name: topic for topic in topics.values()}
    log = mavutil.mavlogfile(str(path), robust_parsing=True)
    bad, number = 0, 0
    while (packet := log.recv_msg()) is not None:
        kind = packet.get_type()
        if kind == "BAD_DATA":
            bad += 1
            continue
        name = f"mavlink/{packet.get_srcSystem()}/{packet.get_srcComponent()}/{kind}"
        if name not in known:
            known[name] = topics[len(topics)] = Topic(name, kind, "mavlink")
        time = round(packet._timestamp * 1e6) * 1000
        if number >= start:
            yield Message(number, 0, known[name], time, time, packet.to_dict())
        number += 1
    if bad:
        tell(f"{bad:,} pieces of {path.name} are no MAVLink and are left out")
