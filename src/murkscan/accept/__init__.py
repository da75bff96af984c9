"""Hold a scan of calibrated artefacts against limits: passed, failed or undecided."""

from .finding import Decision as Decision
from .finding import Finding as Finding
from .page import as_page as as_page
from .plain import as_plain as as_plain
from .protocol import Protocol as Protocol
