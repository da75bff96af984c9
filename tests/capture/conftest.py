"""Recordings made on the spot."""

import threading
import time
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest

from murkscan.io.images import write_image


@pytest.fixture(scope="session")
def write_video() -> Callable[..., Path]:
    """Encode grey pictures; by default without loss, in plain grey."""

    def write(
        path: Path,
        pictures: Sequence[np.ndarray],
        *,
        codec: str = "ffv1",
        given: str = "gray",
        kept: str = "gray",
        height: int | None = None,
        times: Sequence[int] | None = None,
        options: dict[str, str] | None = None,
        title: str | None = None,
        ticks: int = 1000,
    ) -> Path:
        with av.open(str(path), "w") as container:
            if title:
                container.metadata["title"] = title
            stream = container.add_stream(codec, rate=25)
            stream.height, stream.width = height or pictures[0].shape[0], pictures[0].shape[1]
            stream.pix_fmt = kept
            stream.codec_context.time_base = Fraction(1, ticks)
            stream.codec_context.options = options or {}
            for number, picture in enumerate(pictures):
                frame = av.VideoFrame.from_ndarray(picture, given).reformat(format=kept)
                frame.pts = times[number] if times else ticks // 25 * number
                frame.time_base = Fraction(1, ticks)
                container.mux(stream.encode(frame))
            container.mux(stream.encode())
        return path

    return write


@pytest.fixture(scope="session")
def write_clocked() -> Callable[[Path, Sequence[np.ndarray], Sequence[int]], Path]:
    """Encode grey pictures with any times [ms], even such as no encoder would accept."""

    def write(path: Path, pictures: Sequence[np.ndarray], times: Sequence[int]) -> Path:
        with av.open(str(path), "w") as container:
            stream = container.add_stream("ffv1", rate=25)
            stream.height, stream.width = pictures[0].shape
            stream.pix_fmt = "gray"
            # No picture leans on another, and each has a checksum.
            stream.codec_context.options = {"g": "1", "level": "3", "slicecrc": "1"}
            for number, (picture, time) in enumerate(zip(pictures, times, strict=True)):
                (packet,) = stream.encode(av.VideoFrame.from_ndarray(picture, "gray"))
                # Decoding times must grow and come first; Matroska does not keep them.
                packet.pts, packet.dts, packet.time_base = time, number, Fraction(1, 1000)
                container.mux(packet)
        return path

    return write


@pytest.fixture(scope="session")
def write_folder() -> Callable[[Path, Sequence[np.ndarray]], Path]:
    """Write pictures as PNG files of a folder."""

    def write(path: Path, pictures: Sequence[np.ndarray]) -> Path:
        for number, picture in enumerate(pictures):
            write_image(path / f"picture{number}.png", picture)
        return path

    return write


@pytest.fixture
def sending() -> Iterator[Callable[[str, str], threading.Thread]]:
    """Send a small stream of 25 pictures a second to an address until the test ends."""
    done = threading.Event()
    threads: list[threading.Thread] = []

    def send(url: str, form: str) -> None:
        with av.open(url, "w", format=form) as container:
            stream = container.add_stream("libx264", rate=25)
            stream.width, stream.height, stream.pix_fmt = 320, 240, "yuv420p"
            stream.codec_context.options = {
                "g": "10",
                "tune": "zerolatency",
                "preset": "ultrafast",
            }
            number, began = 0, time.monotonic()
            while not done.is_set() and number < 500:
                picture = np.full((240, 320), 20, np.uint8)
                picture[:, 10 + number % 300 : 14 + number % 300] = 200
                frame = av.VideoFrame.from_ndarray(picture, "gray").reformat(format="yuv420p")
                frame.pts = number
                container.mux(stream.encode(frame))
                number += 1
                time.sleep(max(0.0, began + number / 25 - time.monotonic()))

    def start(url: str, form: str) -> threading.Thread:
        threads.append(threading.Thread(target=send, args=(url, form), daemon=True))
        threads[-1].start()
        return threads[-1]

    yield start
    done.set()
    for thread in threads:
        thread.join(5)
