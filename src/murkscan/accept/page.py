"""The page of an acceptance test: one sheet of paper to sign."""

from collections.abc import Sequence

from ..page import Block, Note, Section, Signatures, Table, render_page
from .finding import Decision, Finding
from .protocol import Protocol

_HEAD = ("tested", "calibrated", "measured", "error ± 95 %", "limit", "decision")
_ABOUT = (
    "After VDI/VDE 2634 and ISO 10360-13, not conforming to them: they are written for scanners "
    "that stand still and look once. Probing form and flatness: width of the shell that holds all "
    "points but three in a thousand, about the sphere or plane of least squares. Probing size: a "
    "ball's diameter. Sphere spacing: from centre to centre. Length: distance of two parallel "
    "faces. As in ISO 14253-1, an error has passed where all of its interval lies within the limit "
    "and failed where all lies beyond. The interval holds the noise of the points and the "
    "artefact's calibration; what rig and motion are off by is in the error itself. It holds for "
    "this rig, water, speed and distance."
)


def as_page(protocol: Protocol) -> str:
    """Write the page."""
    is_good = protocol.decision is Decision.PASSED
    blocks: list[Block] = [Note(protocol.verdict, "good" if is_good else "warning")]
    blocks += [Note(text) for text in protocol.open_questions]
    rows = [*protocol.scanned, ("seen", protocol.seen or None)]
    sections = [
        Section("", blocks),
        Section("Results in millimetres", [Table(_rows(protocol.findings), _HEAD)]),
        Section("How it was scanned", [Table(rows)]),
        Section("By which rules", [Note(_ABOUT)]),
        Section("", [Signatures(("tested by", "for the client", "place and date"))]),
    ]
    artefact = ", ".join(filter(None, (protocol.test.name, protocol.test.certificate)))
    return render_page("Acceptance test", sections, subtitle=f"{protocol.name} · {artefact}")


def _rows(findings: Sequence[Finding]) -> list[tuple[str, ...]]:
    return [
        (
            f"{one.what}, {one.artefact}",
            f"{1e3 * one.calibrated:.3f}" if one.calibrated else "–",
            f"{1e3 * one.measured.value:.3f}",
            f"{1e3 * one.error:{'+' if one.calibrated else ''}.3f} ± {1e3 * one.half_width:.3f}",
            "–" if one.limit is None else f"{1e3 * one.limit:g}",
            one.decision.value,
        )
        for one in findings
    ]
