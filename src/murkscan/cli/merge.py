"""murkscan merge: several passes, or clouds of others, into one cloud."""

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from ..errors import InputError
from ..ui.values import read_pose
from .progress import progress_bars
from .typed import WORDS


def merge(
    *passes: Path,
    out: Path,
    reach_mm: float | None = None,
    voxel_mm: float | None = None,
    rigid: Annotated[bool, Parameter(negative=())] = False,
    as_logged: Annotated[bool, Parameter(negative=())] = False,
    unit: Literal["m", "cm", "mm", "in", "ft"] = "m",
    start: Annotated[tuple[str, ...], Parameter(negative=(), allow_leading_hyphen=True)] = (),
) -> None:
    """Lay several scans of one object on another and merge them into one cloud.

    Each pass is laid on those before it where they overlap; then all are adjusted together, each
    along its whole way, where [navigation] of their rigs states how good their logs are. What the
    overlap does not determine (a plain hull slides along itself) is named, and stays as logged.
    Then mesh, measure, view and report work on the result.

    Parameters
    ----------
    passes
        Folders of scans, or clouds as .ply, .las, .laz, .e57, .xyz or .csv. One alone is
        imported; a folder that was merged stands for its passes.
    out
        A new folder for the merged cloud.
    reach_mm
        Distance up to which the surface of one pass is looked for in another [mm]; a twentieth of
        the smaller one's size unless said.
    voxel_mm
        Thin the merged cloud to one point a voxel of this edge [mm]: means, weighted by sigma.
    rigid
        Move each pass as a rigid body; the first stays where it is.
    as_logged
        Move nothing: the poses of all passes are in one frame already, and good enough.
    unit
        Unit of the clouds of other programs, of places and sigmas; scans are in metres.
    start
        Where a pass lies in the world of the first one, about: its origin as X,Y,Z [m], or
        X,Y,Z,QW,QX,QY,QZ with how it is turned. Once for each pass after the first, in order.
    """
    if not passes:
        raise InputError("Give the folders of two scans or more: murkscan merge A B --out OUT.")
    for flag, value in (("--reach-mm", reach_mm), ("--voxel-mm", voxel_mm)):
        if value is not None and not 0 < value < float("inf"):
            raise InputError(f"{flag} must be above 0, got {value:g}.")
    if start and as_logged:
        raise InputError("--start says where aligning begins, and --as-logged aligns nothing.")
    if rigid and as_logged:
        raise InputError("--rigid moves passes as rigid bodies, and --as-logged moves none.")
    starts = [read_pose("--start", text) for text in start]
    from ..measure.reference import UNITS
    from ..survey.merge import merge_passes
    from .summary import print_remarks, print_result
    from .words import tell

    with progress_bars() as progress:
        result = merge_passes(
            passes,
            out,
            align=not as_logged,
            adjust=not rigid,
            reach=None if reach_mm is None else reach_mm / 1e3,
            voxel=None if voxel_mm is None else voxel_mm / 1e3,
            unit=UNITS[unit],
            starts=starts,
            command=WORDS.get(),
            progress=progress,
        )
    for one in result.passes:
        tell("pass", f"{one.path}: {one.words}", *one.correction)
    print_remarks(result.remarks)
    print_result("merge", result, out / "cloud" / "cloud.ply", out=out)
