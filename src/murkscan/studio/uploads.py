"""Files that a page brings: bounded, whole or not at all, and never over another."""

import shutil
from pathlib import Path

import anyio
from starlette.requests import ClientDisconnect, Request

from ..errors import DeviceError, InputError
from ..io.atomic import replacing
from .sandbox import Sandbox

_KEPT_FREE = 500_000_000
"""Bytes of the disk that are left to recordings."""
_KINDS = {
    ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".pgm", ".mkv", ".mp4", ".mov", ".avi", ".ts",
    ".toml", ".csv", ".txt", ".stl", ".obj", ".ply", ".glb", ".sdp", ".mcap", ".bag", ".tlog",
}  # fmt: skip


async def take_upload(request: Request, sandbox: Sandbox, name: str) -> str:
    """Write what a page sends into the folder.

    Returns:
        Its name there.

    Raises:
        InputError: A file stands there, it is of no kind that commands read, or it is incomplete.
        DeviceError: The disk is nearly full.
    """
    path = sandbox.resolve(name)
    if path.suffix.lower() not in _KINDS:
        raise InputError(f"{path.name} is nothing that murkscan reads; bring pictures, a video, a "
                         "log, a rig file or a drawing.")  # fmt: skip
    if path.exists():
        raise InputError(f"{name} is there already, and nothing is replaced; give another name.")
    _check_room(sandbox.root, int(request.headers.get("content-length", "0")))
    with replacing(path) as aside:
        async with await anyio.open_file(aside, "wb") as file:
            try:
                async for chunk in request.stream():
                    await file.write(chunk)
            except ClientDisconnect as error:
                raise InputError(f"{name} did not come whole; bring it again.") from error
    return sandbox.name(path)


def _check_room(root: Path, size: int) -> None:
    free = shutil.disk_usage(root).free
    if free - size < _KEPT_FREE:
        raise DeviceError(
            f"The disk has {free / 1e6:.0f} MB left, too few for this; make room first."
        )
