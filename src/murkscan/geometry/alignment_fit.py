"""Least squares of the distances between two surfaces, on the pairs of points that agree."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation
from scipy.special import stdtrit

from ..errors import Degenerate
from ..types.arrays import Directions, Indices, Points, Scalars, Vector
from ..types.pose import Pose
from .open_directions import Motions
from .surface_points import SurfacePoints
from .voxels import VoxelGrid

Matrix6 = Float[np.ndarray, "6 6"]
Motion = Float[np.ndarray, "6"]
Jacobian = Float[np.ndarray, "n 6"]

_FEWEST = 50
"""Matches below which there is no overlap."""
_AGREE = 0.5
"""Cosine of the angle between normals up to which two points may be of one surface."""
_GAUSSIAN = 1.4826
"""Standard deviation of Gaussian noise as a multiple of its median absolute value."""
_LEAST_OVERLAP = 0.02
"""The same as a share of the smaller surface."""
_ASIDE = 1.5
"""Spacings that a pair may lie apart along the surface."""
_ROBUST = 4.0
"""Robust standard deviations beyond which a match is none."""
_OPEN = 10.0
"""A direction is open where noise of the normals may make up a tenth of what shows it."""
_FLATTEST = 1e-4
"""Mean square of the normals' share along a direction below which it is open in any case."""
_BLOCKS = 64
"""Pieces of the overlap that may be independent of one another."""
_SLABS = 12
"""The same for slabs that reach across all of it."""
_DIRECTIONS = 8
"""Directions in which slabs are cut: profiles and scan lines may run any way."""
_NORMAL_95 = 1.96
"""Standard deviations of a Gaussian that hold 95 %."""
_LEAST_REST = 0.02
"""Share of what shows a direction that is taken to be left without any one piece."""


@dataclass(frozen=True, eq=False)
class AlignmentFit:
    """The pairs that agree at one place, and how their distances change with it."""

    centre: Vector
    """Middle of the pairs [m], in the target's frame."""
    length: float
    """Turns are counted in what they move at this distance [m]."""
    points: Points
    """Where the source's points of the pairs are laid [m]."""
    residuals: Scalars
    """Distance of the source in front of the target at each pair [m]."""
    weights: Scalars
    jacobian: Jacobian
    open_motions: Motions
    """Motions that change no distance."""
    determined: Float[np.ndarray, "6 determined"]
    information: Float[np.ndarray, " determined"]
    """Sum of squares along each determined motion."""
    cuts: tuple[Indices, ...]
    """Several ways to cut the overlap into pieces: the number of each pair's piece in each."""

    @classmethod
    def at(
        cls, pose: Pose, source: SurfacePoints, target: SurfacePoints, tree: cKDTree, reach: float
    ) -> "AlignmentFit":
        """Pair the points of both surfaces at one place of the source, and linearise.

        Args:
            pose: target_from_source.
            source: The surface that moves.
            target: The surface that stays.
            tree: Its points.
            reach: Largest distance of a pair [m].

        Raises:
            Degenerate: Too few pairs agree.
        """
        pairs = _pair(pose, source, target, tree, reach)
        count = len(pairs.residuals)
        if count < max(_FEWEST, _LEAST_OVERLAP * min(len(source), len(target))):
            raise Degenerate(no_overlap(count, len(source), reach))
        centre = pairs.points.mean(axis=0)
        arms = pairs.points - centre
        length = float(np.sqrt(np.mean(np.einsum("ij,ij->i", arms, arms))))
        jacobian = sensitivity(arms, pairs.normals, length)
        information, motions = np.linalg.eigh(jacobian.T @ (pairs.weights[:, None] * jacobian))
        is_open = information < pairs.weights.sum() * max(_OPEN * pairs.noise, _FLATTEST)
        return cls(
            centre,
            length,
            pairs.points,
            pairs.residuals,
            pairs.weights,
            jacobian,
            motions[:, is_open],
            motions[:, ~is_open],
            information[~is_open],
            _cut_all(pairs.points),
        )

    def step(self, pose: Pose, start: Pose) -> tuple[Pose, float]:
        """Give a better place, and how far it is from this one [m]."""
        wanted = -self.jacobian.T @ (self.weights * self.residuals)
        along = self.determined.T @ wanted / self.information
        change = self.determined @ along
        # What earlier steps have moved along directions that are open is taken back.
        so_far = self._motion_of(pose @ start.inverse())
        change -= self.open_motions @ (self.open_motions.T @ so_far)
        turn = Rotation.from_rotvec(change[:3] / self.length).as_matrix()
        about = Pose(turn, self.centre + change[3:] - turn @ self.centre)
        return about @ pose, float(np.linalg.norm(change))

    def covariance(self) -> Matrix6:
        """Give the covariance of a turn [rad] and a shift [m].

        The pieces of each cut are left out in turn; that cut counts by which the least is known,
        since its pieces are what errs as a whole.
        """
        own = self.jacobian @ self.determined
        known = [_leave_out(own, self.weights, self.residuals, pieces) for pieces in self.cuts]
        covariance = max(known, key=lambda one: float(np.diag(one) @ self.information))
        covariance = self.determined @ covariance @ self.determined.T
        unit = np.diag(np.repeat([1 / self.length, 1.0], 3))
        return unit @ covariance @ unit

    def pull(self) -> Float[np.ndarray, "6 n"]:
        """Give the turn [rad] and the shift [m] that answer a metre by which each pair comes apart.

        What errors common to a whole surface do to its place: least squares make of it the motion
        that brings the pairs together again.
        """
        own = self.jacobian @ self.determined
        along = -(own * self.weights[:, None] / self.information).T
        motion = self.determined @ along
        return np.concatenate([motion[:3] / self.length, motion[3:]])

    def _motion_of(self, pose: Pose) -> Motion:
        turn = Rotation.from_matrix(pose.rotation).as_rotvec()
        shift = (pose @ self.centre[None])[0] - self.centre
        return np.concatenate([turn * self.length, shift])


@dataclass(frozen=True, eq=False)
class _Pairs:
    points: Points
    """Of the source, where they are laid [m]."""
    normals: Directions
    residuals: Scalars
    weights: Scalars
    noise: float
    """Mean square by which a mean normal is off, along each direction."""


def _pair(
    pose: Pose, source: SurfacePoints, target: SurfacePoints, tree: cKDTree, reach: float
) -> _Pairs:
    points, normals = pose @ source.points, source.normals @ pose.rotation.T
    found = tree.query(points, distance_upper_bound=reach)
    distance, nearest = np.asarray(found[0]), np.asarray(found[1])
    near = np.flatnonzero(np.isfinite(distance))
    agree = np.einsum("ij,ij->i", normals[near], target.normals[nearest[near]])
    # A drawing's normals may point inwards.
    is_sided = source.is_oriented and target.is_oriented
    side = np.copysign(1.0, np.full(len(near), agree.sum()) if is_sided else agree)
    near, side = near[side * agree > _AGREE], side[side * agree > _AGREE]
    there = nearest[near]
    ours, theirs = side[:, None] * normals[near], target.normals[there]
    mean = (ours + theirs) / np.linalg.norm(ours + theirs, axis=1, keepdims=True)
    between = points[near] - target.points[there]
    residuals = np.einsum("ij,ij->i", mean, between)
    aside = np.sqrt(np.maximum(np.einsum("ij,ij->i", between, between) - residuals**2, 0))
    spread = _GAUSSIAN * float(np.median(np.abs(residuals))) if len(near) else 0.0
    # Where normals differ, the surface between two points that lie aside is not known so well.
    off = np.einsum("ij,ij->i", ours - theirs, ours - theirs)
    expected = np.sqrt(max(spread, 1e-9) ** 2 + off * aside**2 / 4)
    # Beyond the rim of the target, the nearest of its points lies aside.
    kept = (np.abs(residuals) <= _ROBUST * expected) & (aside <= _ASIDE * target.spacing)
    ours_count, theirs_count = source.weights[near], target.weights[there]
    weights = 2 * ours_count * theirs_count / (ours_count + theirs_count)
    weights *= (max(spread, 1e-9) / expected) ** 2
    # Two normals differ in two directions by the noise of both, and their mean has half of each.
    noise = float(np.average(off[kept], weights=weights[kept])) / 8 if kept.any() else 0.0
    return _Pairs(points[near[kept]], mean[kept], residuals[kept], weights[kept], noise)


def sensitivity(arms: Points, directions: Directions, length: float) -> Jacobian:
    """Give how far each point moves along its direction with a turn (times length) and a shift."""
    return np.concatenate([np.cross(arms, directions) / length, directions], axis=1)


def _leave_out(
    jacobian: Float[np.ndarray, "n k"], weights: Scalars, residuals: Scalars, piece: Indices
) -> Float[np.ndarray, "k k"]:
    """Give the covariance of least squares by what leaving out each piece would change.

    A piece that alone fixes a direction shows no residual there: only without it is its error seen.
    """
    moments = weights[:, None] * jacobian
    whole = jacobian.T @ moments
    found, count = np.zeros_like(whole), 0
    order = np.argsort(piece, kind="stable")
    for part in np.split(order, np.flatnonzero(np.diff(piece[order])) + 1):
        rest = whole - jacobian[part].T @ moments[part]
        # What only this piece shows is as good as open without it, but not endless.
        rest += _LEAST_REST * whole
        change = np.linalg.solve(rest, moments[part].T @ residuals[part])
        found += np.outer(change, change)
        count += 1
    # Scaled so that 1.96 standard deviations hold 95 %, however few the pieces are.
    return found * (stdtrit(max(count - 1, 1), 0.975) / _NORMAL_95) ** 2


def _cut_all(points: Points) -> tuple[Indices, ...]:
    """Cut a surface into pieces, and into slabs across it in several directions.

    Errors of a finder may reach along a scan line over all of a pass, those of a log over a whole
    profile, and from each to the next ones.
    """
    off = points - points.mean(axis=0)
    first, second = np.linalg.eigh(off.T @ off)[1][:, :0:-1].T
    slabs = []
    for angle in np.arange(_DIRECTIONS) * (np.pi / _DIRECTIONS):
        along = off @ (np.cos(angle) * first + np.sin(angle) * second)
        share = (along - along.min()) / max(float(np.ptp(along)), 1e-300)
        slabs.append(np.minimum((_SLABS * share).astype(np.int64), _SLABS - 1))
    return (_cut(points), *slabs)


def _cut(points: Points) -> Indices:
    """Cut a surface into about 64 pieces; number each point's."""
    size = float(np.linalg.norm(np.ptp(points, axis=0))) / 4
    grid = VoxelGrid(points - points.min(axis=0), size)
    while len(grid.starts) < _BLOCKS and len(grid.starts) < len(points):
        grid = VoxelGrid(grid.points, 0.85 * grid.size)
    return np.unique(grid.keys, return_inverse=True)[1]


def no_overlap(matches: int, count: int, reach: float) -> str:
    """Say that two clouds share too little."""
    return (
        f"The two clouds do not overlap: {matches} of {count} places of the one have a surface of "
        f"the same direction in the other within {reach * 1e3:.0f} mm. Align only scans that share "
        "some surface, in one frame to about that distance, or allow a larger one."
    )
