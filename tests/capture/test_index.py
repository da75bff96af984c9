"""Started anywhere, a video gives what it gives from there on when it is read whole."""

import numpy as np
import pytest

from murkscan.capture import open_recording
from murkscan.capture.index import index_video

from .test_video import damage_picture, without_data

CODECS = {
    "bframes.mp4": {"codec": "libx264", "kept": "yuv420p", "options": {"g": "12", "bf": "3"}},
    "open_gop.mkv": {
        "codec": "libx264",
        "kept": "yuv420p",
        "options": {"g": "12", "bf": "3", "x264-params": "open-gop=1"},
    },
    "hevc.mkv": {
        "codec": "libx265",
        "kept": "yuv420p",
        "options": {"x265-params": "keyint=12:bframes=3:log-level=none"},
    },
    "bframes.avi": {
        "codec": "libx264",
        "kept": "yuv420p",
        "options": {"g": "12", "bf": "3"},
        "ticks": 25,
    },
    "dropped.avi": {"codec": "mjpeg", "kept": "yuvj420p", "ticks": 25},
    "h264.ts": {"codec": "libx264", "kept": "yuv420p", "options": {"g": "12", "bf": "2"}},
    "damaged.mp4": {"codec": "libx264", "kept": "yuv420p", "options": {"g": "12", "bf": "0"}},
    "one_keyframe.mkv": {"codec": "libx264", "kept": "yuv420p", "options": {"g": "999"}},
    "ffv1.mkv": {},
}


@pytest.fixture(scope="module", params=CODECS)
def path(request, tmp_path_factory, write_video):
    pictures = [np.full((64, 96), 30 + 2 * number, np.uint8) for number in range(60)]
    for number, picture in enumerate(pictures):
        picture[10 + number % 40] = 220
    path = tmp_path_factory.mktemp("video") / request.param
    write_video(path, pictures, **CODECS[request.param])
    if path.stem == "dropped":
        without_data(path, [20, 21, 40])
    if path.stem == "damaged":
        damage_picture(path, 30)
    return path


def read(recording, start):
    skips = []
    frames = list(recording.frames(start, on_skip=skips.append))
    return frames, [(skip.index, skip.count, skip.reason) for skip in skips]


@pytest.mark.parametrize("start", [1, 11, 12, 13, 21, 30, 31, 36, 47, 59])
@pytest.mark.parametrize("fields", ["progressive", "top-first"])
def test_starting_anywhere_gives_the_rest(path, start, fields):
    recording = open_recording(path, fields=fields)
    whole, _ = read(recording, 0)
    frames, skips = read(recording, start)
    wanted = [frame for frame in whole if frame.index >= start]
    assert [frame.index for frame in frames] == [frame.index for frame in wanted]
    for frame, other in zip(frames, wanted, strict=True):
        assert frame.time == pytest.approx(other.time, abs=1e-9)
        np.testing.assert_array_equal(frame.image, other.image)
    missing = set(range(start, recording.num_frames)) - {frame.index for frame in frames}
    assert {k for index, count, _ in skips for k in range(index, index + count)} == missing


def test_the_index_knows_every_time(path):
    index = index_video(path)
    whole = [frame.time for frame in open_recording(path, fields="progressive").frames()]
    assert index is not None
    # Matroska rounds to milliseconds.
    assert all(np.abs(index.times - time).min() < 1e-3 for time in whole)
    assert [index.number_of(time) for time in index.times] == list(range(len(index.times)))
