"""murkscan georeference: lay a scan on control points, on the Earth or on a ship."""

from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from ..errors import InputError
from .options import RecordingFlags
from .paths import RecordingPaths, ScanFolder
from .progress import progress_bars
from .typed import WORDS
from .words import print_table, tell

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..capture import AbstractRecording
    from ..project import GeoreferenceResult
    from ..project.georeference_result import MarkerResult
    from ..types.hull import HullFrame


def _require_control(_: object, path: Path | None) -> None:
    if path is not None and not path.exists():
        raise InputError(f"There is no file of control points at {path}; check its spelling.")


Points = Annotated[Path | None, Parameter(validator=_require_control)]


def georeference(
    out: ScanFolder,
    *,
    control: Points = None,
    crs: str | None = None,
    hull: Points = None,
    frame_spacing_mm: float | None = None,
    frames_from: Literal["stern", "bow"] | None = None,
    heights_above: Literal["keel", "waterline"] | None = None,
    markers: str = "4X4_50",
    recording: RecordingPaths = (),
    reading: RecordingFlags = RecordingFlags(),
) -> None:
    """Lay a scan on control points, of a coordinate system or of a ship.

    Measures, walls and the page then tell places there, and what is exported lies there. The model
    itself stays in its own world.

    Parameters
    ----------
    out
        Folder of the scan, with a finished cloud stage.
    control
        A table with the columns name, easting_m, northing_m, height_m, sigma_mm, and x_m, y_m, z_m:
        where each point lies on the model, as read off view/index.html; or in place of these
        marker: the number of an ArUco marker or AprilTag whose middle the point is, and which the
        laser's line has crossed.
    crs
        The coordinate system, as EPSG:25832, or with that of the heights as EPSG:25832+7837.
    hull
        Instead of these: a table of three points or more of a ship, with the columns name, frame
        (or from_bow_m), height_m, from_centreline_m, side (port, starboard, centreline), sigma_mm,
        and x_m, y_m, z_m or marker.
    frame_spacing_mm
        Distance between two frames of the ship [mm]; without it the table has from_bow_m.
    frames_from
        Where frame 0 is; stern unless said.
    heights_above
        What heights on the ship count from; keel unless said.
    markers
        Dictionary of the markers, as OpenCV calls it: 4X4_50, APRILTAG_36h11, ...
    recording
        The recording that was scanned, where it has been moved since.
    """
    from ..project import Project, load_recording, load_scan_rig
    from ..survey.georeference import OnGrid
    from ..survey.georeference import georeference as lay
    from ..survey.markers import MarkerSearch

    project = Project(out, WORDS.get())
    ship = (frame_spacing_mm, frames_from, heights_above)
    target: OnGrid | HullFrame
    if hull is not None and control is None and crs is None:
        table = hull
        target = _read_hull(frame_spacing_mm, frames_from or "stern", heights_above or "keel")
    elif hull is None and control is not None and crs is not None and not any(ship):
        table, target = control, OnGrid(crs)
    else:
        raise InputError(
            "Give --control and --crs, for a place on the Earth; or for a ship --hull, with "
            "--frame-spacing-mm where its table has frames."
        )

    def open_recording() -> "AbstractRecording":
        paths = recording or (Path(load_recording(project).path),)
        return reading.open(paths, load_scan_rig(project))

    search = MarkerSearch(open_recording, markers, progress_bars)
    result = lay(project, table, target, search=search)
    _print(out, result)


def _read_hull(
    spacing_mm: float | None,
    frames_from: Literal["stern", "bow"],
    heights_above: Literal["keel", "waterline"],
) -> "HullFrame":
    from ..types.hull import HullFrame

    if spacing_mm is None:
        return HullFrame(None, "bow", heights_above)
    if not 0 < spacing_mm < float("inf"):
        raise InputError(f"--frame-spacing-mm must be above 0, got {spacing_mm:g}.")
    return HullFrame(spacing_mm / 1e3, frames_from, heights_above)


def _print(out: Path, result: "GeoreferenceResult") -> None:
    axes = ("east", "north") if result.hull is None else ("aft", "to starboard")
    if result.markers:
        _print_markers(result.markers)
    columns = ("control point", *axes, "up [mm]", "sigma [mm]", "of its σ")
    rows = [
        (
            one.name,
            *(f"{1e3 * part:.1f}" for part in one.residual),
            f"{1e3 * one.sigma:g}",
            f"{one.standardised:.1f}",
        )
        for one in result.points
    ]
    print_table("Residuals, control point less model", columns, rows)
    for remark in result.remarks:
        tell("remark", remark)
    tell("made", f"the way from the model to {result.crs}: {out / 'georeference' / 'stage.json'}")
    tell("quality", f"residuals of {1e3 * result.rms:.1f} mm (RMS of their lengths)")
    folder = quote(str(out))
    tell("next", f"murkscan cloud {folder} --export FILE.laz, which then lies in it")
    if result.hull is not None:
        station = "--from-bow-m 12.5" if result.hull.frame_spacing is None else "--at-frame 42"
        tell("next", f"murkscan measure {folder} section {station}, across the ship there")


def _print_markers(markers: "Sequence[MarkerResult]") -> None:
    where = ("x [m]", "y [m]", "z [m]")
    columns = ("control point", "marker", *where, "sigma [mm]", "pictures", "points on it")
    rows = [
        (
            one.name,
            str(one.marker),
            *(f"{part:.4f}" for part in one.place),
            f"{1e3 * one.sigma:.2f}",
            str(one.pictures),
            str(one.points),
        )
        for one in markers
    ]
    print_table("Markers on the model", columns, rows)
