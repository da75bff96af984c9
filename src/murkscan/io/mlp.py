"""The paper's way: one small cloud a frame, and a MeshLab project that opens them together."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from ..types.cloud import PointCloud
from .atomic import replacing

_IDENTITY = "1 0 0 0 \n0 1 0 0 \n0 0 1 0 \n0 0 0 1 \n"


def frame_name(frame: int) -> str:
    """Name the file of one frame's points, below the folder of the project that opens it."""
    return f"frames/frame_{frame:06d}.ply"


def split_frames(cloud: PointCloud) -> Iterator[tuple[int, PointCloud]]:
    """Take a cloud apart into the points of each frame, in order of frames."""
    order = np.argsort(cloud.frame, kind="stable")
    numbers, starts = np.unique(cloud.frame[order], return_index=True)
    for number, which in zip(numbers.tolist(), np.split(order, starts[1:]), strict=False):
        yield number, cloud[which]


def save_project(path: Path, meshes: Sequence[Path]) -> None:
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
