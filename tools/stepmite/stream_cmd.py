"""The command `stepmite stream`: options, progress bar and messages around stepmite.stream."""

from __future__ import annotations

import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn
from rich.table import Table

from stepmite import stream
from stepmite.arcs import Position
from stepmite.board import Board, BoardError, BoardGone, Cancelled
from stepmite.gcode import AXES, read_lines
from stepmite.machine import machine_from_status
from stepmite.plan import Machine, Planned, plan

EXIT_FAILED, EXIT_CANCELLED = 1, 130


def clock(seconds: float) -> str:
    """Return a duration as m:ss or h:mm:ss."""
    whole = round(seconds)
    hours, minutes = divmod(whole // 60, 60)
    return f"{hours}:{minutes:02}:{whole % 60:02}" if hours else f"{minutes}:{whole % 60:02}"


def time_left(total_s: float, done_s: float, elapsed_s: float) -> float:
    """Return the seconds left: the estimate, corrected by how long the way so far really took."""
    if done_s < 2.0:
        return total_s - done_s
    return (total_s - done_s) * elapsed_s / done_s


def run(
    file: Path,
    device: str,
    reserve: int = 0,
    setup: Path | None = None,
    arm: bool = True,
    console: Console | None = None,
) -> int:
    """Stream `file` to the board at `device`; print what happens; return the exit code."""
    console = console or Console()
    try:
        lines = read_lines(file)
        stream.prepare(file.name, lines)
        with Board.open(device, on_notice=lambda line: _show_notice(line, console)) as board:
            if setup is not None:
                run_setup(board, setup)
            machine = machine_from_status(board.command("STEPPER STATUS"))
            job = stream.prepare(file.name, lines, machine)
            return _stream(board, job, reserve, arm, console)
    except Cancelled:
        console.print("Stopped while the machine was set up", style="yellow")
        return EXIT_CANCELLED
    except (stream.JobError, BoardGone, OSError) as error:
        console.print(f"Error: {error}", style="red", markup=False, highlight=False)
        return EXIT_FAILED


def _show_notice(line: str, console: Console) -> None:
    """Print what the board says by itself; a pause also says how it goes on from here."""
    console.print(line, markup=False)
    if "STEPPER RESUME" in line and sys.stdin.isatty():
        console.print("Press Enter when the machine may go on.", style="yellow")


def run_setup(board: Board, file: Path) -> None:
    """Send the BASIC lines of a file one by one; JobError names the line that is refused.

    Ctrl-C brings what a line has begun, homing for instance, to a controlled stop (Cancelled).
    """
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), start=1):
        if line.strip():
            try:
                board.command(line.strip(), timeout_s=stream.CYCLE_S)
            except KeyboardInterrupt:
                board.stop()
                raise Cancelled from None
            except (BoardError, ValueError) as error:
                raise stream.JobError(f"{file.name}:{number}: {line.strip()}\n{error}") from None


def _stream(board: Board, job: stream.Job, reserve: int, arm: bool, console: Console) -> int:
    started = time.monotonic()
    try:
        with _bar(job, console) as on_progress:
            streamer = stream.Streamer(board, job, reserve, arm, on_progress)
            with _interrupts(streamer):
                _watch_enter(streamer)
                streamer.run()
    except Cancelled:
        _print_stop(board, console)
        return EXIT_CANCELLED
    except stream.JobError:
        _print_stop(board, console)
        raise
    took = clock(time.monotonic() - started)
    end = stream.position_text(board)
    console.print(f"{'Done' if arm else 'Queued'}: {len(job.lines)} lines in {took}, now at {end}")
    return 0


def _print_stop(board: Board, console: Console) -> None:
    place = stream.position_text(board)
    if place:  # a board that is not set up stands nowhere
        console.print(f"Stopped at {place}", style="yellow")


@contextmanager
def _bar(job: stream.Job, console: Console) -> Iterator:
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(None),
        TextColumn("{task.percentage:3.0f} %"),
        TextColumn("line {task.fields[line]}"),
        TextColumn("{task.fields[left]} left"),
    )
    with Progress(*columns, console=console) as bar:
        total = max(job.duration_s, 1e-9)
        left = clock(job.duration_s)
        task = bar.add_task(job.name, total=total, line=0, left=left)
        started = time.monotonic()

        def show(progress: stream.Progress) -> None:
            elapsed = time.monotonic() - started
            left = time_left(total, progress.seconds_done, elapsed)
            number = job.lines[progress.lines_sent - 1].number if progress.lines_sent else 0
            bar.update(task, completed=progress.seconds_done, line=number, left=clock(left))

        yield show


def _watch_enter(streamer: stream.Streamer) -> None:
    """Let Enter go on where the program waits for somebody at the machine (M0, M6)."""
    if not sys.stdin.isatty():
        return

    def watch() -> None:
        for _ in sys.stdin:
            streamer.resume()

    threading.Thread(target=watch, daemon=True).start()


@contextmanager
def _interrupts(streamer: stream.Streamer) -> Iterator[None]:
    """Turn the first Ctrl-C into a controlled stop; the second ends the program."""

    def first(number: int, frame: FrameType | None) -> None:
        signal.signal(signal.SIGINT, before)
        streamer.cancel()

    before = signal.signal(signal.SIGINT, first)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def dry_run(file: Path, machine: Machine, console: Console | None = None) -> int:
    """Check a file without a board: count, bounds, estimated time; return the exit code."""
    console = console or Console()
    try:
        job = stream.prepare(file.name, read_lines(file), machine)
    except (stream.JobError, OSError) as error:
        console.print(f"Error: {error}", style="red", markup=False, highlight=False)
        return EXIT_FAILED
    if job.unreadable is not None:
        console.print(
            f"Error: {file.name}:{job.unreadable.line_number}: {job.unreadable.line}\n"
            f"{job.unreadable.message}",
            style="red",
            markup=False,
            highlight=False,
        )
        return EXIT_FAILED
    console.print(_summary(job, machine))
    return 0


def _places(row: Planned) -> list[Position]:
    """Return where a move leads: its end and, on an arc, points along it."""
    arc = row.block.arc
    if arc is None:
        return [row.block.target]
    count = max(8, int(abs(arc.sweep) * 30))
    return [arc.position(row.start, row.block.target, n / count) for n in range(1, count + 1)]


def _summary(job: stream.Job, machine: Machine) -> Table:
    rows = plan(job.blocks, machine)
    moves = [row for row in rows if row.block.kind == "move"]
    cuts = sum(row.length for row in moves if row.block.feed_per_min is not None)
    rapids = sum(row.length for row in moves if row.block.feed_per_min is None)
    table = Table(title=job.name, show_header=False)
    table.add_row("lines to send", str(len(job.lines)))
    table.add_row("moves", str(len(moves)))
    table.add_row("at feed / rapid", f"{cuts:.1f} mm / {rapids:.1f} mm")
    for index, letter in enumerate(AXES):
        places = [0.0, *(place[index] for row in moves for place in _places(row))]
        if any(places):
            table.add_row(letter, f"{min(places):.3f} to {max(places):.3f}")
    table.add_row("estimated time", clock(job.duration_s))
    return table
