"""Folders as cameras and loggers leave them: what is not read keeps its place, and is told."""

import struct

import cv2
import numpy as np
import pytest

from murkscan.capture import open_recording
from murkscan.errors import FormatError
from murkscan.io.images import read_colour, read_image, write_image
from murkscan.io.picture_notes import count_pages, find_turn


def picture(number, dtype=np.uint8):
    return np.full((48, 64), 10 + number, dtype)


def read(path, **settings):
    skips = []
    recording = open_recording(path, **settings)
    frames = list(recording.frames(on_skip=skips.append))
    return recording, frames, skips


def test_pictures_that_are_not_read_keep_their_numbers_and_are_told(tmp_path):
    for number in range(24):
        if number % 6 == 5:
            write_image(tmp_path / f"IMG_{number}.jpg", picture(number))
        else:
            (tmp_path / f"IMG_{number}.HEIC").write_bytes(b"ftypheic")
    recording, frames, skips = read(tmp_path)
    assert [frame.index for frame in frames] == [5, 11, 17, 23]
    assert sum(skip.count for skip in skips) == 20
    assert "20 of its 24 pictures are of a kind that is not read (.HEIC)" in recording.remarks[0]
    assert recording.num_frames == 24


@pytest.mark.parametrize(("top", "words"), [(4095, "12 of 16"), (65535, None)])
def test_bits_that_are_not_used_are_told_and_nothing_is_stretched(top, words, tmp_path):
    stripe = np.zeros((48, 64), np.uint16)
    stripe[20:23] = top
    write_image(tmp_path / "a.png", stripe)
    recording, frames, _ = read(tmp_path)
    np.testing.assert_array_equal(frames[0].image, stripe)
    assert any("not stretched" in remark for remark in recording.remarks) == (words is not None)
    assert words is None or words in recording.remarks[0]


def test_a_raw_picture_beside_its_own_jpeg_is_no_picture_of_its_own(tmp_path):
    for number in range(3):
        write_image(tmp_path / f"{number}.jpg", picture(number))
        (tmp_path / f"{number}.CR2").write_bytes(b"raw")
    recording, frames, skips = read(tmp_path)
    assert (len(frames), skips, recording.remarks) == (3, [], ())


def test_a_folder_of_nothing_else_says_what_to_do(tmp_path):
    (tmp_path / "a.nef").write_bytes(b"raw")
    with pytest.raises(FormatError, match=r"of a kind that is not read \(\.nef\); convert them"):
        open_recording(tmp_path)


def write_pages(path, pages):
    assert cv2.imwritemulti(str(path), pages)


@pytest.mark.parametrize("alone", [True, False])
def test_each_page_of_a_tiff_is_a_picture(tmp_path, alone):
    write_pages(tmp_path / "a.tif", [picture(k, np.uint16) for k in range(24)])
    assert count_pages(tmp_path / "a.tif") == 24
    recording, frames, _ = read(tmp_path / "a.tif" if alone else tmp_path, fps=25.0)
    assert [int(frame.image[0, 0]) for frame in frames] == list(range(10, 34))
    np.testing.assert_allclose([frame.time for frame in frames], np.arange(24) / 25)
    assert "24 pages" in recording.remarks[0]
    assert recording.fingerprint()


def test_a_tiff_of_one_page_is_a_single_picture(tmp_path):
    write_image(tmp_path / "a.tif", picture(1))
    with pytest.raises(FormatError, match="is a single picture"):
        open_recording(tmp_path / "a.tif")


@pytest.mark.parametrize("data", [b"", b"II*\0", b"II*\0\x08\0\0\0", b"MM\0*\0\0\0\x08\xff\xff"])
def test_a_damaged_tiff_has_one_page(tmp_path, data):
    (tmp_path / "a.tif").write_bytes(data)
    assert count_pages(tmp_path / "a.tif") == 1


def test_a_tiff_whose_pages_run_in_a_circle_ends(tmp_path):
    (tmp_path / "a.tif").write_bytes(b"II*\0" + struct.pack("<IHI", 8, 0, 8))
    assert count_pages(tmp_path / "a.tif") == 1


@pytest.mark.parametrize(
    ("values", "shown"),
    [
        (np.array([0, 0.5, 1]), [0, 32768, 65535]),
        (np.array([0, 100.4, 4095]), [0, 100, 4095]),
        (np.array([-5, np.nan, 70000]), [0, 0, 65535]),
    ],
)
def test_real_numbers_are_read(tmp_path, values, shown):
    cv2.imwrite(str(tmp_path / "a.tif"), values[None].astype(np.float32))
    np.testing.assert_array_equal(read_image(tmp_path / "a.tif"), [shown])


@pytest.mark.parametrize(("top", "steps"), [(4095, 256), (65535, 256), (255, 256), (1023, 256)])
def test_photographs_of_any_depth_keep_their_eight_upper_bits(tmp_path, top, steps):
    ramp = np.linspace(0, top, 1024).round().astype(np.uint16)[None]
    write_image(tmp_path / "a.png", ramp)
    seen = read_colour(tmp_path / "a.png")
    assert len(np.unique(seen)) == steps
    assert seen.max() == 255


@pytest.mark.parametrize(("ticks", "form"), [(1, "{:.6f}"), (1e3, "{:.0f}"), (1e9, "{:.0f}")])
def test_names_that_are_times_since_1970_give_the_times(tmp_path, ticks, form):
    for number in range(5):
        name = form.format((1625140800 + number / 25) * ticks)
        write_image(tmp_path / f"cam0_{name}.png", picture(number))
    recording, frames, _ = read(tmp_path)
    assert recording.is_timed
    # Seconds since 1970 have steps of 2.4e-7 s in double precision.
    shown = np.array([frame.time for frame in frames]) - 1625140800
    np.testing.assert_allclose(shown, np.arange(5) / 25, atol=1e-6)
    assert "taken from their names" in recording.remarks[0]
    assert read(tmp_path, fps=10.0)[1][1].time == 0.1


def test_other_names_give_no_times(tmp_path):
    for number in range(5):
        write_image(tmp_path / f"2021_{number}.png", picture(number))
    assert not open_recording(tmp_path).is_timed


def test_a_note_that_asks_for_a_turn_is_passed_over_with_a_word(tmp_path):
    write_image(tmp_path / "a.jpg", picture(1))
    exif = b"Exif\0\0II*\0" + struct.pack("<IHHHIHHI", 8, 1, 0x0112, 3, 1, 6, 0, 0)
    data = (tmp_path / "a.jpg").read_bytes()
    block = b"\xff\xe1" + struct.pack(">H", len(exif) + 2) + exif
    (tmp_path / "a.jpg").write_bytes(data[:2] + block + data[2:])
    assert find_turn(tmp_path / "a.jpg") == 90
    recording = open_recording(tmp_path)
    assert recording.size == (64, 48)
    assert "asks to turn its pictures by 90 degrees" in recording.remarks[0]
