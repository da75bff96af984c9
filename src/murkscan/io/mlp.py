"""The paper's way: one small cloud a frame, and a MeshLab project that opens them together."""

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from ..types.cloud import PointCloud
from .atomic import replacing
from .ply import save_cloud

_IDENTITY = "1 0 0 0 \n0 1 0 0 \n0 0 1 0 \n0 0 0 1 \n"
_OURS = re.compile(r"frame_\d{6,}\.ply")


def save_frames(folder: Path, cloud: PointCloud) -> Path:
    """Write each frame's points to a file of its own, and a project that opens all of them.

    Args:
        folder: Where `frames.mlp` and `frames/frame_000000.ply` … shall be; frames that an earlier
            run left there and this cloud has not are removed.
        cloud: The cloud.

    Returns:
        The project's path.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    with writing_frames(folder) as write:
        write(cloud)
    return folder / "frames.mlp"


@contextmanager
def writing_frames(folder: Path) -> Iterator[Callable[[PointCloud], None]]:
    """Write as `save_frames` does, a cloud that comes in blocks; a frame lies in one of them.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    paths: list[Path] = []

    def write(cloud: PointCloud) -> None:
        order = np.argsort(cloud.frame, kind="stable")
        numbers, starts = np.unique(cloud.frame[order], return_index=True)
        some = [folder / "frames" / f"frame_{number:06d}.ply" for number in numbers]
        for path, which in zip(some, np.split(order, starts[1:]), strict=False):
            save_cloud(path, cloud[which])
        paths.extend(some)

    yield write
    for stale in set((folder / "frames").glob("frame_*.ply")) - set(paths):
        if _OURS.fullmatch(stale.name):
            stale.unlink()
    save_project(folder / "frames.mlp", paths)


def save_project(path: Path, meshes: list[Path]) -> None:
    """Write a MeshLab project that shows files below its own folder, none of them moved.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    project = ElementTree.Element("MeshLabProject")
    group = ElementTree.SubElement(project, "MeshGroup")
    for mesh in meshes:
        name = mesh.relative_to(path.parent).as_posix()
        item = ElementTree.SubElement(group, "MLMesh", filename=name, label=mesh.stem, visible="1")
        ElementTree.SubElement(item, "MLMatrix44").text = "\n" + _IDENTITY
    ElementTree.SubElement(project, "RasterGroup")
    ElementTree.indent(project)
    text = "<!DOCTYPE MeshLabDocument>\n" + ElementTree.tostring(project, encoding="unicode")
    with replacing(path) as aside:
        aside.write_text(text + "\n", encoding="utf-8")
