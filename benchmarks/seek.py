"""Start in the middle of an hour of H.264, and say whether it is the right picture."""

import tempfile
import time
from pathlib import Path

import av
import numpy as np
from harness import Figure, tell

from murkscan.capture import open_recording

SIZE, RATE, LOOP, LOOPS = (720, 576), 25, 750, 120
BITS = 10
"""Bars at the top of a picture that show its number in the loop."""
NOTE = """
An hour of PAL-size H.264 (x264 veryfast, two B-frames, a keyframe every ten seconds): thirty
seconds repeated, each picture with its number in it. Opening looks at pictures for fields; the
index is made at the first start that is not the beginning, and is kept. A start is the time to the
first picture; the bar holds for the first one with the index, and for the slowest of the others.
"""


def draw(number: int) -> np.ndarray:
    """Draw a line that moves, and the picture's number in bars."""
    picture = np.full(SIZE[::-1], 30, np.uint8)
    picture[100 + 3 * number % 300 :][:5] = 200
    for bit in range(BITS):
        picture[:16, 16 * bit : 16 * bit + 16] = 255 if number >> bit & 1 else 0
    return picture


def number_in(picture: np.ndarray) -> int:
    """Read the number of a picture."""
    return sum(int(picture[8, 8 + 16 * bit] > 128) << bit for bit in range(BITS))


def encode(path: Path) -> None:
    """Write thirty seconds."""
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=RATE)
        stream.width, stream.height, stream.pix_fmt = *SIZE, "yuv420p"
        stream.codec_context.options = {"preset": "veryfast", "bf": "2", "g": "250"}
        for number in range(LOOP):
            frame = av.VideoFrame.from_ndarray(draw(number), "gray").reformat(format="yuv420p")
            container.mux(stream.encode(frame))
        container.mux(stream.encode())


def repeat(loop: Path, path: Path, *, frames: int = LOOP, turns: int = LOOPS) -> None:
    """Copy the packets again and again, with times that go on."""
    with av.open(str(path), "w") as container:
        stream = None
        for turn in range(turns):
            with av.open(str(loop)) as source:
                video = source.streams.video[0]
                stream = stream or container.add_stream_from_template(video)
                shift = round(turn * frames / RATE / video.time_base)
                for packet in source.demux(video):
                    if packet.size:
                        packet.pts, packet.dts = packet.pts + shift, packet.dts + shift
                        packet.stream = stream
                        container.mux(packet)


def measure(path: Path) -> list[Figure]:
    """Start at nine places; the first start makes the index."""
    began = time.perf_counter()
    recording = open_recording(path)
    opened = time.perf_counter() - began
    times, wrong = [], 0
    for place in [*np.linspace(0.5, 0.99, 9).tolist(), 0.001]:
        start = int(place * LOOP * LOOPS)
        began = time.perf_counter()
        frame = next(iter(recording.frames(start)))
        times.append(time.perf_counter() - began)
        wrong += frame.index != start or number_in(frame.image) != start % LOOP
    kind = path.suffix[1:]
    return [
        Figure(f"{kind}: opening", opened, "s"),
        Figure(f"{kind}: first start, in the middle, with the index", times[0], "s", at_most=1),
        Figure(f"{kind}: later starts, the slowest", max(times[1:]), "s", at_most=1),
        Figure(f"{kind}: wrong pictures", wrong, at_most=0),
    ]


def main() -> None:
    figures = []
    with tempfile.TemporaryDirectory() as folder:
        loop = Path(folder) / "loop.mp4"
        encode(loop)
        for suffix in (".mp4", ".mkv"):
            path = Path(folder) / f"hour{suffix}"
            repeat(loop, path)
            figures += measure(path)
    tell("seek", "Starting in the middle of an hour of video", figures, note=NOTE)


if __name__ == "__main__":
    main()
