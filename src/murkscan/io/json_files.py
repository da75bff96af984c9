"""JSON: settings, counts and other small things."""

import json
from pathlib import Path
from typing import Any

from ..errors import FormatError
from .atomic import replacing


def save_json(path: Path, content: dict[str, Any]) -> None:
    """Write a dictionary of plain values.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
    with replacing(path) as aside:
        aside.write_text(text + "\n", "utf-8")


def load_json(path: Path) -> dict[str, Any]:
    """Read what `save_json` wrote.

    Raises:
        FormatError: The file is no JSON, or not a dictionary.
    """
    try:
        content = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise FormatError(f"{path} cannot be read as JSON; delete it and run again.") from error
    if not isinstance(content, dict):
        raise FormatError(f"{path} is not what murkscan writes; delete it and run again.")
    return content
