"""murkscan motion: where the camera was in each frame."""

from .options import MotionFlags, NoAdjust
from .paths import ScanFolder
from .typed import WORDS


def motion(
    out: ScanFolder, *, flags: MotionFlags = MotionFlags(), no_adjust: NoAdjust = False
) -> None:
    """Find where the camera was in each frame of a scan.

    Parameters
    ----------
    out
        Folder of the scan, with finished extract and triangulate stages.
    no_adjust
        Leave the trajectory as it is logged, though the scan saw places twice.
    """
    from pathlib import Path

    from ..project import EXTRACT, Project, load_recording, load_scan_rig
    from ..survey.motion import follow_motion
    from .summary import print_correction, print_remarks, print_result

    project = Project(out, WORDS.get())
    recording = Path(load_recording(project).path)
    flags.check(recording)
    rig = load_scan_rig(project)
    lasers = project.finished(EXTRACT).result.lasers
    made = flags.make(rig, lasers[0], recording)
    result = follow_motion(project, made, adjust=not no_adjust)
    print_result("motion", result, out / "motion", out=out)
    print_remarks(result.remarks)
    print_correction(result.correction)
