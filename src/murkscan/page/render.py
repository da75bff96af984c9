"""Turn content into one self-contained HTML page."""

from collections.abc import Sequence
from decimal import Decimal
from functools import lru_cache
from urllib.parse import quote

from jinja2 import Environment, PackageLoader, StrictUndefined, Template

from .content import Cell, Section


def render_page(title: str, sections: Sequence[Section], *, subtitle: str = "") -> str:
    """Make an HTML page that needs no network, follows the reader's theme and prints on A4.

    Args:
        title: The page's name.
        sections: What it shows, in order.
        subtitle: What the page is about, such as the recording's name.

    Returns:
        The whole document. All text is escaped, except the SVG of figures.
    """
    return _template().render(title=title, subtitle=subtitle, sections=sections)


@lru_cache(maxsize=1)
def _template() -> Template:
    environment = Environment(
        loader=PackageLoader("murkscan.page"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["cell"] = format_cell
    environment.filters["address"] = _as_address
    environment.tests["numeric"] = lambda cell: isinstance(cell, int | float | Decimal)
    return environment.get_template("page.html")


def format_cell(cell: Cell) -> str:
    """Write a table's cell: numbers with thin spaces between thousands, nothing as a dash."""
    if cell is None:
        return "–"
    if isinstance(cell, int | Decimal):
        return f"{cell:,}".replace(",", "\u202f")
    return f"{cell:,.4g}".replace(",", "\u202f") if isinstance(cell, float) else cell


def _as_address(path: str) -> str:
    """Write a relative path so that a browser takes all of it for a path, even `a:b?c#d.png`."""
    address = quote(path)
    return address if address.startswith((".", "/")) else f"./{address}"
