"""Lay passes on one another as `murkscan merge` does: rigidly first, then along their ways."""

from dataclasses import replace

import numpy as np

from murkscan.errors import Degenerate
from murkscan.geometry.alignment import align_clouds
from murkscan.motion.adjust import adjust_passes
from murkscan.types.cloud import PointCloud
from murkscan.types.pose import Pose


def scan_alone(passes):
    """Give world_from_vehicle of each pass as `murkscan scan` does: by its log and its own sheets.

    Returns:
        Trajectories by the logs alone, and as corrected by what each pass saw twice.
    """
    alone = [adjust_passes([one]) for one in passes]
    return [
        [
            getattr(found, way)[0].as_trajectory(one.times)
            for found, one in zip(alone, passes, strict=True)
        ]
        for way in ("as_logged", "paths")
    ]


def register(passes, ways):
    """Lay each pass as a rigid body on those before it that it overlaps; the first one stays.

    Returns:
        Where each is laid, in the world of the first.
    """
    clouds = [as_cloud(one, way) for one, way in zip(passes, ways, strict=True)]
    laid, waiting = {0: Pose.identity()}, list(range(1, len(passes)))
    placed = clouds[0]
    while waiting:
        for number in waiting:
            try:
                found = align_clouds(clouds[number], placed)
            except Degenerate:
                continue
            laid[number] = found.target_from_source
            placed = PointCloud.concatenate([placed, clouds[number].carry(laid[number])])
            waiting.remove(number)
            break
        else:
            raise Degenerate(f"passes {waiting} lie on none of the others")
    return [laid[number] for number in range(len(passes))]


def start_from(passes, laid):
    """Give the passes with where they were laid."""
    return [replace(one, start=way) for one, way in zip(passes, laid, strict=True)]


def as_cloud(one, way):
    """Give a pass's points in the world, with normals from their neighbours in the first sheet."""
    first = one.laser == 0
    lines = int(one.line.max()) + 1
    points = way.transform(one.points[first], one.times[one.profile[first]])
    grid = points.reshape(-1, lines, 3)
    along, across = np.gradient(grid, axis=0), np.gradient(grid, axis=1)
    normals = np.cross(along, across).reshape(-1, 3)
    cameras = way.transform(np.zeros_like(points), one.times[one.profile[first]])
    normals *= np.sign(np.einsum("ni,ni->n", normals, cameras - points))[:, None]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    ones = np.ones(len(points), np.float32)
    return PointCloud(
        points=points,
        normals=normals.astype(np.float32),
        signal=ones,
        posterior=ones,
        sigma=np.float32(1.5e-4) * ones,
        sigma_common=0 * ones,
        frame=one.profile[first].astype(np.int32),
        scan_line=one.line[first].astype(np.uint16),
        laser=np.zeros(len(points), np.uint8),
        branch=np.zeros(len(points), np.uint8),
    )
