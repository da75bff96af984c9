"""murkscan measure step, area and volume."""

from typing import TYPE_CHECKING

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
    from ..types.plane import Plane


def step(
    out: CloudScan,
    *,
    first_m: Place,
    second_m: Place,
    within_mm: float,
    name: Name = "step",
) -> None:
    """Measure the step between two parallel planes; positive where the second is nearer.

    Parameters
    ----------
    first_m
        A place in the middle of the first plane, as X,Y,Z [m].
    second_m
        A place in the middle of the second.
    within_mm
        How far from these places points are taken [mm]; keep clear of edges.
    """
    from ..measure import Ball
    from ..project import Project
    from ..survey.measure import measure_stairs

    first, second = (
        Ball(read_place(flag, text), within_mm / 1e3)
        for flag, text in (("--first-m", first_m), ("--second-m", second_m))
    )
    with working("measuring"):
        found = measure_stairs(Project(out, WORDS.get()), first, second, name=name)
    print_measurement(out, name, found)


def area(out: MeshScan, *, part: PartFlags = PartFlags(), name: Name = "area") -> None:
    """Measure the area of the surface, as far as it was scanned."""
    from ..project import Project
    from ..survey.measure import measure_covered

    project, chosen = Project(out, WORDS.get()), part.select()
    with working("measuring"):
        found = measure_covered(project, name=name, selection=chosen)
    print_measurement(out, name, found)


def volume(
    out: MeshScan,
    *,
    point_m: MaybePlace = None,
    normal: MaybePlace = None,
    base_near_m: MaybePlace = None,
    base_within_mm: float | None = None,
    part: PartFlags = PartFlags(),
    name: Name = "volume",
) -> None:
    """Measure the volume between the surface and a plane, or inside a closed surface.

    With --point-m and --normal the plane is given; with --base-near-m and --base-within-mm it is
    fitted to that part of the scan. Without either the surface must be closed.

    Parameters
    ----------
    point_m
        A point of the plane, as X,Y,Z [m].
    normal
        Its normal, as X,Y,Z of any length, towards the side that counts positive.
    base_near_m
        Middle of the flat part that the plane is fitted to, as X,Y,Z [m].
    base_within_mm
        How far that part reaches from there [mm].
    """
    from ..measure import Ball
    from ..project import Project
    from ..survey.measure import measure_above, measure_inside

    is_given, is_fitted = _are_both(point_m, normal), _are_both(base_near_m, base_within_mm)
    if is_given and is_fitted:
        raise InputError("Give the plane, or the part that it is fitted to, not both.")
    project, chosen = Project(out, WORDS.get()), part.select()
    base: Plane | Ball | None = None
    if point_m is not None and normal is not None:
        base = read_plane(point_m, normal)
    elif base_near_m is not None and base_within_mm is not None:
        base = Ball(read_place("--base-near-m", base_near_m), base_within_mm / 1e3)
    elif chosen is not None:
        raise InputError(
            "A part of a surface encloses no volume; give a plane with --point-m and --normal, or "
            "--base-near-m and --base-within-mm."
        )
    with working("measuring"):
        if base is None:
            found = measure_inside(project, name=name)
        else:
            found = measure_above(project, base, name=name, selection=chosen)
    print_measurement(out, name, found)


def _are_both(one: object, other: object) -> bool:
    if (one is None) != (other is None):
        raise InputError(
            "Give --point-m and --normal together, or --base-near-m and --base-within-mm together."
        )
    return one is not None
