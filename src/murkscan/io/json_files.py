"""JSON: settings, counts and other small things."""

import json
from pathlib import Path
from typing import Any

from ..errors import FormatError, InputError
from .atomic import replacing


def save_json(path: Path, content: dict[str, Any]) -> None:
    """Write a dictionary of plain values.

    Raises:
        InputError: A number is not finite.
        DeviceError: The disk is full or cannot be written.
    """
    try:
        text = json.dumps(content, indent=2, allow_nan=False)
    except ValueError as error:
        raise InputError(
            f"A number that belongs into {path} is not finite; check the rig, the motion and the "
            "settings for absurd values."
        ) from error
    with replacing(path) as aside:
        aside.write_text(text + "\n", "utf-8")


def load_json(path: Path) -> dict[str, Any]:
    """Read what `save_json` wrote.

    Raises:
        FormatError: The file is no JSON, or not a dictionary.
    """
    try:
        content = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise FormatError(f"{path} cannot be read as JSON; delete it and run again.") from error
    if not isinstance(content, dict):
        raise FormatError(f"{path} is not what murkscan writes; delete it and run again.")
    return content
