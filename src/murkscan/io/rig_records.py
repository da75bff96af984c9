"""The rig files that calibrations left, each kept as it was: no later step changes them."""

import datetime
from pathlib import Path

from ..errors import InputError
from .atomic import replacing

_FOLDER = Path("calibrate") / "records"
_READ_ONLY = 0o444


def is_rig_record(path: Path) -> bool:
    """Tell by its place whether a file is a record of a calibration, and no rig to work with."""
    return path.parent.parts[-2:] == _FOLDER.parts


def keep_rig_file(path: Path, name: str) -> Path:
    """Keep a rig file as it is, unless the very same one is kept already.

    Args:
        path: The rig file; its records lie in calibrate/records beside it.
        name: What it is, such as the step that wrote it.

    Returns:
        The record: a rig file of its own, which nobody is to change.

    Raises:
        InputError: The rig file is itself a record.
        DeviceError: The disk is full.
    """
    if is_rig_record(path):
        raise InputError(
            f"{path} is a record of a calibration, which no later step changes; copy it to where "
            "your rig file lies, and calibrate that."
        )
    folder, content = path.parent / _FOLDER, path.read_bytes()
    for record in sorted(folder.glob("*.toml")):
        if record.read_bytes() == content:
            return record
    when = f"{datetime.datetime.now(datetime.UTC):%Y%m%dT%H%M%SZ}"
    record, number = folder / f"{when}-{name}.toml", 1
    while record.exists():
        number += 1
        record = folder / f"{when}-{name}-{number}.toml"
    with replacing(record) as aside:
        aside.write_bytes(content)
        aside.chmod(_READ_ONLY)
    return record
