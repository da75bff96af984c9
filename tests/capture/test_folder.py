import cv2
import numpy as np
import pytest

from murkscan.capture import open_recording
from murkscan.errors import FormatError, InputError
from murkscan.io.images import write_image

GREY = np.arange(40 * 48, dtype=np.uint8).reshape(40, 48)


def fill(folder, names, image=GREY):
    for name in names:
        write_image(folder / name, image)
    return folder


def test_pictures_come_in_natural_order(tmp_path):
    names = ["a10.png", "a9.png", "A1.png", "a100.png", "a2b3.png", "a2b20.png"]
    for level, name in enumerate(names):
        write_image(tmp_path / name, np.full((40, 48), level, np.uint8))
    order = [names[frame.image[0, 0]] for frame in open_recording(tmp_path).frames()]
    assert order == ["A1.png", "a2b3.png", "a2b20.png", "a9.png", "a10.png", "a100.png"]


def test_without_times_a_frame_has_the_number_of_its_picture(tmp_path):
    fill(tmp_path, ["1.png", "2.png", "3.png"])
    recording = open_recording(tmp_path)
    assert not recording.is_timed
    assert [frame.time for frame in recording.frames()] == [0, 1, 2]
    fields = open_recording(tmp_path, fields="top-first")
    assert [frame.time for frame in fields.frames()] == [0, 0.5, 1, 1.5, 2, 2.5]


def test_times_come_from_times_csv(tmp_path):
    fill(tmp_path, ["1.png", "2.png", "10.png"])
    (tmp_path / "times.csv").write_text("file,time_s\n1.png,5\n2.png,5.5\n10.png,7.5\n")
    recording = open_recording(tmp_path)
    assert recording.is_timed
    assert [frame.time for frame in recording.frames()] == [5, 5.5, 7.5]
    # The second field comes half the usual 1.25 s later, or half way to a picture that is early.
    fields = open_recording(tmp_path, fields="bottom-first")
    assert [frame.time for frame in fields.frames()] == [5, 5.25, 5.5, 6.125, 7.5, 8.125]


def test_times_csv_and_a_rate_contradict(tmp_path):
    fill(tmp_path, ["1.png", "2.png"])
    (tmp_path / "times.csv").write_text("file,time_s\n1.png,5\n2.png,5.5\n")
    with pytest.raises(InputError, match=r"times\.csv"):
        open_recording(tmp_path, fps=25.0)


@pytest.mark.parametrize("suffix", [".png", ".tif", ".bmp", ".webp", ".jpg", ".pgm", ".jp2"])
def test_common_formats_are_read(tmp_path, suffix):
    smooth = np.tile(np.linspace(10, 240, 48).astype(np.uint8), (40, 1))
    (image,) = [f.image for f in open_recording(fill(tmp_path, [f"a{suffix}"], smooth)).frames()]
    assert image.dtype == np.uint8
    # Lossy formats at their default quality may be some levels off.
    np.testing.assert_allclose(image.astype(int), smooth, atol=6)


@pytest.mark.parametrize("suffix", [".png", ".tif"])
def test_sixteen_bits_stay(tmp_path, suffix):
    deep = (np.arange(40 * 48, dtype=np.uint16) * 34).reshape(40, 48)
    (frame,) = open_recording(fill(tmp_path, [f"a{suffix}"], deep)).frames()
    assert frame.image.dtype == np.uint16
    np.testing.assert_array_equal(frame.image, deep)


def test_names_may_be_of_any_script_and_other_files_may_lie_around(tmp_path):
    folder = fill(tmp_path / "Ölhafen Картахена", ["снимок 1.png", "снимок 2.PNG"])
    (folder / "notes.txt").write_text("dive 3")
    (folder / "log.csv").write_text("a,b")
    (folder / ".hidden.png").write_bytes(b"")
    (folder / "more.png").mkdir()
    assert len(list(open_recording(folder).frames())) == 2


@pytest.mark.parametrize("name", ["3.png", "3.jpg"])
@pytest.mark.parametrize("damage", ["cut", "empty", "junk"])
def test_a_corrupt_picture_is_skipped_and_keeps_its_number(tmp_path, name, damage):
    fill(tmp_path, ["1.png", "2.png", name, "4.png"])
    data = (tmp_path / name).read_bytes()
    damaged = {"cut": data[: len(data) // 2], "empty": b"", "junk": b"no picture at all"}
    (tmp_path / name).write_bytes(damaged[damage])
    skips = []
    recording = open_recording(tmp_path)
    frames = list(recording.frames(on_skip=skips.append))
    assert [frame.index for frame in frames] == [0, 1, 3]
    assert [skip.index for skip in skips] == [2]
    assert name in skips[0].reason
    assert len(recording.sample(4)) == 3


def test_a_corrupt_picture_of_two_fields_is_two_frames_less(tmp_path):
    fill(tmp_path, ["1.png", "2.png", "3.png"])
    (tmp_path / "2.png").write_bytes(b"")
    skips = []
    recording = open_recording(tmp_path, fields="top-first")
    assert [f.index for f in recording.frames(on_skip=skips.append)] == [0, 1, 4, 5]
    list(recording.frames(3, on_skip=skips.append))
    assert [(skip.index, skip.count) for skip in skips] == [(2, 2), (3, 1)]


def test_a_corrupt_first_picture_does_not_matter(tmp_path):
    fill(tmp_path, ["1.png", "2.png"])
    (tmp_path / "1.png").write_bytes(b"")
    recording = open_recording(tmp_path)
    assert recording.size == (48, 40)
    assert [frame.index for frame in recording.frames()] == [1]


def test_a_picture_of_another_size_is_refused_by_name(tmp_path):
    fill(tmp_path, ["1.png", "2.png"])
    write_image(tmp_path / "3.png", np.zeros((30, 50), np.uint8))
    recording = open_recording(tmp_path)
    with pytest.raises(FormatError, match=r"3\.png is 50 x 30 px.*48 x 40"):
        list(recording.frames())


def test_an_empty_folder_is_refused(tmp_path):
    with pytest.raises(FormatError, match="holds no pictures"):
        open_recording(tmp_path)


def test_a_folder_of_broken_pictures_is_refused(tmp_path):
    for name in ("1.png", "2.png"):
        (tmp_path / name).write_bytes(b"junk")
    with pytest.raises(FormatError, match="None of the 2 pictures"):
        open_recording(tmp_path)


def test_a_missing_path_is_refused(tmp_path):
    with pytest.raises(InputError, match="no recording at"):
        open_recording(tmp_path / "nothing")


def test_a_single_picture_is_refused(tmp_path):
    fill(tmp_path, ["1.png"])
    with pytest.raises(FormatError, match="the folder"):
        open_recording(tmp_path / "1.png")


@pytest.mark.parametrize("rate", [0.0, -25.0, float("nan"), float("inf")])
def test_an_impossible_rate_is_refused(tmp_path, rate):
    with pytest.raises(InputError, match="pictures a second"):
        open_recording(fill(tmp_path, ["1.png"]), fps=rate)


@pytest.mark.parametrize("source", ["udp://127.0.0.1:5600", "camera.sdp"])
def test_a_stream_is_to_be_recorded_first(source):
    with pytest.raises(InputError, match="murkscan capture"):
        open_recording(source)


def test_colours_are_weighted_for_the_laser(tmp_path):
    colour = np.zeros((40, 48, 3), np.uint8)
    colour[:, 20:24] = (0, 200, 0)
    write_image(tmp_path / "1.png", colour)
    peak = [
        next(open_recording(tmp_path, wavelength=w).frames()).image.max() for w in (532e-9, 650e-9)
    ]
    assert peak[0] > 2 * peak[1]


def test_transparent_pictures_are_read(tmp_path):
    data = cv2.imencode(".png", np.dstack([GREY] * 3 + [np.full_like(GREY, 255)]))[1]
    (tmp_path / "1.png").write_bytes(data.tobytes())
    (frame,) = open_recording(tmp_path).frames()
    np.testing.assert_array_equal(frame.image, GREY)


def test_the_photographs_of_a_line_scan_are_read_as_they_are(data):
    recording = open_recording(data("stage_stairs") / "scan", wavelength=650e-9)
    assert (recording.size, recording.order, recording.num_frames) == (
        (640, 480),
        "progressive",
        65,
    )
    middle = recording.sample(3)[1].image
    assert middle.max() == 255  # the line saturates
    assert np.median(middle) < 60
