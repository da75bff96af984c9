"""The one way HTML pages and figures are made."""

from .content import Block as Block
from .content import Cell as Cell
from .content import Code as Code
from .content import EmbeddedPage as EmbeddedPage
from .content import Facts as Facts
from .content import Figure as Figure
from .content import Gallery as Gallery
from .content import Note as Note
from .content import Picture as Picture
from .content import Section as Section
from .content import Signatures as Signatures
from .content import Table as Table
from .figures import ACCENT as ACCENT
from .figures import FAINT as FAINT
from .figures import INK as INK
from .figures import SECOND as SECOND
from .figures import as_svg as as_svg
from .figures import new_figure as new_figure
from .render import format_cell as format_cell
from .render import render_page as render_page
