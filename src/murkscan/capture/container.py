"""A video file as FFmpeg opens it: the file itself, and nothing that it names."""

import re
from collections.abc import Iterator
from functools import cache
from itertools import pairwise
from pathlib import Path
from statistics import median
from typing import Any

import av
from av.format import ContainerFormat

from ..errors import FormatError, InputError

_REFERRING = frozenset(
    [
        "concat",
        "dash",
        "hls",
        "image2",
        "image2pipe",
        "imf",
        "rtp",
        "rtsp",
        "sap",
        "sdp",
        "smoothstreaming",
        "vobsub",
        "webm_dash_manifest",
    ]
)
"""Formats that name other files or addresses, which FFmpeg would read."""
_NO_FILE = 0x0001
"""FFmpeg's flag of a format that is no file, but a device (AVFMT_NOFILE)."""
_DOORS = (
    (re.compile(rb"#EXTM3U"), "a playlist (m3u8)"),
    (re.compile(rb"ffconcat version"), "a list of files (ffconcat)"),
    (re.compile(rb"<\?xml.{0,400}<MPD\b|<MPD\b", re.DOTALL), "a DASH manifest"),
    (re.compile(rb"v=0\r?\n"), "a description of a stream (SDP)"),
    (re.compile(rb"\[(playlist|Reference)\]", re.IGNORECASE), "a playlist"),
)
"""How files begin that only say where pictures are."""
_SUFFIXES = {
    ".m3u8": "a playlist",
    ".m3u": "a playlist",
    ".pls": "a playlist",
    ".ffconcat": "a list of files",
    ".mpd": "a DASH manifest",
    ".sdp": "a description of a stream",
}
_HEAD = 1024
"""Bytes of a file in which it says what it is."""


def open_video(path: Path) -> Any:
    """Open a video file as PyAV's container; close it after use.

    Only the file itself is read: what names other files or addresses is refused before FFmpeg
    sees it, and FFmpeg may use neither a network nor a format that does so.

    Raises:
        InputError: It is no file, but a pipe or a device.
        FormatError: It is a playlist or describes a stream, FFmpeg does not know it, or it holds
            no moving pictures.
    """
    _refuse_doors(path)
    try:
        container = av.open(
            f"file:{path}",  # Without "file:" a colon in the name means a protocol.
            options={"protocol_whitelist": "file", "format_whitelist": _formats()},
            metadata_errors="replace",  # Cameras write their names in any alphabet.
        )
    except (av.error.FFmpegError, OSError) as error:
        raise FormatError(
            f"{path} cannot be read as a video ({error.strerror}). If it was cut off while it was "
            "recorded, repair it with a video tool, or record into .mkv, which bears a cut."
        ) from error
    kind = container.format.name
    is_picture = kind.startswith("image") or kind.endswith("_pipe")
    if not container.streams.video or kind == "tty" or is_picture:
        container.close()
        raise FormatError(f"{path} holds no video; give a video file or a folder of pictures.")
    container.streams.video[0].thread_type = "AUTO"
    return container


def is_avi(container: Any) -> bool:
    """Tell whether a file places its pictures by their number, as AVI does, not by their time."""
    return container.format.name == "avi"


def picture_ticks(container: Any) -> int:
    """Give how many places of an AVI a picture takes; 0 for other files, and without an index.

    A place without data is a picture that the recorder dropped; only where the places are finer
    than the pictures, most of them are empty.
    """
    if not is_avi(container):
        return 0
    places = [entry.timestamp for entry in container.streams.video[0].index_entries]
    return max(round(median(b - a for a, b in pairwise(places))), 0) if len(places) > 1 else 0


def demux_video(container: Any) -> Iterator[Any]:
    """Give the packets of the pictures from the present place on.

    In AVI a packet's time is that of its place: FFmpeg's guess of when it is shown is wrong where
    pictures are reordered.

    Raises:
        av.error.FFmpegError: The file is damaged there.
    """
    for packet in container.demux(container.streams.video[0]):
        if is_avi(container) and packet.dts is not None:
            packet.pts = packet.dts
        yield packet


def _refuse_doors(path: Path) -> None:
    """Refuse what is no file, and a file that only says where pictures are."""
    if not path.is_file():
        raise InputError(
            f"{path} is neither a file nor a folder; record what comes out of a pipe or a device "
            "first, with murkscan capture."
        )
    with path.open("rb") as file:
        head = file.read(_HEAD).lstrip(b"\xef\xbb\xbf \t\r\n")
    kind = _SUFFIXES.get(path.suffix.lower())
    kind = next((name for form, name in _DOORS if form.match(head)), kind)
    if kind is not None:
        raise FormatError(
            f"{path} is {kind} and holds no pictures itself: give the video file that it names, "
            "or record the stream first with 'murkscan capture ADDRESS dive.mkv'."
        )


@cache
def _formats() -> str:
    """List the formats that FFmpeg may open: those that are read and name nothing else."""
    return ",".join(name for name in sorted(av.formats_available) if _is_closed(name))


def _is_closed(name: str) -> bool:
    try:
        form = ContainerFormat(name, "r")
    except ValueError:
        return False
    return not (form.flags & _NO_FILE or _REFERRING & set(name.split(",")))
