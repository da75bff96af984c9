"""What a command says when it is done."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..ui.results import list_counts

if TYPE_CHECKING:
    from ..project import Project
    from ..project.results import Skipped
    from ..types.background import Attenuation

_SKIPS_SHOWN = 5


def print_result(stage: str, result: Any, where: Path) -> None:
    """Say what one stage has made, and where it lies; of some results only where."""
    counts = "" if result is None else ", ".join(list_counts(result))
    print(f"{stage}: {counts + '; ' if counts else ''}{where}")


def print_remarks(remarks: Sequence[str], water: "Attenuation | None" = None) -> None:
    """Say what is odd about the recording or its poses, and how murky the water was."""
    for remark in remarks:
        print(f"  note: {remark}")
    if water:
        so = (
            f"so the beam attenuation lies between {water.low:.2g} and {water.high:.2g} per metre"
            if water.is_telling
            else "and scatters too much to tell the beam attenuation"
        )
        print(f"  water: the glow fades by {water.effective:.2g} per metre, {so}")


def print_skips(skips: "Sequence[Skipped]") -> None:
    """Say what could not be read."""
    for _, _, reason in skips[:_SKIPS_SHOWN]:
        print(f"  skipped: {reason}")
    if len(skips) > _SKIPS_SHOWN:
        print(f"  and {len(skips) - _SKIPS_SHOWN} more; see the report")


def when_reported(out: Path) -> int | None:
    """Give the time at which a scan's report was finished last [ns]; None where it was not."""
    note = out / "report" / "stage.json"
    return note.stat().st_mtime_ns if note.exists() else None


def print_summary(project: "Project") -> None:
    """Say what a whole scan has made, and where it lies."""
    from ..project import CLOUD, EXTRACT, MESH, MOTION

    found, moved = project.finished(EXTRACT).result, project.finished(MOTION).result
    cloud = project.finished(CLOUD).result
    faces, root = project.finished(MESH).result.faces, project.root
    print(
        f"frames     {found.frames:,} read, {found.skipped:,} skipped, "
        f"{found.frames_without_stripe:,} without a stripe"
    )
    print_skips(found.skips)
    print_remarks((*found.remarks, *moved.remarks), found.attenuation)
    print(f"points     {cloud.points:,}, {cloud.outliers:,} outliers taken out")
    print(f"triangles  {faces:,}")
    if not faces:
        print("There is no surface: look at extract/overlay to see what was found in the frames.")
        print(f"report     {root / 'report' / 'index.html'}")
        return
    print(f"cloud      {root / 'cloud' / 'cloud.ply'}")
    print(f"model      {root / 'mesh' / 'mesh.glb'}, .ply, .stl")
    print(f"to look at {root / 'view' / 'index.html'}, .png")
    print(f"report     {root / 'report' / 'index.html'}")
