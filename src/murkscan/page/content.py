"""What a page can show: sections, and the blocks in them."""

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import ClassVar, Literal, final

Cell = str | int | float | Decimal | None
"""A table's cell; a number is aligned to the right, a Decimal with the digits that it has; None is
shown as a dash."""


@final
@dataclass(frozen=True)
class Note:
    """A sentence or two in plain words."""

    kind: ClassVar[str] = "note"
    text: str
    tone: Literal["plain", "good", "warning"] = "plain"


@final
@dataclass(frozen=True)
class Facts:
    """A few large numbers with their names, such as ("45 808", "points")."""

    kind: ClassVar[str] = "facts"
    items: Sequence[tuple[str, str]]
    """Value with its unit, and what it is."""


@final
@dataclass(frozen=True)
class Table:
    """Rows of cells."""

    kind: ClassVar[str] = "table"
    rows: Sequence[Sequence[Cell]]
    head: Sequence[str] = ()
    """Titles of the columns; without them the first cell of each row is its title."""


@final
@dataclass(frozen=True)
class Figure:
    """A drawing, as `as_svg` gives it."""

    kind: ClassVar[str] = "figure"
    svg: str
    caption: str
    is_wide: bool = False
    """Whether it takes the page's whole width."""


@final
@dataclass(frozen=True)
class Picture:
    """A picture in a file beside the page."""

    path: str
    """Relative to the page, with forward slashes."""
    caption: str
    link: str = ""
    """What a click opens, relative to the page; the picture itself unless given."""


@final
@dataclass(frozen=True)
class Gallery:
    """Pictures side by side; the first may stand larger before the others."""

    kind: ClassVar[str] = "gallery"
    pictures: Sequence[Picture]
    is_first_large: bool = False
    is_in_pairs: bool = False
    """Whether two stand beside one another to be compared, as large as the page allows."""


@final
@dataclass(frozen=True)
class EmbeddedPage:
    """Another page, such as that of a model to turn, shown within this one."""

    kind: ClassVar[str] = "embedded"
    path: str
    """Of the page, relative to this one, with forward slashes."""
    caption: str


@final
@dataclass(frozen=True)
class Code:
    """Lines to be typed as they are."""

    kind: ClassVar[str] = "code"
    lines: Sequence[str]


@final
@dataclass(frozen=True)
class Signatures:
    """Lines to be signed on paper, side by side."""

    kind: ClassVar[str] = "signatures"
    lines: Sequence[str]
    """What stands below each line."""


Block = Note | Facts | Table | Figure | Gallery | EmbeddedPage | Code | Signatures


@final
@dataclass(frozen=True)
class Section:
    """Blocks under one heading."""

    title: str
    """Empty for blocks that belong to the page's own title."""
    blocks: Sequence[Block]
