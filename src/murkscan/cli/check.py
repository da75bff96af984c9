"""murkscan check: is everything still as it was written?"""

from pathlib import Path

from ..errors import FormatError
from .progress import progress_bars
from .words import tell

_INDENT = 13
"""Columns of the longest stage's name."""


def check(out: Path) -> None:
    """Compare every file of a scan with the checksum that it was written with.

    Parameters
    ----------
    out
        Folder of the scan, or of a merged cloud.
    """
    from ..project import Project
    from ..survey.check import check_project

    with progress_bars() as progress:
        checks = check_project(Project(out), progress=progress)
    for one in checks:
        many = one.num_whole != 1
        counts = (
            f"{one.num_whole:,} file{'s' * many} as {'they were' if many else 'it was'} written"
        )
        if one.foreign:
            counts += f", {len(one.foreign):,} that are not murkscan's"
        tell(one.word, f"{counts}{'; ' + one.state if one.state else ''}", indent=_INDENT)
    spoilt = [name for one in checks for name in (*one.changed, *one.missing)]
    for name in spoilt:
        tell("", f"{'changed' if (out / name).exists() else 'missing'}: {name}")
    if spoilt:
        raise FormatError(
            f"{len(spoilt):,} files of {out} are not as they were written. Delete those that have "
            "changed and run the same commands again: what is missing is made anew."
        )
    tell("quality", "every file is as it was written", indent=_INDENT)
