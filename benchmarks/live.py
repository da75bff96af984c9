"""How far behind a dive its preview is, what it leaves out, and whether its gaps are the scan's."""

import argparse
import multiprocessing
import os
import tempfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from harness import Figure, tell
from studio_streams import SDP

from murkscan.capture.field_order import Fields
from murkscan.cli.memory import share_freed_memory
from murkscan.extract import AbstractExtractor, GrayGravity, Murk
from murkscan.io.rig_toml import load_rig
from murkscan.live import GapMap, LiveFolder, LiveStatus
from murkscan.live.gap_map import NOTHING
from murkscan.motion import ConstantSpeed
from murkscan.motion.following import SteadyFollower
from murkscan.project import Project
from murkscan.report import CAUSES, GrowingCoverage, Reach, SurfaceDirections, SwathLayout
from murkscan.simulate import Recorder, Scene, load_scene
from murkscan.survey.live import run_live
from murkscan.survey.live_settings import LiveSettings
from murkscan.survey.simulate import simulate_recording
from murkscan.triangulate import RaySheet
from murkscan.types.rig import Rig

PICTURES = 50
"""Pictures that are simulated; a stream shows them forwards and backwards, over and over."""
COMPARED = 250
"""The same of the dive whose maps are compared."""
SPEED = 0.125
"""Of the camera in the scenes [m/s]."""
SPACING = 5e-3


class _Over(Exception):
    """The stream has been long enough; it is not scanned."""


@dataclass(frozen=True)
class Case:
    """One stream by one finder."""

    name: str
    scene: str
    extractor: AbstractExtractor
    port: int
    latency: float
    dropped: float | None
    shown: float | None
    """Bars: behind at most [s], dropped at most [%], frames a second shown at least."""


CASES = (
    Case("PAL fields at 50 /s by murk", "hull-c1.5", Murk(), 42010, 0.25, 2.0, None),
    Case("1920 × 1080 at 25 /s by murk", "hull-c1.5-hd", Murk(), 42020, 0.5, None, 10.0),
    Case(
        "1920 × 1080 at 25 /s by gray gravity", "hull-c1.5-hd", GrayGravity(), 42030, 0.2, 2, None
    ),
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0, help="length of each stream [s]")
    parser.add_argument("--only", default="", help="part of the names of the streams; no page then")
    given = parser.parse_args()
    seconds = given.seconds
    figures: list[Figure] = []
    with tempfile.TemporaryDirectory() as name:
        root, made = Path(name), dict[str, Path]()
        for case in CASES:
            if given.only not in case.name:
                continue
            if case.scene not in made:
                made[case.scene] = _make(case.scene, root / case.scene)
            out = root / f"dive-{case.port}"
            figures += _alone(_stream, case, made[case.scene], out, seconds)
            print("\n".join(one.as_row() for one in figures[-6:]), flush=True)
        if given.only:
            return
        figures += _compare(root / "compared")
    tell("live", "Live: how far behind, and how true", figures, note=_note(seconds))


def _alone(task: Callable[..., list[Figure]], *arguments: object) -> list[Figure]:
    """Call a function in a process of its own, as a dive is one: nothing else is in its memory."""
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=context) as pool:
        return pool.submit(task, *arguments).result()


def _note(seconds: float) -> str:
    load = os.getloadavg()[0]
    return (
        f"H.264 by RTP over the loopback interface, {seconds:g} s each, on {os.cpu_count()} cores "
        f"with a load of {load:.1f} in the last minute, this benchmark's own among it. On a "
        "machine that does other things as well frames come later and more are dropped: then what "
        "a frame costs, recording, decoding and drawing among it, tells more than the delay. "
        "Behind is the time from the arrival of a frame's data to its profile that 95 % of the "
        "frames keep; the frames that are looked ahead for are in it. Resident grows from a third "
        "of the stream to its end.\n\n"
        "Gaps are compared in cells of 5 mm, from where the preview begins, of a dive whose "
        "laser goes out for 50 mm of every 250 mm, with a camera of 360 × 288 px, replayed: the "
        "share of the cells "
        "that are gaps in either map, the preview's or the scan's, that are in both."
    )


def _make(name: str, out: Path) -> Path:
    """Simulate the middle of a hull, and encode it as H.264 of a stream."""
    scene = load_scene(name)
    if scene.rig.camera.size[0] == 1920:
        scene = _as_1080(scene)
    rows = scene.row_step
    first = len(scene) // (2 * rows) - PICTURES // 2
    times = scene.times[rows * first : rows * (first + PICTURES)]
    simulate_recording(replace(scene, times=times, recorder=Recorder("ffv1")), out)
    with av.open(str(out / "recording.mkv")) as source:
        forth = [f.to_ndarray(format="gray") for f in source.decode(video=0)]
    _encode(out / "stream.mkv", [*forth, *forth[::-1]])
    return out


def _as_1080(scene: Scene) -> Scene:
    camera = scene.rig.camera
    u, v = camera.principal_point
    cut = (camera.size[1] - 1080) // 2
    camera = replace(camera, size=(1920, 1080), principal_point=(u, v - cut))
    return replace(scene, rig=replace(scene.rig, camera=camera))


def _encode(path: Path, pictures: Sequence[np.ndarray], *, rate: int = 25) -> None:
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=rate)
        stream.height, stream.width = pictures[0].shape
        stream.pix_fmt = "yuv420p"
        options = {"g": "25", "tune": "zerolatency", "preset": "ultrafast", "crf": "23"}
        # Parameter sets stand before each keyframe, as cameras send them.
        stream.codec_context.options = options | {"x264-params": "repeat-headers=1:annexb=1"}
        for number, picture in enumerate(pictures):
            frame = av.VideoFrame.from_ndarray(picture, "gray").reformat(format="yuv420p")
            frame.pts, frame.time_base = number, Fraction(1, rate)
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))


def _send(path: str, port: int) -> None:
    """Send a file's packets over and over, 25 a second."""
    with av.open(path) as source:
        template = source.streams.video[0]
        packets = [p for p in source.demux(video=0) if p.size]
        with av.open(f"rtp://127.0.0.1:{port}", "w", format="rtp") as out:
            stream = out.add_stream_from_template(template)
            began, number = time.monotonic(), 0
            while True:
                for packet in packets:
                    copy = av.Packet(bytes(packet))
                    copy.stream, copy.time_base = stream, Fraction(1, 25)
                    copy.pts = copy.dts = number
                    copy.is_keyframe = packet.is_keyframe
                    out.mux(copy)
                    number += 1
                    time.sleep(max(0.0, began + number / 25 - time.monotonic()))


def _settings(
    extractor: AbstractExtractor, fields: Fields, *, is_scanned: bool = False
) -> LiveSettings:
    motion = ConstantSpeed(SPEED, "y")

    def stop(began: float) -> ConstantSpeed:
        raise _Over

    return LiveSettings(
        lambda began: SteadyFollower(motion),
        (lambda began: motion) if is_scanned else stop,
        extractor,
        RaySheet(),
        spacing=SPACING,
        fields=fields,
        timeout=120.0,  # the sender is a process of its own, which has to begin first
    )


def _stream(case: Case, made: Path, out: Path, seconds: float) -> list[Figure]:
    """Stream for so long after the first profile, and say how the preview kept up."""
    share_freed_memory()  # as the command does
    rig, told = load_rig(made / "rig.toml"), list[LiveStatus]()
    sdp = out.with_suffix(".sdp")
    sdp.write_text(SDP.format(port=case.port))
    resident: list[float] = []
    used = os.times()

    def over() -> bool:
        seen = [status for status in told if status.preview.frames]
        if seen:
            resident.append(_resident())
        return bool(seen) and told[-1].recorded.time >= seen[0].recorded.time + seconds

    fields: Fields = "top-first" if rig.camera.size[0] == 720 else "progressive"
    context = multiprocessing.get_context("spawn")
    sender = context.Process(target=_send, args=(str(made / "stream.mkv"), case.port), daemon=True)
    sender.start()
    try:
        run_live(
            str(sdp), rig, _settings(case.extractor, fields), out=out, tell=told.append, until=over
        )
    except _Over:
        pass
    finally:
        sender.kill()
    now = os.times()
    return _figures(case, told, resident, now.user + now.system - used.user - used.system)


def _figures(
    case: Case, told: Sequence[LiveStatus], resident: Sequence[float], busy: float
) -> list[Figure]:
    seen = [status for status in told if status.preview.frames]
    first, last = seen[0], seen[-1]
    span = last.recorded.time - first.recorded.time
    frames = last.preview.frames - first.preview.frames
    dropped = last.preview.dropped - first.preview.dropped
    late = float(np.median([s.preview.latency for s in seen if s.preview.latency is not None]))
    third = resident[len(resident) // 3]
    name = case.name
    return [
        Figure(f"{name}: behind", 1e3 * late, "ms", at_most=1e3 * case.latency),
        Figure(f"{name}: dropped", 100 * dropped / max(frames + dropped, 1), "%", case.dropped),
        Figure(f"{name}: shown", frames / span, "/s", at_least=case.shown),
        Figure(f"{name}: processor", 1e3 * busy / max(last.preview.frames, 1), "ms a frame shown"),
        Figure(f"{name}: resident grows by", resident[-1] - third, "MB", at_most=50.0),
        Figure(f"{name}: resident", resident[-1], "MB", at_most=900.0),
    ]


def _resident() -> float:
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def _compare(out: Path) -> list[Figure]:
    """Replay a dive whose laser goes out for a while, scan it, and hold both maps together."""
    scene = halved(load_scene("hull-c1.5"))
    first = len(scene) // 4
    times = scene.times[first : first + 2 * COMPARED]
    simulate_recording(replace(scene, times=times, recorder=Recorder("ffv1")), out)
    with av.open(str(out / "recording.mkv")) as source:
        pictures = [f.to_ndarray(format="gray") for f in source.decode(video=0)]
    dark = np.full_like(pictures[0], int(np.median(pictures[0])))
    shown = [dark if number % 50 >= 40 else one for number, one in enumerate(pictures)]
    _encode(out / "dive.mkv", shown, rate=25)
    rig = load_rig(out / "rig.toml")
    settings = _settings(Murk(), "top-first", is_scanned=True)
    project = run_live(str(out / "dive.mkv"), rig, settings, out=out / "scan")
    live = LiveFolder(out / "scan" / "live")
    gaps, status = live.load_gaps(), live.load_status()
    assert gaps is not None
    agreement = 100 * _agreement(gaps, project, rig)
    return [
        Figure("gaps in both of those in either", agreement, "%", at_least=90.0),
        Figure("of that dive dropped from the preview", _share_dropped(status), "%"),
    ]


def halved(scene: Scene) -> Scene:
    """The same scene through a camera of a quarter of the pixels, which is looked at sooner."""
    camera = scene.rig.camera
    width, height = (side // 2 for side in camera.size)
    f, g = camera.focal_length
    centre = ((width - 1) / 2, (height - 1) / 2)
    camera = replace(
        camera, size=(width, height), focal_length=(f / 2, g / 2), principal_point=centre
    )
    return replace(scene, rig=replace(scene.rig, camera=camera))


def _share_dropped(status: LiveStatus) -> float:
    preview = status.preview
    return 100 * preview.dropped / max(preview.frames + preview.dropped, 1)


def _agreement(gaps: GapMap, project: Project, rig: Rig) -> float:
    """Compare with the map of the scan's own points, by the report's way, in the same cells."""
    frames, trajectory = project.load_placed_times(), project.load_trajectory()
    directions = SurfaceDirections.from_trajectory(trajectory, rig.lasers[0].axis)
    layout = SwathLayout(frames, trajectory, rig.lasers[0].axis, rig.camera.size, 2, directions)
    parts = list(project.load_kept_parts())
    ranges = np.concatenate([np.linalg.norm(part.points, axis=1) for part in parts])
    signals = np.concatenate([part.signal for part in parts])
    background = project.load_background()
    reach = Reach.from_points(
        ranges, signals, noise=0.0 if background is None else background.noise
    )
    growing = GrowingCoverage(wanted=SPACING, cell=gaps.cell, most=10**7)
    growing.add(parts, layout, reach)
    whole = growing.as_map()
    assert whole is not None
    low = np.round(np.array(whole.corner) / gaps.cell).astype(int)
    shift = np.round(np.array(gaps.corner) / gaps.cell).astype(int) - low
    state = np.full(gaps.state.shape, NOTHING, int)
    rows, columns = np.indices(gaps.state.shape)
    rows, columns = rows + shift[1], columns + shift[0]
    inside = (rows >= 0) & (columns >= 0)
    inside &= (rows < whole.points.shape[0]) & (columns < whole.points.shape[1])
    state[inside] = whole.state()[rows[inside], columns[inside]]
    # What lies before the first cell of a row that the preview knows was passed while it learnt.
    seen = np.maximum.accumulate(gaps.state != NOTHING, axis=1)
    in_preview = (gaps.state != NOTHING) & (gaps.state > 0) & seen
    in_scan = (state > 0) & (state <= len(CAUSES)) & seen
    either = int((in_preview | in_scan).sum())
    return float((in_preview & in_scan).sum() / either) if either else 1.0


if __name__ == "__main__":
    main()
