"""Workers of a Dask cluster, on this machine or on many. Extra `[cluster]`."""

from collections import deque
from collections.abc import Callable, Generator, Iterable
from contextlib import ExitStack
from dataclasses import dataclass
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar, final

from ..errors import DeviceError, InputError, MissingDependency
from .base import AbstractExecutor, check_workers

if TYPE_CHECKING:
    from types import ModuleType

T = TypeVar("T")
R = TypeVar("R")
_PATIENCE = 30
"""Seconds in which a scheduler answers."""
_RETRIES = 3
"""How often a task is begun anew after its worker died."""


@final
@dataclass(frozen=True)
class Dask(AbstractExecutor):
    """Work on a Dask cluster, whose machines see the recording under the same path."""

    address: str | None = None
    """Where its scheduler listens, as tcp://host:8786; without one a cluster is begun here."""
    workers: int | None = None
    """How many processes a cluster that is begun here has; as many as there are cores unless
    said."""

    shares_memory: ClassVar[bool] = False

    def __post_init__(self) -> None:
        """Refuse settings that mean nothing together, and to begin without the library."""
        if find_spec("distributed") is None:
            raise MissingDependency.of("Dask", "distributed", "cluster")
        check_workers(self.workers)
        if self.address is not None and self.workers is not None:
            raise InputError(
                f"The cluster at {self.address} has its own workers; leave out their number."
            )

    def map(self, task: Callable[[T], R], items: Iterable[T]) -> Generator[R, None, None]:
        """Run a task for each item; see `AbstractExecutor.map`."""
        distributed = import_distributed()
        with ExitStack() as stack:
            client = self._connect(distributed, stack)
            width = 2 * max(len(client.scheduler_info(n_workers=-1)["workers"]), 1)
            waiting: deque[Any] = deque()
            for item in items:
                waiting.append(client.submit(task, item, pure=False, retries=_RETRIES))
                if len(waiting) >= width:
                    yield _result(distributed, waiting.popleft())
            while waiting:
                yield _result(distributed, waiting.popleft())

    def _connect(self, distributed: Any, stack: ExitStack) -> Any:
        if self.address is None:
            cluster = distributed.LocalCluster(
                n_workers=self.workers,
                threads_per_worker=1,
                dashboard_address=None,
                silence_logs=50,
            )
            stack.enter_context(cluster)
            return stack.enter_context(distributed.Client(cluster))
        try:
            return stack.enter_context(distributed.Client(self.address, timeout=_PATIENCE))
        except (OSError, ValueError, TimeoutError) as error:
            raise DeviceError(
                f"No Dask scheduler answers at {self.address}; start one with `dask scheduler`, "
                "and workers with `dask worker ADDRESS` on each machine."
            ) from error


def _result(distributed: Any, future: Any) -> Any:
    try:
        return future.result()
    except distributed.scheduler.KilledWorker as error:
        raise DeviceError(
            "Workers of the cluster died again and again at one task; what is finished is kept. "
            "Look whether they have memory enough."
        ) from error


def import_distributed() -> "ModuleType":
    """Import Dask's scheduler, late: it is an extra.

    Raises:
        MissingDependency: It is not installed.
    """
    try:
        import distributed
        import distributed.scheduler
    except ImportError as error:
        raise MissingDependency.of("Dask", "distributed", "cluster") from error
    return distributed
