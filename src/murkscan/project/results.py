"""What each stage says when it is finished."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ..types.arrays import Indices, SignedFrameNumbers
from ..types.background import Attenuation
from ..types.paint_pull import PaintPull
from ..types.part_note import Skipped as Skipped

if TYPE_CHECKING:
    from ..geometry.alignment import Alignment


@dataclass(frozen=True)
class ExtractResult:
    """What was found in the pictures."""

    lasers: tuple[int, ...]
    """Numbers of the lasers in the rig whose stripes were looked for."""
    frames: int
    """Frames that were read."""
    skipped: int
    """Frames that could not be read."""
    frames_without_stripe: int
    points: int
    """Stripe centres, of all lasers."""
    skips: tuple[Skipped, ...] = ()
    remarks: tuple[str, ...] = ()
    """What is odd about the recording, with its cure; sentences for the user."""
    attenuation: Attenuation | None = None
    """How murky the water was, where the glow tells."""
    points_of: tuple[int, ...] = ()
    """Stripe centres of each laser."""


@dataclass(frozen=True)
class TriangulateResult:
    """What became of the stripe centres."""

    points: int
    dropped: int
    """Centres whose ray does not meet the sheet in front of the camera."""
    paint_pulls: tuple[PaintPull, ...] = ()
    """How far paint had pulled the centres of each laser, where that is seen; it was taken back."""


@dataclass(frozen=True)
class MotionResult:
    """How the camera moved."""

    poses: int
    frames_without_pose: int = 0
    """Frames of which the motion says nothing; they give no points."""
    remarks: tuple[str, ...] = ()
    """What was odd, such as the frames without a pose; sentences for the user."""
    duration: float = field(default=0.0, metadata={"unit": "s"})
    """From the first frame to the last [s]."""
    length: float = field(default=0.0, metadata={"unit": "m"})
    """Length of the camera's path [m]."""
    carries_mount: bool = False
    """Whether the poses came through the rig's mount, whose errors they then share."""
    accuracy: str = ""
    """How well the poses are known, in words; empty where nothing is stated, and their error is in
    no interval."""
    start: float = field(default=0.0, metadata={"unit": "s"})
    """What the log's clock showed when recording time was 0 [s]."""
    correction: tuple[str, ...] = ()
    """How the scan itself has corrected the log, or why it has not; sentences for the user."""
    corrected: float | None = field(default=None, metadata={"unit": "m"})
    """By how far, RMS [m]; None where the poses are those of the log."""


@dataclass(frozen=True)
class OpenDirectionResult:
    """A motion that an alignment left as it was."""

    words: str
    axis: tuple[float, ...]
    through: tuple[float, ...] = field(metadata={"unit": "m"})


@dataclass(frozen=True)
class AlignmentResult:
    """How one cloud was laid on another."""

    rotation: tuple[tuple[float, ...], ...]
    """Rotation matrix target_from_source."""
    translation: tuple[float, ...] = field(metadata={"unit": "m"})
    centre: tuple[float, ...] = field(metadata={"unit": "m"})
    """Middle of the overlap, about which it is turned [m]."""
    shift_of_centre: tuple[float, ...] = field(metadata={"unit": "m"})
    turn: tuple[float, ...] = field(metadata={"unit": "rad"})
    """Rotation vector [rad]."""
    covariance_of_turn_and_shift: tuple[tuple[float, ...], ...]
    """[rad², rad·m, m²]."""
    open: tuple[OpenDirectionResult, ...]
    overlap: float
    """Share of the source that was matched."""
    matches: int
    rms: float = field(metadata={"unit": "m"})
    """Root mean square distance of the matches [m]."""

    @classmethod
    def from_alignment(cls, alignment: "Alignment") -> "AlignmentResult":
        """Put an alignment into numbers."""
        from ..geometry.alignment_words import motion_of_overlap

        shift, turn = motion_of_overlap(alignment)
        return cls(
            rotation=_rows(alignment.target_from_source.rotation),
            translation=tuple(alignment.target_from_source.translation.tolist()),
            centre=tuple(alignment.centre.tolist()),
            shift_of_centre=tuple(shift.tolist()),
            turn=tuple(turn.tolist()),
            covariance_of_turn_and_shift=_rows(alignment.covariance),
            open=tuple(
                OpenDirectionResult(str(one), tuple(one.axis.tolist()), tuple(one.through.tolist()))
                for one in alignment.open_directions
            ),
            overlap=alignment.overlap,
            matches=alignment.num_matches,
            rms=alignment.rms,
        )


def _rows(matrix: np.ndarray) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in matrix.tolist())


@dataclass(frozen=True)
class PassResult:
    """What became of one pass of a merged cloud."""

    path: str
    """As it was given."""
    frames: tuple[int, int]
    """First and last of its frames, by the merged cloud's count."""
    left_out: int
    """Points that are not finite."""
    words: str
    """How it was moved, for people."""
    alignment: AlignmentResult | None
    """How it was laid on those before it; None: it stays where it was."""
    laid_on: tuple[float, ...]
    """Share of its matches in each pass that it was laid on."""
    first_frame: int = 0
    """Its own number of the first of its frames."""
    points: int = 0
    """Its points, before any were thinned out."""
    pose_errors: int = 0
    """How many independent errors its poses have."""
    answers: tuple[tuple[float, ...], ...] = ()
    """Change of its turn about the centre [rad] and of its shift [m] with each error of all rigs,
    poses and alignments; see `MergedErrors`. None for a pass that stays."""
    correction: tuple[str, ...] = ()
    """How its way was corrected by what the passes saw together; sentences for the user."""
    corrected: float | None = field(default=None, metadata={"unit": "m"})
    """By how far, RMS [m]; None where it was moved as a rigid body."""


@dataclass(frozen=True)
class CloudResult:
    """What the cloud holds."""

    points: int
    outliers: int
    """Points that were taken out."""
    outliers_by: Mapping[str, int] = field(default_factory=dict)
    """How many of them for each cause."""
    attenuation: float | None = field(default=None, metadata={"unit": "per_m"})
    """Beam attenuation of the water that the points' reflectance is corrected for [1/m]; None: none
    was known."""
    passes: tuple[PassResult, ...] = ()
    """The scans that a merged cloud was made of."""
    remarks: tuple[str, ...] = ()
    """Why passes were moved as rigid bodies; sentences for the user."""

    @property
    def is_joint(self) -> bool:
        """Whether the ways of a merged cloud's passes were adjusted together."""
        return any(one.corrected is not None for one in self.passes)

    def number_passes(self, frame: SignedFrameNumbers) -> Indices:
        """Tell in which pass of a merged cloud each frame of its count was taken."""
        first = [one.frames[0] for one in self.passes]
        return np.searchsorted(first, frame, side="right") - 1


@dataclass(frozen=True)
class MeshResult:
    """What the surface holds; what was not asked for is None."""

    vertices: int
    faces: int
    holes_closed: int | None = None
    holes_left: int | None = None
    faces_filled: int | None = None
    """Faces that close holes."""
    origin: tuple[float, ...] = field(default=(0.0, 0.0, 0.0), metadata={"unit": "m"})
    """Where the coordinates of mesh.stl and mesh.glb count from in the world [m]."""


@dataclass(frozen=True)
class ViewResult:
    """What was drawn."""

    pictures: tuple[str, ...]
    """Names, in the order to show them."""
    points: int
    """Points that the page shows."""
    relation: str = ""
    """Of two scans, how the other one was moved, in a sentence."""
    alignment: AlignmentResult | None = None
    """The same in numbers."""


@dataclass(frozen=True)
class ReportResult:
    """What the report tells in short."""

    frames: int
    skipped: int
    frames_without_stripe: int
    points: int
    covered: float | None = None
    """Share of the surface passed over that the scan has; None where it is not known."""
    largest_gap: str | None = None
    """Why most of the rest is missing; None where nothing is."""
    half_width: float | None = field(default=None, metadata={"unit": "m"})
    """Half the 95 % interval of a typical point [m], with all that is stated."""
    own_half_width: float | None = field(default=None, metadata={"unit": "m"})
    """The same by its own noise alone [m]."""
    unstated: tuple[str, ...] = ()
    """Whose errors are in neither, since nothing is stated of them; sentences for the user."""
    steps_with_advice: tuple[str, ...] = ()
    """Steps of the calibration whose verdict asks for better."""


@dataclass(frozen=True)
class MeasureResult:
    """What was measured; the numbers stand in a file of their own."""

    kind: str
    """Such as sphere, distance, section."""


@dataclass(frozen=True)
class AcceptResult:
    """What an acceptance test came to; the numbers stand in a file of their own."""

    decision: str
    """passed, failed, undecided, or no limit stated."""


@dataclass(frozen=True)
class SimulateResult:
    """What was simulated."""

    recording: str
    """The folder of pictures or the video, relative to the folder of the simulation."""
    pictures: int
    """Pictures kept."""
    frames: int
    """Frames, fields counted."""
    centres: int
    """True centres of the stripe."""
