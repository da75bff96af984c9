"""The demo: simulate a recording, scan it as the paper does and as we do, and ask the truth."""

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path

import numpy as np

from ..capture import open_recording
from ..extract import AbstractExtractor, Murk, ThresholdSkeleton
from ..geometry.mesh_distance import distance_to_mesh
from ..io.images import write_image
from ..io.mesh_files import load_mesh
from ..io.rig_toml import load_rig
from ..io.text import save_text
from ..motion import ConstantSpeed
from ..page import EmbeddedPage, Gallery, Note, Picture, Section, Table, render_page
from ..project import CLOUD, Project, find_trajectory
from ..simulate import as_standalone, parse_scene, read_scene
from ..types.arrays import ColourImage, Scalars
from ..view import Depth, View, front_view, render
from .progress import Progress, silent
from .scan import scan
from .simulate import simulate_recording

_SCENE = "demo"
_SPEED = 0.1
"""Of the camera in that scene [m/s]."""
FALSE = 0.01
"""Distance from the truth beyond which a point is false: a particle, or a ghost [m]."""
_NEXT = (
    f"False points lie more than {FALSE * 1e3:g} mm off the true hull. White is where no point was "
    "measured: an edge hid the surface from the laser or from the camera, or no light came back. "
    "How the scan by murk went, and how far to trust it, stands in scan/report/index.html."
)
_HEAD = ("", "points", "false [%]", "RMS of the others [mm]")
_SIZE = 1280, 480
"""Of the pictures of both hulls, which lie along them [px]."""
_COMPARED = 20_000
"""Points of the cloud that are held against the truth."""


@dataclass(frozen=True)
class Errors:
    """How far points lie from the true surface."""

    count: int
    """Points that were compared."""
    false: int
    """Those that lie so far off that they are no points of the surface."""
    rms: float
    """Root mean square distance of the others [m]."""
    within_95: float
    """Distance within which 95 % of the others lie [m]."""

    @classmethod
    def from_distances(cls, distances: Scalars) -> "Errors":
        """Summarise distances [m], infinite for false points; NaN where there are no others."""
        true = distances[np.isfinite(distances)]
        if len(true) == 0:
            return cls(len(distances), len(distances), np.nan, np.nan)
        rms = float(np.sqrt(np.mean(true**2)))
        return cls(len(distances), len(distances) - len(true), rms, float(np.quantile(true, 0.95)))


@dataclass(frozen=True)
class Judged:
    """A scan, and how far it is from the truth."""

    name: str
    """How the stripe was found, in words."""
    project: Project
    errors: Errors


def run_demo(out: Path, *, progress: Progress = silent) -> tuple[Judged, Judged]:
    """Simulate a hull's recording, scan it in two ways, and compare both with the true hull.

    All but the way to find the stripe is the same in both.

    Args:
        out: Folder for `recording`, `scan`, `paper` and the page that shows both.
        progress: Told how far each stage is.

    Returns:
        The scan by the default way, and the one by the paper's threshold and skeleton. Of each
        cloud at most 20 000 points spread evenly over it are compared.

    Raises:
        DeviceError: The disk is full.
    """
    text, name, beside = read_scene(_SCENE)
    scene = parse_scene(text, name, beside)
    text = as_standalone(text, scene.rig, beside)
    simulate_recording(scene, out / "recording", text=text, progress=progress)
    ours = _scan(out, "scan", Murk(), "murk: noise, chain and fit", progress)
    paper = _scan(out, "paper", ThresholdSkeleton(), "the paper: threshold and skeleton", progress)
    for one in (paper, ours):
        write_image(
            out / f"{one.project.root.name}.png", _draw_hull(one.project, like=ours.project)
        )
    save_text(out / "index.html", _page(ours, paper))
    return ours, paper


def _scan(
    out: Path, folder: str, extractor: AbstractExtractor, name: str, progress: Progress
) -> Judged:
    """Scan the recording in one way, and hold the cloud against the true hull."""
    rig_file = out / "recording" / "rig.toml"
    rig = load_rig(rig_file)
    recording = open_recording(out / "recording" / "frames", wavelength=rig.wavelength)
    motion = ConstantSpeed(_SPEED, rig.lasers[0].axis, sigma=0.0)  # as it was simulated
    project = scan(
        recording,
        rig,
        motion,
        out=out / folder,
        extractor=extractor,
        rig_file=rig_file,
        command=("demo", str(out)),
        progress=_of(name.split(":")[0], progress),
    )
    points = project.load_cloud().points
    compared = points[:: -(-len(points) // _COMPARED) or 1]
    truth = load_mesh(out / "recording" / "truth" / "mesh.ply")
    errors = Errors.from_distances(distance_to_mesh(compared, truth, within=FALSE))
    return Judged(name, project, errors)


def _of(name: str, progress: Progress) -> Progress:
    """Let the bars of a scan have its name."""
    return lambda stage, done, total: progress(f"{name}: {stage}", done, total)


def _draw_hull(project: Project, *, like: Project) -> ColourImage:
    """Draw the hull as the camera sees it, turned to lie along the picture, as another scan's."""
    front = front_view(find_trajectory(project))
    right, down, away = front.view_from_world
    x, y, z = (float(part) for part in away)
    view = View("from below", np.stack([down, -right, away]), front.eye)
    depth = Depth((x, y, z), front.start)
    return render(project.load_mesh(), view, colours=depth, size=_SIZE, like=like.load_mesh())


def _page(ours: Judged, paper: Judged) -> str:
    """Show both scans under one another, and the better one to be turned."""
    both = (paper, ours)
    hulls = [
        Picture(
            f"{folder}.png", f"{one.name}; coloured by the distance", f"{folder}/view/index.html"
        )
        for one in both
        for folder in [one.project.root.name]
    ]
    model = EmbeddedPage(f"{ours.project.root.name}/view/index.html", f"{ours.name}: drag to turn")
    return render_page(
        "One recording, scanned in two ways",
        [
            Section("", [Table([_row(one) for one in both], _HEAD), Note(_NEXT)]),
            Section("The hull from below", [Gallery([one], is_first_large=True) for one in hulls]),
            Section("To turn and to measure", [model]),
            Section("What was found in one frame", [Gallery(_frames(both), is_in_pairs=True)]),
        ],
        subtitle="A ship model's hull in water in which a diver sees a metre and a half, simulated",
    )


def _row(one: Judged) -> tuple[str, int, Decimal, Decimal | None]:
    """Put a scan's errors beside its name."""
    false = Decimal(f"{100 * one.errors.false / max(one.errors.count, 1):.1f}")
    rms = Decimal(f"{1e3 * one.errors.rms:.2f}") if np.isfinite(one.errors.rms) else None
    return one.name, one.project.finished(CLOUD).result.points, false, rms


def _frames(both: Sequence[Judged]) -> list[Picture]:
    """Choose a frame from the middle that both have drawn."""
    overlays = [set(one.project.find_overlays()) for one in both]
    common = sorted(set.intersection(*overlays))
    return [
        Picture(f"{one.project.root.name}/extract/overlay/{name}.png", one.name)
        for name in common[len(common) // 2 :][:1]
        for one in both
    ]
