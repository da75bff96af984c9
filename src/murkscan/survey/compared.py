"""Two scans to be shown in one world: before and after."""

from dataclasses import dataclass, replace

from ..errors import Degenerate
from ..geometry.alignment import Alignment
from ..geometry.alignment_words import describe_alignment, turn_round
from ..project import AlignmentResult, Project
from ..types.mesh import Mesh
from ..view import Model
from .shown import choose_points, folder_of, load_model, load_surface

_SAMPLE = 2_000_000
"""Points of the scan, about, that alignment looks at."""

_ALL = 6
"""Motions of a rigid body."""


@dataclass(frozen=True, eq=False)
class Compared:
    """What the page shows of two scans."""

    models: list[Model]
    """Those that have points, named by their folders; the second one moved."""
    relation: str
    """How the second one was moved, in a sentence."""
    alignment: AlignmentResult | None
    """The same in numbers; None where it lies as its own poses put it."""


def compare_models(
    project: Project,
    surface: Mesh | None,
    other: Project,
    *,
    align: bool,
    deviation: str,
    most: int,
) -> Compared:
    """Load two scans, and lay the second on the first as `measure deviation` lays a reference.

    Args:
        project: The scan that stays.
        surface: Its surface, as `load_surface` gives it.
        other: The one that is laid on it.
        align: Whether to lay it there; otherwise it stays where its poses put it.
        deviation: As for `load_model`, of the first.
        most: As for `load_model`.

    Raises:
        Degenerate: They do not overlap.
        MissingResult: A stage has not been finished.
        FormatError: A file is damaged.
    """
    others = load_surface(other)
    stays = load_model(project, surface, most=most, deviation=deviation)
    moves = load_model(other, others, most=most)
    named = [(stays, folder_of(project)), (moves, folder_of(other))]
    models = [replace(model, name=name) for model, name in named if model is not None]
    if len(models) < 2:
        return Compared(models, "", None)
    first, second = models
    if not align:
        return Compared(models, "Both lie where their poses put them.", None)
    if surface is None or others is None:
        text = "Both lie where their poses put them: without two surfaces nothing can be aligned."
        return Compared(models, text, None)
    alignment = _lay(others, other, project)
    if len(alignment.open_directions) == _ALL:
        text = (
            f"Both lie where their poses put them: what {second.name} and {first.name} share does "
            "not show how one lies on the other."
        )
        return Compared(models, text, None)
    second = second.moved(alignment.target_from_source, first.views)
    second = replace(second, place=first.place)
    words = describe_alignment(alignment, whose=first.name)
    relation = f"{second.name} was laid on {first.name}: {words}."
    return Compared([first, second], relation, AlignmentResult.from_alignment(alignment))


def _lay(surface: Mesh, other: Project, project: Project) -> Alignment:
    try:
        # Here, since a scan that begins would load all measures for what it does not do.
        from ..measure.reference import Reference, lay_on

        reference = Reference(surface, name=str(other.root))
        laid = lay_on(reference, choose_points(project, _SAMPLE))
    except Degenerate as error:
        raise Degenerate(f"{error} With --as-given both stay as they are.") from error
    assert laid.alignment is not None
    return turn_round(laid.alignment)
