"""What every recording promises; a new kind joins the list and inherits the tests."""

import os
import pickle
from itertools import pairwise

import av
import numpy as np
import pytest

from murkscan.capture import ImageFolder, Video, open_recording
from murkscan.errors import FormatError

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


ORDERS = ["progressive", "top-first", "bottom-first"]


@pytest.fixture(params=ORDERS)
def recording(request, path):
    return open_recording(path, fields=request.param)


def assert_same(frames, others, tolerance=0.0):
    """Compare frames; a sample adds a second field's half period with a rounding of its own."""
    assert [frame.index for frame in frames] == [frame.index for frame in others]
    for frame, other in zip(frames, others, strict=True):
        assert frame.time == pytest.approx(other.time, rel=0, abs=tolerance)
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
    assert_same(sample, [whole[frame.index] for frame in sample], tolerance=1e-9)
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


def test_other_fields_another_rate_and_another_laser_change_the_fingerprint(path):
    readings = [{"fields": order, "fps": fps} for order in ORDERS for fps in (None, 1.0, 8.0, 25.0)]
    readings.append({"fields": "progressive", "wavelength": 650e-9})
    prints = [open_recording(path, **reading).fingerprint() for reading in readings]
    assert len(set(prints)) == len(readings)
    again = [open_recording(path, **reading).fingerprint() for reading in readings]
    assert again == prints


def test_other_times_in_times_csv_change_the_fingerprint(tmp_path, pictures, write_folder):
    folder, listed = write_folder(tmp_path, pictures[:3]), tmp_path / "times.csv"
    prints = [open_recording(folder).fingerprint()]
    for last in ("0.08", "0.09"):  # As long as each other, and of one date.
        listed.write_text(f"file,time_s\npicture0.png,0\npicture1.png,0.04\npicture2.png,{last}\n")
        os.utime(listed, ns=(0, 0))
        prints.append(open_recording(folder).fingerprint())
    assert len(set(prints)) == 3


def write_times(folder, times):
    lines = [f"picture{n}.png,{time / 1000}\n" for n, time in enumerate(times)]
    (folder / "times.csv").write_text("file,time_s\n" + "".join(lines))


JITTERED = [1000, 1040, 1110, 1120, 1160, 1200, 1230, 1280, 1320, 1321, 1400, 1440]


@pytest.fixture(params=[ImageFolder, Video], ids=["folder", "video"])
def clocked(request, tmp_path, pictures, write_folder, write_clocked):
    """Write a recording whose pictures have given times [ms]."""

    def write(times):
        if request.param is Video:
            return write_clocked(tmp_path / "scan.mkv", pictures, times)
        folder = write_folder(tmp_path / "scan", pictures)
        write_times(folder, times)
        return folder

    return write


@pytest.mark.parametrize("order", ORDERS)
def test_times_strictly_increase_however_pictures_jitter(clocked, order):
    recording, skips = open_recording(clocked(JITTERED), fields=order), []
    frames = list(recording.frames(on_skip=skips.append))
    assert skips == []
    assert [frame.index for frame in frames] == list(range(recording.num_frames))
    assert all(a.time < b.time for a, b in pairwise(frames))
    first_fields = frames[:: recording.fields_per_picture]
    assert [frame.time for frame in first_fields] == [time / 1000 for time in JITTERED]
    if order != "progressive":
        late = [b.time - a.time for a, b in zip(frames[::2], frames[1::2], strict=True)]
        # Half way to the next picture, or half the usual 40 ms where that is late.
        steps = [*np.diff(JITTERED), 40]
        assert late == pytest.approx([min(step, 40) / 2000 for step in steps], abs=1e-9)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize(
    ("times", "lost"),
    [
        ([1000, 1040, 1040, *range(1120, 1480, 40)], [(2, 1)]),
        ([1000, 1000, 1080, 1080, 1080, *range(1200, 1480, 40)], [(1, 1), (3, 2)]),
        ([1000, 1040, 1080, 1010, 1070, *range(1200, 1480, 40)], [(3, 2)]),
        ([*range(1000, 1320, 40), 1000, 1040, 1080, 1120], [(8, 4)]),
    ],
    ids=["twice", "often", "backward", "anew"],
)
def test_pictures_out_of_time_do_not_come(clocked, order, times, lost):
    """A video skips them with a word; a folder's times.csv, which can be mended, is refused."""
    path = clocked(times)
    if path.is_dir():
        with pytest.raises(FormatError, match=r"times\.csv"):
            open_recording(path, fields=order)
        return
    recording, skips = open_recording(path, fields=order), []
    frames = list(recording.frames(on_skip=skips.append))
    each = recording.fields_per_picture
    assert all(a.time < b.time for a, b in pairwise(frames))
    assert [(skip.index, skip.count) for skip in skips] == [(n * each, c * each) for n, c in lost]
    gone = {n for skip in skips for n in range(skip.index, skip.index + skip.count)}
    assert [frame.index for frame in frames] == sorted(set(range(12 * each)) - gone)
    assert all(frame.time >= times[frame.index // each] / 1000 for frame in frames)
    for skip, (first, _) in zip(skips, lost, strict=True):
        assert f" {first} " in skip.reason
        assert "scan.mkv" in skip.reason
        assert "--fps" in skip.reason


@pytest.mark.parametrize("order", ORDERS)
def test_a_given_rate_is_the_cure_for_times_that_run_backward(
    tmp_path, pictures, write_clocked, order
):
    path = write_clocked(tmp_path / "a.mkv", pictures, [1000, 1040, 1000, *range(1080, 1440, 40)])
    skips = []
    recording = open_recording(path, fields=order, fps=25.0)
    frames = list(recording.frames(on_skip=skips.append))
    assert (len(frames), skips) == (12 * recording.fields_per_picture, [])
    assert all(a.time < b.time for a, b in pairwise(frames))


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("spoilt", [[4], [4, 5, 6], [0, 1], [10, 11]], ids=str)
def test_what_is_skipped_is_counted_in_frames_from_the_start_on(clocked, order, spoilt):
    """Whatever the start, the frames that come and those that are skipped make up the rest."""
    path = clocked(range(1000, 1480, 40))
    spoil(path, spoilt)
    recording = open_recording(path, fields=order)
    each = recording.fields_per_picture
    assert recording.num_frames == 12 * each
    for start in range(12 * each + 2):
        skips = []
        frames = list(recording.frames(start, on_skip=skips.append))
        lost = [n for skip in skips for n in range(skip.index, skip.index + skip.count)]
        assert lost == list(range(max(spoilt[0] * each, start), (spoilt[-1] + 1) * each))
        came = [frame.index for frame in frames]
        assert sorted(came + lost) == list(range(start, 12 * each))


def spoil(path, numbers):
    if path.is_dir():
        for number in numbers:
            (path / f"picture{number}.png").write_bytes(b"no picture")
        return
    with av.open(str(path)) as container:
        packets = [packet for packet in container.demux(video=0) if packet.size]
    data = bytearray(path.read_bytes())
    for number in numbers:
        where, size = packets[number].pos, packets[number].size
        begin = data.index(bytes(packets[number])[:32], where)
        data[begin + 40 : begin + size] = bytes(b ^ 0x5A for b in data[begin + 40 : begin + size])
    path.write_bytes(data)


def test_frames_can_be_changed_without_harm_to_the_next(recording):
    wanted = [frame.image.copy() for frame in recording.frames()]
    for frame, image in zip(recording.frames(), wanted, strict=True):
        np.testing.assert_array_equal(frame.image, image)
        frame.image[:] = 0
