"""Each way in which a message holds a picture gives that picture."""

import base64

import cv2
import numpy as np
import pytest

from murkscan.errors import FormatError
from murkscan.io.dive.messages import Topic, read_stamp
from murkscan.io.dive.pictures import read_picture
from murkscan.io.dive.series import read_series

TOPIC = Topic("/camera", "sensor_msgs/Image", "ros1")
RANDOM = np.random.default_rng(0)
GREY = RANDOM.integers(0, 256, (6, 8), np.uint8)
COLOUR = RANDOM.integers(0, 256, (6, 8, 3), np.uint8)
DEEP = RANDOM.integers(0, 4096, (6, 8), np.uint16)

RAW = {
    "mono8": (GREY, GREY),
    "mono16": (DEEP, DEEP),
    "rgb8": (COLOUR, COLOUR),
    "bgr8": (COLOUR[:, :, ::-1], COLOUR),
    "bgra8": (np.dstack([COLOUR[:, :, ::-1], GREY]), COLOUR),
    "yuv422": (np.dstack([GREY[::-1], GREY]), GREY),
    "yuv422_yuy2": (np.dstack([GREY, GREY[::-1]]), GREY),
}


@pytest.mark.parametrize("encoding", RAW)
def test_raw_pictures_come_as_they_are(encoding):
    stored, expected = RAW[encoding]
    rows = np.ascontiguousarray(stored).reshape(6, -1).view(np.uint8)
    padded = np.hstack([rows, np.full((6, 4), 77, np.uint8)])  # drivers align their rows
    value = {
        "data": padded.reshape(-1), "encoding": encoding, "width": 8, "height": 6,
        "step": padded.shape[1], "is_bigendian": 0,
    }  # fmt: skip
    np.testing.assert_array_equal(read_picture(TOPIC, value).as_array(), expected)
    if encoding == "mono16":
        swapped = np.ascontiguousarray(stored.byteswap()).reshape(6, -1).view(np.uint8)
        value |= {"data": swapped.reshape(-1), "step": 16, "is_bigendian": 1}
        np.testing.assert_array_equal(read_picture(TOPIC, value).as_array(), expected)
    with pytest.raises(FormatError, match="too few"):
        read_picture(TOPIC, value | {"data": padded.reshape(-1)[:40]}).as_array()


def test_a_bayer_pattern_gives_its_colours():
    mosaic = np.zeros((16, 16), np.uint8)
    mosaic[::2, ::2], mosaic[1::2, 1::2] = 200, 40  # red at the first place, blue beyond
    mosaic[::2, 1::2] = mosaic[1::2, ::2] = 90
    value = {"data": mosaic.reshape(-1), "encoding": "bayer_rggb8", "width": 16, "height": 16}
    image = read_picture(TOPIC, value).as_array()
    np.testing.assert_array_equal(image[4:-4, 4:-4].reshape(-1, 3), [[200, 90, 40]] * 64)


@pytest.mark.parametrize(
    ("form", "codec"),
    [
        ("h264", "h264"), ("H265", "h265"), ("jpeg", "still"),
        ("rgb8; jpeg compressed bgr8", "still"),
        ("16UC1; compressedDepth png", "16UC1; compressedDepth png"), ("theora", "theora"),
    ],
)  # fmt: skip
def test_what_a_compressed_picture_is_follows_from_its_format(form, codec):
    data = base64.b64encode(b"\0\0\1\x67").decode()
    picture = read_picture(
        TOPIC, {"data": data, "format": form, "timestamp": {"sec": 5, "nsec": 7}}
    )
    assert picture.codec == codec
    assert picture.data == b"\0\0\1\x67"
    assert picture.stamp == 5_000_000_007
    assert picture.is_readable == (codec in ("h264", "h265", "still"))


def test_jpeg_is_known_by_its_bytes():
    _, data = cv2.imencode(".jpg", GREY)
    assert read_picture(TOPIC, {"data": data.reshape(-1), "format": ""}).codec == "still"


def test_a_keyframe_is_known_by_its_units():
    def start(codec: str, *units: int) -> bool | None:
        data = b"".join(b"\0\0\0\1" + bytes([unit]) + b"\x80\0\2" for unit in units)
        value = {"data": list(data), "format": codec}
        return read_picture(TOPIC, value).is_key

    assert start("h264", 9, 0x67, 0x68, 0x65)
    assert not start("h264", 9, 0x41)
    assert start("h265", 0x40, 0x42, 0x44, 0x26)
    assert not start("h265", 0x02)
    assert start("vp9", 1) is None


def test_a_transform_is_named_by_both_its_frames():
    one = {
        "header": {"frame_id": "odom", "stamp": {"sec": 3, "nanosec": 5}}, "child_frame_id": "base",
        "transform": {"translation": {"x": 1, "y": 2, "z": 3},
                      "rotation": {"x": 0, "y": 0, "z": 0, "w": 1}},
    }  # fmt: skip
    readings, stamp = read_series(
        Topic("/tf", "tf2_msgs/msg/TFMessage", "cdr"), {"transforms": [one]}
    )
    assert readings[0][:2] == ("/tf odom > base", (1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.0))
    assert stamp == 3_000_000_005


def test_stamps_are_read_as_each_writer_has_them():
    assert read_stamp("2026-05-01T09:30:00.5Z") == 1_777_627_800_500_000_000
    assert read_stamp({"secs": 2, "nsecs": 1}) == 2_000_000_001
    assert read_stamp({"sec": 0, "nsec": 0}) is None
    assert read_stamp(None) is None
