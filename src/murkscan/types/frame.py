"""One grey picture at one time."""

from dataclasses import dataclass

from .arrays import Image, Scalars
from .short_repr import ShortRepr


@dataclass(frozen=True, eq=False, repr=False)
class Frame(ShortRepr):
    """One picture: a whole one, or one field of an interlaced one.

    A field has every second row of the full frame, exposed at its own time; nothing is
    interpolated.
    """

    image: Image
    """Grey levels, 8 or 16 bit."""
    index: int
    """Number of the frame in its recording; where fields are frames, fields are counted."""
    time: float
    """Recording time [s]; the number of the picture where the recording has no times."""
    first_row: int = 0
    """Row of the full frame that row 0 of the image shows."""
    row_step: int = 1
    """Rows of the full frame from one row of the image to the next: 2 for a field."""

    def as_full_rows(self, rows: Scalars) -> Scalars:
        """Give rows of this image as rows v of the full frame [px]."""
        return self.first_row + self.row_step * rows
