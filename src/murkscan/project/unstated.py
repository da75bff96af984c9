"""Whose errors no interval of a scan knows, since nobody has stated them."""

from .folder import Project
from .kinds import CLOUD, MOTION
from .merged import load_pass_rig, load_passes
from .scanned import is_merged, load_scan_rig

_NAVIGATION = "say in [navigation] of the rig file how good the vehicle's instruments are."


def list_unstated(project: Project) -> list[str]:
    """Say whose errors are in no interval of a scan or a merged cloud, a sentence each.

    Raises:
        MissingResult: The motion stage has not been finished.
    """
    if is_merged(project):
        return _list_of_passes(project)
    said = []
    if not load_scan_rig(project).covariance.names:
        said.append(
            "The rig file states no covariance: the rig's error is unknown, and in no interval; "
            "murkscan calibrate finds it."
        )
    if not project.finished(MOTION).result.accuracy:
        said.append(
            "The log of the poses states no uncertainty: the motion's error is in no interval; "
            f"{_NAVIGATION}"
        )
    return said


def _list_of_passes(project: Project) -> list[str]:
    passes = [(one, load_pass_rig(project, one)) for one in load_passes(project)]
    told, said = project.finished(CLOUD).result.passes, []
    bare = [one.path for one, rig in passes if rig is None or not rig.covariance.names]
    if bare:
        said.append(
            f"Of {', '.join(bare)} no rig with a covariance is known: its error is in no interval."
        )
    pairs = zip(passes, told, strict=True)
    unsure = [one.path for (one, rig), of in pairs if rig is not None and not of.pose_errors]
    if unsure:
        said.append(
            f"The poses of {', '.join(unsure)} state no uncertainty: beyond what the alignment "
            f"tells, the motion's error is in no interval; {_NAVIGATION}"
        )
    return said
