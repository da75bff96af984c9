"""Small streams over the loopback interface, and the rig that would see them."""

import socket
import threading
import time
from fractions import Fraction

import av
import numpy as np

from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.rig import Rig

WIDTH, HEIGHT, FIRST = 320, 240, 60
SDP = """v=0
o=- 0 0 IN IP4 127.0.0.1
s=camera
c=IN IP4 127.0.0.1
t=0 0
m=video {port} RTP/AVP 96
a=rtpmap:96 H264/90000
a=fmtp:96 packetization-mode=1
"""


def picture(number: int) -> np.ndarray:
    """A bright line down the picture that moves by a pixel a picture."""
    image = np.full((HEIGHT, WIDTH), 20, np.uint8)
    at = FIRST + number % 150
    image[:, at : at + 4] = 200
    return image


def stream_rig() -> Rig:
    """A camera of that size, with its laser beside it: the line lies 0.2 to 0.6 m away."""
    camera = Camera((WIDTH, HEIGHT), (250.0, 250.0), ((WIDTH - 1) / 2, (HEIGHT - 1) / 2))
    return Rig(camera, (Laser.from_baseline_angle(0.2, np.arctan2(0.5, 0.2), "x"),), 532e-9)


def free_port() -> int:
    """A port that nothing uses; even, as RTP wants it."""
    while True:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.bind(("127.0.0.1", 0))
            number: int = probe.getsockname()[1]
        if number % 2 == 0:
            return number


class Sender:
    """Sends 25 pictures a second as MPEG-TS until it is stopped."""

    def __init__(self, port: int) -> None:
        self._url = f"udp://127.0.0.1:{port}?pkt_size=1316"
        self._done = threading.Event()
        self._thread = threading.Thread(target=self._send, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        self._done.set()
        self._thread.join(10)

    def _send(self) -> None:
        with av.open(self._url, "w", format="mpegts") as container:
            stream = container.add_stream("libx264", rate=25)
            stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT, "yuv420p"
            stream.codec_context.options = {
                "g": "10",
                "tune": "zerolatency",
                "preset": "ultrafast",
            }
            began = time.monotonic()
            for number in range(2000):
                frame = av.VideoFrame.from_ndarray(picture(number), "gray").reformat(
                    format="yuv420p"
                )
                frame.pts, frame.time_base = number, Fraction(1, 25)
                container.mux(stream.encode(frame))
                if self._done.wait(max(0.0, began + number / 25 - time.monotonic())):
                    return
