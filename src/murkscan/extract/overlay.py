"""Pictures of what was found, for a person to judge."""

import cv2
import numpy as np

from ..types.arrays import ColourImage
from ..types.frame import Frame
from ..types.stripe import Stripe

_ZOOM = 2
"""Picture pixels a frame pixel: enough to see where in its pixel a centre lies."""
_COLOURS = ((0, 230, 120), (255, 150, 0), (90, 160, 255))
"""Red, green, blue of the first branch, the second, and all others."""
_DIMMEST = 0.25
"""Share of full range to which a dark frame is brightened at most: a black one stays black."""
_BITS = 4
"""Binary places of a mark's position."""


def draw_stripe(frame: Frame, stripe: Stripe) -> ColourImage:
    """Draw the centres of a frame's stripe over it, twice as large.

    A dark frame is brightened. A field is drawn at the height of its full frame. The first branch
    is green, the second orange, others blue; the frame's number and count stand in the corner.

    Args:
        frame: The frame.
        stripe: What was found in it.
    """
    height, width = frame.image.shape
    dimmest = _DIMMEST * np.iinfo(frame.image.dtype).max
    top = max(float(np.quantile(frame.image, 0.999)), dimmest)
    grey = np.clip(frame.image * (200.0 / top), 0, 255).astype(np.uint8)
    size = (width * _ZOOM, height * frame.row_step * _ZOOM)
    large = cv2.resize(grey, size, interpolation=cv2.INTER_NEAREST)
    picture = cv2.cvtColor(large, cv2.COLOR_GRAY2RGB)
    # The centre of frame pixel 0 lies in the middle of its enlarged square.
    corner = (0.0, float(frame.first_row if frame.row_step > 1 else 0))
    places = (stripe.pixels - corner + 0.5) * _ZOOM - 0.5
    for (u, v), branch in zip(np.rint(places * 2**_BITS).astype(int), stripe.branch, strict=True):
        colour = _COLOURS[min(int(branch), len(_COLOURS) - 1)]
        cv2.circle(picture, (int(u), int(v)), 2**_BITS, colour, -1, cv2.LINE_AA, _BITS)
    label = f"frame {frame.index}: {len(stripe)} points"
    cv2.putText(
        picture, label, (12, 30), cv2.FONT_HERSHEY_SIMPLEX, 0.8, (255, 255, 255), 2, cv2.LINE_AA
    )
    return picture
