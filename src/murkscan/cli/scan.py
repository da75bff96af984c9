"""murkscan scan: all stages in order."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from ..ui.choices import (
    ExtractorName,
    MesherName,
    MethodName,
    check_settings,
    make_extractor,
    make_mesher,
    make_method,
    make_rules,
)
from ..ui.values import read_box
from .options import (
    Attenuation,
    ExecutorFlags,
    Lasers,
    MaybePlace,
    MotionFlags,
    NoAdjust,
    RecordingFlags,
    Settings,
)
from .paths import RecordingPaths, RigFile
from .progress import progress_bars
from .typed import WORDS
from .words import say


def scan(
    recording: RecordingPaths,
    *,
    rig: RigFile,
    out: Path,
    motion: MotionFlags = MotionFlags(),
    reading: RecordingFlags = RecordingFlags(),
    work: ExecutorFlags = ExecutorFlags(),
    extractor: ExtractorName = "murk",
    settings: Settings = (),
    method: MethodName = "ray-sheet",
    mesher: MesherName = "grid",
    laser: Lasers = (),
    no_adjust: NoAdjust = False,
    volume_m: MaybePlace = None,
    attenuation_per_m: Attenuation = None,
    frames: Annotated[bool, Parameter(negative=())] = False,
) -> None:
    """Turn a recording into a measured 3D model: all stages in order.

    A stage that is done and unchanged is skipped, an interrupted one goes on where it stopped.

    Parameters
    ----------
    recording
        A folder of images, a video or its chapters in order, or a dive's MCAP or bag.
    rig
        The rig file of the camera and laser that made the recording.
    out
        Folder for everything that is made.
    extractor
        The way to find the stripe.
    settings
        A setting of the extractor, as NAME=NUMBER; may be given again.
    method
        The way from pixels to points.
    mesher
        The way to make a surface.
    laser
        Number of a laser in the rig whose stripe is followed, from 0; may be given again. All of
        them unless given.
    no_adjust
        Leave the trajectory as it is logged, though the scan saw places twice.
    volume_m
        Leave out of the model what lies outside of this box: two corners X,Y,Z,X,Y,Z in the world
        [m].
    frames
        Write one cloud a frame for more than 500 frames, too.
    """
    motion.check(recording[0])
    check_settings(settings)
    if volume_m is not None:
        read_box("--volume-m", volume_m)
    executor = work.make()
    with progress_bars() as progress:
        from ..io.rig_toml import load_rig
        from ..survey.scan import scan as run
        from .summary import print_summary, when_reported

        of_recording, before = load_rig(rig), when_reported(out)
        project = run(
            reading.open(recording, of_recording),
            of_recording,
            motion.make(of_recording, min(laser, default=0), recording[0]),
            out=out,
            extractor=make_extractor(extractor, settings),
            method=make_method(method),
            mesher=make_mesher(mesher, ()),
            lasers=laser,
            adjust=not no_adjust,
            rules=make_rules(volume_m),
            attenuation=attenuation_per_m,
            frames=frames,
            rig_file=rig,
            command=WORDS.get(),
            executor=executor,
            progress=progress,
        )
    print_summary(project)
    if before is not None and before == when_reported(out):
        say("All of this was there already, and nothing had changed.")
