"""Files and folders that commands are given, looked for before anything heavy is loaded."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from ..errors import FormatError, InputError, MissingResult


def _require_recordings(_: object, paths: tuple[Path, ...]) -> None:
    for path in paths:
        if not path.exists():
            raise InputError(f"There is no recording at {path}; check the spelling of the path.")


def _require_rig(_: object, path: Path) -> None:
    if not path.exists():
        raise FormatError(f"There is no rig file {path}; give one with --rig.")


def _require_log(_: object, path: Path | None) -> None:
    if path is not None and not path.exists():
        raise InputError(f"There is no log at {path}; check the spelling of the path.")


def _require_photos(_: object, path: Path) -> None:
    if not path.exists():
        raise InputError(f"There is no folder or video {path}; give the one with the photos.")


def require_scan(_: object, path: Path | None) -> None:
    """Refuse a folder in which no scan has been begun; none at all is fine.

    Raises:
        MissingResult: It is no scan's.
    """
    if path is not None and not path.exists():
        raise MissingResult(f"There is no folder {path}; check the spelling of the path.")
    if path is not None and not (path / "scan.json").exists():
        raise MissingResult(
            f"{path} holds no scan; run `murkscan scan` or `murkscan extract` into it first."
        )


RecordingPaths = Annotated[tuple[Path, ...], Parameter(validator=_require_recordings, negative=())]
"""A folder of images, a video or its chapters, an MCAP or a bag."""
RigFile = Annotated[Path, Parameter(validator=_require_rig)]
"""A rig file that is there."""
LogPath = Annotated[Path, Parameter(validator=_require_log)]
"""A log of poses."""
MaybeLogPath = Annotated[Path | None, Parameter(validator=_require_log)]
"""The same, which may be left out."""
PhotoPath = Annotated[Path, Parameter(validator=_require_photos)]
"""A folder of photos, or a video."""
ScanFolder = Annotated[Path, Parameter(validator=require_scan)]
"""The folder of a scan that has been begun."""
