"""The page of a scan: its stages, its measures, its files, and what to do next."""

from contextlib import suppress
from pathlib import Path
from shlex import quote
from typing import Any

from ..errors import FormatError, MissingResult, MurkscanError
from ..io.json_files import load_json
from ..project import MEASURE, STAGES, Project
from ..project.unstated import list_unstated
from ..ui.results import tell_made, tell_quality
from .sandbox import Sandbox

_EXPORTS = (
    *("*.ply", "*.glb", "*.stl", "*.obj", "*.laz", "*.las", "*.e57", "*.dxf", "*.svg", "*.csv"),
    *("*.json", "*.mp4"),
)
_FOLDERS = ("cloud", "mesh", "motion", "measure", "report", "view", "accept")
_MOST = 60
"""Files that are listed."""


def tell_scan(sandbox: Sandbox, name: str) -> dict[str, Any]:
    """Say what a scan has come to.

    Raises:
        InputError: It does not lie in the folder.
    """
    root = sandbox.existing(name)
    project = Project(root)
    stages = []
    for kind in STAGES:
        try:
            result = project.finished(kind).result
            stage = {"made": tell_made(result), "quality": list(tell_quality(result)), "fault": ""}
        except MissingResult:
            stage = {"made": "", "quality": [], "fault": ""}
        except MurkscanError as error:
            stage = {"made": "", "quality": [], "fault": str(error)}
        stages.append({"stage": kind.word, **stage})
    return {
        "name": name,
        "stages": stages,
        "unstated": _unstated(project),
        "measures": _measures(sandbox, root),
        "page": _page(sandbox, root / "view" / "index.html"),
        "report": _page(sandbox, root / "report" / "index.html"),
        "accepted": _page(sandbox, root / "accept" / "index.html"),
        "pictures": [_page(sandbox, path) for path in _pictures(root / "view")],
        "files": _files(sandbox, root),
    }


def _unstated(project: Project) -> list[str]:
    with suppress(MurkscanError):
        return list_unstated(project)
    return []


def _page(sandbox: Sandbox, path: Path) -> str:
    """Give a page's name with the time of its last change, so that browsers see a new one."""
    return f"{sandbox.name(path)}?{path.stat().st_mtime_ns}" if path.exists() else ""


def _pictures(view: Path) -> list[Path]:
    """List the pictures from all sides; the one that is not along an axis stands first."""
    return sorted(view.glob("*.png"), key=lambda path: (path.stem != "isometric", path.name))


def _measures(sandbox: Sandbox, root: Path) -> list[dict[str, Any]]:
    measures = []
    for path in sorted((root / "measure").glob("*.json"), key=lambda one: one.stat().st_mtime_ns):
        if path.stem == "stage" or path.stem.endswith(".stage") or path.name.startswith("."):
            continue
        with suppress(FormatError, KeyError, TypeError, AttributeError, ValueError):
            measures.append(_measure(sandbox, path, load_json(path), _typed(root, path.stem)))
    return measures[::-1]


def _typed(root: Path, name: str) -> str:
    """Give the command that took a measure, where a command did."""
    try:
        words = Project(root).finished(MEASURE, name).record.command
    except MurkscanError:
        return ""
    return " ".join(["murkscan", *map(quote, words)]) if words else ""


def _measure(sandbox: Sandbox, path: Path, content: dict[str, Any], command: str) -> dict[str, Any]:
    rows = []
    for key, quantity in content["quantities"].items():
        low, high = quantity["interval_95"]
        rows.append([key, float(quantity["value"]), (float(high) - float(low)) / 2,
                     quantity["sigma_common"] is None])  # fmt: skip
    beside = sorted(path.parent.glob(f"{path.stem}.*"))
    return {
        "name": path.stem,
        "kind": str(content["kind"]),
        "rows": rows,
        "command": command,
        "files": [sandbox.name(one) for one in beside if one.suffix in (".svg", ".csv", ".dxf")],
    }


def _files(sandbox: Sandbox, root: Path) -> list[tuple[str, int]]:
    files = [
        path
        for folder in _FOLDERS
        for pattern in _EXPORTS
        for path in sorted((root / folder).glob(pattern))
        if not path.name.startswith(".") and not path.name.endswith("stage.json")
    ]
    return [(sandbox.name(path), path.stat().st_size) for path in files[:_MOST]]
