"""TOML: what users write by hand, and what is said of its faults."""

import re
import tomllib

import tomlkit

from ..errors import FormatError

_TWICE = re.compile(r"Cannot (overwrite|declare|mutate|redefine)")
"""How tomllib begins to say that something stands twice."""
_PLACE = re.compile(r" \(at (?:line (\d+), column \d+|end of document)\)$")


def parse_toml(text: str, name: str) -> tomlkit.TOMLDocument:
    """Read TOML such that it can be written again with its comments.

    Args:
        text: What the file holds.
        name: What errors call it.

    Raises:
        FormatError: It is no TOML, or a key stands twice; the message names the line.
    """
    try:
        tomllib.loads(text)  # It says where; tomlkit keeps the comments.
        return tomlkit.parse(text)
    except tomllib.TOMLDecodeError as error:
        raise FormatError(f"{name}{_explain(text, str(error))}") from error
    except RecursionError as error:
        raise FormatError(f"{name} is not a TOML file: it is nested too deeply.") from error
    except (tomlkit.exceptions.TOMLKitError, ValueError, TypeError, KeyError) as error:
        raise FormatError(f"{name} is not a TOML file: {error}.") from error


def _explain(text: str, fault: str) -> str:
    place = _PLACE.search(fault)
    if place is None or not _TWICE.match(fault):
        return f" is not a TOML file: {fault}."
    lines = text.splitlines()
    line = int(place[1] or len(lines))
    written = lines[line - 1]
    key = re.match(r"\s*(\[+[^\]]*\]+|[^=]*?)\s*(=|$|#)", written)
    word = key[1] if key and key[1] else written.strip()
    return f", line {line}: the key {word} stands twice; remove one of the two."
