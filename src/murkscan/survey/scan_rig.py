"""The rig that a project's recording was made with."""

from ..io.rig_toml import parse_rig
from ..project import Project
from ..types.rig import Rig
from .merged import require_recording


def load_scan_rig(project: Project) -> Rig:
    """Give the rig as it was when the scan began.

    Raises:
        MissingResult: The folder holds no scan.
        InputError: It was merged from other scans.
    """
    require_recording(project)
    return parse_rig(project.load_scan()["rig"], name=f"{project.root / 'scan.json'}: rig")
