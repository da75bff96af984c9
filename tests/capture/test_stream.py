"""Streams over the loopback interface, copied as they come."""

import time
from contextlib import closing
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from murkscan.capture import copy_stream, is_stream, open_recording
from murkscan.capture.stream import StreamTimes
from murkscan.errors import DeviceError, InputError

from ..streams import SDP, free_port


@pytest.fixture
def port():
    return free_port()


def record(source, out, seconds):
    for written in copy_stream(source, out, seconds=seconds, timeout=8.0):
        last = written
    return last


LENGTH = 1.18
"""Half way between the thirtieth picture and the next [s]: a receiver works an RTP stream's times
out of the sender's reports, to a millisecond or so."""


def check(out, last, pictures):
    """Pictures of the sender: a line that moves 1 px a picture, 25 a second, without a gap."""
    skips = []
    frames = list(open_recording(out).frames(on_skip=skips.append))
    assert skips == []
    assert len(frames) == last.frames == pictures
    assert frames[0].time == 0
    np.testing.assert_allclose(np.diff([frame.time for frame in frames]), 0.04, atol=2e-3)
    where = [int(frame.image[100].argmax()) for frame in frames]
    # Compression may make either of the line's four columns the brightest.
    np.testing.assert_allclose(np.diff(where), 1, atol=4)
    assert where[-1] - where[0] == pytest.approx(len(frames) - 1, abs=4)
    assert last.bytes > 0


def test_mpeg_ts_over_udp_is_copied_with_its_times(tmp_path, sending, port):
    sending(f"udp://127.0.0.1:{port}?pkt_size=1316", "mpegts")
    out = tmp_path / "dive.mkv"
    check(out, record(f"udp://127.0.0.1:{port}", out, LENGTH), 30)
    assert [file.name for file in tmp_path.iterdir()] == ["dive.mkv"]


def test_rtp_with_an_sdp_file_is_copied_with_its_times(tmp_path, sending, port):
    sending(f"rtp://127.0.0.1:{port}", "rtp")
    (tmp_path / "camera.sdp").write_text(SDP.format(port=port))
    out = tmp_path / "made" / "dive.mkv"
    check(out, record(str(tmp_path / "camera.sdp"), out, LENGTH), 30)


def test_a_recording_that_is_closed_early_plays(tmp_path, sending, port):
    sending(f"udp://127.0.0.1:{port}?pkt_size=1316", "mpegts")
    out = tmp_path / "dive.mkv"
    with closing(copy_stream(f"udp://127.0.0.1:{port}", out, timeout=8.0)) as recording:
        for last in recording:
            assert not out.exists()
            if last.frames == 20:
                break
    check(out, last, 20)


def test_a_stream_that_does_not_answer_is_told_in_time_and_leaves_nothing(tmp_path, port):
    began = time.monotonic()
    with pytest.raises(DeviceError, match=rf"{port} within 1 s.*firewall"):
        list(copy_stream(f"udp://127.0.0.1:{port}", tmp_path / "dive.mkv", timeout=1.0))
    assert time.monotonic() - began < 5
    assert list(tmp_path.iterdir()) == []


def test_a_refused_connection_is_told(tmp_path):
    with pytest.raises(DeviceError, match="refused"):
        list(copy_stream("rtsp://127.0.0.1:1/x", tmp_path / "dive.mkv", timeout=2.0))


def test_what_stands_there_is_not_overwritten(tmp_path):
    for name in ("dive.mkv", "deep.part.mkv"):
        (tmp_path / name).write_text("precious")
    for name in ("dive.mkv", "deep.mkv"):
        with pytest.raises(InputError, match="mkv"):
            list(copy_stream("udp://127.0.0.1:9", tmp_path / name))
    assert {file.read_text() for file in tmp_path.iterdir()} == {"precious"}


def test_another_kind_of_file_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"dive\.mkv"):
        list(copy_stream("udp://127.0.0.1:9", tmp_path / "dive.avi"))


def test_a_missing_sdp_file_is_refused(tmp_path):
    with pytest.raises(InputError, match="no SDP file"):
        list(copy_stream(str(tmp_path / "camera.sdp"), tmp_path / "dive.mkv"))
    assert is_stream("camera.SDP")
    assert is_stream("rtsp://camera")
    assert not is_stream("dive.mkv")


times = st.one_of(st.none(), st.integers(-(10**6), 10**9).map(lambda n: n / 90000))


@given(st.lists(st.tuples(times, times), min_size=1, max_size=30))
def test_recorded_times_always_grow_from_zero(packets):
    timeline = StreamTimes()
    placed = [timeline.place(*packet) for packet in packets]
    decoded = [dts for _, dts in placed]
    assert decoded[0] == 0
    assert all(a < b for a, b in pairwise(decoded))
    assert all(pts >= dts for pts, dts in placed)


@given(st.integers(0, 2**33), st.lists(st.integers(180, 90000), min_size=1, max_size=30))
def test_the_spacing_is_the_streams_own(start, steps):
    timeline = StreamTimes()
    ticks = np.cumsum([start, *steps])
    placed = [timeline.place(float(Fraction(int(t), 90000)), None)[0] for t in ticks]
    # Matroska keeps whole milliseconds.
    np.testing.assert_allclose(placed, (ticks - start) / 90, atol=0.5 + 1e-6)


def test_a_sender_that_begins_anew_goes_on_where_it_stopped():
    timeline = StreamTimes()
    placed = [timeline.place(time, None)[0] for time in (100.0, 100.04, 100.08, 0.0, 0.04)]
    assert placed == [0, 40, 80, 120, 160]


def test_a_file_that_describes_no_stream_is_told_so(tmp_path):
    (tmp_path / "camera.sdp").write_text("this is no description\n")
    with pytest.raises(DeviceError, match=r"camera\.sdp is no description of a stream"):
        list(copy_stream(str(tmp_path / "camera.sdp"), tmp_path / "dive.mkv", timeout=1.0))
