"""murkscan georeference: lay a scan on control points."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from ..errors import InputError
from .paths import ScanFolder
from .typed import WORDS
from .words import print_table, tell


def _require_control(_: object, path: Path) -> None:
    if not path.exists():
        raise InputError(f"There is no file of control points at {path}; check its spelling.")


def georeference(
    out: ScanFolder,
    *,
    control: Annotated[Path, Parameter(validator=_require_control)],
    crs: str,
) -> None:
    """Lay a scan on control points; what is exported then lies in their coordinate system.

    The model itself stays in its own world, in which measures are taken.

    Parameters
    ----------
    out
        Folder of the scan, with a finished cloud stage.
    control
        A table with the columns name, easting_m, northing_m, height_m, sigma_mm, and x_m, y_m, z_m:
        where each point lies on the model, as read off view/index.html.
    crs
        The coordinate system, as EPSG:25832, or with that of the heights as EPSG:25832+7837.
    """
    from ..project import Project
    from ..survey.georeference import georeference as lay

    result = lay(Project(out, WORDS.get()), control, crs)
    columns = ("control point", "east", "north", "up [mm]", "sigma [mm]", "of its σ")
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
    tell("next", f"murkscan cloud {out} --export FILE.laz, which then lies in it")
