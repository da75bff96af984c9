"""A scan's values: the one place that knows where each lies."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from ..errors import NotEnoughData
from ..io import parquet
from ..io.images import write_image
from ..io.json_files import save_json
from ..io.mesh_files import load_mesh, save_mesh
from ..io.mlp import frame_name, save_project, split_frames
from ..io.ply import save_cloud, writing_cloud
from ..io.poses import load_poses, save_poses
from ..io.text import save_text
from ..io.values import load_value, save_value
from ..types.arrays import ColourImage
from ..types.background import Background
from ..types.cloud import PointCloud
from ..types.cloud_part import CloudPart
from ..types.frame_times import FrameTimes
from ..types.measured import Measured
from ..types.mesh import Mesh
from ..types.part_note import PartNote
from ..types.profile import Profile
from ..types.stripe import Stripe
from ..types.trajectory import Trajectory
from .kinds import CLOUD, EXTRACT, MESH, MOTION, REPORT, TRIANGULATE, VIEW, Kind
from .scan_folder import ScanFolder

V = TypeVar("V")
_STRIPES, _NOTES = "stripes/{:06d}.parquet", "frames/{:06d}.json"
_PROFILES, _POINTS = "profiles/{:06d}.parquet", "points/{:06d}.parquet"
"""Where each part lies in its stage."""


@dataclass(frozen=True)
class Project(ScanFolder):
    """The folder OUT of a scan. Each value is saved and loaded here, and nowhere else."""

    def load_stripe_parts(self) -> Iterator[tuple[int, PartNote]]:
        """Read the number and the note of each part that extract has made so far, in order."""
        files = self._files(EXTRACT)
        stripes = files.made("stripes/")
        for name in files.made("frames/"):
            part = _part_of(name)
            if _STRIPES.format(part) in stripes:
                yield part, load_value(files.checked(name), PartNote)

    def save_stripe_part(self, part: int, stripe: Stripe, note: PartNote) -> None:
        """Write one part of extract, and last a note on the frames that it covers."""
        self._save(EXTRACT, _STRIPES.format(part), parquet.save_stripe, stripe)
        self._save(EXTRACT, _NOTES.format(part), save_value, note)

    def discard_stripe_part(self, part: int) -> None:
        """Take the note of one part away, so that it counts as not made."""
        self._files(EXTRACT).remove(_NOTES.format(part))

    def load_stripe_part(self, part: int) -> Stripe:
        """Read the stripes of one part."""
        return parquet.load_stripe(self._files(EXTRACT).checked(_STRIPES.format(part)))

    def load_frame_times(self) -> FrameTimes:
        """Read which frames a finished extract has seen, with or without a stripe."""
        self.finished(EXTRACT)
        notes = [note for _, note in self.load_stripe_parts()]
        frames = [index for note in notes for index in note.frames]
        times = [time for note in notes for time in note.times]
        return FrameTimes(np.array(frames, np.uint32), np.array(times, float))

    def load_stripe(self) -> Stripe:
        """Read all stripes of a finished extract, in order of frames."""
        self.finished(EXTRACT)
        parts = [self.load_stripe_part(part) for part, _ in self.load_stripe_parts()]
        return Stripe.concatenate(parts)

    def find_profile_parts(self) -> set[int]:
        """Number the parts that triangulate has made so far."""
        return {_part_of(name) for name in self._files(TRIANGULATE).made("profiles/")}

    def count_profile_points(self) -> dict[int, int]:
        """Count the points of each part of a finished triangulate, without reading them."""
        self.finished(TRIANGULATE)
        return self._count_rows(TRIANGULATE, "profiles/")

    def save_profile_part(self, part: int, profile: Profile) -> None:
        """Write one part of triangulate."""
        self._save(TRIANGULATE, _PROFILES.format(part), parquet.save_profile, profile)

    def load_profile_part(self, part: int) -> Profile:
        """Read one part of triangulate."""
        return parquet.load_profile(self._files(TRIANGULATE).checked(_PROFILES.format(part)))

    def load_profile_parts(self) -> Iterator[Profile]:
        """Read the profiles of a finished triangulate, part by part in order of frames."""
        self.finished(TRIANGULATE)
        for part in sorted(self.find_profile_parts()):
            yield self.load_profile_part(part)

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

    def save_background(self, background: Background, laser: int = 0) -> None:
        """Write what the extractor has learnt of a laser's stripe, and of what is beside it."""
        self._save(EXTRACT, _background_name(laser), save_value, background)

    def load_background(self, laser: int = 0) -> Background | None:
        """Read what the extractor has learnt; None where that has not been kept."""
        name, files = _background_name(laser), self._files(EXTRACT)
        return load_value(files.checked(name), Background) if files.made(name) else None

    def save_overlay(self, name: str, picture: ColourImage) -> None:
        """Write one picture of what was found, extract/overlay/<name>.png."""
        self._save(EXTRACT, f"overlay/{name}.png", write_image, picture)

    def remove_overlay(self, name: str) -> None:
        """Remove one of them."""
        self._files(EXTRACT).remove(f"overlay/{name}.png")

    def find_overlays(self) -> list[str]:
        """Name the pictures of what was found, in order of frames."""
        return sorted(Path(name).stem for name in self._files(EXTRACT).made("overlay/"))

    def save_trajectory(self, trajectory: Trajectory, *, logged: Trajectory | None = None) -> None:
        """Write motion/trajectory.csv and, where errors are stated, motion/errors.parquet.

        Args:
            trajectory: The poses.
            logged: The poses as the motion alone has them; kept as logged.csv where they differ.
        """
        self._save(MOTION, "trajectory.csv", save_poses, trajectory)
        if logged is not None and logged is not trajectory:
            self._save(MOTION, "logged.csv", save_poses, logged)
        if trajectory.errors is not None:
            self._save(MOTION, "errors.parquet", parquet.save_pose_errors, trajectory.errors)

    def save_measured(self, measured: Measured) -> None:
        """Write motion/measured.json: what the vehicle's instruments measured, and how well."""
        self._save(MOTION, "measured.json", save_value, measured)

    def load_measured(self) -> Measured | None:
        """Read what a finished motion was measured by; None where nothing is stated of it."""
        self.finished(MOTION)
        files = self._files(MOTION)
        if not files.made("measured.json"):
            return None
        return load_value(files.checked("measured.json"), Measured)

    def load_trajectory(self) -> Trajectory:
        """Read the poses of a finished motion."""
        self.finished(MOTION)
        files = self._files(MOTION)
        trajectory = load_poses(files.checked("trajectory.csv"))
        if not files.made("errors.parquet"):
            return trajectory
        return replace(trajectory, errors=parquet.load_pose_errors(files.checked("errors.parquet")))

    def save_cloud_part(self, part: int, points: CloudPart) -> None:
        """Write one part of the cloud, with what was taken out of it."""
        self._save(CLOUD, _POINTS.format(part), parquet.save_cloud_part, points)

    def find_cloud_parts(self) -> list[int]:
        """Number the parts that cloud has made so far, in order."""
        return sorted(map(_part_of, self._files(CLOUD).made("points/")))

    def count_cloud_points(self) -> dict[int, int]:
        """Count the points of each part of a finished cloud, those that were taken out, too."""
        self.finished(CLOUD)
        return self._count_rows(CLOUD, "points/")

    def load_cloud_part(self, part: int) -> CloudPart:
        """Read one part of the cloud, with what was taken out of it."""
        return parquet.load_cloud_part(self._files(CLOUD).checked(_POINTS.format(part)))

    def load_kept_parts(self) -> Iterator[Profile]:
        """Read the profiles of the points that a finished cloud keeps, part by part, in its order.

        So row i of all of them is the profile's side of the cloud's point i: its pixel, its time.

        Raises:
            MissingResult: A stage has not been finished, or a part of it is lost.
        """
        self.finished(CLOUD)
        parts = zip(self.find_cloud_parts(), self.load_placed_parts(), strict=True)
        for part, profile in parts:
            yield profile[self.load_cloud_part(part).stays]

    def export_cloud(self, *, frames: bool) -> None:
        """Write cloud/cloud.ply from the parts that have been made.

        Args:
            frames: Whether to write one cloud a frame, cloud/frames/*.ply, and cloud/frames.mlp
                that opens them all.
        """
        paths: list[Path] = []
        with self._files(CLOUD).making("cloud.ply") as path, writing_cloud(path) as write:
            for part in self.find_cloud_parts():
                points = self.load_kept_part(part)
                write(points)
                if frames:
                    paths += self._save_frames(points)
        if frames:
            self._save(CLOUD, "frames.mlp", save_project, paths)

    def _save_frames(self, points: PointCloud) -> Iterator[Path]:
        for frame, mine in split_frames(points):
            with self._files(CLOUD).making(frame_name(frame)) as path:
                save_cloud(path, mine)
                yield path

    def load_cloud(self) -> PointCloud:
        """Read the cloud of a finished cloud stage."""
        return PointCloud.concatenate(list(self.iterate_cloud()))

    def iterate_cloud(self) -> Iterator[PointCloud]:
        """Read the cloud of a finished cloud stage, part by part."""
        self.finished(CLOUD)
        return map(self.load_kept_part, self.find_cloud_parts())

    def load_kept_part(self, part: int) -> PointCloud:
        """Read the points that the cloud keeps of one part."""
        return self.load_cloud_part(part).kept

    def save_mesh(self, mesh: Mesh) -> None:
        """Write mesh/mesh.ply, .stl and .glb, and which points the vertices are."""
        for suffix in ("ply", "stl", "glb"):
            self._save(MESH, f"mesh.{suffix}", save_mesh, mesh)
        if mesh.points is not None:
            with self._files(MESH).making("points.parquet") as path:
                parquet.save_columns(path, {"point": mesh.points})

    def load_mesh(self) -> Mesh:
        """Read the mesh of a finished mesh stage.

        Raises:
            NotEnoughData: It has no triangles, and so no file.
        """
        if self.finished(MESH).result.faces == 0:
            raise NotEnoughData(
                f"The surface of {self.root} has no triangles: its cloud has no two neighbouring "
                "profiles, or points too far apart. Scan more frames, or look at extract/overlay "
                "to see what was found in them."
            )
        files = self._files(MESH)
        mesh = load_mesh(files.checked("mesh.ply"))
        if not files.made("points.parquet"):
            return mesh
        return replace(mesh, points=parquet.load_columns(files.checked("points.parquet"))["point"])

    def save_picture(self, name: str, picture: ColourImage) -> None:
        """Write one picture of the surface, view/<name>.png."""
        self._save(VIEW, f"{name}.png", write_image, picture)

    def save_view_page(self, name: str, page: str) -> None:
        """Write view/<name>.html."""
        self._save(VIEW, f"{name}.html", save_text, page)

    def save_report(self, content: dict[str, Any], page: str) -> None:
        """Write report/report.json and report/index.html."""
        self._save(REPORT, "report.json", save_json, content)
        self._save(REPORT, "index.html", save_text, page)

    def _save(
        self, kind: Kind[Any], name: str, save: Callable[[Path, V], object], value: V
    ) -> None:
        with self._files(kind).making(name) as path:
            save(path, value)

    def _count_rows(self, kind: Kind[Any], below: str) -> dict[int, int]:
        files = self._files(kind)
        count = parquet.count_rows
        return {_part_of(name): count(files.checked(name)) for name in files.made(below)}


def _background_name(laser: int) -> str:
    return f"background-{laser}.json" if laser else "background.json"


def _part_of(name: str) -> int:
    return int(Path(name).stem)
