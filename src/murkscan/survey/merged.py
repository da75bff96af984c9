"""Projects whose cloud was merged from other scans: they have no recording."""

from contextlib import suppress

from ..errors import FormatError, InputError, MissingResult
from ..project import Project


def is_merged(project: Project) -> bool:
    """Tell whether a project's cloud was merged from others, so that no stage can make it anew."""
    with suppress(MissingResult, FormatError):
        return "merged" in project.load_scan()
    return False


def require_recording(project: Project) -> None:
    """Refuse what needs a recording where there is none.

    Raises:
        InputError: The cloud was merged from other scans.
    """
    if is_merged(project):
        raise InputError(
            f"{project.root} was merged from other scans and has no recording of its own; give one "
            "of those, or another folder."
        )
