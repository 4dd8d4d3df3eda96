"""The commands `put` and `get`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, DownloadColumn, Progress, TextColumn

from stepmite import transfer
from stepmite.board import Board, BoardError, BoardGone

EXIT_FAILED = 1


def put(file: Path, name: str, device: str) -> int:
    """Send a file; return the exit code."""
    return _run(device, name, lambda board, show: _put(board, file, name, show))


def get(name: str, file: Path, device: str) -> int:
    """Fetch a file; return the exit code."""
    return _run(device, name, lambda board, show: _get(board, name, file, show))


Show = Callable[[int, int | None], None]
"""Called with the bytes so far, and how many there are in all if that is known."""


def _put(board: Board, file: Path, name: str, show: Show) -> int:
    data = file.read_bytes()
    transfer.put(board, data, name, lambda done: show(done, len(data)))
    return len(data)


def _get(board: Board, name: str, file: Path, show: Show) -> int:
    data = transfer.get(board, name, lambda done: show(done, None))
    file.write_bytes(data)
    return len(data)


def _run(device: str, name: str, work: Callable[[Board, Show], int]) -> int:
    console = Console()
    columns = (TextColumn("{task.description}"), BarColumn(), DownloadColumn())
    try:
        with (
            Progress(*columns, console=console, transient=True) as bar,
            Board.open(device) as board,
        ):
            task = bar.add_task(name, total=None)
            size = work(board, lambda done, all_: bar.update(task, completed=done, total=all_))
    except (BoardError, BoardGone, transfer.TransferError, ValueError, OSError) as error:
        console.print(f"Error: {error}", style="red", markup=False, highlight=False)
        return EXIT_FAILED
    console.print(f"{name}: {size} bytes", markup=False, highlight=False)
    return 0
