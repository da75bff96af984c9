"""Who does the work: an executor is an argument.

Every executor is a frozen dataclass: its fields are its settings, `map` is its one verb.
"""

from .base import AbstractExecutor as AbstractExecutor
from .dask import Dask as Dask
from .processes import Processes as Processes
from .processes import give_way as give_way
from .serial import Serial as Serial
from .threads import Threads as Threads
