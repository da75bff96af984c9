"""murkscan measure wall: the elevation of a wall, curves through it, and its anomalies."""

from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from ..errors import InputError
from .measure_part import (
    CloudScan,
    PartFlags,
    print_measurement,
    read_cylinder,
    read_place,
    read_plane,
    tell_of_report,
)
from .options import MaybePlace
from .progress import working
from .typed import WORDS
from .words import tell

if TYPE_CHECKING:
    from ..types.cylinder import Cylinder
    from ..types.plane import Plane

_LENGTHS = ("--cell-mm", "--strip-mm")


def wall(
    out: CloudScan,
    *,
    shape: Literal["plane", "cylinder"] = "plane",
    point_m: MaybePlace = None,
    normal: MaybePlace = None,
    axis: MaybePlace = None,
    radius_mm: float | None = None,
    up: MaybePlace = None,
    cell_mm: float = 20.0,
    sections: int = 3,
    strip_mm: float = 100.0,
    ribbed: Annotated[bool, Parameter(negative=())] = False,
    least_mm: float = 10.0,
    part: PartFlags = PartFlags(),
    name: Annotated[str, Parameter(help="What to call it: OUT/measure/NAME.json …")] = "wall",
) -> None:
    """Draw a wall in elevation, with curves of how it bends and a list of what stands out.

    Distances are taken from a plane or a cylinder that is fitted to the scan, or from one that is
    given: a plane by --point-m and --normal, a cylinder by --point-m, --axis and --radius-mm.

    Parameters
    ----------
    shape
        What is fitted.
    point_m
        A point of a plane, or of a cylinder's axis, that is given, as X,Y,Z [m].
    normal
        The plane's normal, as X,Y,Z of any length, towards the viewer.
    axis
        Direction of the cylinder's axis, as X,Y,Z of any length.
    radius_mm
        Radius of the cylinder [mm].
    up
        A direction that is about upwards, as X,Y,Z; that of the grid of a georeferenced scan, or of
        the camera's pictures, unless said.
    cell_mm
        Edge of a cell of the map, and height of a piece of a curve [mm].
    sections
        How many curves, evenly along the wall.
    strip_mm
        Width of the strip that a curve is the mean of [mm].
    ribbed
        Take what repeats along the height off the map: the ribs of sheet piles.
    least_mm
        Distance from which a part of the wall is listed [mm].
    """
    for flag, value in zip(_LENGTHS, (cell_mm, strip_mm), strict=True):
        if not 0 < value < float("inf"):
            raise InputError(f"{flag} must be above 0, got {value:g}.")
    if not least_mm >= 0 or not 0 <= sections <= 1000:
        raise InputError("--least-mm must be 0 or more, and --sections from 0 to 1000.")
    from ..project import Project
    from ..survey.wall import WallPlan, draw_elevation

    plan = WallPlan(
        shape=shape,
        given=_read_reference(shape, point_m, normal, axis, radius_mm),
        up=None if up is None else read_place("--up", up),
        cell=cell_mm / 1e3,
        sections=sections,
        strip=strip_mm / 1e3,
        is_ribbed=ribbed,
        least=least_mm / 1e3,
    )
    project, chosen = Project(out, WORDS.get()), part.select()
    with working("drawing the wall"):
        found = draw_elevation(project, plan, name=name, selection=chosen)
    listed = found.details["anomalies"]
    count = len(listed) if isinstance(listed, list) else 0
    tell("found", f"{count} parts off by more than {least_mm:g} mm, in {name}-anomalies.csv")
    endings = (".png", ".tif", ".dxf", "-anomalies.csv")
    print_measurement(out, name, found, endings=endings, then=tell_of_report(out))


def _read_reference(
    shape: Literal["plane", "cylinder"],
    point_m: str | None,
    normal: str | None,
    axis: str | None,
    radius_mm: float | None,
) -> "Plane | Cylinder | None":
    """Read what distances are taken from; None: it is fitted."""
    if point_m is None and normal is None and axis is None and radius_mm is None:
        return None
    is_round = axis is not None or radius_mm is not None
    if point_m is not None and normal is not None and shape == "plane" and not is_round:
        return read_plane(point_m, normal)
    if point_m is None or normal is not None or axis is None or radius_mm is None:
        raise InputError(
            "Give a plane with --point-m and --normal together, or a cylinder with --point-m, "
            "--axis and --radius-mm together."
        )
    return read_cylinder(point_m, axis, radius_mm)
