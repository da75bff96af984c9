import struct

import av
import numpy as np
import pytest

from murkscan.capture import open_recording
from murkscan.capture.clock import usual_spacing
from murkscan.capture.colour import LaserColour
from murkscan.capture.decode import grey_from_video
from murkscan.errors import FormatError

RANDOM = np.random.default_rng(5)
X264 = {"codec": "libx264", "kept": "yuv420p", "options": {"g": "10", "preset": "ultrafast"}}


@pytest.fixture(scope="module")
def pictures():
    return [RANDOM.integers(0, 200, (96, 128), dtype=np.uint8) for _ in range(40)]


def damage(path, where, length):
    data = bytearray(path.read_bytes())
    begin = int(where * len(data))
    data[begin : begin + length] = bytes(byte ^ 0x5A for byte in data[begin : begin + length])
    path.write_bytes(data)


def damage_picture(path, number):
    """Spoil what one packet holds, but not the container around it."""
    with av.open(str(path)) as container:
        packet = list(container.demux(video=0))[number]
        where, size = packet.pos, packet.size
    data = bytearray(path.read_bytes())
    inside = slice(where + 50, where + size - 10)
    data[inside] = bytes(byte ^ 0x5A for byte in data[inside])
    path.write_bytes(data)


def read(path, **settings):
    skips = []
    recording = open_recording(path, **settings)
    return recording, list(recording.frames(on_skip=skips.append)), skips


def test_times_are_those_of_the_container_even_where_the_rate_varies(tmp_path, write_video):
    times = [0, 40, 80, 200, 240, 285, 1000]
    path = write_video(tmp_path / "a.mkv", [np.zeros((40, 48), np.uint8)] * 7, times=times)
    recording, frames, skips = read(path)
    assert recording.is_timed
    assert [frame.time for frame in frames] == [time / 1000 for time in times]
    assert skips == []


@pytest.mark.parametrize("kept", ["yuv420p", "yuyv422", "uyvy422", "nv12", "yuv444p"])
def test_a_green_laser_gets_the_luma_as_it_is(tmp_path, write_video, kept):
    # Levels 16 to 235 of limited range stay; a width of 50 makes the planes' lines wider than it.
    luma = RANDOM.integers(16, 236, (40, 50), dtype=np.uint8)
    planar = np.vstack([luma, np.full((20, 50), 128, np.uint8)])
    path = write_video(
        tmp_path / "a.nut", [planar] * 3, codec="rawvideo", given="yuv420p", kept=kept, height=40
    )
    _, frames, _ = read(path)
    for frame in frames:
        np.testing.assert_array_equal(frame.image, luma)


@pytest.mark.parametrize("form", ["yuv420p10le", "p010le", "yuv420p10be", "y210le"])
def test_ten_bits_are_the_same_however_they_are_packed(form):
    deep = RANDOM.integers(64, 940, (60, 48)).astype(np.uint16)
    frame = av.VideoFrame.from_ndarray(deep, "yuv420p10le").reformat(format=form)
    np.testing.assert_array_equal(grey_from_video(frame, LaserColour.mean(532e-9)), deep[:40])


@pytest.mark.parametrize(("kept", "top"), [("gray10le", 1023), ("gray12le", 4095)])
def test_more_than_eight_bits_are_kept(tmp_path, write_video, kept, top):
    deep = RANDOM.integers(0, top + 1, (40, 48)).astype(np.uint16)
    path = write_video(tmp_path / "a.mkv", [deep] * 2, given=kept, kept=kept)
    _, frames, _ = read(path)
    assert frames[0].image.dtype == np.uint16
    np.testing.assert_array_equal(frames[0].image, deep)


def test_a_red_laser_is_seen_in_a_colour_video(tmp_path, write_video):
    colour = np.full((40, 48, 3), 10, np.uint8)
    colour[:, 20:28] = (220, 10, 10)
    path = write_video(
        tmp_path / "a.mkv", [colour] * 3, codec="libx264", given="rgb24", kept="yuv444p"
    )
    red, green = (read(path, wavelength=w)[1][0].image for w in (650e-9, 532e-9))
    contrast = [int(i[20, 24]) - int(i[20, 4]) for i in (red, green)]
    assert contrast[0] > 1.5 * contrast[1]


def test_rgb_video_is_weighted(tmp_path, write_video):
    colour = np.full((40, 48, 3), 10, np.uint8)
    colour[:, 20:28] = (10, 220, 10)
    path = write_video(tmp_path / "a.mkv", [colour] * 2, given="rgb24", kept="bgr0")
    image = read(path)[1][0].image
    assert image[20, 4] == 10
    assert image[20, 24] > 100


@pytest.mark.parametrize("suffix", [".mkv", ".mp4"])
def test_damage_in_the_middle_costs_the_damaged_pictures_only(
    tmp_path, write_video, pictures, suffix
):
    path = write_video(tmp_path / f"a{suffix}", pictures, **X264)
    whole = {frame.index: frame for frame in read(path)[1]}
    damage_picture(path, 17)
    _, frames, skips = read(path)
    assert skips
    assert all("a" + suffix in skip.reason for skip in skips)
    lost = {n for skip in skips for n in range(skip.index, skip.index + skip.count)}
    assert {frame.index for frame in frames} == set(range(40)) - lost
    # Indices still belong to the same moments.
    assert all(frame.time == whole[frame.index].time for frame in frames)
    assert 17 in lost
    assert len(lost) <= 3  # those that the decoder says lean on it


def test_pictures_that_the_container_lost_in_the_damage_are_counted_by_time(
    tmp_path, write_video, pictures
):
    path = write_video(tmp_path / "a.ts", pictures, **X264)
    with av.open(str(path)) as container:
        lost = [packet.pos for packet in container.demux(video=0) if packet.size][15:19]
    data = path.read_bytes()
    # What is cut out begins and ends in the middle of a picture, so that the decoder notices.
    begin, end = (lost[i] // 188 * 188 + 188 * packets for i, packets in ((0, 8), (-1, 3)))
    path.write_bytes(data[:begin] + data[end:])
    _, frames, skips = read(path)
    gone = {n for skip in skips for n in range(skip.index, skip.index + skip.count)}
    assert gone >= {16, 17, 18}
    assert {frame.index for frame in frames} == set(range(40)) - gone
    assert all(frame.time - frames[0].time == pytest.approx(frame.index / 25) for frame in frames)


def test_a_damaged_transport_stream_is_read_on_behind_the_damage(tmp_path, write_video, pictures):
    path = write_video(tmp_path / "a.ts", pictures, **X264)
    whole = [frame.time for frame in read(path)[1]]
    damage(path, 0.5, 6000)
    # Packets that vanish without a trace cannot be counted; their times are a gap.
    times = [frame.time for frame in read(path)[1]]
    assert set(times) < set(whole)
    assert times[-1] == whole[-1]
    assert len(times) >= 28  # but for one group of pictures


@pytest.mark.parametrize("suffix", [".mkv", ".mp4", ".avi"])
def test_a_truncated_video_is_read_up_to_its_cut(tmp_path, write_video, pictures, suffix):
    path = tmp_path / f"a{suffix}"
    write_video(path, pictures, **X264)
    if suffix == ".mp4":  # Its table stands at the end, unless it is asked to the front.
        with (
            av.open(str(path)) as old,
            av.open(str(tmp_path / "b.mp4"), "w", options={"movflags": "faststart"}) as new,
        ):
            stream = new.add_stream_from_template(old.streams.video[0])
            for packet in old.demux(video=0):
                if packet.size:
                    packet.stream = stream
                    new.mux(packet)
        path = tmp_path / "b.mp4"
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    _, frames, skips = read(path)
    assert 10 < len(frames) < 30
    assert [frame.index for frame in frames] == list(range(len(frames)))
    if suffix != ".avi":  # A cut AVI has lost its index, by which it knew its length.
        assert "ends too early" in skips[-1].reason
        assert skips[0].index == len(frames)
        assert skips[-1].index + skips[-1].count == 40


def test_a_sample_survives_damage(tmp_path, write_video, pictures):
    path = write_video(tmp_path / "a.mkv", pictures, **X264)
    damage(path, 0.3, 20000)
    sample = open_recording(path).sample(8)
    assert len(sample) >= 5
    assert sample[-1].index >= 30


def test_a_sample_of_a_video_without_times_is_read(tmp_path, write_video, pictures):
    path = write_video(tmp_path / "a.h264", pictures, **X264)
    recording = open_recording(path)
    assert not recording.is_timed
    assert [frame.time for frame in recording.frames()][:3] == [0, 1, 2]
    assert recording.sample(5)


@pytest.mark.parametrize("text", ["", "no video", "frame,time\n" * 500])
@pytest.mark.parametrize("name", ["a.mp4", "a.txt", "a.csv", "a.mkv"])
def test_a_file_that_is_no_video_is_refused_by_name(tmp_path, name, text):
    (tmp_path / name).write_text(text)
    with pytest.raises(FormatError, match=name):
        open_recording(tmp_path / name)


def test_a_truncated_video_without_its_table_is_refused_with_the_cure(
    tmp_path, write_video, pictures
):
    path = write_video(tmp_path / "a.mp4", pictures, **X264)
    path.write_bytes(path.read_bytes()[:-4000])
    with pytest.raises(FormatError, match="repair"):
        open_recording(path)


def test_the_name_may_be_of_any_script_and_hold_a_colon(tmp_path, write_video):
    path = write_video(tmp_path / "a.mkv", [np.zeros((40, 48), np.uint8)] * 3)
    odd = path.rename(tmp_path / "глубина 3:1 %03d.mkv")
    assert len(read(odd)[1]) == 3


def test_the_usual_spacing_is_the_median():
    assert usual_spacing([[0.0, 1.0, 2.0, 9.0], [20.0, 21.0]]) == 1
    assert usual_spacing([[3.0], []]) == 0


def test_the_real_video_is_read_whole(data):
    recording, frames, skips = read(
        data("stage_stairs") / "grey_step_8.94mm.mp4", wavelength=650e-9
    )
    assert (recording.size, len(frames), skips) == ((640, 480), 23, [])
    assert [frame.time for frame in frames] == pytest.approx([n / 25 for n in range(23)])


def without_data(path, numbers):
    """Rewrite an AVI such that some pictures have no data, as recorders write dropped ones."""
    data = path.read_bytes()
    movi = data.index(b"movi")
    (size,) = struct.unpack_from("<I", data, movi - 4)
    at, picture, body, index = movi + 4, 0, b"", b""
    while at < movi + size:
        name, length = data[at : at + 4], struct.unpack_from("<I", data, at + 4)[0]
        content = data[at + 8 : at + 8 + length]
        if name == b"00dc":
            content, picture = (b"" if picture in numbers else content), picture + 1
        index += name + struct.pack("<III", 0x10, 4 + len(body), len(content))
        body += name + struct.pack("<I", len(content)) + content + b"\0" * (len(content) % 2)
        at += 8 + length + length % 2
    chunks = struct.pack("<I", len(body) + 4) + b"movi" + body
    chunks += b"idx1" + struct.pack("<I", len(index)) + index
    path.write_bytes(data[: movi - 4] + chunks)


@pytest.mark.parametrize("dropped", [[3, 4, 7], [9], [5, 6, 7, 8]], ids=str)
def test_pictures_without_data_keep_their_numbers_and_times(tmp_path, write_video, dropped):
    pictures = [np.full((64, 96), 20 * number, np.uint8) for number in range(10)]
    path = write_video(tmp_path / "a.avi", pictures, codec="mjpeg", kept="yuvj420p", ticks=25)
    without_data(path, dropped)
    skips = []
    frames = list(open_recording(path).frames(on_skip=skips.append))
    there = np.setdiff1d(np.arange(10), dropped)
    np.testing.assert_array_equal([frame.index for frame in frames], there)
    np.testing.assert_allclose([frame.time for frame in frames], there / 25)
    np.testing.assert_allclose([frame.image.mean() for frame in frames], 20 * there, atol=2)
    assert sorted(k for one in skips for k in range(one.index, one.index + one.count)) == dropped


@pytest.mark.parametrize("name", ["bframes.avi", "x264_default.avi"])
def test_pictures_that_avi_reorders_come_in_order_at_their_right_times(fault, name):
    """Each picture bears its number in binary, a bar for each one: so its mean grows with them."""
    skips = []
    recording = open_recording(fault(f"video/{name}"))
    frames = list(recording.frames(on_skip=skips.append))
    assert [frame.index for frame in frames] == list(range(100))
    np.testing.assert_allclose([frame.time for frame in frames], np.arange(100) / 25)
    assert skips == []
    means = np.array([frame.image.mean() for frame in frames])
    bars = (means - means[0]) / (means[1] - means[0])
    # The last few fade: an encoder has no pictures behind them to spend its bits for.
    np.testing.assert_allclose(bars[:94], [k.bit_count() for k in range(94)], atol=0.3)
    assert recording.span == pytest.approx((0.0, 3.96))
    sample = recording.sample(5)
    np.testing.assert_allclose([frame.time for frame in sample], [f.index / 25 for f in sample])
