"""Lay passes on one another as `murkscan merge` does, and judge what it states of them."""

from dataclasses import replace

import numpy as np

from murkscan.errors import Degenerate
from murkscan.geometry.alignment import align_clouds
from murkscan.types.cloud import PointCloud
from murkscan.types.pose import Pose


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


def length_pulls(dive, adjusted):
    """Divide the error of each pass's length by its stated deviation."""
    pulls = []
    for number, (one, truth) in enumerate(zip(dive.passes, dive.truths, strict=True)):
        trajectory = adjusted.trajectory(number, one.times)
        middle = np.flatnonzero(truth.line == np.median(truth.line).astype(int))[[0, -1]]
        times = one.times[truth.profile[middle]]
        ends = trajectory.transform(truth.own[middle], times)
        between = ends[1] - ends[0]
        shifts = trajectory.shifts(ends, times)
        along = between / np.linalg.norm(between)
        sigma = np.linalg.norm(along @ (shifts[1] - shifts[0]))
        true = np.linalg.norm(np.diff(truth.world[middle], axis=0))
        pulls.append(float((np.linalg.norm(between) - true) / sigma))
    return pulls


def clock_pull(adjusted, late):
    """Give how far the clock was found off what it is [ms], and that over what is stated."""
    if not late:
        return None
    found, sigma = adjusted.instrument_errors(0)["clock_offset"]
    return 1e3 * (found + late), (found + late) / sigma
