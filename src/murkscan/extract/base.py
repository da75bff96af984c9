"""What every extractor can do."""

import abc
from collections.abc import Iterable, Iterator, Sequence
from typing import ClassVar

from ..types.background import Background
from ..types.frame import Frame
from ..types.rig import Rig
from ..types.stripe import Stripe
from .noise import learn_noise


class AbstractExtractor(abc.ABC):
    """A way to find the stripe. Subclasses are final: wrap one, do not subclass it.

    A recording is read twice: `learn` sees some frames spread over all of it, `extract` every
    frame in order.
    """

    look_ahead: ClassVar[int] = 0
    """Frames on both sides of a frame that its stripe depends on, 0 to 8."""
    tells_lasers_apart: ClassVar[bool] = False
    """Whether it knows whose line it sees where several lasers are in the picture."""

    def learn(self, frames: Sequence[Frame], rig: Rig, *, laser: int = 0) -> Background:
        """Learn what the recording looks like where the stripe is not.

        Args:
            frames: Frames spread over the recording, in order, at least one.
            rig: The rig that recorded them.
            laser: Number of the laser in the rig whose stripe will be looked for.
        """
        return learn_noise(frames)

    def learn_soon(self, frames: Sequence[Frame], rig: Rig, *, laser: int = 0) -> Background:
        """Learn what suffices to show a dive while it goes on; arguments as of `learn`.

        As `learn`, unless that may find that frames are to be looked at more closely than their
        coming allows.
        """
        return self.learn(frames, rig, laser=laser)

    @abc.abstractmethod
    def extract(
        self, frames: Iterable[Frame], rig: Rig, background: Background, *, laser: int = 0
    ) -> Iterator[Stripe]:
        """Find the stripe of one laser in frames that follow one another.

        Args:
            frames: Frames in order; consecutive but for those that could not be read.
            rig: The rig that recorded them.
            background: What `learn` gave for this recording.
            laser: Number of the laser in the rig whose stripe is looked for.

        Yields:
            One stripe a frame, in order; of length 0 where the frame shows none.
        """

    def extract_soon(
        self, frames: Iterable[Frame], rig: Rig, background: Background, *, laser: int = 0
    ) -> Iterator[Stripe]:
        """Find the stripe well enough to show a dive while it goes on; arguments as of `extract`.

        As `extract`, unless that makes more of a centre than a preview shows.
        """
        return self.extract(frames, rig, background, laser=laser)
