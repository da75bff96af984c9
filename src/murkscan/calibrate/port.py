"""A camera's port, and the index of the water, from boards seen through both."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import NotEnoughData
from ..types.arrays import Pixels
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from .adjust import Adjustment, adjust
from .board import Chessboard
from .limits import refuse_open_parameters
from .observed import index_of
from .parameters import port_parameters
from .seen_board import locate_seen_board
from .sighting import Sighting
from .tilt import refuse_parallel_boards
from .view import BoardView

_MIN_VIEWS = 4
_OUTLIER, _MAX_OUTLIERS = 3.0, 0.25
"""A view whose RMS is so many times the median is left out; at most such a share of the views."""


@dataclass(frozen=True, eq=False)
class PortCalibration:
    """A camera behind its port, and what both are worth."""

    adjustment: Adjustment
    """The rig, its covariance and the residuals."""
    wanted: tuple[str, ...]
    """The parameters that the photos were taken for; others are adjusted along."""
    sightings: tuple[Sighting, ...]
    """The views used, with the board where it was found to be."""
    left_out: tuple[str, ...]
    """Names of views left out, since they fit far worse than the others."""

    @property
    def rig(self) -> Rig:
        """The rig with its new port and its covariance."""
        return self.adjustment.rig

    @property
    def view_rms(self) -> tuple[float, ...]:
        """Root mean square distance of a corner from its projection, of each view [px]."""
        return tuple(_rms(residuals) for residuals in self.adjustment.corner_residuals)

    @property
    def rms(self) -> float:
        """The same of all views [px]."""
        return _rms(np.concatenate(self.adjustment.corner_residuals))


def calibrate_port(
    views: Sequence[BoardView],
    board: Chessboard,
    rig: Rig,
    *,
    free: Sequence[str] = (),
    prior: RigCovariance | None = None,
    considered: RigCovariance | None = None,
) -> PortCalibration:
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
    if len(used) < _MIN_VIEWS:
        raise NotEnoughData(
            f"Need at least {_MIN_VIEWS} views of the {board} board through the port, better 15, "
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
        worst = _worst(found)
        if worst is None or len(left_out) >= int(_MAX_OUTLIERS * len(used)):
            break
        left_out.append(sightings.pop(worst).name)
    refuse_open_parameters(found)
    return PortCalibration(found, wanted, tuple(sightings), tuple(left_out))


def join(covariance: RigCovariance, prior: RigCovariance | None) -> RigCovariance:
    """Put what is known beforehand in the place of what a covariance says of the same names."""
    if prior is None:
        return covariance
    kept = [name for name in covariance.names if name not in prior.names]
    names = (*kept, *prior.names)
    matrix = covariance.select(names).matrix
    matrix[:, len(kept) :] = matrix[len(kept) :] = 0.0
    matrix[len(kept) :, len(kept) :] = prior.matrix
    return RigCovariance(names, matrix)


def indices_apart(known: RigCovariance, wanted: Sequence[str]) -> tuple[str, ...]:
    """Name the water's index, unless it is wanted: it belongs to the place, not to the rig."""
    return tuple(n for n in known.names if n.startswith("water.") and n not in wanted)


def _locate(view: BoardView, board: Chessboard, rig: Rig) -> Sighting:
    pose = locate_seen_board(view.corners, board, rig.camera, index_of(rig))
    return Sighting(view.name, view.corners, board.points(), pose)


def _worst(found: Adjustment) -> int | None:
    """Give the view that fits far worse than the others."""
    rms = [_rms(residuals) for residuals in found.corner_residuals]
    worst = int(np.argmax(rms))
    return worst if rms[worst] > _OUTLIER * float(np.median(rms)) else None


def _rms(residuals: Pixels) -> float:
    return float(np.sqrt(np.mean(np.sum(residuals**2, axis=1))))
