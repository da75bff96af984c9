"""murkscan capture: record a stream or a camera."""

from collections.abc import Generator, Iterator
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter, validators
from cyclopts.types import PositiveFloat

from .words import tell

if TYPE_CHECKING:
    from ..capture import RecordingProgress


def capture(
    source: str,
    out: Path,
    *,
    seconds: PositiveFloat | None = None,
    timeout: Annotated[
        PositiveFloat, Parameter(name="--timeout-s", validator=validators.Number(lte=86400))
    ] = 10.0,
) -> None:
    """Record a stream or a camera into a file, as it comes.

    A network stream is copied with its times, without a new encoding; a camera at this machine is
    recorded without loss. Ctrl-C ends the recording and leaves a file that plays.

    Parameters
    ----------
    source
        An address (udp://, rtp://, rtsp:// ...), an SDP file, or a camera: its number, or
        /dev/video and its number.
    out
        The file to write, ending in .mkv; nothing may stand there.
    seconds
        Length of the recording [s], unless Ctrl-C or the end of the stream comes first.
    timeout
        Longest wait for the stream and for its next picture [s].
    """
    from contextlib import closing

    last: RecordingProgress | None = None
    ending = ""
    try:
        with closing(_start(source, out, seconds, timeout)) as recording:
            for recorded in _show(recording):
                last = recorded
    except KeyboardInterrupt:
        # Stopping by hand is how a recording ends, and no failure, even before --seconds are over.
        ending = "; stopped by hand, and whole up to there"
        if last is None:
            tell("made", f"nothing: no picture had come when it was stopped, {out} is not written")
    finally:
        if last is not None:
            tell("made", f"{_describe(last)}: {out}{ending}")
            tell("next", f"murkscan scan {quote(str(out))} --rig RIG --speed-mm-s V --out SCAN")


def _start(
    source: str, out: Path, seconds: float | None, timeout: float
) -> Generator["RecordingProgress", None, None]:
    """Choose how to record a source."""
    from ..capture import camera_images, copy_stream, is_camera, is_stream, record_images
    from ..errors import InputError

    if is_stream(source):
        return copy_stream(source, out, seconds=seconds, timeout=timeout)
    if is_camera(source):
        return record_images(camera_images(source), out, seconds=seconds)
    if Path(source).exists():
        raise InputError(
            f"{source} lies here already, and is no stream: murkscan scan reads recordings itself."
        )
    raise InputError(
        f"{source} is no stream and no camera; give an address such as udp://0.0.0.0:5600, an SDP "
        "file, or a camera's number. No file of that name is here either."
    )


def _show(recording: Iterator["RecordingProgress"]) -> Iterator["RecordingProgress"]:
    """Keep a line on the terminal that tells how far the recording is."""
    from rich.console import Console

    with Console(stderr=True).status("waiting for the first picture ...") as line:
        for recorded in recording:
            line.update(f"recording: {_describe(recorded)}; Ctrl-C ends it")
            yield recorded


def _describe(recorded: "RecordingProgress") -> str:
    rate = recorded.bytes * 8e-6 / recorded.seconds if recorded.seconds else 0.0
    return f"{recorded.frames} frames, {recorded.seconds:.1f} s, {rate:.1f} Mbit/s"
