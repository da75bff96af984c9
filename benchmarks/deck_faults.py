"""Faults that spoil a dive or a calibration, put in one at a time: what is said, and how soon."""

import math
import re
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import cv2
import numpy as np
from deck_pictures import (
    BOARD,
    SQUARE,
    WAYS,
    cut_off,
    darken,
    draw_flat_board,
    encode,
    fog_up,
    light,
    make_boards,
    make_dive,
)
from harness import Figure, tell
from kept import Kept, make_in_pieces

from murkscan.calibrate import BoardView, Chessboard, calibrate_camera
from murkscan.calibrate.board.corners import find_board
from murkscan.calibrate.so_far import SoFar, judge_so_far
from murkscan.distribute import Threads
from murkscan.errors import MurkscanError
from murkscan.extract import Murk
from murkscan.io.growing_table import GrowingTable
from murkscan.io.images import write_image
from murkscan.io.json_files import load_json
from murkscan.io.pose_reading import PoseConvention
from murkscan.io.rig_toml import load_rig
from murkscan.live import LiveStatus
from murkscan.motion import ConstantSpeed
from murkscan.motion.following import AbstractFollower, LogFollower, SteadyFollower
from murkscan.survey.calibrate_camera import calibrate_camera_from_photos
from murkscan.survey.calibrate_laser import calibrate_laser_from_photos
from murkscan.survey.live import run_live
from murkscan.survey.live_settings import LiveSettings
from murkscan.survey.photograph import take_photos
from murkscan.triangulate import RaySheet
from murkscan.types.arrays import Image
from murkscan.types.pose import Pose

RATE, GOOD, BAD = 25, 200, 150
"""Pictures a second; pictures before a fault begins, and with it."""
SPEED = 0.125
"""Of the camera [m/s]."""
SOON = 5.0
"""Time in which a fault must be named [s]."""
CLEAN = (0.5, 1.0, 1.5, 2.0, 3.0)
"""Attenuations of the dives without a fault [1/m]."""
OFF = 30.0
"""By how much a wrong clock is wrong [s]."""


class _Over(Exception):
    """The dive has been shown; it is not scanned."""


@dataclass(frozen=True)
class Told:
    """What was said of one fault."""

    name: str
    words: str
    """The sentence; empty where nothing was said."""
    seconds: float
    is_right: bool
    """Whether it names the fault, and nothing else was said before."""


@dataclass(frozen=True)
class Fault:
    """One fault of a dive: what it does to its pictures from one on, and what names it."""

    name: str
    spoil: Callable[[Image, float], Image]
    """Gives the picture some time [s] after the fault began."""
    right: str
    """What a sentence says that names it."""
    log_is_off: bool = False
    disk_fills: bool = False


def main() -> None:
    told, clean = make_in_pieces(_try_all)
    named = [one for one in told if one.is_right and one.seconds <= SOON]
    spoken = [one for one in clean if one.words]
    figures = [
        Figure("faults named in the right words within 5 s, of 10", len(named), "", at_least=9),
        Figure("slowest of these", max((t.seconds for t in named), default=math.nan), "s"),
        Figure("clean runs with a warning, of 10", len(spoken), "", at_most=0),
    ]
    tell("deck_faults", "Ten faults, one at a time", figures, note=_note(told))


def _try_all(kept: Kept) -> tuple[list[Told], list[Told]]:
    """Put in each fault, and watch what has none."""
    with tempfile.TemporaryDirectory() as scratch:
        root = Path(scratch)
        faults = {fault.name: partial(_spoil_dive, root, kept.folder, fault) for fault in FAULTS}
        faults |= {name: partial(_spoil_board, root, kept.folder, name) for name in SPOILT}
        faults |= {
            "boards all flat": _hold_flat,
            "wrong square size": partial(_mistake_square, root, kept.folder),
        }
        clean = {
            f"dive at {murk:g} per m": partial(_watch_clean_dive, root, kept.folder, murk)
            for murk in CLEAN
        }
        clean |= {
            f"boards {name}": partial(_watch_clean_boards, kept.folder, name) for name in WAYS
        }
        return _take(kept, faults), _take(kept, clean)


def _take(kept: Kept, runs: Mapping[str, Callable[[], Told]]) -> list[Told]:
    taken = []
    for name, run in runs.items():
        taken.append(Told(**kept.take(name.replace(" ", "-"), lambda run=run: asdict(run()))))
        print(taken[-1], flush=True)
    return taken


def _note(told: Sequence[Told]) -> str:
    rows = [f"| {t.name} | {t.seconds:.1f} s | {t.words or '**nothing**'} |" for t in told]
    return "\n".join([
        "A fault begins after eight seconds of a good dive (360 × 288 px, 25 /s, by murk), or with "
        "the next photograph of a board; the time runs from its first picture to the first "
        "sentence. Clean are five dives at c = 0.5 to 3 /m and five sets of 25 photographs, as "
        "they come, darker, noisier, softer, and mirrored.", "",
        "| fault | said after | sentence |", "|---|---|---|", *rows,
    ])  # fmt: skip


def _nothing(image: Image, since: float) -> Image:
    return image


FAULTS = (
    Fault("lamp on", light, "lamp is on"),
    Fault("laser off", darken, "stripe is lost"),
    Fault("window fogged", fog_up, "window is fogged"),
    Fault("wrong clock", _nothing, "log's clock does not fit", log_is_off=True),
    Fault("disk nearly full", _nothing, "disk is nearly full", disk_fills=True),
)


def _spoil_dive(root: Path, made: Path, fault: Fault) -> Told:
    rig_file, pictures = make_dive(made, 1.5)
    spoilt = [
        image if number < GOOD else fault.spoil(image, (number - GOOD) / RATE)
        for number, image in enumerate(_shown(pictures))
    ]
    return _judge(fault, _watch(root, fault.name, rig_file, spoilt, fault))


def _shown(pictures: Sequence[Image]) -> Iterator[Image]:
    """Show a few pictures forwards and backwards, as many as a dive has."""
    both = [*pictures, *pictures[::-1]]
    for number in range(GOOD + BAD):
        yield both[number % len(both)]


def _watch(
    root: Path, name: str, rig_file: Path, pictures: Sequence[Image], fault: Fault | None
) -> list[LiveStatus]:
    """Replay pictures as a dive; gives each status."""
    folder = root / name.replace(" ", "-")
    folder.mkdir(parents=True)
    encode(folder / "dive.mkv", pictures, RATE)
    told = list[LiveStatus]()
    with suppress(_Over):
        run_live(
            str(folder / "dive.mkv"), load_rig(rig_file), _settings(folder, fault, told),
            out=folder / "out", tell=told.append,
        )  # fmt: skip
    return told


def _settings(folder: Path, fault: Fault | None, told: Sequence[LiveStatus]) -> LiveSettings:
    def move(began: float) -> ConstantSpeed:
        raise _Over

    def follow(began: float) -> AbstractFollower:
        if fault is None or not fault.log_is_off:
            return SteadyFollower(ConstantSpeed(SPEED, "y"))
        table = GrowingTable(_write_log(folder / "poses.csv"), "pose log")
        return LogFollower(table, PoseConvention(), Pose.identity(), start_time=OFF, gap=0.5)

    def find_room(of: Path) -> int:
        shown = told[-1].recorded.pictures if told else 0
        return 1_500_000_000 if fault and fault.disk_fills and shown > GOOD else 50_000_000_000

    return LiveSettings(
        follow, move, Murk(), RaySheet(), fields="progressive", learner=Threads(1),
        find_room=find_room,
    )  # fmt: skip


def _write_log(path: Path) -> Path:
    lines = ["time_s,x_m,y_m,z_m,qw,qx,qy,qz"]
    lines += [f"{t:.2f},0,{SPEED * t:.4f},0,1,0,0,0" for t in np.arange(0, 20, 0.1)]
    path.write_text("\n".join(lines) + "\n")
    return path


def _judge(fault: Fault, told: Sequence[LiveStatus]) -> Told:
    spoken = [status for status in told if status.warnings]
    if not spoken:
        return Told(fault.name, "", 0.0, False)
    words = " ".join(spoken[0].warnings)
    # A wrong clock is there from the first profile on.
    began = GOOD / RATE
    if fault.log_is_off:
        began = next(status.recorded.time for status in told if status.preview.frames)
    return Told(
        fault.name, words, spoken[0].recorded.time - began,
        re.search(fault.right, words) is not None and len(spoken[0].warnings) == 1
        and spoken[0].recorded.time >= began,
    )  # fmt: skip


def _watch_clean_dive(root: Path, made: Path, murk: float) -> Told:
    rig_file, pictures = make_dive(made, murk)
    told = _watch(root, f"dive-{murk:g}", rig_file, list(_shown(pictures)), None)
    spoken = [" ".join(status.warnings) for status in told if status.warnings]
    return Told(f"dive at {murk:g} /m", spoken[0] if spoken else "", 0.0, not spoken)


SPOILT: dict[str, tuple[Callable[[Image], Image], str]] = {
    "glare": (lambda good: cv2.circle(good.copy(), (380, 300), 90, 255, -1), "glare"),
    "blur": (lambda good: cv2.GaussianBlur(good, (0, 0), 5.0), "not sharp|blurred"),
    "board cut off": (cut_off, "edge cuts"),
}
"""What spoils a photograph, and what names it."""


def _spoil_board(root: Path, made: Path, name: str) -> Told:
    """Photograph a board, and then one with a fault."""
    boards, _ = make_boards(made)
    spoil, right = SPOILT[name]
    folder = root / name.replace(" ", "-")
    words, seconds = _photograph(folder, [boards[3]] * 3, spoil(boards[3]))
    return Told(name, words, seconds, re.search(right, words) is not None)


def _photograph(folder: Path, before: Sequence[Image], spoilt: Image) -> tuple[str, float]:
    """Show boards to the camera, and then a spoilt one; gives what is said, and how soon [s]."""
    began, said = math.nan, ""

    def pictures() -> Iterator[tuple[Image, float]]:
        nonlocal began, said
        for number, image in enumerate(before):
            yield image, 0.5 * number
        began = time.perf_counter()
        for number in range(3):
            yield spoilt, 0.5 * (len(before) + number)
        said = str(load_json(folder / "sight" / "status.json")["message"])

    take_photos(pictures(), BOARD, folder, count=100)
    return said, time.perf_counter() - began


def _judge_camera(views: Sequence[BoardView], size: tuple[int, int]) -> SoFar:
    return judge_so_far("camera", views, BOARD, size, lambda: calibrate_camera(views, BOARD, size))


def _hold_flat() -> Told:
    photos = [draw_flat_board(number) for number in range(12)]
    began = time.perf_counter()
    views = [find_board(photo, BOARD, name=f"{k}") for k, photo in enumerate(photos)]
    judged = _judge_camera(views, (photos[0].shape[1], photos[0].shape[0]))
    spent = time.perf_counter() - began
    is_right = "face the camera straight on" in judged.verdict and "tilted" in judged.verdict
    return Told("boards all flat", judged.verdict, spent, is_right)


def _mistake_square(root: Path, made: Path) -> Told:
    """Calibrate the camera with the right squares, and the laser with wrong ones."""
    for name, photos in zip(("camera", "laser"), make_boards(made), strict=True):
        (root / name).mkdir()
        for number, photo in enumerate(photos):
            write_image(root / name / f"{number:02d}.png", photo)
    rig = root / "rig.toml"
    calibrate_camera_from_photos(root / "camera", BOARD, rig)
    began = time.perf_counter()
    wrong = Chessboard(BOARD.columns, BOARD.rows, 1.1 * SQUARE)
    result = calibrate_laser_from_photos(root / "laser", wrong, rig)
    spent = time.perf_counter() - began
    words = result.verdict.advice[0] if result.verdict.advice else ""
    return Told("wrong square size", words, spent, "squares are 33 mm" in words)


def _watch_clean_boards(made: Path, name: str) -> Told:
    photos = [WAYS[name](image) for image in make_boards(made)[0]]
    said = [words for words in map(_say_of_photo, photos) if words]
    views = [find_board(photo, BOARD) for photo in photos]
    judged = _judge_camera(views, (photos[0].shape[1], photos[0].shape[0]))
    said += [] if judged.is_good else [judged.verdict]
    return Told(f"boards {name}", said[0] if said else "", 0.0, not said)


def _say_of_photo(photo: Image) -> str:
    """Show one board long enough to be photographed; gives what is said instead of "taken"."""
    with tempfile.TemporaryDirectory() as name:
        try:
            take_photos(((photo, 0.5 * k) for k in range(3)), BOARD, Path(name), count=1)
        except MurkscanError as error:
            return str(error)
        said = str(load_json(Path(name) / "sight" / "status.json")["message"])
    return "" if said == "taken" else said


if __name__ == "__main__":
    main()
