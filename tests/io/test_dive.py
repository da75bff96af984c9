"""What MCAPs, bags and tlogs hold is read, whatever became of them."""

import pickle
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("mcap", reason="the extra [dive] is not installed")
pytest.importorskip("rosbags", reason="the extra [dive] is not installed")
sys.path.append(str(Path(__file__).resolve().parents[2] / "benchmarks"))

from dive_files import (
    BEGIN,
    Dive,
    Flaws,
    encode_h264,
    write_blueos,
    write_csv,
    write_mp4,
    write_ros1,
    write_ros2,
    write_tlog,
)

from murkscan.capture import open_recording
from murkscan.errors import FormatError, InputError
from murkscan.io.dive.clock import find_steps_back, smooth_arrival, time_by_other
from murkscan.io.dive.gather import read_contents
from murkscan.io.dive.listing import list_contents
from murkscan.io.navigation_log import read_navigation_log
from murkscan.types.trajectory import Trajectory

COUNT, RATE = 60, 25.0


def numbered(number: int) -> np.ndarray:
    """A picture whose rows of squares say its number."""
    image = np.full((64, 96), 20, np.uint8)
    for bit in range(6):
        image[24:40, 8 + 14 * bit : 18 + 14 * bit] = 220 if number >> bit & 1 else 20
    return image


def number_of(image: np.ndarray) -> int:
    return sum(
        1 << bit for bit in range(6) if image[28:36, 10 + 14 * bit : 16 + 14 * bit].mean() > 120
    )


@pytest.fixture(scope="module")
def dive() -> Dive:
    packets = encode_h264([numbered(k) for k in range(COUNT)], RATE, gop=10)
    times = np.arange(0, COUNT / RATE + 0.05, 0.1)
    turn = 0.02 * np.sin(times)
    quaternions = np.column_stack([np.cos(turn / 2), np.sin(turn / 2), 0 * turn, 0 * turn])
    positions = np.column_stack([0.1 * times, 0.01 * times**2, 0.02 * times])
    return Dive(packets, np.arange(COUNT) / RATE, Trajectory(times, positions, quaternions))


WRITERS = {
    "cdr.mcap": write_blueos,
    "json.mcap": lambda path, dive: write_blueos(path, dive, json_video=True),
    "sqlite": lambda path, dive: write_ros2(path, dive, "sqlite3"),
    "ros2mcap": lambda path, dive: write_ros2(path, dive, "mcap"),
    "ros1.bag": lambda path, dive: write_ros1(path, dive, [numbered(k) for k in range(COUNT)]),
}


@pytest.mark.parametrize("name", WRITERS)
def test_pictures_and_the_way_come_out_of_one_file(name, tmp_path, dive):
    WRITERS[name](tmp_path / name, dive)
    recording = open_recording(tmp_path / name, fields="progressive")
    frames = list(recording.frames())
    assert [number_of(frame.image) for frame in frames] == list(range(COUNT))
    assert [frame.index for frame in frames] == list(range(COUNT))
    # Times since 1970 have steps of 0.24 µs.
    np.testing.assert_allclose([f.time for f in frames], BEGIN + dive.times, atol=1e-6)
    log = read_navigation_log(tmp_path / name).poses
    assert log is not None
    way = log.at(BEGIN + dive.way.times[1:-1])
    np.testing.assert_allclose(way.positions, dive.way.positions[1:-1], atol=1e-6)
    same = np.abs(np.sum(way.quaternions * dive.way.quaternions[1:-1], axis=1))
    np.testing.assert_allclose(same, 1, atol=1e-9)


@pytest.mark.parametrize("name", ["cdr.mcap", "sqlite", "ros1.bag"])
def test_reading_from_the_middle_gives_what_reading_from_the_beginning_does(name, tmp_path, dive):
    WRITERS[name](tmp_path / name, dive)
    recording = open_recording(tmp_path / name, fields="progressive")
    late = list(recording.frames(37))
    assert [number_of(frame.image) for frame in late] == list(range(37, COUNT))
    assert [number_of(f.image) for f in recording.sample(4)] == [
        f.index for f in recording.sample(4)
    ]


def test_logs_beside_a_video_say_the_same(tmp_path, dive):
    write_csv(tmp_path / "a.csv", dive)
    ways = [read_navigation_log(tmp_path / "a.csv").poses]
    if pytest.importorskip("pymavlink", reason="the extra [tlog] is not installed"):
        write_tlog(tmp_path / "a.tlog", dive)
        ways.append(read_navigation_log(tmp_path / "a.tlog").poses)
    for way in ways:
        np.testing.assert_allclose(way.positions, dive.way.positions, atol=1e-6)
        np.testing.assert_allclose(way.times, BEGIN + dive.way.times, atol=1e-6)


def test_h265_is_read_from_any_place(tmp_path, dive):
    packets = encode_h264([numbered(k) for k in range(COUNT)], RATE, gop=10, codec="libx265")
    write_blueos(tmp_path / "a.mcap", replace(dive, packets=packets), form="h265")
    recording = open_recording(tmp_path / "a.mcap", fields="progressive")
    assert [number_of(frame.image) for frame in recording.frames()] == list(range(COUNT))
    assert recording.index.is_key.sum() == 6
    assert number_of(next(recording.frames(37)).image) == 37


def test_a_recording_goes_to_other_processes(tmp_path, dive):
    write_blueos(tmp_path / "a.mcap", dive)
    there = pickle.loads(pickle.dumps(open_recording(tmp_path / "a.mcap", fields="progressive")))
    assert [number_of(frame.image) for frame in there.frames(50)] == list(range(50, COUNT))


def test_a_file_that_was_cut_off_is_read_to_its_last_whole_chunk(tmp_path, dive):
    path = tmp_path / "cut.mcap"
    write_blueos(path, dive, chunk_size=2000)
    whole = len(list(open_recording(path, fields="progressive").frames()))
    with path.open("r+b") as file:
        file.truncate(int(path.stat().st_size * 0.6))
    recording = open_recording(path, fields="progressive")
    numbers = [number_of(frame.image) for frame in recording.frames()]
    assert numbers == list(range(len(numbers)))
    assert whole > len(numbers) > 0.4 * whole
    assert any("cut off" in remark for remark in recording.remarks)


def test_a_damaged_chunk_is_left_out_and_told(tmp_path, dive):
    path = tmp_path / "bad.mcap"
    write_blueos(path, dive, chunk_size=4000)
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0xFF
    path.write_bytes(data)
    contents = read_contents(path)
    assert len(contents.damage) == 1
    assert "damaged" in contents.damage[0]
    assert 20 < len(contents.pictures[0].times) < COUNT


def test_a_clock_that_steps_back_and_late_stamps_are_taken_out(tmp_path, dive):
    long = replace(
        dive,
        packets=dive.packets * 4,
        times=np.arange(4 * COUNT) / RATE,
        way=Trajectory(
            np.arange(-1, 11, 0.1), np.zeros((120, 3)), np.tile([1.0, 0, 0, 0], (120, 1))
        ),
    )
    write_blueos(
        tmp_path / "a.mcap", long, flaws=Flaws(jitter=0.02, delay=0.3, step_at=4.0, step=-1.0)
    )
    contents = read_contents(tmp_path / "a.mcap")
    assert [step.size for step in contents.steps] == [pytest.approx(-1.0, abs=0.05)]
    # Arrival is late by 0.3 s and by the mean of |jitter|; the smoothed rest is far below a step.
    late = contents.pictures[0].times - BEGIN - long.times
    assert np.std(late) < 0.01
    assert np.mean(late) == pytest.approx(0.3 + 0.016, abs=0.02)
    attitude = next(one for one in contents.series if one.kind == "attitude")
    assert np.std(attitude.times - BEGIN - long.way.times) < 0.01
    text = "\n".join(list_contents(contents))
    assert "put back by 1.0" in text
    assert "smoothed" in text


def test_a_single_late_message_is_no_step():
    log = (np.arange(200) * 10_000_000).astype(np.int64)
    log[100] -= 500_000_000
    assert find_steps_back(log) == []
    log[100:] -= 2_000_000_000
    assert [at for at, _ in find_steps_back(log)] == [100]


def test_the_autopilot_s_clock_tells_when_the_log_s_is_put_forward(tmp_path, dive):
    flaws = Flaws(step_at=1.0, step=86_400.0)
    write_blueos(tmp_path / "a.mcap", dive, flaws=flaws)
    contents = read_contents(tmp_path / "a.mcap")
    assert [step.size for step in contents.steps] == [pytest.approx(86_400.0, abs=0.1)]
    assert np.diff(contents.pictures[0].times).max() < 0.2


def test_even_times_stay_as_they_are():
    times = np.arange(100) / 25
    smooth, jitter = smooth_arrival(times)
    assert jitter == 0
    assert smooth is times
    boot = np.arange(100) / 10
    np.testing.assert_allclose(time_by_other(boot + 7, boot), boot + 7)


BAD = {
    "two": ({"cameras": ("video/a", "video/b")}, InputError, "video/a, video/b"),
    "codec": ({"form": "vvc"}, FormatError, "'vvc', which is not read"),
    "none": ({"cameras": ()}, FormatError, "holds no pictures"),
}


@pytest.mark.parametrize("case", BAD)
def test_what_cannot_be_scanned_is_one_sentence(case, tmp_path, dive):
    settings, error, words = BAD[case]
    write_blueos(tmp_path / "a.mcap", dive, **settings)
    with pytest.raises(error, match=words):
        open_recording(tmp_path / "a.mcap")
    if case == "two":
        assert open_recording(tmp_path / "a.mcap", topic="video/b").num_frames


def test_encrypted_pictures_are_told(tmp_path, dive):
    random = np.random.default_rng(0)
    noise = [random.integers(0, 256, 500, np.uint8).tobytes() for _ in dive.packets]
    write_blueos(tmp_path / "a.mcap", replace(dive, packets=noise))
    with pytest.raises(FormatError, match="encrypted"):
        open_recording(tmp_path / "a.mcap")


def test_pictures_without_data_keep_their_numbers(tmp_path, dive):
    packets = [b"" if k in (20, 21) else packet for k, packet in enumerate(dive.packets)]
    # Picture 22 to 29 lean on those that are missing, until the next keyframe.
    write_blueos(tmp_path / "a.mcap", replace(dive, packets=packets))
    skips = []
    recording = open_recording(tmp_path / "a.mcap", fields="progressive")
    frames = list(recording.frames(on_skip=skips.append))
    assert [frame.index for frame in frames if frame.index >= 30] == list(range(30, COUNT))
    assert {20, 21} <= {s.index + k for s in skips for k in range(s.count)}
    assert all(number_of(f.image) == f.index for f in frames if f.index >= 30)


def test_chapters_are_one_recording(tmp_path, dive):
    pieces = [slice(0, 20), slice(20, 50), slice(50, 60)]
    for k, piece in enumerate(pieces, start=1):
        times = dive.times[piece] - dive.times[piece][0]
        part = replace(dive, packets=dive.packets[piece], times=times)
        write_mp4(tmp_path / f"GX0{k}0042.MP4", part, RATE)
    recording = open_recording(tmp_path, fields="progressive")
    frames = list(recording.frames())
    assert [number_of(frame.image) for frame in frames] == list(range(COUNT))
    assert [frame.index for frame in frames] == list(range(COUNT))
    np.testing.assert_allclose([frame.time for frame in frames], dive.times, atol=1e-4)
    late = list(recording.frames(45))
    assert [frame.index for frame in late] == list(range(45, COUNT))
    assert {frame.index == number_of(frame.image) for frame in recording.sample(6)} == {True}
    paths = [tmp_path / f"GX0{k}0042.MP4" for k in (1, 2)]
    assert open_recording(paths).num_frames == 50
    with pytest.raises(InputError, match="named twice"):
        open_recording([paths[0], paths[0]])
