"""Where a scan comes from: what was typed, the record of the calibration, and when."""

import json
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ..io.rig_toml import read_tables

_LEFT_OUT = ("covariance", "before")
"""Parts of a record that no reader of a report asks for; the rig has the covariance."""


def tell_origin(rig_file: Path | None, command: Sequence[str]) -> dict[str, Any]:
    """Say what goes into scan.json of the rig's file and of the command; nothing unknown.

    Args:
        rig_file: The file of the rig.
        command: The words that were typed after `murkscan`.

    Raises:
        FormatError: The rig's file is missing or no TOML.
    """
    origin: dict[str, Any] = {"command": list(command)} if command else {}
    if rig_file is not None:
        record = _trim(read_tables(rig_file).get("calibration", {}))
        origin["rig_file"] = str(rig_file)
        origin["calibration"] = json.loads(json.dumps(record, default=str))  # dates as text
    return origin


def name_recording(path: Path) -> str:
    """Name a recording by its file or folder; one that is called frames by what it belongs to."""
    above = path.parent.name
    return above if path.name == "frames" and above not in ("", "..") else path.name


def when_written(path: Path) -> str | None:
    """Tell when a recording's file, or the last one of its folder, was written; None if unknown."""
    try:
        files = list(path.iterdir()) if path.is_dir() else [path]
        last = max((file.stat().st_mtime for file in files), default=None)
    except OSError:
        return None
    if last is None:
        return None
    return datetime.fromtimestamp(last, UTC).isoformat(timespec="seconds")


def _trim(record: dict[str, Any]) -> dict[str, Any]:
    return {
        name: _trim(value) if isinstance(value, dict) else value
        for name, value in record.items()
        if name not in _LEFT_OUT
    }
