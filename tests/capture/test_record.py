"""Pictures recorded without loss, whatever ends the recording."""

import os
import signal
import subprocess
import sys
import time
from contextlib import closing

import numpy as np
import pytest

from murkscan.capture import is_camera, open_recording, record_images
from murkscan.capture.container import open_video
from murkscan.capture.decode import Picture, decode_pictures
from murkscan.errors import DeviceError, InputError

RANDOM = np.random.default_rng(11)


def camera(shape, depth=np.uint8, count=20):
    """A camera that sends random pictures at uneven times, by any clock."""
    times = 1000 + np.cumsum(RANDOM.integers(5, 90, count)) / 1000
    top = np.iinfo(depth).max
    return [(RANDOM.integers(0, top + 1, shape, dtype=depth), float(time)) for time in times]


@pytest.mark.parametrize("depth", [np.uint8, np.uint16])
def test_grey_pictures_come_back_bit_by_bit_with_their_times(tmp_path, depth):
    images = camera((41, 50), depth)
    *_, last = record_images(images, tmp_path / "a.mkv")
    frames = list(open_recording(tmp_path / "a.mkv", fields="progressive").frames())
    assert last.frames == len(frames) == 20
    for frame, (image, moment) in zip(frames, images, strict=True):
        assert frame.image.dtype == depth
        np.testing.assert_array_equal(frame.image, image)
        # Matroska keeps whole milliseconds, and these are some.
        assert frame.time == pytest.approx(moment - images[0][1], abs=1e-6)


def test_colour_pictures_come_back_bit_by_bit(tmp_path):
    images = camera((40, 48, 3))
    list(record_images(images, tmp_path / "a.mkv"))
    with closing(open_video(tmp_path / "a.mkv")) as container:
        pictures = [p for p in decode_pictures(container) if isinstance(p, Picture)]
        for picture, (image, _) in zip(pictures, images, strict=True):
            np.testing.assert_array_equal(picture.decoded.to_ndarray(format="rgb24"), image)


def test_it_stops_after_the_time_asked_for(tmp_path):
    images = [(np.zeros((40, 48), np.uint8), n / 10) for n in range(100)]
    *_, last = record_images(images, tmp_path / "a.mkv", seconds=2.0)
    assert last.frames == 20
    assert len(list(open_recording(tmp_path / "a.mkv").frames())) == 20


def test_a_camera_that_fails_leaves_what_came(tmp_path):
    def failing():
        yield from camera((40, 48), count=5)
        raise DeviceError("Camera 0 stopped sending; check its cable.")

    with pytest.raises(DeviceError, match="cable"):
        list(record_images(failing(), tmp_path / "a.mkv"))
    assert len(list(open_recording(tmp_path / "a.mkv").frames())) == 5


def test_pictures_that_change_their_size_end_the_recording(tmp_path):
    images = [*camera((40, 48), count=3), (np.zeros((30, 48), np.uint8), 2000.0)]
    with pytest.raises(DeviceError, match="from 48 x 40 to 48 x 30"):
        list(record_images(images, tmp_path / "a.mkv"))
    assert len(list(open_recording(tmp_path / "a.mkv").frames())) == 3


def test_a_camera_that_sends_nothing_leaves_nothing(tmp_path):
    assert list(record_images([], tmp_path / "a.mkv")) == []
    assert list(tmp_path.iterdir()) == []


def test_what_stands_there_is_not_overwritten(tmp_path):
    (tmp_path / "a.mkv").write_text("precious")
    with pytest.raises(InputError, match="exists already"):
        list(record_images(camera((40, 48)), tmp_path / "a.mkv"))
    assert (tmp_path / "a.mkv").read_text() == "precious"


ENDLESS = """
import itertools, sys, time
from pathlib import Path
import numpy as np
from murkscan.capture import record_images
images = ((np.full((40, 48), n % 256, np.uint8), n / 25) for n in itertools.count())
for written in record_images(images, Path(sys.argv[1])):
    print(written.frames, flush=True)
    time.sleep(0.002)
"""


@pytest.mark.skipif(os.name == "nt", reason="signals are sent as on POSIX systems")
@pytest.mark.parametrize("end", ["SIGINT", "SIGKILL"])
def test_a_recording_that_is_stopped_or_killed_plays(tmp_path, end):
    out = tmp_path / "a.mkv"
    process = subprocess.Popen(
        [sys.executable, "-c", ENDLESS, str(out)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    )
    while int(process.stdout.readline()) < 200:
        pass
    process.send_signal(getattr(signal, end))
    process.communicate(timeout=20)
    part = tmp_path / "a.part.mkv"
    left = out if end == "SIGINT" else part
    assert list(tmp_path.iterdir()) == [left]
    frames = list(open_recording(left).frames())
    # A kill may cost what was not yet handed to the disk: up to the last two seconds.
    assert len(frames) >= (200 if end == "SIGINT" else 150)
    assert [frame.image[0, 0] for frame in frames] == [n % 256 for n in range(len(frames))]


@pytest.mark.skipif(os.name == "nt", reason="a limit on file sizes is a matter of POSIX systems")
def test_a_full_disk_is_told_and_leaves_what_came(tmp_path):
    limit = "import resource, signal; signal.signal(signal.SIGXFSZ, signal.SIG_IGN);"
    limit += "resource.setrlimit(resource.RLIMIT_FSIZE, (60000, 60000));"
    noise = "r = np.random.default_rng(0)\n"
    code = limit + ENDLESS.replace("images =", noise + "images =").replace(
        "np.full((40, 48), n % 256, np.uint8)", "r.integers(0, 256, (40, 48), dtype=np.uint8)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "a.mkv")], capture_output=True, timeout=60
    )
    assert b"DeviceError: Cannot write" in done.stderr
    (left,) = tmp_path.iterdir()
    assert left.name == "a.part.mkv"
    assert len(list(open_recording(left).frames())) > 10


@pytest.mark.parametrize(
    ("source", "answer"),
    [("0", True), ("/dev/video2", True), ("udp://1", False), ("a.mkv", False), ("1.5", False)],
)
def test_cameras_are_known_by_their_names(source, answer):
    assert is_camera(source) is answer


COMMAND = "from murkscan.cli import main; main()"


@pytest.mark.skipif(os.name == "nt", reason="signals are sent as on POSIX systems")
@pytest.mark.parametrize("length", [[], ["--seconds", "600"]], ids=["open", "timed"])
def test_ctrl_c_ends_the_command_with_a_file_that_plays(tmp_path, sending, length):
    out = tmp_path / "dive.mkv"
    sending("udp://127.0.0.1:45122?pkt_size=1316", "mpegts")
    process = subprocess.Popen(
        [sys.executable, "-c", COMMAND, "capture", "udp://127.0.0.1:45122", str(out), *length],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    part, deadline = tmp_path / "dive.part.mkv", time.monotonic() + 20
    while time.monotonic() < deadline and not (part.exists() and part.stat().st_size > 8000):
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    said, complained = process.communicate(timeout=20)
    assert process.returncode == 0
    assert [line.split()[0] for line in said.splitlines()] == ["made", "next"]
    assert "murkscan:" not in complained
    frames = list(open_recording(out).frames())
    assert len(frames) > 10
    assert f"{len(frames)} frames" in said
