"""What every recording promises; a new kind joins the list and inherits the tests."""

import os
import pickle
from itertools import pairwise

import numpy as np
import pytest

from murkscan.capture import ImageFolder, Video, open_recording

NUM_PICTURES = 12


@pytest.fixture(scope="module")
def pictures():
    random = np.random.default_rng(1)
    return [random.integers(0, 256, (40, 48), dtype=np.uint8) for _ in range(NUM_PICTURES)]


@pytest.fixture(scope="module", params=[ImageFolder, Video], ids=["folder", "video"])
def path(request, tmp_path_factory, pictures, write_folder, write_video):
    folder = tmp_path_factory.mktemp("recording")
    if request.param is ImageFolder:
        return write_folder(folder / "scan", pictures)
    return write_video(folder / "scan.mkv", pictures)


@pytest.fixture(params=["progressive", "top-first", "bottom-first"])
def recording(request, path):
    return open_recording(path, fields=request.param)


def assert_same(frames, others):
    assert [frame.index for frame in frames] == [frame.index for frame in others]
    for frame, other in zip(frames, others, strict=True):
        assert frame.time == other.time
        assert (frame.first_row, frame.row_step) == (other.first_row, other.row_step)
        np.testing.assert_array_equal(frame.image, other.image)


def test_frames_are_numbered_from_zero_and_times_grow(recording):
    frames = list(recording.frames())
    assert [frame.index for frame in frames] == list(range(recording.num_frames))
    assert len(frames) == NUM_PICTURES * recording.fields_per_picture
    assert all(a.time < b.time for a, b in pairwise(frames))


def test_rows_of_a_picture_come_back_where_they_were(recording, pictures):
    whole = [np.zeros_like(picture) for picture in pictures]
    for frame in recording.frames():
        picture = whole[frame.index // recording.fields_per_picture]
        picture[frame.first_row :: frame.row_step] = frame.image
    for got, wanted in zip(whole, pictures, strict=True):
        np.testing.assert_array_equal(got, wanted)


def test_the_first_field_has_the_rows_that_were_said(path):
    for order, row in (("top-first", 0), ("bottom-first", 1)):
        first, second = list(open_recording(path, fields=order).frames())[:2]
        assert (first.first_row, second.first_row) == (row, 1 - row)
        assert first.row_step == second.row_step == 2


@pytest.mark.parametrize("start", [0, 1, 2, 7, 11, 12, 23, 24, 100])
def test_starting_later_gives_the_rest(recording, start):
    whole = list(recording.frames())
    assert_same(list(recording.frames(start)), whole[start:])


@pytest.mark.parametrize("count", [1, 2, 5, 12, 50])
def test_a_sample_is_spread_and_true(recording, count):
    whole = list(recording.frames())
    sample = recording.sample(count)
    assert 1 <= len(sample) <= count
    assert len(sample) >= min(count, NUM_PICTURES)
    assert_same(sample, [whole[frame.index] for frame in sample])
    if count > 1:
        assert sample[0].index <= 1
        assert sample[-1].index >= len(whole) - 2


def test_a_sample_of_fields_holds_both_kinds(path):
    sample = open_recording(path, fields="top-first").sample(6)
    assert {frame.first_row for frame in sample} == {0, 1}


def test_a_given_rate_makes_the_times(path):
    frames = list(open_recording(path, fps=8.0, fields="top-first").frames())
    # Eighths and sixteenths are exact in binary.
    assert [frame.time for frame in frames[:4]] == [0.0, 0.0625, 0.125, 0.1875]


def test_it_can_be_sent_to_another_process(recording):
    copy = pickle.loads(pickle.dumps(recording))
    assert copy == recording
    assert_same(list(copy.frames()), list(recording.frames()))


def test_a_changed_file_changes_the_fingerprint(recording):
    before = recording.fingerprint()
    assert recording.fingerprint() == before
    file = recording.path
    if file.is_dir():
        file = file / "picture3.png"
    state = file.stat()
    os.utime(file, ns=(state.st_atime_ns, state.st_mtime_ns + 1_000_000_000))
    assert recording.fingerprint() != before


def test_frames_can_be_changed_without_harm_to_the_next(recording):
    wanted = [frame.image.copy() for frame in recording.frames()]
    for frame, image in zip(recording.frames(), wanted, strict=True):
        np.testing.assert_array_equal(frame.image, image)
        frame.image[:] = 0
