"""murkscan studio: all of it in the browser."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from ..errors import MissingDependency
from .words import tell


def studio(
    folder: Path = Path(),
    *,
    host: str = "127.0.0.1",
    port: int = 0,
    no_browser: Annotated[bool, Parameter(negative=())] = False,
) -> None:
    """Calibrate, record, scan, look, measure and plan in the browser, from one folder.

    Each thing done there is one command, which the page shows. Ctrl-C ends it. Extra `[studio]`.

    Parameters
    ----------
    folder
        The folder with rigs, recordings and scans; nothing outside of it is shown or written.
    host
        Address at which to listen; only this machine can open the page unless another is given.
    port
        Port; that of last time, or a free one, unless given.
    no_browser
        Print the address only.
    """
    try:
        from ..studio import serve
    except ModuleNotFoundError as error:
        raise MissingDependency.of("The studio", error.name or "more", "studio") from error

    def show(address: str) -> None:
        if not address.startswith("http"):
            tell("note", address)
            return
        tell("open", address)
        tell("note", "whoever has this address can use the studio; Ctrl-C ends it")
        if not no_browser:
            import webbrowser

            webbrowser.open(address)

    serve(folder, host=host, port=port, tell=show)
