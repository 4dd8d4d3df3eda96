"""The command `stepmite sgtune`: a jog with a TMC2209, what StallGuard reads, and a picture."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console
from rich.live import Live
from rich.table import Table

from stepmite import sgtune
from stepmite.board import Board, BoardError, BoardGone

EXIT_FAILED, EXIT_CANCELLED = 1, 130
BAR_WIDTH = 30
SG_MAX = 510
JOG_S = 3600.0
"""Longest silence that is waited for: rows come every 50 ms, but a jog may be held."""


def line_to_type(driver: str, feed: float, distance: float | None, tx_pin: str | None) -> str:
    """Return the BASIC line for the options."""
    arguments = [driver, f"{feed:g}", "" if distance is None else f"{distance:g}", tx_pin or ""]
    return f"TMC22xx SGTUNE {','.join(arguments).rstrip(',')}"


class Rows:
    """The table that grows while the axis moves."""

    def __init__(self) -> None:
        self.table = Table(box=None, header_style="bold")
        for name in ("ms", "speed/min", "SG_RESULT", "lowest", "CS"):
            self.table.add_column(name, justify="right")
        self.table.add_column("", width=BAR_WIDTH)

    def add(self, line: str) -> None:
        """Take a line of the answer; those that are no rows do not count."""
        row = sgtune.row_of(line)
        if row is not None:
            bar = "█" * round(min(row.mean, SG_MAX) / SG_MAX * BAR_WIDTH)
            values = (row.ms, row.speed, row.mean, row.lowest, row.current_scale)
            self.table.add_row(*(f"{value:.0f}" for value in values), bar)


def _ask(board: Board, line: str, console: Console) -> list[str]:
    """Type the line; show rows as they come. Returns the whole answer."""
    rows = Rows()
    try:
        with Live(rows.table, console=console, vertical_overflow="visible"):
            return board.command(line, timeout_s=JOG_S, on_line=rows.add)
    finally:
        if not console.is_terminal:
            console.print()  # where it is no terminal the table ends without


def run(device: str, line: str, picture: Path | None = None, console: Console | None = None) -> int:
    """Tune at the board behind `device`; print what comes of it; return the exit code."""
    console = console or Console()
    error, answer = "", []
    try:
        with Board.open(device) as board:
            try:
                answer = _ask(board, line, console)
            except BoardError as refused:
                error, answer = str(refused), refused.output
            except KeyboardInterrupt:
                board.stop()
                console.print("Stopped", style="yellow")
                return EXIT_CANCELLED
    except (BoardGone, OSError) as gone:
        console.print(f"Error: {gone}", style="red", markup=False, highlight=False)
        return EXIT_FAILED
    return _conclude(sgtune.parse(answer), line, error, picture, console)


def _conclude(
    tuning: sgtune.Tuning, line: str, error: str, picture: Path | None, console: Console
) -> int:
    for text in tuning.says:
        proposed = text in tuning.commands
        style = "bold green" if proposed else ""
        console.print(text, style=style, markup=False, highlight=False, soft_wrap=True)
    if picture is not None and tuning.rows:
        sgtune.draw(tuning, line, picture)
        console.print(f"Picture: {picture}", markup=False, highlight=False)
    if error:
        console.print(f"Error: {error}", style="red", markup=False, highlight=False)
        return EXIT_FAILED
    return 0
