"""murkscan measure: take measures of a finished scan."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import App, Parameter

from ..errors import InputError
from .measure_part import (
    CloudScan,
    MeshScan,
    Name,
    PartFlags,
    print_measurement,
    read_place,
    read_plane,
)
from .options import MaybePlace, Place
from .progress import working
from .typed import WORDS

if TYPE_CHECKING:
    from ..measure import Sample
    from ..types.measurement import Measurement

What = Literal[
    "distance", "section", "area", "volume", "plane", "sphere", "cylinder", "step", "deviation",
    "dents", "wall",
]  # fmt: skip

app = App(
    name="measure",
    help="Take measures of a scan, each with its uncertainty; `murkscan measure WHAT --help` tells "
    "what each wants to know.",
    usage="Usage: murkscan measure OUT WHAT [OPTIONS]\n",
    suppress_keyboard_interrupt=False,
)
for _file, _name, _help, _place in (
    ("extent", "step", "Measure the step between two parallel planes.", 5),
    ("extent", "area", "Measure the area of the surface, as far as it was scanned.", 6),
    ("extent", "volume", "Measure the volume between the surface and a plane, or inside it.", 7),
    ("deviation", "deviation", "Compare the scan with a drawing's mesh or an earlier scan.", 8),
    ("wall", "wall", "Draw a wall in elevation, with curves of how it bends.", 10),
    ("deviation", "dents", "Find dents and bumps, with place, depth and diameter.", 9),
):
    app.command(f"murkscan.cli.measure_{_file}:{_name}", name=_name, help=_help, sort_key=_place)


@app.default
def measure(
    out: Annotated[Path, Parameter(show=False)],
    what: Annotated[What, Parameter(show=False)],
    *more: Annotated[str, Parameter(allow_leading_hyphen=True, show=False)],
) -> None:
    """Take measures of a scan, each with its uncertainty, into OUT/measure.

    Parameters
    ----------
    out
        Folder of the scan.
    what
        What to measure.
    """
    app(
        [what, str(out), *more],
        exit_on_error=False,
        print_error=False,
        result_action="return_value",
    )


@app.command(sort_key=0)
def distance(out: CloudScan, *, from_m: Place, to_m: Place, name: Name = "distance") -> None:
    """Measure between two points of the scan.

    Parameters
    ----------
    from_m
        Where it begins, as X,Y,Z [m], which a click on the model's page tells; the nearest
        point of the scan counts.
    to_m
        Where it ends [m].
    """
    import numpy as np

    from ..measure import measure_distance
    from ..project import Project
    from ..survey.measure import measure_points

    ends = np.array([read_place("--from-m", from_m), read_place("--to-m", to_m)])
    project = Project(out, WORDS.get())
    with working("measuring"):
        found = measure_points(project, lambda points: measure_distance(points, ends), name=name)
    print_measurement(out, name, found)


@app.command(sort_key=2)
def plane(out: CloudScan, *, part: PartFlags = PartFlags(), name: Name = "plane") -> None:
    """Fit a plane to a part of the scan."""
    from ..measure import measure_plane

    _measure_part(out, measure_plane, part, name)


@app.command(sort_key=3)
def sphere(out: CloudScan, *, part: PartFlags = PartFlags(), name: Name = "sphere") -> None:
    """Fit a sphere to a part of the scan."""
    from ..measure import measure_sphere

    _measure_part(out, measure_sphere, part, name)


@app.command(sort_key=4)
def cylinder(out: CloudScan, *, part: PartFlags = PartFlags(), name: Name = "cylinder") -> None:
    """Fit a cylinder to a part of the scan, such as a pipe or a pile."""
    from ..measure import measure_cylinder

    _measure_part(out, measure_cylinder, part, name)


@app.command(sort_key=1)
def section(
    out: MeshScan,
    *,
    point_m: MaybePlace = None,
    normal: MaybePlace = None,
    at_frame: float | None = None,
    from_bow_m: float | None = None,
    formats: str = "svg,csv",
    name: str = "section",
) -> None:
    """Cut the surface by a plane, and draw the lines in millimetres.

    Parameters
    ----------
    point_m
        A point of the plane, as X,Y,Z [m].
    normal
        Its normal, as X,Y,Z of any length: 0,1,0 cuts across y.
    at_frame
        Instead of these: the frame of a ship, of a scan that was laid on its points.
    from_bow_m
        Or the distance from the bow [m], where these tell no frames.
    formats
        What to write of dxf, svg and csv.
    name
        What to call it: OUT/measure/NAME.json, .svg …
    """
    from ..project import Project
    from ..survey.measure import measure_cut, plane_across_ship

    chosen = formats.split(",")
    if unknown := set(chosen) - {"dxf", "svg", "csv"}:
        raise InputError(f"--formats takes dxf, svg and csv, got {', '.join(sorted(unknown))}.")
    project, stations = Project(out, WORDS.get()), (at_frame, from_bow_m)
    if stations != (None, None) and (point_m, normal) == (None, None):
        plane = plane_across_ship(project, frame=at_frame, from_bow=from_bow_m)
    elif point_m is not None and normal is not None and stations == (None, None):
        plane = read_plane(point_m, normal)
    else:
        raise InputError("Give --point-m and --normal, or of a ship --at-frame or --from-bow-m.")
    with working("cutting the surface"):
        found = measure_cut(project, plane, name=name, formats=chosen)
    print_measurement(out, name, found, endings=tuple(f".{one}" for one in chosen))


def _measure_part(
    out: Path, measure: "Callable[[Sample], Measurement]", part: PartFlags, name: str
) -> None:
    from ..project import Project
    from ..survey.measure import measure_points

    project, chosen = Project(out, WORDS.get()), part.select()
    with working("measuring"):
        found = measure_points(project, measure, name=name, selection=chosen)
    print_measurement(out, name, found)
