"""How one scan of a surface lies on another: the correction, how well it is known, what is open."""

from dataclasses import dataclass, field

import numpy as np
import small_gicp
from jaxtyping import Float
from scipy.spatial import cKDTree

from ..errors import Degenerate, InputError
from ..types.arrays import Directions, Points, Scalars, Vector
from ..types.cloud import PointCloud
from ..types.pose import Pose
from .alignment_fit import AlignmentFit, Matrix6, no_overlap, sensitivity
from .open_directions import OpenDirection, describe_motions
from .surface_points import SurfacePoints

_REACH = 0.05
"""Distance up to which surfaces are looked for in each other's place, in the size of the smaller:
generous for the drift of a vehicle's log."""
_COARSE = 4.0
"""Spacing of the first, rough fit in spacings of the last."""
_ROUNDS = 20
_SETTLED = 1e-4
"""Step, in spacings, below which the last fit has settled."""


@dataclass(frozen=True, eq=False)
class Pairs:
    """Where two surfaces were found to agree; one a row."""

    points: Points
    """Of the source, where they are laid, in the target's frame [m]."""
    normals: Directions
    """Of both surfaces, in the target's frame."""
    pull: Float[np.ndarray, "6 n"]
    """Turn [rad] and shift [m] that answer a metre by which the source leaves the target there."""

    @classmethod
    def none(cls) -> "Pairs":
        """Make no pairs."""
        return cls(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((6, 0)))


@dataclass(frozen=True, eq=False)
class Alignment:
    """The correction that lays a source on a target."""

    target_from_source: Pose
    """Along open directions it moves nothing that `start` did not."""
    centre: Vector
    """Middle of the overlap [m], in the target's frame."""
    covariance: Matrix6
    """Of a small turn about `centre` [rad] and then a shift [m], in the target's frame; zero along
    open directions, of which nothing is known."""
    open_directions: tuple[OpenDirection, ...]
    """Motions that the overlap does not show."""
    overlap: float
    """Share of the source's surface that lies on the target."""
    num_matches: int
    """Pairs of points that agree."""
    rms: float
    """Root mean square distance of the surfaces at these pairs, along the normal [m]."""
    start: Pose = field(default_factory=Pose.identity)
    """What was taken for target_from_source to begin with."""
    pairs: Pairs = field(default_factory=Pairs.none)
    """Where it was told from."""

    @property
    def correction(self) -> Pose:
        """Give what alignment has changed, in the target's frame: after `start`."""
        return self.target_from_source @ self.start.inverse()

    def answer(self, apart: Float[np.ndarray, "n 3 modes"]) -> Float[np.ndarray, "6 modes"]:
        """Tell how the source would have been laid, had errors moved it off the target.

        Args:
            apart: By how much each error moves the source off the target at the pairs [m].

        Returns:
            The change of a turn about `centre` [rad] and of a shift [m] with each error.
        """
        along = np.einsum("nj,njm->nm", self.pairs.normals, apart)
        return self.pairs.pull @ along

    def sigma_along(self, points: Points, directions: Directions) -> Scalars:
        """Give the standard deviation that the alignment leaves at aligned points [m].

        Args:
            points: Points of the source, in the target's frame [m].
            directions: Unit direction of interest at each, such as the target's normal.
        """
        moves = sensitivity(points - self.centre, directions, 1.0)
        return np.sqrt(np.maximum(np.einsum("ni,ij,nj->n", moves, self.covariance, moves), 0.0))


def align_clouds(
    source: PointCloud,
    target: PointCloud,
    *,
    reach: float | None = None,
    start: Pose | None = None,
) -> Alignment:
    """Lay one scan on another where they overlap.

    Args:
        source: The cloud that moves.
        target: The cloud that stays.
        reach: Distance up to which a surface is looked for in the other's place [m]; a twentieth
            of the size of the smaller unless given.
        start: target_from_source, about; the identity unless given.

    Raises:
        InputError: A point is not finite, or reach is not positive.
        NotEnoughData: A cloud has fewer than 30 points.
        Degenerate: The clouds do not overlap.
    """
    first, second = SurfacePoints.from_cloud(source), SurfacePoints.from_cloud(target)
    spacing = max(first.spacing, second.spacing)
    if first.spacing < spacing:
        first = SurfacePoints.from_cloud(source, spacing=spacing)
    if second.spacing < spacing:
        second = SurfacePoints.from_cloud(target, spacing=spacing)
    return align_surfaces(first, second, reach=reach, start=start)


def align_surfaces(
    source: SurfacePoints,
    target: SurfacePoints,
    *,
    reach: float | None = None,
    start: Pose | None = None,
) -> Alignment:
    """Lay one surface on another where they overlap.

    Generalised ICP finds the place. From there least squares of the distances along the normals,
    on the pairs that agree, refine it, moving nothing along directions that the overlap does not
    show. The covariance is the larger of that of 64 pieces of the overlap and
    those of 12 slabs across it, in 8 directions, each of which may err as a whole: errors that
    reach farther than a slab, of a wrong calibration say, are not in it.

    Args:
        source: The surface that moves.
        target: The surface that stays.
        reach: As for `align_clouds`.
        start: As for `align_clouds`.

    Raises:
        InputError: reach is not positive.
        Degenerate: The surfaces do not overlap.

    References:
        Segal, Haehnel, Thrun, Generalized-ICP, RSS 2009. Rusinkiewicz, A symmetric objective
        function for ICP, SIGGRAPH 2019, equation (10). Gelfand et al., Geometrically stable
        sampling for the ICP algorithm, 3DIM 2003, for the directions. Liang and Zeger,
        Longitudinal data analysis using generalized linear models, Biometrika 73(1), 1986, and
        MacKinnon and White, Some heteroskedasticity-consistent covariance matrix estimators,
        J. Econometrics 29(3), 1985, for the covariance. Bell and McCaffrey, Bias reduction in
        standard errors for linear regression with multi-stage samples, Survey Methodology 28(2),
        2002, for leaving out pieces.
    """
    start = start or Pose.identity()
    size = min(float(np.linalg.norm(np.ptp(s.points, axis=0))) for s in (source, target))
    reach = _REACH * size if reach is None else reach
    if not 0 < reach < np.inf:
        raise InputError(f"reach must be above 0, got {reach:g} m.")
    reach = max(reach, 2 * max(source.spacing, target.spacing))
    tree = cKDTree(target.points)
    pose = _register(source, target, reach, start)
    for _ in range(_ROUNDS):
        fit = AlignmentFit.at(pose, source, target, tree, reach)
        pose, moved = fit.step(pose, start)
        if moved < _SETTLED * target.spacing:
            break
    fit = AlignmentFit.at(pose, source, target, tree, reach)
    return Alignment(
        pose,
        fit.centre,
        fit.covariance(),
        tuple(describe_motions(fit.open_motions, centre=fit.centre, length=fit.length)),
        overlap=len(fit.residuals) / len(source),
        num_matches=len(fit.residuals),
        rms=float(np.sqrt(np.mean(fit.residuals**2))),
        start=start,
        pairs=Pairs(fit.points, fit.jacobian[:, 3:], fit.pull()),
    )


def _register(source: SurfacePoints, target: SurfacePoints, reach: float, start: Pose) -> Pose:
    """Find the place by generalised ICP, roughly and then finely."""
    spacing = max(source.spacing, target.spacing)
    # small_gicp numbers its cubes from the origin, and stops at fixed steps in metres and radians.
    middle = target.points.mean(axis=0)
    there, here = target.points - middle, start @ source.points - middle
    moved = np.eye(4)
    for cube, within in ((_COARSE * spacing, reach), (spacing, max(reach / _COARSE, 2 * spacing))):
        result = small_gicp.align(
            there,
            here,
            moved,
            downsampling_resolution=cube,
            max_correspondence_distance=within,
            max_iterations=60,
            rotation_epsilon=1e-5,
            translation_epsilon=_SETTLED * spacing,
        )
        moved = np.asarray(result.T_target_source)
        if not np.isfinite(moved).all() or result.num_inliers == 0:
            raise Degenerate(no_overlap(0, len(source), reach))
    here_to_there = Pose(moved[:3, :3], moved[:3, 3])
    return Pose(np.eye(3), middle) @ here_to_there @ Pose(np.eye(3), -middle) @ start
