"""murkscan accept: hold a scan of calibrated artefacts against limits."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from .paths import ScanFolder
from .progress import working
from .typed import WORDS
from .words import print_table, say, say_verdict, tell

if TYPE_CHECKING:
    from ..accept import Finding, Protocol

_COLUMNS = ("tested", "on", "measured", "error", "±95%", "limit", "decision")


def accept(
    out: ScanFolder,
    *,
    test: Annotated[Path, Parameter(help="File of the artefacts and limits: acceptance.toml.")],
) -> None:
    """Test a scan of a ball bar, a plate or a step after VDI/VDE 2634 and ISO 10360-13.

    Each error gets its 95 % interval, and passes, fails or stays undecided by ISO 14253-1. Writes a
    page to sign. The exit status says that the test was done, not how it ended: that is in
    accept.json.

    Parameters
    ----------
    out
        Folder of the scan, or of a merged cloud, with a finished cloud stage.
    """
    from ..io.acceptance_toml import load_acceptance
    from ..project import Project
    from ..survey.accept import accept_scan

    project, asked = Project(out, WORDS.get()), load_acceptance(test)
    with working("holding the scan against its limits"):
        protocol = accept_scan(project, asked, source=test)
    _print(protocol)
    page = out / "accept" / "index.html"
    tell("made", str(page), str(page.with_name("accept.json")))
    tell("next", "open the page in a browser, print it and sign it")


def _print(protocol: "Protocol") -> None:
    from ..accept import Decision

    print_table("Acceptance (mm)", _COLUMNS, [_row(one) for one in protocol.findings])
    say_verdict(protocol.verdict, protocol.decision is Decision.PASSED)
    for sentence in protocol.open_questions:
        say(sentence)


def _row(one: "Finding") -> tuple[str, ...]:
    return (
        one.what,
        one.artefact,
        f"{1e3 * one.measured.value:.3f}",
        f"{1e3 * one.error:.3f}",
        f"{1e3 * one.half_width:.3f}",
        "–" if one.limit is None else f"{1e3 * one.limit:g}",
        one.decision.value,
    )
