"""A dive's recording outlives a lost stream and a killed program, and its clock goes on."""

import os
import signal
import subprocess
import sys
import time
from contextlib import closing

import av
import numpy as np
import pytest

from murkscan.capture import DiveFolder, DiveRecord, open_recording, record_dive
from murkscan.errors import InputError, StreamLost

from ..streams import SDP, Sender, free_port

RECORD = """
import sys
from pathlib import Path
from murkscan.capture import DiveFolder, record_dive
for progress in record_dive(sys.argv[1], DiveFolder(Path(sys.argv[2])), timeout=20.0):
    print(progress.written.seconds, flush=True)
"""


def packet_times(file):
    with av.open(str(file)) as container:
        times = [
            packet.pts * packet.time_base for packet in container.demux(video=0) if packet.size
        ]
    return np.array(times, float)


def record_pictures(source, folder, count, **settings):
    with closing(record_dive(source, folder, **settings)) as recording:
        came = 0
        for progress in recording:
            came += progress.written is not None
            if came == count:
                return progress
    raise AssertionError("the stream ended too early")


@pytest.mark.parametrize("gone", [0.0, 30.0])
def test_a_lost_stream_is_waited_for_and_the_clock_goes_on(tmp_path, gone):
    port, folder = free_port(), DiveFolder(tmp_path / "capture")
    source, now = f"udp://127.0.0.1:{port}", [1e9]
    sender, losses, came = Sender(port), 0, 0
    recording = record_dive(source, folder, timeout=1.0, clock=lambda: now[0])
    with closing(recording):
        for progress in recording:
            if progress.written is None:
                losses, sender = progress.losses, Sender(port)
                now[0] += gone
            came += progress.written is not None
            if came == 15 and not losses:
                sender.stop()
            if came == 30:
                break
    sender.stop()
    assert losses >= 1
    assert folder.record == DiveRecord(source, 1e9)
    first, second = (packet_times(chapter) for chapter in folder.chapters)
    assert first[0] == 0
    assert second[0] == pytest.approx(max(gone, 0.0), abs=0.01)
    whole = open_recording(folder.chapters)
    times = [frame.time for frame in whole.frames()]
    assert np.all(np.diff(times) > 0)
    assert times[-1] - times[0] >= gone


def test_a_stream_that_stays_away_ends_the_dive(tmp_path):
    port, folder = free_port(), DiveFolder(tmp_path)
    sender, came = Sender(port), 0
    for progress in record_dive(f"udp://127.0.0.1:{port}", folder, timeout=0.7, patience=0.1):
        came += progress.written is not None
        if came == 5:
            sender.stop()
    assert len(folder.chapters) == 1


def test_what_was_recorded_before_a_kill_is_kept_and_gone_on_with(tmp_path):
    port, folder = free_port(), DiveFolder(tmp_path / "capture")
    source = f"udp://127.0.0.1:{port}"
    sender = Sender(port)
    command = [sys.executable, "-c", RECORD, source, str(folder.root)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as running:
        seconds = 0.0
        while seconds < 2.5:
            seconds = float(running.stdout.readline())
        os.kill(running.pid, signal.SIGKILL)
    part = folder.root / "dive-1.part.mkv"
    assert part.exists()
    assert packet_times(part)[-1] >= seconds - 2.0
    began = time.time()
    record_pictures(source, folder, 5, timeout=20.0)
    sender.stop()
    assert [chapter.name for chapter in folder.chapters] == ["dive-1.mkv", "dive-2.mkv"]
    second = packet_times(folder.chapters[1])
    assert second[0] >= began - folder.record.began


def test_a_part_that_does_not_play_is_put_aside(tmp_path):
    folder = DiveFolder(tmp_path)
    (tmp_path / "dive-1.part.mkv").write_bytes(b"no video")
    folder.adopt()
    assert [file.name for file in tmp_path.iterdir()] == ["dive-1.part.broken"]
    assert folder.chapters == []


def test_a_wrong_description_of_a_stream_is_told_in_one_sentence(tmp_path):
    (tmp_path / "camera.sdp").write_text(SDP.format(port=free_port()))
    with pytest.raises(StreamLost, match=r"No video .* comes from .*camera\.sdp within 0.5 s"):
        list(record_dive(str(tmp_path / "camera.sdp"), DiveFolder(tmp_path / "c"), timeout=0.5))
    with pytest.raises(InputError, match="no stream, no camera"):
        list(record_dive("nothing.mkv", DiveFolder(tmp_path / "c")))
