"""Copying a network stream into a file as it comes, with its times."""

import time
from collections.abc import Callable, Generator, Iterator
from contextlib import closing
from fractions import Fraction
from pathlib import Path
from typing import Any

import av

from ..errors import InputError, StreamLost
from .coded import CodedPicture, PictureCodec, Tap, tell_nobody
from .growing import TICKS, RecordingProgress, growing_video

_OPTIONS = {
    "protocol_whitelist": "file,crypto,data,udp,rtp,rtsp,rtmp,srtp,srt,tcp,tls,http,https",
    "analyzeduration": "10000000",  # [µs]: some cameras send a keyframe only every ten seconds
    "probesize": "50000000",
    "buffer_size": "4000000",  # [bytes]: a keyframe comes as a burst
    "fifo_size": "100000",
    "overrun_nonfatal": "1",
}


def is_stream(source: str) -> bool:
    """Tell whether a source is a network stream: an address, or a file that describes one."""
    return "://" in source or source.lower().endswith(".sdp")


def copy_stream(
    source: str,
    out: Path,
    *,
    seconds: float | None = None,
    timeout: float = 10.0,
    begin: Callable[[], float] = lambda: 0.0,
    tap: Tap = tell_nobody,
) -> Generator[RecordingProgress, None, None]:
    """Copy a stream's video packet by packet into a Matroska file, without decoding it.

    The copy begins at the first keyframe, which gets the time 0. Closing the iterator, or an
    interrupt, ends the recording and leaves a file that plays.

    Args:
        source: An address (udp://, rtp://, rtsp:// …) or an SDP file.
        out: Where the file shall be; nothing may stand there.
        seconds: Length of the recording [s]; without it, to the end of the stream.
        timeout: Longest wait for the stream, and for its next picture [s].
        begin: Asked once, when the first picture comes: the time that it shall have [s].
        tap: Given each picture's data, too, for who wants to see them while they come.

    Yields:
        What is written so far, after each packet.

    Raises:
        InputError: The SDP file is missing, or a file stands at `out`.
        StreamLost: No stream comes, or it stops; what came is kept.
        DeviceError: The disk is full; what came is kept.
    """
    check_description(source)
    with growing_video(out) as container, closing(_open(source, timeout)) as stream:
        video = stream.streams.video[0]
        target = container.add_stream_from_template(video)
        codec = PictureCodec.of(video.codec_context)
        timeline, frames, size, first = StreamTimes(), 0, 0, 0
        for packet in _packets(stream, source, timeout):
            first = first if frames else round(begin() * TICKS)
            _place(packet, timeline, first)
            if seconds is not None and packet.pts - first >= seconds * TICKS:
                return
            tap(CodedPicture.of(packet, codec))
            packet.stream = target
            frames, size, last = frames + 1, size + packet.size, packet.pts
            container.mux(packet)
            yield RecordingProgress(frames, last / TICKS, size)


def check_description(source: str) -> None:
    """Refuse an SDP file that is not there.

    Raises:
        InputError: It is not.
    """
    if is_stream(source) and "://" not in source and not Path(source).exists():
        raise InputError(f"There is no SDP file {source}; save the one that the camera offers.")


def _open(source: str, timeout: float) -> Any:
    """Open a stream; where nothing has come for as long as FFmpeg looks, it looks again."""
    until = time.monotonic() + timeout
    while True:
        stream = _look_once(source, timeout)
        if stream.streams.video and stream.streams.video[0].width:
            return stream
        stream.close()
        if not stream.streams.video or time.monotonic() > until:
            raise StreamLost(
                f"No video that can be understood comes from {source} within {timeout:g} s; check "
                "that it is the address of the picture, that the camera is sending to this machine "
                "and this port, and let it send keyframes more often."
            )


def _look_once(source: str, timeout: float) -> Any:
    name = source if "://" in source else f"file:{source}"
    try:
        return av.open(
            name, options=_OPTIONS, timeout=(timeout, timeout), metadata_errors="replace"
        )
    except (av.error.FFmpegError, OSError) as error:
        raise _silence(source, timeout, error) from error


def _silence(source: str, timeout: float, error: Any) -> StreamLost:
    if isinstance(error, av.error.InvalidDataError) and source.lower().endswith(".sdp"):
        return StreamLost(
            f"{source} is no description of a stream; save the SDP file that the camera offers, "
            "which begins with v=0."
        )
    why = "" if isinstance(error, av.error.ExitError) else f" ({error.strerror})"
    return StreamLost(
        f"No stream comes from {source} within {timeout:g} s{why}; check that the camera is "
        "sending to this machine and this port, and that no firewall blocks it."
    )


def _packets(stream: Any, source: str, timeout: float) -> Iterator[Any]:
    """Give the video's packets from the first keyframe on."""
    began, has_begun = time.monotonic(), False
    try:
        for packet in stream.demux(stream.streams.video[0]):
            if packet.size == 0:
                continue
            has_begun = has_begun or packet.is_keyframe
            if has_begun:
                yield packet
            elif time.monotonic() - began > timeout:
                raise StreamLost(
                    f"{source} sent no keyframe within {timeout:g} s; let the camera send them "
                    "more often."
                )
    except av.error.FFmpegError as error:
        silent = isinstance(error, av.error.ExitError)
        why = f"sent nothing for {timeout:g} s" if silent else f"broke off ({error.strerror})"
        raise StreamLost(f"The stream {source} {why}; what came until then is kept.") from error


class StreamTimes:
    """A recording's times: from 0, always growing, in ticks of the file."""

    _JUMP = TICKS
    """A step back by more than this is a sender that began anew."""

    def __init__(self) -> None:
        self._base: float | None = None
        self._last = -1
        self._step = TICKS // 25

    def place(self, presented: float | None, decoded: float | None) -> tuple[int, int]:
        """Turn a packet's times [s] into times of presentation and of decoding [ticks].

        Order and spacing are the stream's own. A packet without a time follows the last one.
        """
        known = decoded if decoded is not None else presented
        if known is None:
            known = 0.0 if self._base is None else (self._base + self._last + self._step) / TICKS
        if self._base is None:
            self._base = known * TICKS
        if known * TICKS - self._base < self._last - self._JUMP:
            self._base = known * TICKS - self._last - self._step
        ticks = round(known * TICKS - self._base)
        if ticks > self._last >= 0:
            self._step = min(ticks - self._last, TICKS)
        self._last = max(ticks, self._last + 1)
        ahead = 0 if presented is None else round(presented * TICKS - self._base)
        return max(ahead, self._last), self._last


def _place(packet: Any, timeline: StreamTimes, first: int) -> None:
    base = packet.time_base
    presented, decoded = (
        None if ticks is None else float(ticks * base) for ticks in (packet.pts, packet.dts)
    )
    placed = timeline.place(presented, decoded)
    if packet.duration:
        packet.duration = round(packet.duration * base * TICKS)
    packet.pts, packet.dts = first + placed[0], first + placed[1]
    packet.time_base = Fraction(1, TICKS)
