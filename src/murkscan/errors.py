"""The errors that murkscan raises on purpose.

MurkscanError
├── InputError         (also ValueError)         an argument or a setting is wrong
├── FormatError        (also ValueError)         a file is not what it says
├── EstimationError    (also RuntimeError)       sound input, but it has no answer
│   ├── NotEnoughData
│   ├── Degenerate
│   └── NotConverged
├── MissingResult      (also FileNotFoundError)  an earlier stage has not been run
├── MissingDependency  (also ImportError)        an extra is not installed
├── DeviceError        (also OSError)            a camera, a disk or a worker failed
│   └── StreamLost                               pictures stopped coming; they may come again
└── Cancelled                                    somebody stopped it

Every message is a sentence that says what is wrong, with the numbers and the file, and what to do.
"""


class MurkscanError(Exception):
    """Base of every error that murkscan raises on purpose."""


class InputError(MurkscanError, ValueError):
    """An argument or a setting is wrong."""


class FormatError(MurkscanError, ValueError):
    """A file is not what it says it is."""


class EstimationError(MurkscanError, RuntimeError):
    """The input is sound, but the estimate does not exist."""


class NotEnoughData(EstimationError):
    """Too little was seen to determine the answer."""


class Degenerate(EstimationError):
    """The geometry leaves the answer open, such as boards that all face the camera."""


class NotConverged(EstimationError):
    """An iteration found no answer."""


class MissingResult(MurkscanError, FileNotFoundError):
    """A stage needs what an earlier stage has not yet made."""


class MissingDependency(MurkscanError, ImportError):
    """An optional extra is not installed."""

    @classmethod
    def of(cls, what: str, package: str, extra: str) -> "MissingDependency":
        """Say what needs a package, and the line that installs it."""
        return cls(
            f'{what} needs {package}: pip install "murkscan[{extra}]", or ".[{extra}]" in a clone.'
        )


class DeviceError(MurkscanError, OSError):
    """A camera, a disk or a worker failed."""


class StreamLost(DeviceError):
    """A stream or a camera is silent or broke off; it may come back."""


class Cancelled(MurkscanError):
    """A job was stopped from outside; what is finished is kept."""
