"""From a message's bytes to its fields."""

import json
from functools import lru_cache
from typing import Any

from ...errors import FormatError
from .messages import Message, Topic, require_extra

_SHARED = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration", "std_msgs/msg/Header")
"""Types that a schema may leave out."""


def decode(message: Message) -> Any:
    """Decode a message: mappings for JSON and MAVLink, objects for ROS; see `look_up`.

    Raises:
        FormatError: It is not what its topic says, or in an encoding that is not read.
        MissingDependency: rosbags is not installed.
    """
    topic = message.topic
    if topic.encoding == "mavlink":
        return message.data
    if topic.encoding == "json":
        try:
            return json.loads(message.data)
        except ValueError as error:
            raise FormatError(f"A message of {topic.name} is no JSON.") from error
    if topic.encoding not in ("cdr", "ros1"):
        raise FormatError(f"Messages of {topic.name} are written as {topic.encoding}.")
    store, name = _know_type(topic)
    read = store.deserialize_ros1 if topic.encoding == "ros1" else store.deserialize_cdr
    try:
        return read(message.data, name)
    except Exception as error:  # rosbags' generated code fails in many ways on foreign bytes
        raise FormatError(f"A message of {topic.name} is not a {topic.type}.") from error


@lru_cache(maxsize=256)
def _know_type(topic: Topic) -> tuple[Any, str]:
    """Make what decodes a topic's messages, by the definition in the file or the well-known one."""
    try:
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore
    except ImportError as error:
        raise require_extra(error, "dive", "messages of ROS") from error
    name = _full_name(topic.type)
    known = get_typestore(Stores.ROS1_NOETIC if topic.encoding == "ros1" else Stores.ROS2_HUMBLE)
    try:
        if not topic.schema:
            if name not in known.fielddefs:
                raise FormatError(f"{topic.name} has messages of {topic.type}, not defined in it.")
            return known, name
        types = get_types_from_msg(topic.schema, name)
        types |= {one: known.fielddefs[one] for one in _SHARED if one not in types}
        store = get_typestore(Stores.EMPTY)
        store.register(types)
    except FormatError:
        raise
    except Exception as error:  # the grammar's own errors
        raise FormatError(f"The definition of {topic.type} in the file cannot be read.") from error
    return store, name


def _full_name(name: str) -> str:
    """Write a type's name as ROS 2 does: package/msg/Name."""
    parts = name.replace(".", "/").split("/")
    return f"{'/'.join(parts[:-1]) or 'unknown'}/msg/{parts[-1]}" if "msg" not in parts else name
