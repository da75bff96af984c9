"""A step of the calibration on the photos that are there, by what its command does, unwritten."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

from ..calibrate.adjust.observations import index_of
from ..calibrate.board.chessboard import Chessboard, Margin
from ..calibrate.board.pose import locate_seen_board
from ..calibrate.board.view import BoardView
from ..calibrate.check import judge_boards
from ..calibrate.precision import Precision
from ..calibrate.so_far import SoFar, cover_found, judge_so_far
from ..capture.photos import BoardPhotos
from ..errors import EstimationError, InputError
from ..io.poses import load_poses
from ..io.rig_toml import load_rig, parse_rig
from ..types.pose import Pose
from ..types.rig import Rig
from .calibrate import BoardSession, Fit
from .calibrate_camera import fit_camera
from .calibrate_check import check_views
from .calibrate_laser import LaserPlan
from .calibrate_mount import PhotoClock, plan_mount
from .calibrate_port import PortKnowledge, plan_port
from .progress import silent


class AbstractStep(ABC):
    """A step, and what its command would be given."""

    @abstractmethod
    def judge(
        self, folder: Path, views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]
    ) -> SoFar:
        """Say what photos are worth.

        Args:
            folder: The photos' folder.
            views: The boards in them.
            board: The board.
            size: Width and height of the photos [px].

        Raises:
            MurkscanError: What the command would refuse whatever the photos show.
        """

    @property
    def files(self) -> tuple[Path, ...]:
        """The files beside the photos, by which they are judged."""
        return ()


@dataclass(frozen=True)
class CameraStep(AbstractStep):
    """The camera in air."""

    def judge(
        self, folder: Path, views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]
    ) -> SoFar:
        """Judge as `calibrate camera` does."""
        session = _session(folder, views, board, size, folder, {})
        return judge_so_far("camera", views, board, size, lambda: fit_camera(session))


@dataclass(frozen=True)
class AbstractRigStep(AbstractStep):
    """A step on a rig that has a camera."""

    name: ClassVar[str]
    """The step's."""

    rig: Path

    @property
    def files(self) -> tuple[Path, ...]:
        """The rig file."""
        return (self.rig,)

    @abstractmethod
    def plan(self, folder: Path) -> tuple[dict[str, Any], Fit]:
        """Read the rig file, and say how the step is done."""

    def judge(
        self, folder: Path, views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]
    ) -> SoFar:
        """Judge as the command does."""
        tables, fit = self.plan(folder)
        rig = parse_rig(tables, name=str(self.rig))
        _refuse_size(size, rig, self.rig)
        session = _session(folder, views, board, size, self.rig, tables)

        def locate(view: BoardView) -> Pose:
            points = view.places(board.points())
            return locate_seen_board(view.corners, points, rig.camera, index_of(rig))

        return judge_so_far(self.name, views, board, size, lambda: fit(session), locate=locate)


@dataclass(frozen=True)
class PortStep(AbstractRigStep):
    """The camera's port."""

    name: ClassVar[str] = "port"

    knowledge: PortKnowledge = field(default_factory=PortKnowledge)

    def plan(self, folder: Path) -> tuple[dict[str, Any], Fit]:
        """Plan as `calibrate port` does."""
        return plan_port(self.rig, self.knowledge)


@dataclass(frozen=True)
class LaserStep(AbstractRigStep):
    """Lasers."""

    name: ClassVar[str] = "laser"

    lasers: LaserPlan = field(default_factory=LaserPlan)

    def plan(self, folder: Path) -> tuple[dict[str, Any], Fit]:
        """Plan as `calibrate laser` does."""
        return self.lasers.read(self.rig)


@dataclass(frozen=True)
class MountStep(AbstractRigStep):
    """The mount on the vehicle."""

    name: ClassVar[str] = "mount"

    poses: Path
    clock: PhotoClock

    @property
    def files(self) -> tuple[Path, ...]:
        """The rig file, and the vehicle's log."""
        return (self.rig, self.poses)

    def plan(self, folder: Path) -> tuple[dict[str, Any], Fit]:
        """Plan as `calibrate mount` does."""
        return plan_mount(self.rig, folder, load_poses(self.poses), self.clock)


@dataclass(frozen=True)
class CheckStep(AbstractStep):
    """Squares of a board, measured by a rig."""

    rig: Path
    margin: Margin | None = None
    laser: int = 0

    @property
    def files(self) -> tuple[Path, ...]:
        """The rig file."""
        return (self.rig,)

    def judge(
        self, folder: Path, views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]
    ) -> SoFar:
        """Judge as `calibrate check` does."""
        rig = load_rig(self.rig)
        _refuse_size(size, rig, self.rig)
        found = [view for view in views if view.is_found]
        coverage = cover_found(found, size)
        try:
            check, _ = check_views(
                BoardPhotos.open(folder), views, board, rig, margin=self.margin, laser=self.laser
            )
        except EstimationError as error:
            return SoFar(len(found), coverage, str(error), False, ())
        verdict = judge_boards(check, rig)
        square = Precision("side of a square", check.sigma, f"{check.sigma * 1e3:.2g} mm")
        return SoFar(
            len(found), coverage, str(verdict), verdict.is_good, (), (square,), check.rms,
        )  # fmt: skip


def _refuse_size(size: tuple[int, int], rig: Rig, path: Path) -> None:
    if size != rig.camera.size:
        raise InputError(
            f"The photos are {size[0]} x {size[1]} px but the camera of {path.name} has "
            f"{rig.camera.size[0]} x {rig.camera.size[1]}; give photos of this camera."
        )


def _session(
    folder: Path,
    views: Sequence[BoardView],
    board: Chessboard,
    size: tuple[int, int],
    rig: Path,
    tables: dict[str, Any],
) -> BoardSession:
    return BoardSession(
        BoardPhotos.open(folder), board, rig, folder, tables, silent, views=list(views), size=size
    )
