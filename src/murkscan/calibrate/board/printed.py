"""A chessboard to print, whose squares are as wide as they say."""

import io

from ...errors import InputError
from .chessboard import Chessboard

_INCH = 25.4e-3
"""An inch [m]."""
_LARGEST = 2.0
"""Longest side of a sheet [m]: wider than any plotter's."""
_LINE = 5e-3
"""Height of the line of writing below the board [m]."""


def print_board(board: Chessboard, *, kind: str = "pdf") -> bytes:
    """Draw a board on a sheet with a margin of one square, which finding its corners needs.

    Args:
        board: The board.
        kind: pdf or svg.

    Returns:
        The file; printed at 100 % its squares have the board's size.

    Raises:
        InputError: The sheet would be larger than 2 m.
    """
    from matplotlib.backends.backend_pdf import FigureCanvasPdf
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure

    width, height = (board.columns + 3) * board.square, (board.rows + 3) * board.square
    if max(width, height) > _LARGEST:
        raise InputError(
            f"A board of {board} would need a sheet of {width:.2f} × {height:.2f} m; make its "
            "squares smaller, or fewer."
        )
    figure = Figure(figsize=(width / _INCH, (height + _LINE) / _INCH))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, width), ylim=(-_LINE, height))
    axes.set_axis_off()
    for row in range(board.rows + 1):
        black = [
            ((column + 1) * board.square, board.square)
            for column in range(board.columns + 1)
            if (row + column) % 2 == 0
        ]
        axes.broken_barh(
            black, (height - (row + 2) * board.square, board.square), facecolor="black", linewidth=0
        )
    said = f"{board} corners, squares of {board.square * 1e3:g} mm; print at 100 %"
    axes.text(board.square, 0, said, fontsize=8, verticalalignment="center")
    drawn = io.BytesIO()
    canvas = FigureCanvasPdf(figure) if kind == "pdf" else FigureCanvasSVG(figure)
    nothing = {"CreationDate": None} if kind == "pdf" else {"Date": None}
    canvas.print_figure(drawn, format=kind, metadata=nothing)
    return drawn.getvalue()
