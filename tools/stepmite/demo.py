"""`make demo`: the real firmware cuts a real part in the emulator, and a picture shows it.

Boots the UF2 in the emulated RP2040, sets the machine up over its USB serial port, streams
examples/nameplate.nc with the same code as `stepmite stream`, rebuilds the path from the step edges
of the pins and draws it over the commanded one: build/demo/demo.png.
"""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from stepmite import oracle, stream_cmd
from stepmite.board import Board, BoardError, BoardGone
from stepmite.demo_plot import draw
from stepmite.gcode import read_blocks, read_lines, target_steps
from stepmite.trace import AxisPins, AxisTrace, Edges, Floats, Ints, TraceError, axis_trace

ROOT = Path(__file__).resolve().parents[2]
UF2 = ROOT / "build" / "pico" / "stepmite-pico.uf2"
PART = ROOT / "examples" / "nameplate.nc"
FOLDER = ROOT / "build" / "demo"

PINS = [
    AxisPins("X", 2, 3, steps_per_unit=80.0),
    AxisPins("Y", 4, 5, steps_per_unit=80.0),
    AxisPins("Z", 6, 7, steps_per_unit=400.0),
]
MAX_VELOCITY = {"X": 6000, "Y": 6000, "Z": 3000}
MAX_ACCELERATION = 500
SETUP = [
    "STEPPER INIT ,128",
    *(
        f"STEPPER AXIS {pin.name},GP{pin.step_gpio},GP{pin.dir_gpio},,,"
        f"{pin.steps_per_unit:g},{MAX_VELOCITY[pin.name]},{MAX_ACCELERATION}"
        for pin in PINS
    ),
    "STEPPER SPINDLE GP22",
    "STEPPER POSITION HOME",
    "STEPPER RUN",
]
BOOT_TIMEOUT_S = 60.0


@dataclass(frozen=True)
class Outcome:
    """What the demo found out."""

    traces: list[AxisTrace]
    commanded: Floats
    """Corners in mm, shape (corners, 3)."""
    corners: Ints
    """The same in steps."""
    motion_s: float
    """Virtual time from the first to the last step."""
    deviation_steps: float | None
    """Largest distance from the commanded path; None if the path was not followed at all."""
    problem: str


@contextmanager
def emulated_board(uf2: Path, link: Path, trace: Path) -> Iterator[None]:
    """Keep an emulated board running, its serial port at `link`; ends with a complete trace."""
    link.unlink(missing_ok=True)
    command = [sys.executable, "-m", "stepmite.cli", "emulate", str(uf2)]
    command += ["--pty", str(link), "--trace", str(trace), "--speed", "0"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, start_new_session=True)
    try:
        deadline = time.monotonic() + BOOT_TIMEOUT_S
        while not link.exists():
            if process.poll() is not None:
                raise BoardGone(f"the emulator ended at once (exit code {process.returncode})")
            if time.monotonic() > deadline:
                raise BoardGone("the emulator does not start")
            time.sleep(0.1)
        yield
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
        code = process.wait(timeout=60)
    if code != 0:
        raise BoardGone(f"the emulator found faults (exit code {code})")


def set_up(link: Path) -> None:
    """Configure the machine by the commands a user would type."""
    with Board.open(str(link), wake_timeout_s=BOOT_TIMEOUT_S) as board:
        for line in SETUP:
            board.command(line)


def judge(trace: Path, part: Path) -> Outcome:
    """Compare the recorded edges with the program."""
    edges = Edges.read(trace)
    traces = [axis_trace(edges, pin) for pin in PINS]
    if not all(len(one.step_ns) for one in traces):
        raise TraceError(f"{trace}: an axis did not move")
    scale = (*(pin.steps_per_unit for pin in PINS), 1.0)
    commanded, corners = [(0.0, 0.0, 0.0)], [(0, 0, 0)]
    for block in read_blocks(read_lines(part)):
        steps = target_steps(block.target, scale)[:3]
        if block.kind == "move" and steps != corners[-1]:
            commanded.append(block.target[:3])
            corners.append(steps)
    table = np.array(corners)
    deviation, problem = None, ""
    try:
        blocks = oracle.split_blocks(traces, table)
        deviation = float(oracle.block_deviation(traces, blocks).max())
    except TraceError as error:
        problem = str(error)
    first = min(one.step_ns[0] for one in traces)
    last = max(one.step_ns[-1] for one in traces)
    seconds = float(last - first) / 1e9
    return Outcome(traces, np.array(commanded), table, seconds, deviation, problem)


def report(outcome: Outcome, picture: Path, wall_s: float, console: Console) -> bool:
    """Print the summary; tell whether all is well."""
    ends = [trace.end_steps() for trace in outcome.traces]
    exact = ends == outcome.corners[-1].tolist()
    table = Table(title="StepMite demo", show_header=False)
    table.add_row("part", f"{PART.name}, {len(read_lines(PART))} lines")
    table.add_row("steps", " ".join(f"{t.name} {len(t.step_ns)}" for t in outcome.traces))
    table.add_row("motion", f"{outcome.motion_s:.2f} s of virtual time, {wall_s:.0f} s to emulate")
    deviation = outcome.deviation_steps
    followed = f"{deviation:.2f} steps at most" if deviation is not None else outcome.problem
    table.add_row("off the path", followed)
    table.add_row("end position", "exact" if exact else f"wrong: {ends}")
    table.add_row("picture", str(picture.relative_to(ROOT)))
    console.print(table)
    return exact and deviation is not None and deviation <= 1.0


def main() -> int:
    """Run the demo; return the exit code."""
    console = Console()
    FOLDER.mkdir(parents=True, exist_ok=True)
    trace, link = FOLDER / "edges.csv", FOLDER / "port"
    started = time.monotonic()
    try:
        with emulated_board(UF2, link, trace):
            set_up(link)
            code = stream_cmd.run(PART, str(link), console=console)
        if code != 0:
            return code
        outcome = judge(trace, PART)
    except (BoardGone, BoardError, TraceError) as error:
        console.print(f"Error: {error}", style="red", markup=False, highlight=False)
        return 1
    picture = FOLDER / "demo.png"
    draw(outcome.traces, outcome.commanded, picture)
    return 0 if report(outcome, picture, time.monotonic() - started, console) else 1


if __name__ == "__main__":
    sys.exit(main())
