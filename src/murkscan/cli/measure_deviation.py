"""murkscan measure deviation and dents: compare a scan with what it should be."""

from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from ..ui.values import read_pose
from .measure_part import MeshScan, PartFlags, print_measurement, tell_of_report
from .progress import working
from .typed import WORDS
from .words import print_table, say, tell

if TYPE_CHECKING:
    from ..measure import DentSearch
    from ..measure.reference import Reference
    from ..project import Project
    from ..types.dent import Dent

Unit = Annotated[Literal["m", "cm", "mm", "in", "ft"], Parameter(help="Unit of the file.")]
AsGiven = Annotated[
    bool,
    Parameter(
        negative=(),
        help="Take the reference where it is, in the scan's world; otherwise it is laid on the "
        "scan by ICP.",
    ),
]
Start = Annotated[
    str | None,
    Parameter(
        allow_leading_hyphen=True,
        help="Where the reference lies in the scan's world, about: its origin as X,Y,Z [m], or "
        "X,Y,Z,QW,QX,QY,QZ with how it is turned.",
    ),
]
_MAP = (".ply", ".csv", "-front.png", "-isometric.png", "-histogram.png")
"""Endings of what deviations are written into."""
FilesName = Annotated[
    str, Parameter(help="What to call it: OUT/measure/NAME.json, .ply, .csv, .png.")
]


def deviation(
    out: MeshScan,
    *,
    reference: Path,
    unit: Unit = "m",
    as_given: AsGiven = False,
    start: Start = None,
    reach_mm: float = 50.0,
    part: PartFlags = PartFlags(),
    name: FilesName = "deviation",
) -> None:
    """Compare the scan with a drawing's mesh or an earlier scan.

    Writes a coloured map (.ply and two pictures), a histogram and a signed table beside the
    numbers. Positive is towards the camera, negative a dent.

    Parameters
    ----------
    reference
        A .ply, .stl, .obj or .glb file, or the folder of an earlier scan.
    reach_mm
        Distance beyond which a point of the scan is none of the reference's [mm].
    """
    from ..project import Project
    from ..survey.deviation import compare_scan

    project, chosen = Project(out, WORDS.get()), part.select()
    with working("comparing with the reference"):
        found = compare_scan(
            project,
            _load(project, reference, unit, as_given, start),
            within=reach_mm / 1e3,
            name=name,
            selection=chosen,
        )
    then = f"murkscan view {quote(str(out))} --deviation {name}: its page, coloured by this"
    print_measurement(out, name, found, endings=_MAP, then=then)


def dents(
    out: MeshScan,
    *,
    reference: Path | None = None,
    unit: Unit = "m",
    as_given: AsGiven = False,
    start: Start = None,
    smallest_mm: float = 20.0,
    largest_mm: float = 150.0,
    least_depth_mm: float = 0.0,
    part: PartFlags = PartFlags(),
    name: FilesName = "dents",
) -> None:
    """Find dents and bumps: where the scan departs from a reference by more than chance.

    Without a reference the scan is compared with a smooth surface through itself.

    Parameters
    ----------
    reference
        A .ply, .stl, .obj or .glb file, or the folder of an earlier scan.
    smallest_mm
        Width of the smallest dent looked for [mm].
    largest_mm
        Width of the largest one [mm]: wider shapes are taken for the hull's own.
    least_depth_mm
        Depth below which none is listed [mm].
    """
    from ..project import Project
    from ..survey.deviation import search_dents

    project, chosen = Project(out, WORDS.get()), part.select()
    with working("looking for dents"):
        search = search_dents(
            project,
            None if reference is None else _load(project, reference, unit, as_given, start),
            smallest=smallest_mm / 1e3,
            largest=largest_mm / 1e3,
            least_depth=least_depth_mm / 1e3,
            name=name,
            selection=chosen,
        )
    _print_dents(search)
    endings = (".json", ".ply", ".csv", "-anomalies.csv", ".dxf", "-front.png", "-isometric.png")
    tell("made", *(str(out / "measure" / f"{name}{ending}") for ending in endings))
    if search.dents:
        tell("next", tell_of_report(out))
    else:
        tell(
            "next", f"murkscan view {quote(str(out))} --deviation {name}: the page, coloured by it"
        )


def _load(
    project: "Project", path: Path, unit: Unit, as_given: bool, start: str | None
) -> "Reference":
    pose = None if start is None else read_pose("--start", start)
    from ..measure.reference import begin_at, lay_on
    from ..survey.deviation import load_reference

    reference = load_reference(path, unit=unit)
    if pose is not None:
        reference = begin_at(reference, pose)
    return reference if as_given else lay_on(reference, project.load_cloud())


def _print_dents(search: "DentSearch") -> None:
    if search.dents:
        columns = ("", "x [m]", "y [m]", "z [m]", "depth [mm]", "diameter [mm]", "volume [cm³]")
        print_table("Dents (±95%)", columns, [_row(dent) for dent in search.dents])
    else:
        say("No dent was found.")
    if search.num_unsure:
        say(
            f"{search.num_unsure} more place{'s depart' if search.num_unsure > 1 else ' departs'}, "
            "by a depth that the scan does not tell: at a rim, or no more than its own ±95%."
        )
    for text in search.remarks:
        say(text)
    say(
        f"Averaged over the smallest dent, the scan scatters by {1e3 * search.noise:.3f} mm; what "
        f"departs by more than {1e3 * search.threshold:.3f} mm is listed."
    )


def _row(dent: "Dent") -> tuple[str, ...]:
    place = [
        f"{at:.4f} ± {1.96 * sigma:.4f}"
        for at, sigma in zip(dent.place.tolist(), dent.sigma_place.tolist(), strict=True)
    ]
    return (
        "dent" if dent.depth.value > 0 else "bump",
        *place,
        f"{1e3 * dent.depth.value:.2f} ± {1e3 * dent.depth.half_width:.2f}",
        f"{1e3 * dent.diameter.value:.0f} ± {1e3 * dent.diameter.half_width:.0f}",
        f"{1e6 * dent.volume.value:.2f} ± {1e6 * dent.volume.half_width:.2f}",
    )
