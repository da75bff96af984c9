"""murkscan live: record a dive, show it while it goes on, and scan it when it is over."""

from contextlib import closing, nullcontext
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter, validators
from cyclopts.types import PositiveFloat

from ..ui.choices import ExtractorName, check_settings, make_extractor, make_method
from .live_display import LiveDisplay
from .live_motion import follow_mavlink, make_follower, make_mover, open_link
from .options import ExecutorFlags, Lasers, MotionFlags, Settings
from .paths import RigFile
from .progress import progress_bars
from .typed import WORDS

_Wait = Annotated[
    PositiveFloat, Parameter(name="--timeout-s", validator=validators.Number(lte=86400))
]
_Patience = Annotated[
    PositiveFloat, Parameter(name="--patience-s", validator=validators.Number(lte=86400))
]


def live(
    source: str,
    *,
    rig: RigFile,
    out: Path,
    motion: MotionFlags = MotionFlags(),
    work: ExecutorFlags = ExecutorFlags(),
    mavlink: str | None = None,
    spacing_mm: PositiveFloat = 5.0,
    extractor: ExtractorName = "murk",
    settings: Settings = (),
    fields: Literal["auto", "progressive", "top-first", "bottom-first"] = "auto",
    laser: Lasers = (),
    seconds: PositiveFloat | None = None,
    timeout: _Wait = 10.0,
    patience: _Patience = 60.0,
) -> None:
    """Record a dive, see it while it goes on, and scan it when it is over.

    The stream is recorded into OUT/capture as `murkscan capture` does; gauges, a preview that grows
    and a map of gaps go to the terminal and into OUT/live. Ctrl-C ends the dive; then all of it is
    scanned into OUT. Run the same command again to go on with a dive that was broken off.

    Parameters
    ----------
    source
        An address (udp://, rtp://, rtsp:// ...), an SDP file, a camera (its number, or /dev/video
        and its number), or a recording, which is replayed at its own speed.
    rig
        The rig file of the camera and laser.
    out
        Folder for everything that is made.
    mavlink
        Where to listen to the vehicle: HOST:PORT of this machine, such as 0.0.0.0:14550. What it
        sends is written to OUT/capture/navigation.tlog; --speed-mm-s may stand beside it.
    spacing_mm
        Wanted distance of neighbouring points [mm]: gaps and speed are judged by it.
    extractor
        The way to find the stripe.
    settings
        A setting of the extractor, as NAME=NUMBER; may be given again.
    fields
        Whether a picture holds two fields of an interlaced camera; found if not said.
    laser
        Number of a laser in the rig whose stripe is followed, from 0; may be given again. All of
        them unless given; the preview follows the first.
    seconds
        Length of the dive [s], unless Ctrl-C or the end of the stream comes first.
    timeout
        Longest wait for the stream and for its next picture [s].
    patience
        How long a stream that was lost is waited for before the dive counts as over [s].
    """
    check_settings(settings)
    motion = follow_mavlink(motion, mavlink, out)
    motion.check()
    with progress_bars():
        from ..io.rig_toml import load_rig
        from ..live import find_calibrated_range
        from ..project.origin import read_calibration
        from ..survey.live import run_live
        from ..survey.live_settings import LiveSettings
        from .summary import print_summary

        of_dive, first = load_rig(rig), min(laser, default=0)
        link = None if mavlink is None else open_link(mavlink, motion)
        chosen = LiveSettings(
            make_follower(motion, of_dive, first, link),
            make_mover(motion, of_dive, first),
            make_extractor(extractor, settings),
            make_method("ray-sheet"),
            lasers=laser,
            spacing=spacing_mm / 1e3,
            working=find_calibrated_range(read_calibration(rig), first),
            fields=fields,
            timeout=timeout,
            patience=patience,
            beside=nullcontext if link is None else link.listening,
        )
    with closing(LiveDisplay(seconds)) as show:
        project = run_live(
            source,
            of_dive,
            chosen,
            out=out,
            rig_file=rig,
            command=WORDS.get(),
            executor=work.make(),
            tell=show.tell,
            progress=show.progress,
            until=show.is_over,
        )
    print_summary(project)
