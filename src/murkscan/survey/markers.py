"""Look for the markers of control points in a scan's pictures, and place them on the model."""

from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace

import numpy as np

from ..calibrate import find_markers, load_dictionary
from ..capture import AbstractRecording
from ..errors import InputError, NotEnoughData
from ..io.control_points import ControlPoints
from ..measure import MarkerPlace, MarkerSight, MarkerView, place_marker
from ..project import Project, is_merged, load_moving_rig, load_recording
from ..project.georeference_result import MarkerResult
from .progress import Progress, silent

_LOOKS = 12.0
"""Pictures a second that are looked at: at 0.1 m/s one every centimetre."""


def unwatched() -> AbstractContextManager[Progress]:
    """Show nothing."""
    return nullcontext(silent)


@dataclass(frozen=True)
class MarkerSearch:
    """Where the markers of control points are looked for."""

    open: Callable[[], AbstractRecording]
    """Opens the recording that was scanned."""
    dictionary: str = "4X4_50"
    """Which markers, as OpenCV calls them without DICT_."""
    watching: Callable[[], AbstractContextManager[Progress]] = unwatched
    """Shows how far the search is."""


def place_markers(
    project: Project, points: ControlPoints, search: MarkerSearch
) -> tuple[ControlPoints, tuple[MarkerResult, ...]]:
    """Place those control points that are given by a marker in the pictures.

    Args:
        project: A scan with a finished cloud stage.
        points: The control points; sigma is that of the survey.
        search: Where the markers are looked for.

    Returns:
        The points, with the places and with the sigma that these add; and what was found.

    Raises:
        InputError: The recording is not the one that was scanned.
        NotEnoughData: A marker is in none of the pictures, or the laser's line has not crossed it.
    """
    wanted = {row: number for row, number in enumerate(points.markers) if number is not None}
    if not wanted:
        return points, ()
    if is_merged(project):
        raise InputError(
            f"{project.root} was merged from other scans and has no pictures in which a marker can "
            "be seen; give x_m, y_m and z_m of each control point."
        )
    with search.watching() as progress:
        sights = _see(project, {*wanted.values()}, search, progress)
    on_model, sigma, found = points.on_model.copy(), points.sigma.copy(), []
    for row, number in wanted.items():
        place = _place(project, number, sights)
        on_model[row] = place.place
        sigma[row] = float(np.hypot(sigma[row], place.sigma))
        found.append(_describe(points.names[row], number, place))
    return replace(points, on_model=on_model, sigma=sigma), tuple(found)


def _describe(name: str, number: int, place: MarkerPlace) -> MarkerResult:
    where = tuple(place.place.tolist())
    return MarkerResult(name, number, where, place.sigma, place.views, place.points)


def _see(
    project: Project, numbers: Iterable[int], search: MarkerSearch, progress: Progress
) -> dict[int, MarkerSight]:
    """Find each marker in the pictures of which the pose is known."""
    recording = search.open()
    if recording.fingerprint() != load_recording(project).fingerprint:
        raise InputError(
            f"{recording.path} is not the recording that was scanned, or is read otherwise; name "
            "that one with --recording, and with the --fps, --fields and --topic that it had."
        )
    trajectory, rig = project.load_trajectory(), load_moving_rig(project)
    views: dict[int, list[MarkerView]] = {number: [] for number in numbers}
    looked = 0
    for view_of in _look(project, recording, search.dictionary, progress):
        looked += 1
        for number, view in view_of.items():
            if number in views and trajectory.has(np.array([view.time])).all():
                views[number].append(view)
    for number, some in views.items():
        if not some:
            raise NotEnoughData(
                f"Marker {number} of {search.dictionary} is in none of the {looked} pictures that "
                "were looked at; check --markers, and whether there was light to see it by."
            )
    return {number: MarkerSight(tuple(some), trajectory, rig) for number, some in views.items()}


def _look(
    project: Project, recording: AbstractRecording, dictionary: str, progress: Progress
) -> Iterable[dict[int, MarkerView]]:
    """Look at pictures evenly over the recording: the markers in each."""
    known, times = load_dictionary(dictionary), project.load_frame_times()
    time_of = dict(zip(times.frame.tolist(), times.time.tolist(), strict=True))
    step = _step(times.time) if recording.is_timed else 1
    for frame in recording.frames():
        if frame.index % step or frame.index not in time_of:
            continue
        progress("look for markers", frame.index + 1, recording.num_frames)
        seen = find_markers(frame.image, known)
        yield {
            number: MarkerView(
                frame.index,
                time_of[frame.index],
                np.stack([corners[:, 0], frame.as_full_rows(corners[:, 1])], axis=1),
            )
            for number, corners in seen.items()
        }


def _step(times: np.ndarray) -> int:
    """Give how many frames go by from one that is looked at to the next."""
    if len(times) < 2:
        return 1
    return max(int(1 / _LOOKS / float(np.median(np.diff(times)))), 1)


def _place(project: Project, number: int, sights: dict[int, MarkerSight]) -> MarkerPlace:
    sight = sights[number]
    places, frames = [np.zeros((0, 3))], [np.zeros(0, np.int64)]
    for block in project.iterate_cloud():
        mine = sight.find_points(block)
        places.append(block.points[mine])
        frames.append(block.frame[mine].astype(np.int64))
    try:
        return place_marker(sight, np.concatenate(places), np.concatenate(frames))
    except NotEnoughData as error:
        raise NotEnoughData(
            f"Marker {number} cannot be placed: {error}. It is in {len(sight.views)} of the "
            "pictures; give x_m, y_m and z_m of that point, or leave it out."
        ) from error
