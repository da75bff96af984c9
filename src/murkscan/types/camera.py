"""A pinhole camera with lens distortion, and the window that it looks through."""

from dataclasses import dataclass, field

import numpy as np

from ..errors import InputError
from .arrays import Matrix3, Scalars
from .port import FlatPort, Port
from .short_repr import ShortRepr


def _no_distortion() -> Scalars:
    return np.zeros(5)


@dataclass(frozen=True, eq=False, repr=False)
class Camera(ShortRepr):
    """Intrinsics: how a ray in the camera frame becomes a pixel.

    The frame has x right, y down, z forward and its origin at the optical centre.

    References:
        Brown, Close-range camera calibration, Photogrammetric Engineering 37(8), 1971 (the
        distortion; its order is OpenCV's).
    """

    size: tuple[int, int]
    """Width and height of the full frame [px]."""
    focal_length: tuple[float, float]
    """Focal length along u and v [px]."""
    principal_point: tuple[float, float]
    """Where the optical axis meets the image, u and v [px]."""
    distortion: Scalars = field(default_factory=_no_distortion)
    """Distortion k1 k2 p1 p2 k3, for normalised image coordinates."""
    port: Port | None = None
    """The window before the lens; without one the intrinsics hold in the medium they were
    calibrated in."""

    def __post_init__(self) -> None:
        """Refuse a port behind the camera."""
        if isinstance(self.port, FlatPort) and not self.port.normal[2] > 0:
            raise InputError(
                f"The normal of the camera's port must point forwards, its z above 0, got "
                f"{self.port.normal}."
            )

    def as_matrix(self) -> Matrix3:
        """Give the intrinsic matrix K, the A of the paper's equation (2)."""
        (fx, fy), (cx, cy) = self.focal_length, self.principal_point
        return np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])

    def is_distorted(self) -> bool:
        """Tell whether the lens bends straight lines."""
        return bool(np.any(self.distortion != 0))
