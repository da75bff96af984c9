"""murkscan calibrate board: a chessboard to print."""

from pathlib import Path

from ..errors import InputError
from .calibrate import parse_board
from .words import tell


def board(out: Path, *, board: str, square_mm: float) -> None:
    """Draw a chessboard of the right size, to print at 100 % and glue on something flat.

    Parameters
    ----------
    out
        The file to write: .pdf or .svg; nothing may stand there.
    board
        Inner corners of the board, such as 9x6: where black squares touch, not squares.
    square_mm
        Side of a square [mm].
    """
    kind = out.suffix.lower().removeprefix(".")
    if kind not in ("pdf", "svg"):
        raise InputError(f"A board is drawn as .pdf or .svg, not as {out.name}.")
    if out.exists():
        raise InputError(f"{out} is there already; give another name.")
    chessboard = parse_board(board, square_mm)
    from ..calibrate.board.printed import print_board
    from ..io.atomic import replacing

    with replacing(out) as aside:
        aside.write_bytes(print_board(chessboard, kind=kind))
    tell("made", str(out))
    tell("next", "print it at 100 %, glue it on something flat, and measure a row of squares: the "
         "printed size is what --square-mm wants")  # fmt: skip
