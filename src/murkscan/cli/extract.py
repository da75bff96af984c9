"""murkscan extract: find the stripe in every frame."""

from pathlib import Path

from ..ui.choices import ExtractorName, check_settings, make_extractor
from .options import ExecutorFlags, Lasers, RecordingFlags, Settings
from .paths import RecordingPaths, RigFile
from .progress import progress_bars
from .typed import WORDS


def extract(
    recording: RecordingPaths,
    *,
    rig: RigFile,
    out: Path,
    reading: RecordingFlags = RecordingFlags(),
    work: ExecutorFlags = ExecutorFlags(),
    extractor: ExtractorName = "murk",
    settings: Settings = (),
    laser: Lasers = (),
) -> None:
    """Find the stripe in every frame of a recording.

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
    laser
        Number of a laser in the rig whose stripe is followed, from 0; may be given again. All of
        them unless given.
    """
    check_settings(settings)
    executor = work.make()
    from ..io.rig_toml import load_rig
    from ..project import Project
    from ..survey.extract import extract_recording
    from ..survey.scan import begin_scan
    from .summary import print_remarks, print_result, print_skips

    of_recording = load_rig(rig)
    pictures = reading.open(recording, of_recording)
    finder = make_extractor(extractor, settings)
    project = Project(out, WORDS.get())
    begin_scan(
        project,
        pictures,
        of_recording,
        lasers=laser,
        settings={"extractor": finder},
        rig_file=rig,
    )
    with progress_bars() as progress:
        result = extract_recording(
            project,
            pictures,
            of_recording,
            finder,
            lasers=laser,
            executor=executor,
            progress=progress,
        )
    print_result("extract", result, out / "extract", out=out)
    print_skips(result.skips)
    print_remarks(result.remarks, result.attenuation)
