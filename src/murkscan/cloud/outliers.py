"""Points that are no surface, by every reason in turn."""

from collections.abc import Mapping, Sequence

import numpy as np

from ..types.arrays import Mask
from ..types.cloud import PointCloud
from .base import AbstractOutlierRule, SeenCloud
from .doubtful import Doubtful
from .seen_through import SeenThrough
from .sparse import Sparse

OUTLIER_RULES: tuple[AbstractOutlierRule, ...] = (Doubtful(), Sparse(), SeenThrough())
"""The reasons not to believe a point, in the order in which a scan asks for them."""


def find_outliers(
    seen: SeenCloud, rules: Sequence[AbstractOutlierRule] = OUTLIER_RULES
) -> Mapping[str, Mask]:
    """Find the points that are no surface, by cause.

    Args:
        seen: The points of a scan, and from where they were seen.
        rules: The reasons; each judges only what those before it let stay.

    Returns:
        For the cause of each rule which points it takes out: a point has one cause at most.

    Raises:
        InputError: A point is not finite.
    """
    left = np.arange(len(seen.cloud))
    found: dict[str, Mask] = {}
    for rule in rules:
        is_false = rule.find(seen[left])
        found[rule.cause] = np.zeros(len(seen.cloud), bool)
        found[rule.cause][left[is_false]] = True
        left = left[~is_false]
    return found


def remove_outliers(cloud: PointCloud, *, max_jump: float | None = None) -> PointCloud:
    """Take out the points that stand alone, in specks or out: what `Sparse` finds.

    For those that need more than the points themselves, see `find_outliers`.

    Args:
        cloud: The points of a scan.
        max_jump: As in `Sparse` [m].

    Returns:
        The points that stay, in their order.

    Raises:
        InputError: A point is not finite, or max_jump is not positive.
    """
    return cloud[~Sparse(max_jump).find(SeenCloud(cloud, cloud.points))]
