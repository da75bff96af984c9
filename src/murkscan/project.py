"""A scan's folder: the one place that knows where each value lies."""

import hashlib
import json
import shutil
import time
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from .errors import InputError, MissingResult
from .io.json_files import load_json, save_json
from .io.mesh_files import load_mesh, save_mesh
from .io.mlp import save_frames
from .io.parquet import load_profile, load_stripe, save_profile, save_stripe
from .io.ply import load_cloud, save_cloud
from .io.poses import load_poses, save_poses
from .types.cloud import PointCloud
from .types.frame_times import FrameTimes
from .types.mesh import Mesh
from .types.profile import Profile
from .types.stripe import Stripe
from .types.trajectory import Trajectory

STAGES = ("extract", "triangulate", "motion", "cloud", "mesh", "view", "report")
"""The stages of a scan, in order."""


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
        """Give what the stage said when it was finished with this very key, None before that."""
        note = self._note()
        return note.get("result") if note.get("key") == self.key else None

    def counts(self) -> dict[str, Any]:
        """Give what the stage said when it was finished; nothing before that."""
        return self.result() or {}

    def seconds(self) -> float:
        """Tell how long the run took that finished the stage [s]."""
        return float(self._note().get("seconds", 0.0))

    def begin(self) -> None:
        """Make the folder ready: parts made with this very key stay, all else is removed."""
        if self._note().get("key") != self.key:
            shutil.rmtree(self.folder, ignore_errors=True)
        save_json(self._file, {"key": self.key, "began": time.time()})

    def finish(self, result: dict[str, Any]) -> None:
        """Say that the stage is done, with its counts."""
        seconds = round(time.time() - self._note()["began"], 3)
        save_json(self._file, {"key": self.key, "seconds": seconds, "result": result})

    @property
    def _file(self) -> Path:
        return self.folder / "stage.json"

    def _note(self) -> dict[str, Any]:
        return load_json(self._file) if self._file.exists() else {}


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
        return load_json(self.root / "scan.json")

    def check_writable(self) -> None:
        """Refuse a folder that holds something other than a scan, so that nothing is mixed.

        Raises:
            InputError: It is a file, or a folder with other things in it.
        """
        if self.root.is_file():
            raise InputError(f"{self.root} is a file; give a folder with --out.")
        if (
            self.root.is_dir()
            and any(self.root.iterdir())
            and not (self.root / "scan.json").exists()
        ):
            raise InputError(f"{self.root} holds other files; give a new folder with --out.")

    def stage(self, name: str, *, settings: dict[str, Any], inputs: dict[str, Any]) -> Stage:
        """Give a stage's folder, to be made with these settings and inputs."""
        key = {"murkscan": version("murkscan"), "settings": settings, "inputs": inputs}
        return Stage(self.root / name, key)

    def finished(self, name: str) -> Stage:
        """Give a stage as it was finished last.

        Raises:
            MissingResult: It has not been run, or not to its end.
        """
        file = self.root / name / "stage.json"
        note = load_json(file) if file.exists() else {}
        if "result" not in note:
            raise MissingResult(
                f"{self.root} has no finished {name} stage; run `murkscan {name}` or "
                "`murkscan scan` first."
            )
        return Stage(self.root / name, note["key"])

    def has_stripe_part(self, part: int) -> bool:
        """Tell whether a part is whole; its note is written last."""
        return self._part("extract/frames", part, "json").exists()

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
            yield int(file.stem), load_json(file)

    def load_frame_times(self) -> FrameTimes:
        """Read which frames a finished extract has seen, with or without a stripe."""
        self.finished("extract")
        notes = [note for _, note in self.load_stripe_notes()]
        frames = [index for note in notes for index in note["frames"]]
        times = [time for note in notes for time in note["times"]]
        return FrameTimes(np.array(frames, np.uint32), np.array(times, float))

    def save_profile_part(self, part: int, profile: Profile) -> None:
        """Write one part of triangulate."""
        save_profile(self._part("triangulate/profiles", part, "parquet"), profile)

    def load_profile_parts(self) -> Iterator[Profile]:
        """Read the profiles of a finished triangulate, part by part in order of frames."""
        folder = self.finished("triangulate").folder / "profiles"
        for file in sorted(folder.glob("*.parquet")):
            yield load_profile(file)

    def load_profile(self) -> Profile:
        """Read all profiles of a finished triangulate, in order of frames."""
        return Profile.concatenate(list(self.load_profile_parts()))

    def load_stripe(self) -> Stripe:
        """Read all stripes of a finished extract, in order of frames."""
        folder = self.finished("extract").folder / "stripes"
        files = sorted(folder.glob("*.parquet"))
        return Stripe.concatenate([load_stripe(file) for file in files])

    def save_trajectory(self, trajectory: Trajectory) -> None:
        """Write motion/trajectory.csv."""
        save_poses(self.root / "motion/trajectory.csv", trajectory)

    def load_trajectory(self) -> Trajectory:
        """Read the poses of a finished motion."""
        return load_poses(self.finished("motion").folder / "trajectory.csv")

    def save_cloud(self, cloud: PointCloud) -> None:
        """Write cloud/cloud.ply."""
        save_cloud(self.root / "cloud/cloud.ply", cloud)

    def save_frames(self, cloud: PointCloud) -> None:
        """Write one cloud a frame, cloud/frames/*.ply, and cloud/frames.mlp that opens them all."""
        save_frames(self.root / "cloud", cloud)

    def load_cloud(self) -> PointCloud:
        """Read the cloud of a finished cloud stage."""
        return load_cloud(self.finished("cloud").folder / "cloud.ply")

    def save_mesh(self, mesh: Mesh) -> None:
        """Write mesh/mesh.ply, .stl and .glb."""
        for suffix in ("ply", "stl", "glb"):
            save_mesh(self.root / f"mesh/mesh.{suffix}", mesh)

    def load_mesh(self) -> Mesh:
        """Read the mesh of a finished mesh stage."""
        return load_mesh(self.finished("mesh").folder / "mesh.ply")

    def _part(self, folder: str, part: int, suffix: str) -> Path:
        return self.root / folder / f"{part:06d}.{suffix}"
