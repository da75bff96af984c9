"""What a command says when it is done: what was made, how good it is, and what to do next."""

from collections.abc import Sequence
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Any

from ..ui.results import tell_made, tell_quality
from .words import tell

if TYPE_CHECKING:
    from ..project import Project
    from ..project.results import Skipped
    from ..types.background import Attenuation

_SKIPS_SHOWN = 5
_NEXT = {
    "extract": "murkscan triangulate {out}",
    "triangulate": "murkscan motion {out} --speed-mm-s V (or --step-mm D, or --poses LOG)",
    "motion": "murkscan cloud {out}",
    "cloud": "murkscan mesh {out}",
    "merge": "murkscan mesh {out}, then measure, view and report",
    "mesh": "murkscan view {out}",
    "view": "murkscan report {out}",
    "report": "open the page in a browser; then `murkscan measure {out} --help`",
}
"""What follows each stage."""


def print_result(stage: str, result: Any, where: Path, *, out: Path) -> None:
    """Say what one stage has made, where it lies, how good it is, and what comes next."""
    tell("made", f"{tell_made(result)}: {where}")
    if quality := tell_quality(result):
        tell("quality", *quality)
    tell("next", _NEXT[stage].format(out=quote(str(out))))


def print_remarks(remarks: Sequence[str], water: "Attenuation | None" = None) -> None:
    """Say what is odd about the recording or its poses, and how murky the water was."""
    for remark in remarks:
        tell("note", remark)
    if water:
        tell("water", _tell_water(water))


def _tell_water(water: "Attenuation") -> str:
    from ..plan import visibility_from_attenuation

    near, far = map(visibility_from_attenuation, (water.high, water.low))
    return (
        f"the laser's glow in it fades by {water.effective:.2g} per metre, so its beam attenuation "
        f"lies between {water.low:.2g} and {water.high:.2g} per metre: a diver sees {near:.1f} to "
        f"{far:.1f} m"
    )


def print_correction(words: Sequence[str]) -> None:
    """Say how the scan has corrected its trajectory, or why it has not."""
    if words:
        tell("motion", *words)


def print_skips(skips: "Sequence[Skipped]") -> None:
    """Say what could not be read."""
    for _, _, reason in skips[:_SKIPS_SHOWN]:
        tell("skipped", reason)
    if len(skips) > _SKIPS_SHOWN:
        tell("skipped", f"and {len(skips) - _SKIPS_SHOWN} more; the report lists them")


def when_reported(out: Path) -> int | None:
    """Give the time at which a scan's report was finished last [ns]; None where it was not."""
    note = out / "report" / "stage.json"
    return note.stat().st_mtime_ns if note.exists() else None


def print_summary(project: "Project") -> None:
    """Say what a whole scan has made, how good it is, and what to do next."""
    from ..project import CLOUD, EXTRACT, MESH, MOTION, REPORT

    found, moved = project.finished(EXTRACT).result, project.finished(MOTION).result
    cloud, mesh = project.finished(CLOUD).result, project.finished(MESH).result
    report, root = project.finished(REPORT).result, project.root
    tell("frames", tell_made(found))
    print_skips(found.skips)
    print_remarks((*found.remarks, *moved.remarks), found.attenuation)
    print_correction(moved.correction)
    tell("points", f"{tell_made(cloud)}: {root / 'cloud' / 'cloud.ply'}")
    tell("model", f"{tell_made(mesh)}: {root / 'mesh' / 'mesh.glb'}, .ply, .stl")
    tell("quality", *tell_quality(found), *tell_quality(report), *tell_quality(mesh))
    if mesh.faces:
        _print_next(root)
    else:
        tell("next", f"open {root / 'report' / 'index.html'}: it says what is missing, and why")


def _print_next(root: Path) -> None:
    tell(
        "next",
        f"open {root / 'view' / 'index.html'} in a browser, to turn and measure the model",
        f"open {root / 'report' / 'index.html'}: what the scan covers, and how far to trust it",
        f"murkscan measure {quote(str(root))} --help, for lengths, areas, dents and drawings",
    )
