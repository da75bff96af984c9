"""What a command says when it is done."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..project import Project

_SKIPS_SHOWN = 5


def print_result(stage: str, result: dict[str, Any], where: Path) -> None:
    """Say what one stage has made, and where it lies."""
    counts = ", ".join(
        f"{name.replace('_', ' ')} {value:g}" if isinstance(value, float) else
        f"{name.replace('_', ' ')} {value:,}"
        for name, value in result.items()
        if isinstance(value, int | float)
    )  # fmt: skip
    print(f"{stage}: {counts + '; ' if counts else ''}{where}")
    print_skips(result.get("skips", []))
    print_remarks(result)


def print_remarks(extracted: dict[str, Any]) -> None:
    """Say what is odd about the recording, and how murky the water was."""
    from ..survey.recorded import attenuation_of

    for remark in extracted.get("remarks", []):
        print(f"  note: {remark}")
    if water := attenuation_of(extracted):
        so = (
            f"so the beam attenuation lies between {water.low:.2g} and {water.high:.2g} per metre"
            if water.is_telling
            else "and scatters too much to tell the beam attenuation"
        )
        print(f"  water: the glow fades by {water.effective:.2g} per metre, {so}")


def print_skips(skips: list[tuple[int, int, str]]) -> None:
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
    found, moved = (project.finished(name).counts() for name in ("extract", "motion"))
    cloud, mesh = (project.finished(name).counts() for name in ("cloud", "mesh"))
    root = project.root
    print(
        f"frames     {found['frames']:,} read, {found['skipped']:,} skipped, "
        f"{found['frames_without_stripe']:,} without a stripe"
    )
    print_skips(found["skips"])
    print_remarks(found)
    print_remarks(moved)
    print(f"points     {cloud['points']:,}, {cloud['outliers']:,} outliers taken out")
    print(f"triangles  {mesh['faces']:,}")
    if not mesh["faces"]:
        print("There is no surface: look at extract/overlay to see what was found in the frames.")
        print(f"report     {root / 'report' / 'index.html'}")
        return
    print(f"cloud      {root / 'cloud' / 'cloud.ply'}")
    print(f"model      {root / 'mesh' / 'mesh.glb'}, .ply, .stl")
    print(f"to look at {root / 'view' / 'index.html'}, .png")
    print(f"report     {root / 'report' / 'index.html'}")
