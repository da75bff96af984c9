"""A dive is recorded whole, shown while it goes on, and scanned when it is over."""

import shutil
import threading
import time
from dataclasses import replace

import numpy as np
import pytest

from murkscan.capture import DiveFolder, DiveRecord, open_recording, record_images
from murkscan.distribute import Threads
from murkscan.errors import DeviceError, InputError
from murkscan.extract import AbstractExtractor, GrayGravity
from murkscan.live import LiveFolder
from murkscan.motion import ConstantSpeed
from murkscan.motion.following import SteadyFollower
from murkscan.project import Project
from murkscan.survey.live import _play, run_live
from murkscan.survey.live_settings import LiveSettings
from murkscan.triangulate import RaySheet

from ..streams import Sender, free_port, picture, stream_rig

SPEED = 0.1
NUM_PICTURES = 60


class Scanned(Exception):
    """The dive is over, and the scan would begin."""


def _settings(**changed):
    motion = ConstantSpeed(SPEED, "x")
    given = LiveSettings(
        lambda began: SteadyFollower(motion),
        lambda began: motion,
        GrayGravity(),
        RaySheet(),
        spacing=0.01,
        fields="progressive",
        learner=Threads(1),
    )
    return replace(given, **changed)


def _no_scan(began):
    raise Scanned


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    """Two and a half seconds of a line that moves."""
    random, out = np.random.default_rng(0), tmp_path_factory.mktemp("replay") / "recording.mkv"
    noisy = (
        np.clip(picture(number) + random.normal(0, 2, (240, 320)), 0, 255).astype(np.uint8)
        for number in range(NUM_PICTURES)
    )
    list(record_images(((image, k / 25) for k, image in enumerate(noisy)), out))
    return out


@pytest.fixture(scope="module")
def replayed(recording, tmp_path_factory):
    """Replay it: the project, and each status that was told."""
    out, told = tmp_path_factory.mktemp("live") / "dive", []
    project = run_live(str(recording), stream_rig(), _settings(), out=out, tell=told.append)
    return project, told, LiveFolder(out / "live")


def test_a_replayed_recording_is_shown_and_scanned(replayed):
    project, told, live = replayed
    assert {"learning", "live"} <= {status.state for status in told}
    done = live.load_status()
    assert done.state == "done"
    assert done.recorded.pictures == NUM_PICTURES
    assert abs(done.began - done.updated) < 600
    assert 0 < done.preview.frames <= NUM_PICTURES
    assert done.stripe.state == "good"
    assert done.speed.value == pytest.approx(1e3 * SPEED, rel=1e-6)
    assert done.speed.highest == pytest.approx(250.0, rel=0.2)
    assert done.warnings == ()
    assert project.load_cloud().points.shape[0] > 1000
    assert not (project.root / "capture" / "dive-1.mkv").exists()


def test_the_preview_lies_on_the_scan(replayed):
    project, _, live = replayed
    parts = [live.load_points(part) for part in live.find_points()]
    shown, scanned = np.concatenate([part.points for part in parts]), project.load_cloud()
    frames = np.concatenate([part.frame for part in parts])
    assert len(shown) > 20
    for frame in np.unique(frames):
        of_scan = scanned.points[scanned.frame == frame]
        for point in shown[frames == frame]:
            assert np.abs(of_scan - point).sum(axis=1).min() < 1e-6


def test_pictures_and_map_can_be_read(replayed):
    _, _, live = replayed
    for file in (live.picture, live.stripe):
        assert file.read_bytes()[:2] == b"\xff\xd8"
    gaps = live.load_gaps()
    assert gaps.share > 0.9
    assert gaps.cell == 0.01


def test_the_same_command_again_only_sees_that_all_is_done(replayed, recording):
    project = replayed[0]
    before = (project.root / "report" / "report.json").stat().st_mtime_ns
    told = []
    run_live(str(recording), stream_rig(), _settings(), out=project.root, tell=told.append)
    assert told == []
    assert (project.root / "report" / "report.json").stat().st_mtime_ns == before
    with pytest.raises(InputError, match=r"recording\.mkv.*another folder"):
        run_live("udp://127.0.0.1:9", stream_rig(), _settings(), out=project.root)


def test_a_dive_that_was_killed_goes_on_with_its_points_and_its_map(tmp_path, replayed):
    _, _, earlier = replayed
    live = LiveFolder(tmp_path / "live")
    shutil.copytree(earlier.root, live.root)
    port, before = free_port(), earlier.load_status()
    source, sender, told = f"udp://127.0.0.1:{port}", Sender(port), []
    DiveFolder(tmp_path / "capture").save(DiveRecord(source, time.time() - 100.0))

    def is_over():
        return bool(told) and told[-1].preview.frames > 50

    with pytest.raises(Scanned):
        run_live(
            source, stream_rig(), _settings(move=_no_scan, timeout=20.0),
            out=tmp_path, tell=told.append, until=is_over,
        )  # fmt: skip
    sender.stop()
    after = live.load_status()
    assert after.points.parts > before.points.parts
    assert after.coverage.covered > before.coverage.covered
    assert DiveFolder(tmp_path / "capture").chapters
    assert after.recorded.time > 100.0


class Dreadful(AbstractExtractor):
    """Finds nothing, slowly, and then fails."""

    def extract(self, frames, rig, background, *, laser=0):
        for number, _ in enumerate(frames):
            time.sleep(0.3)
            if number == 2:
                raise RuntimeError("broken")
            yield from ()


class Slow(GrayGravity):
    """Takes longer for a frame than the frame lasts."""

    def extract(self, frames, rig, background, *, laser=0):
        for stripe in super().extract(frames, rig, background, laser=laser):
            time.sleep(0.08)
            yield stripe


def test_a_replay_waits_for_who_cannot_follow_and_a_disk_that_fills_is_told(tmp_path, recording):
    told = []
    settings = _settings(
        extractor=Slow(), move=_no_scan, find_room=lambda folder: 1_500_000_000
    )  # fmt: skip
    with pytest.raises(Scanned):
        run_live(str(recording), stream_rig(), settings, out=tmp_path / "dive", tell=told.append)
    shown = told[-1].preview
    assert shown.dropped == 0
    # The first dozen are what it learns from, and a few are under way by then.
    assert shown.frames >= NUM_PICTURES - 16
    assert told[-1].warnings == ("The disk is nearly full: 1.5 GB left; make room.",)


@pytest.mark.parametrize("extractor", [GrayGravity(), Dreadful()])
def test_every_picture_of_a_stream_is_recorded_whatever_the_scanning_does(tmp_path, extractor):
    port, told = free_port(), []
    source, sender = f"udp://127.0.0.1:{port}", Sender(port)
    settings = _settings(extractor=extractor, move=_no_scan, fields="auto", timeout=20.0)

    def is_over():
        return bool(told) and told[-1].recorded.time >= 2.5

    with pytest.raises(Scanned):
        run_live(source, stream_rig(), settings, out=tmp_path, tell=told.append, until=is_over)
    sender.stop()
    folder = DiveFolder(tmp_path / "capture")
    assert folder.record.ended
    (chapter,) = folder.chapters
    times = np.array([frame.time for frame in open_recording(chapter).frames()])
    np.testing.assert_allclose(np.diff(times), 0.04, atol=1e-9)
    assert told[-1].recorded.pictures == len(times)
    states = {status.state for status in told}
    if isinstance(extractor, Dreadful):
        assert any("the recording goes on" in said for said in told[-1].warnings)
    else:
        assert "live" in states
        assert told[-1].preview.frames > 0


def test_a_stream_of_another_size_is_recorded_and_told(tmp_path):
    port, told = free_port(), []
    rig = stream_rig()
    rig = replace(rig, camera=replace(rig.camera, size=(640, 480)))
    sender = Sender(port)
    with pytest.raises(Scanned):
        run_live(
            f"udp://127.0.0.1:{port}", rig, _settings(move=_no_scan, timeout=20.0),
            out=tmp_path, tell=told.append,
            until=lambda: bool(told) and told[-1].recorded.time >= 1.5,
        )  # fmt: skip
    sender.stop()
    assert any("320 × 240 px but the rig's camera has 640" in w for w in told[-1].warnings)
    assert DiveFolder(tmp_path / "capture").chapters


def test_a_replay_of_another_size_is_refused_before_anything_is_made(tmp_path, recording):
    rig = stream_rig()
    rig = replace(rig, camera=replace(rig.camera, size=(640, 480)))
    with pytest.raises(InputError, match="320 × 240 px but the rig's camera has 640 × 480"):
        run_live(str(recording), rig, _settings(), out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_stream_that_never_comes_leaves_one_sentence(tmp_path):
    source = f"udp://127.0.0.1:{free_port()}"
    with pytest.raises(DeviceError, match="No stream comes from"):
        run_live(source, stream_rig(), _settings(timeout=0.5), out=tmp_path / "dive")
    status = LiveFolder(tmp_path / "dive" / "live").load_status()
    assert status.state == "failed"
    assert "No stream comes from" in status.message
    assert Project(tmp_path / "dive").check_writable() is None


def test_a_source_that_is_none_is_refused_before_anything_is_made(tmp_path):
    for source in ("nothing.mkv", str(tmp_path / "missing.sdp")):
        with pytest.raises(InputError, match=r"nothing\.mkv is no|no SDP file .*missing"):
            run_live(source, stream_rig(), _settings(), out=tmp_path / "dive")
    assert not (tmp_path / "dive").exists()


def test_a_folder_of_other_things_is_refused(tmp_path):
    (tmp_path / "thesis.tex").write_text("mine")
    with pytest.raises(InputError, match="other files"):
        run_live("udp://127.0.0.1:9", stream_rig(), _settings(), out=tmp_path)


class _Interrupted:
    """A dive that is ended by hand while its stream is silent: its recorder takes a while."""

    def __init__(self):
        self.pictures, self.ticks, self.is_stopped = self, 0, False
        self.is_over = threading.Event()

    def tick(self):
        self.ticks += 1
        if self.ticks == 1:
            raise KeyboardInterrupt

    def stop(self):
        self.is_stopped = True
        threading.Timer(0.3, self.is_over.set).start()


def test_a_dive_that_is_ended_by_hand_waits_until_its_recording_is_whole():
    dive = _Interrupted()
    _play(dive, until=lambda: False)
    assert dive.is_stopped
    assert dive.is_over.is_set()
    assert dive.ticks > 1
