"""The recordings of `studio.py`, and the streams that they are sent as."""

import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path

import av

from murkscan.io.images import read_image

RATE = 25
SDP = """v=0
o=- 0 0 IN IP4 127.0.0.1
s=camera
c=IN IP4 127.0.0.1
t=0 0
m=video {port} RTP/AVP 96
a=rtpmap:96 H264/90000
a=fmtp:96 packetization-mode=1
"""
DIVE = """format = 1

[[object]]
mesh = "sphere"
radius_mm = 60.0
position_mm = [0.0, 300.0, 640.0]

[[object]]
mesh = "plane"
width_mm = 3000.0
height_mm = 3000.0
position_mm = [0.0, 0.0, 760.0]

[surface]
albedo = 0.2

[water]
index = 1.0
attenuation_per_m = 1.5

[rig]
format = 1

[rig.camera]
size = [720, 576]
focal_length = [554.0, 554.0]
principal_point = [359.5, 287.5]
distortion = [-0.15, 0.05, 0.0005, -0.0003, 0.0]

[[rig.laser]]
kind = "baseline_angle"
baseline_mm = 250.0
angle_deg = 67.0
axis = "y"

[sensor]
peak_grey = 200

[motion]
frames = 300
speed_mm_s = 40.0
frame_rate_hz = 25.0
"""
"""The camera and the laser of the boards' scenes before a ball; air that is as murky as water, so
that what was calibrated in air holds."""


def make_recordings(folder: Path) -> None:
    """Simulate the boards, the boards with the laser's line, and the dive."""
    folder.mkdir()
    (folder / "dive.toml").write_text(DIVE)
    for scene, out in (
        ("chessboard", "boards"),
        ("chessboard-laser", "lines"),
        ("dive.toml", "dive"),
    ):
        words = [sys.executable, "-m", "murkscan", "simulate", scene, out]
        subprocess.run(words, cwd=folder, check=True, capture_output=True)


class Streams:
    """Sends recordings as H.264 by RTP to ports of this machine."""

    def __init__(self, folder: Path) -> None:
        """Take the folder with the recordings."""
        self._folder = folder
        self._done = threading.Event()

    def __enter__(self) -> "Streams":
        """Begin; nothing is sent yet."""
        return self

    def __exit__(self, *_: object) -> None:
        """End what is still being sent."""
        self._done.set()

    @contextmanager
    def sending(
        self, name: str, port: int, *, hold: float = 1 / RATE, once: bool = False
    ) -> Iterator[threading.Thread]:
        """Send a recording, each picture for some time [s]; over and over unless once."""
        self._done = threading.Event()
        arguments = (sorted((self._folder / name / "frames").glob("*.png")), port, hold, once)
        sender = threading.Thread(target=self._send, args=arguments, daemon=True)
        sender.start()
        try:
            yield sender
        finally:
            self._done.set()
            sender.join()

    def _send(self, files: list[Path], port: int, hold: float, once: bool) -> None:
        pictures = [read_image(file) for file in files]
        repeats = max(round(hold * RATE), 1)
        with av.open(f"rtp://127.0.0.1:{port}?pkt_size=1200", "w", format="rtp") as container:
            stream = container.add_stream("libx264", rate=RATE)
            stream.height, stream.width = pictures[0].shape[:2]
            stream.pix_fmt = "yuv420p"
            stream.codec_context.options = {
                "g": "10", "tune": "zerolatency", "preset": "ultrafast", "crf": "16",
            }  # fmt: skip
            number, began = 0, time.monotonic()
            while not self._done.is_set():
                turn = number // repeats
                if once and turn >= len(pictures):
                    return
                picture = pictures[turn % len(pictures)]
                frame = av.VideoFrame.from_ndarray(picture, "gray").reformat(format="yuv420p")
                frame.pts, frame.time_base = number, Fraction(1, RATE)
                container.mux(stream.encode(frame))
                number += 1
                time.sleep(max(0.0, began + number / RATE - time.monotonic()))
