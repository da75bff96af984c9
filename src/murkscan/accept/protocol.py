"""All that the page of an acceptance test says."""

from collections.abc import Sequence
from dataclasses import dataclass

from ..types.acceptance import AcceptanceTest
from .finding import Decision, Finding
from .words import decide_all, tell_verdict, tell_what_decides


@dataclass(frozen=True)
class Protocol:
    """An acceptance test that was done."""

    name: str
    """The scan."""
    test: AcceptanceTest
    findings: Sequence[Finding]
    scanned: Sequence[tuple[str, str]]
    """How it was scanned, in words: what, and how; rig, water, speed and date among them."""
    seen: str
    """How much the scan has of each ball, in words; empty without balls."""
    unstated: Sequence[str] = ()
    """Whose errors the intervals that the scan itself states lack; sentences."""

    @property
    def decision(self) -> Decision:
        """What the whole comes to."""
        return decide_all(self.findings)

    @property
    def verdict(self) -> str:
        """The same in a sentence."""
        return tell_verdict(self.findings)

    @property
    def open_questions(self) -> list[str]:
        """What would decide what is undecided, a sentence each."""
        left = [one for one in self.findings if one.decision is Decision.UNDECIDED]
        return [tell_what_decides(one) for one in left]
