"""By which names a dive's recording is known; light, so that a command line can ask early."""

from pathlib import Path
from typing import Literal

DiveKind = Literal["MCAP", "bag of ROS 1", "bag of ROS 2", "tlog"]
KINDS: dict[str, DiveKind] = {
    ".mcap": "MCAP",
    ".bag": "bag of ROS 1",
    ".active": "bag of ROS 1",
    ".db3": "bag of ROS 2",
    ".tlog": "tlog",
}
METADATA = "metadata.yaml"
"""The file by which a folder is a bag of ROS 2."""


def is_dive(path: Path) -> bool:
    """Tell by its name whether a file, or a folder by what lies in it, is a dive's recording."""
    if path.is_dir():
        return (path / METADATA).is_file()
    return path.suffix.lower() in KINDS
