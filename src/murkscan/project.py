"""A scan's folder: the one place that knows where each value lies."""

import hashlib
import json
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from .errors import FormatError, InputError, MissingResult, NotEnoughData
from .io.images import write_image
from .io.json_files import load_json, save_json
from .io.mesh_files import load_mesh, save_mesh
from .io.mlp import writing_frames
from .io.parquet import load_profile, load_stripe, save_profile, save_stripe
from .io.ply import iterate_cloud, load_cloud, writing_cloud
from .io.poses import load_poses, save_poses
from .io.text import save_text
from .types.arrays import ColourImage
from .types.cloud import PointCloud
from .types.frame_times import FrameTimes
from .types.mesh import Mesh
from .types.profile import Profile
from .types.stripe import Stripe
from .types.trajectory import Trajectory

STAGES = ("extract", "triangulate", "motion", "cloud", "mesh", "view", "report")
"""The stages of a scan, in order."""


_TOLD = ("recording", "rig", "versions")
"""What scan.json tells of every scan."""
_NOTED = ("frames", "times", "points", "skips")
"""What the note of a part of extract lists."""


@dataclass(frozen=True)
class Stage:
    """One stage's folder, and what it was made from."""

    folder: Path
    key: dict[str, Any]
    """Settings and inputs; another key is another result."""

    @property
    def digest(self) -> str:
        """A short text that changes with the key; later stages name it as their input."""
        return hashlib.sha256(json.dumps(self.key, sort_keys=True).encode()).hexdigest()[:16]

    def result(self) -> dict[str, Any] | None:
        """Give what the stage said when it was finished with this very key.

        None before that, and where a file that it made is missing or cut off since.
        """
        note = self.note()
        if note.get("key") != self.key or "result" not in note:
            return None
        # What others put beside it, such as a file browser's notes, is no reason to begin again.
        made = note.get("files")
        is_whole = isinstance(made, dict) and made.items() <= self._files().items()
        return note["result"] if is_whole else None

    def counts(self) -> dict[str, Any]:
        """Give what the stage said when it was finished; nothing before that."""
        return self.note().get("result", {})

    def seconds(self) -> float:
        """Tell how long the run took that finished the stage [s]."""
        return float(self.note().get("seconds", 0.0))

    def begin(self) -> None:
        """Make the folder ready: parts made with this very key stay, all else is removed.

        Raises:
            InputError: The folder holds something that no stage has made.
        """
        if self.folder.exists() and not self._file.exists() and any(self.folder.iterdir()):
            raise InputError(f"{self.folder} holds other files; give a new folder for the scan.")
        if self.note().get("key") != self.key:
            shutil.rmtree(self.folder, ignore_errors=True)
        save_json(self._file, {"key": self.key})

    def finish(self, result: dict[str, Any], *, since: float) -> None:
        """Say that the stage is done, with its counts; it began `since` [s, monotonic clock]."""
        seconds = round(time.monotonic() - since, 3)
        note = {"key": self.key, "seconds": seconds, "result": result, "files": self._files()}
        save_json(self._file, note)

    def _files(self) -> dict[str, int]:
        """Give the size of every file that the stage has made."""
        made = (file for file in self.folder.rglob("*") if file.is_file())
        sizes = {file.relative_to(self.folder).as_posix(): file.stat().st_size for file in made}
        return {name: size for name, size in sorted(sizes.items()) if name != self._file.name}

    @property
    def _file(self) -> Path:
        return self.folder / "stage.json"

    def note(self) -> dict[str, Any]:
        """Read what the stage wrote of itself; one that is damaged counts as not done."""
        try:
            note = load_json(self._file) if self._file.exists() else {}
        except FormatError:
            return {}
        key, result = note.get("key"), note.get("result", {})
        sound = isinstance(key, dict) and isinstance(key.get("inputs", {}), dict)
        return note if sound and isinstance(result, dict) else {}


@dataclass(frozen=True)
class Project:
    """The folder OUT of a scan. Each value is saved and loaded here, and nowhere else."""

    root: Path

    def save_scan(self, content: dict[str, Any]) -> None:
        """Write scan.json: versions, rig, recording, settings."""
        save_json(self.root / "scan.json", content)

    def load_scan(self) -> dict[str, Any]:
        """Read scan.json.

        Raises:
            MissingResult: The folder holds no scan.
        """
        if not (self.root / "scan.json").exists():
            raise MissingResult(
                f"{self.root} holds no scan; run `murkscan scan` or `murkscan extract` into it "
                "first."
            )
        content = load_json(self.root / "scan.json")
        lost = [key for key in _TOLD if not isinstance(content.get(key), dict)]
        if lost:
            raise FormatError(
                f"{self.root / 'scan.json'} has lost its key {lost[0]}; run `murkscan scan` again."
            )
        return content

    def check_writable(self) -> None:
        """Refuse a folder that holds something other than a scan, so that nothing is mixed.

        Raises:
            InputError: It is a file, or a folder with other things in it.
        """
        if self.root.is_file():
            raise InputError(f"{self.root} is a file; give a folder with --out.")
        is_scan = (self.root / "scan.json").exists()
        # A hidden file is what a run left that was killed while it wrote its first one.
        others = [file for file in self.root.glob("*") if not file.name.startswith(".")]
        if others and not is_scan:
            raise InputError(f"{self.root} holds other files; give a new folder with --out.")

    def stage(self, name: str, *, settings: dict[str, Any], inputs: dict[str, Any]) -> Stage:
        """Give a stage's folder, to be made with these settings and inputs."""
        key = {"murkscan": version("murkscan"), "settings": settings, "inputs": inputs}
        return Stage(self.root / name, key)

    def finished(self, name: str) -> Stage:
        """Give a stage as it was finished last.

        Raises:
            MissingResult: It has not been run, not to its end, or a stage before it has been run
                anew since.
        """
        note = Stage(self.root / name, {}).note()
        if "result" not in note:
            raise MissingResult(
                f"{self.root} has no finished {name} stage; run `murkscan {name}` or "
                "`murkscan scan` first."
            )
        stage = Stage(self.root / name, note["key"])
        for source, digest in stage.key.get("inputs", {}).items():
            if source in STAGES and self.finished(source).digest != digest:
                raise MissingResult(
                    f"The {name} stage of {self.root} is older than its {source} stage; run "
                    f"`murkscan {name}` or `murkscan scan` again."
                )
        return stage

    def has_stripe_part(self, part: int) -> bool:
        """Tell whether a part is there; its note is written last."""
        files = ("extract/stripes", "parquet"), ("extract/frames", "json")
        return all(self._part(folder, part, suffix).exists() for folder, suffix in files)

    def save_stripe_part(self, part: int, stripe: Stripe, note: dict[str, Any]) -> None:
        """Write one part of extract, and a note on the frames that it covers."""
        save_stripe(self._part("extract/stripes", part, "parquet"), stripe)
        save_json(self._part("extract/frames", part, "json"), note)

    def load_stripe_part(self, part: int) -> Stripe:
        """Read the stripes of one part."""
        return load_stripe(self._part("extract/stripes", part, "parquet"))

    def load_stripe_notes(self) -> Iterator[tuple[int, dict[str, Any]]]:
        """Read the number and the note of each part, in order."""
        for file in sorted((self.root / "extract/frames").glob("*.json")):
            note = load_json(file)
            if not all(isinstance(note.get(name), list) for name in _NOTED):
                raise FormatError(f"{file} is damaged; delete it and run `murkscan scan` again.")
            yield int(file.stem), note

    def load_frame_times(self) -> FrameTimes:
        """Read which frames a finished extract has seen, with or without a stripe."""
        self.finished("extract")
        notes = [note for _, note in self.load_stripe_notes()]
        frames = [index for note in notes for index in note["frames"]]
        times = [time for note in notes for time in note["times"]]
        return FrameTimes(np.array(frames, np.uint32), np.array(times, float))

    def load_profile_part(self, part: int) -> Profile | None:
        """Read one part of triangulate; None where it has not been made."""
        file = self._part("triangulate/profiles", part, "parquet")
        return load_profile(file) if file.exists() else None

    def save_profile_part(self, part: int, profile: Profile) -> None:
        """Write one part of triangulate."""
        save_profile(self._part("triangulate/profiles", part, "parquet"), profile)

    def load_profile_parts(self) -> Iterator[Profile]:
        """Read the profiles of a finished triangulate, part by part in order of frames."""
        folder = self.finished("triangulate").folder / "profiles"
        for file in sorted(folder.glob("*.parquet")):
            yield load_profile(file)

    def load_placed_parts(self) -> Iterator[Profile]:
        """Read the profiles of a finished triangulate as far as a finished motion has their poses.

        Part by part in order of frames, as `load_profile_parts`.
        """
        trajectory = self.load_trajectory()
        for part in self.load_profile_parts():
            yield part[trajectory.has(part.time)]

    def load_placed_times(self) -> FrameTimes:
        """Read which frames have a pose, with or without a stripe."""
        frames, trajectory = self.load_frame_times(), self.load_trajectory()
        placed = trajectory.has(frames.time)
        return FrameTimes(frames.frame[placed], frames.time[placed])

    def load_profile(self) -> Profile:
        """Read all profiles of a finished triangulate, in order of frames."""
        return Profile.concatenate(list(self.load_profile_parts()))

    def load_stripe(self) -> Stripe:
        """Read all stripes of a finished extract, in order of frames."""
        folder = self.finished("extract").folder / "stripes"
        files = sorted(folder.glob("*.parquet"))
        return Stripe.concatenate([load_stripe(file) for file in files])

    def save_background(self, content: dict[str, Any]) -> None:
        """Write extract/background.json: what the extractor has learnt."""
        save_json(self.root / "extract/background.json", content)

    def save_overlay(self, name: str, picture: ColourImage) -> None:
        """Write one picture of what was found, extract/overlay/<name>.png."""
        write_image(self.root / f"extract/overlay/{name}.png", picture)

    def find_overlays(self) -> list[Path]:
        """Give the pictures of what was found, in order of frames."""
        return sorted((self.root / "extract/overlay").glob("*.png"))

    def save_trajectory(self, trajectory: Trajectory) -> None:
        """Write motion/trajectory.csv."""
        save_poses(self.root / "motion/trajectory.csv", trajectory)

    def load_trajectory(self) -> Trajectory:
        """Read the poses of a finished motion."""
        return load_poses(self.finished("motion").folder / "trajectory.csv")

    def writing_cloud(self) -> AbstractContextManager[Callable[[PointCloud], None]]:
        """Write cloud/cloud.ply block by block."""
        return writing_cloud(self.root / "cloud/cloud.ply")

    def writing_frames(self) -> AbstractContextManager[Callable[[PointCloud], None]]:
        """Write one cloud a frame, cloud/frames/*.ply, and cloud/frames.mlp that opens them all."""
        return writing_frames(self.root / "cloud")

    def load_cloud(self) -> PointCloud:
        """Read the cloud of a finished cloud stage."""
        return load_cloud(self.finished("cloud").folder / "cloud.ply")

    def iterate_cloud(self) -> Iterator[PointCloud]:
        """Read the cloud of a finished cloud stage, some points at a time."""
        return iterate_cloud(self.finished("cloud").folder / "cloud.ply")

    def save_mesh(self, mesh: Mesh) -> None:
        """Write mesh/mesh.ply, .stl and .glb."""
        for suffix in ("ply", "stl", "glb"):
            save_mesh(self.root / f"mesh/mesh.{suffix}", mesh)

    def load_mesh(self) -> Mesh:
        """Read the mesh of a finished mesh stage.

        Raises:
            NotEnoughData: It has no triangles, and so no file.
        """
        stage = self.finished("mesh")
        if stage.counts().get("faces") == 0:
            raise NotEnoughData(
                f"The surface of {self.root} has no triangles: its cloud has no two neighbouring "
                "profiles, or points too far apart. Scan more frames, or look at extract/overlay "
                "to see what was found in them."
            )
        return load_mesh(stage.folder / "mesh.ply")

    def save_picture(self, name: str, picture: ColourImage) -> None:
        """Write one picture of the surface, view/<name>.png."""
        write_image(self.root / f"view/{name}.png", picture)

    def save_view_page(self, page: str) -> None:
        """Write view/index.html."""
        save_text(self.root / "view/index.html", page)

    def save_pictures_page(self, page: str) -> None:
        """Write view/pictures.html."""
        save_text(self.root / "view/pictures.html", page)

    def save_report(self, content: dict[str, Any], page: str) -> None:
        """Write report/report.json and report/index.html."""
        save_json(self.root / "report/report.json", content)
        save_text(self.root / "report/index.html", page)

    def _part(self, folder: str, part: int, suffix: str) -> Path:
        return self.root / folder / f"{part:06d}.{suffix}"
