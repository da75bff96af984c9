"""A camera's port, and the index of the water, from boards seen through both."""

from collections.abc import Sequence
from dataclasses import replace

from ..errors import NotEnoughData
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from .adjust.observations import Sighting, index_of
from .adjust.parameters import port_parameters
from .adjust.priors import indices_apart, join
from .adjust.solve import adjust
from .board.chessboard import Chessboard
from .board.pose import locate_seen_board
from .board.tilt import refuse_parallel_boards
from .board.view import BoardView
from .calibration import MIN_VIEWS, Calibration, find_outlier
from .words import refuse_open_parameters

_OUTLIER = 3.0
"""A view whose RMS is so many times the median is left out."""


def calibrate_port(
    views: Sequence[BoardView],
    board: Chessboard,
    rig: Rig,
    *,
    free: Sequence[str] = (),
    prior: RigCovariance | None = None,
    considered: RigCovariance | None = None,
) -> Calibration:
    """Find how a camera's port stands, from views of a board through it.

    The camera is adjusted along, within its covariance. Where it has none it is taken as exact.

    Args:
        views: The views; those in which the board was not found are passed over.
        board: The board, of known size.
        rig: The rig with its camera, its covariance, a port as it was measured, and the water.
        free: Other parameters to find too, such as `water.index`.
        prior: What is known beforehand of the port, or of the free ones.
        considered: What is neither found nor exact, such as the water's index.

    Raises:
        NotEnoughData: The board was found in fewer than 4 views.
        Degenerate: The boards are parallel, or a parameter is not determined; the message names it.
        InputError: The boards cannot be seen through the port as it was measured.
        NotConverged: The adjustment came to no end.
    """
    used = [view for view in views if view.is_found]
    if len(used) < MIN_VIEWS:
        raise NotEnoughData(
            f"Need at least {MIN_VIEWS} views of the {board} board through the port, better 15, "
            f"found it in {len(used)} of {len(views)}. Take photos of the whole board, near and "
            "far, each tilted another way."
        )
    refuse_parallel_boards(used, board, rig.camera.size)
    assert rig.camera.port is not None
    wanted = (*port_parameters(rig.camera.port), *free)
    known = join(join(rig.covariance, prior), considered)
    apart = indices_apart(known, wanted)
    names = (*wanted, *(n for n in known.names if n not in wanted and n not in apart))
    sightings = [_locate(view, board, rig) for view in used]
    left_out = list[str]()
    while True:
        found = adjust(rig, sightings, names, prior=known, considered=apart)
        worst = find_outlier(found.view_rms, len(left_out), outlier=_OUTLIER)
        if worst is None:
            break
        left_out.append(sightings.pop(worst).name)
    refuse_open_parameters(found)
    calibration = Calibration.of("port", found, wanted, sightings)
    return replace(calibration, left_out=tuple(left_out))


def _locate(view: BoardView, board: Chessboard, rig: Rig) -> Sighting:
    points = view.places(board.points())
    pose = locate_seen_board(view.corners, points, rig.camera, index_of(rig))
    return Sighting(view.name, view.corners, points, pose)
