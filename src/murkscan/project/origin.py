"""Where a scan comes from: what was typed, the record of the calibration, and when."""

import json
from datetime import UTC, datetime
from pathlib import Path, PurePath
from typing import Any

from ..io.rig_toml import read_tables

_LEFT_OUT = ("covariance", "before")
"""Parts of a record that no reader of a report asks for; the rig has the covariance."""


def read_calibration(rig_file: Path) -> dict[str, Any]:
    """Read what a rig's file says of its calibration, without its bulk; dates as text.

    Raises:
        FormatError: The file is missing or no TOML.
    """
    record = _trim(read_tables(rig_file).get("calibration", {}))
    return json.loads(json.dumps(record, default=str))


def name_recording(path: PurePath) -> str:
    """Name a recording by its file or folder; one that is called frames by what it belongs to."""
    above = path.parent.name
    return above if path.name == "frames" and above not in ("", "..") else path.name


def when_written(path: Path) -> datetime | None:
    """Tell when a recording's file, or the last one of its folder, was written; None if unknown."""
    try:
        files = list(path.iterdir()) if path.is_dir() else [path]
        last = max((file.stat().st_mtime for file in files), default=None)
    except OSError:
        return None
    return None if last is None else datetime.fromtimestamp(last, UTC)


def _trim(record: dict[str, Any]) -> dict[str, Any]:
    return {
        name: _trim(value) if isinstance(value, dict) else value
        for name, value in record.items()
        if name not in _LEFT_OUT
    }
