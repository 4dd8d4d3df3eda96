"""The step train of the emulated UF2 and of the host program: the same pins, order and ticks."""

import subprocess
import sys
from pathlib import Path

import pytest

from stepmite.emulator import PROJECT, Emulator
from stepmite.ticks import (
    TickEdge,
    estimate_tick_run,
    first_difference,
    latencies_ns,
    snap_to_ticks,
    tick_train,
)
from stepmite.trace import Edges

sys.path.insert(0, str(Path(__file__).parents[1] / "host"))
from busy_program import BEGINS as BUSY_BEGINS
from busy_program import BUSY, DONE

HOST = PROJECT / "build" / "host" / "stepmite"
STEP, DIR, SPINDLE = (2, 4, 6, 8), (3, 5, 7, 9), 15
PINS = (*STEP, *DIR, SPINDLE)
BEGIN = (*STEP, SPINDLE)
TICK_NS = 10_000

SETUP = [
    "STEPPER INIT ,1024",
    "STEPPER AXIS X,GP2,GP3,,,80,6000,500",
    "STEPPER AXIS Y,GP4,GP5,,1,80,6000,500",
    "STEPPER AXIS Z,GP6,GP7,,,400,3000,500",
    "STEPPER AXIS A,GP8,GP9,,,17.5,9000,700",
    "STEPPER SPINDLE GP15",
    "STEPPER POSITION HOME",
]
WAIT = "DO WHILE PEEK(STEPPER ACTIVE)=1: PAUSE 10: LOOP"
END = "STEPPER STATUS"

# Lines, corners, tiny moves, a reversal, four axes at once, a dwell, fast and slow; arcs in two
# planes, round corners.
FIGURE = """\
G90
G0 X10 Y5 Z1
M3
G4 P20
G1 X20 Y8 A90 F3000
X20.1 Y8.1
X20.2 Y8.05
X20.25 Y7.9
X20.2 Y7.7
Y0 A45
X5 Y0 Z-0.5 A0 F450
G91
X-2 Y2
X2 Y-2
X-2.01 Y2.02 Z0.013
G90
X3 Y2 Z0
G2 X8 Y2.001 I2.5 F2500
G3 X8 Y2.001 I-1 Z0.4 A20 P2
G18 G2 X9 Z0.2 R0.75
G17 G64 P0.2 G1 X12 F4000
X12.5 Y7 Z0.1
X10 Y7.3
X4 Y2 A0
G64 G0 X0 Y0 Z0
M5
""".splitlines()


def host_edges(lines: list[str], folder: Path) -> Edges:
    trace = folder / "host.csv"
    subprocess.run(
        [HOST, "--virtual", "--trace", trace],
        input="".join(line + "\r" for line in lines),
        text=True,
        check=True,
        capture_output=True,
        timeout=60,
    )
    return Edges.read(trace)


def board_edges(board: Emulator, lines: list[str]) -> tuple[Edges, Edges]:
    """The edges as they were, and rounded down to their ticks."""
    for line in lines:
        answer = board.command(line, timeout_ms=200_000)
        assert "rror" not in answer, answer
    edges = Edges.from_rows(board.edges())
    return edges, snap_to_ticks(edges, board.tick_runs())


def queue(blocks: list[str]) -> list[str]:
    """Everything queued before the first step, so that the plan does not depend on the pace."""
    code = [f'STEPPER GS "{block}"' for block in blocks if block.strip()]
    return [*SETUP, *code, "STEPPER RUN", WAIT, END]


def train(edges: Edges) -> list[TickEdge]:
    return tick_train(edges, PINS, BEGIN)


def assert_same(host: Edges, board: Edges) -> None:
    difference = first_difference(train(host), train(board))
    assert difference is None, difference


def test_figure_with_four_axes(board: Emulator, tmp_path: Path) -> None:
    lines = queue(FIGURE)
    host = host_edges(lines, tmp_path)
    raw, snapped = board_edges(board, lines)
    assert len(train(host)) > 5000
    assert_same(host, snapped)
    late = latencies_ns(raw, board.tick_runs())
    assert late.max() < TICK_NS / 2, "the rounding must not be a matter of luck"


def test_figure_with_another_spindle_speed_in_each_line(board: Emulator, tmp_path: Path) -> None:
    """Speeds that change in motion, spin-up, coolant: levels are of no matter for the steps."""
    speeds = [f"{line} S{n * 137 % 10_000}" if n > 3 else line for n, line in enumerate(FIGURE)]
    lines = [
        line.replace("SPINDLE GP15", "SPINDLE GP20,,8000,500,,30,GP15")
        for line in queue(["M8", *speeds[:-1], "M4", "X1 S3000", "M9", "M5"])
    ]
    lines.insert(SETUP.index("STEPPER POSITION HOME"), "STEPPER COOLANT GP21")
    host = host_edges(lines, tmp_path)
    _, snapped = board_edges(board, lines)
    assert len(train(host)) > 5000
    assert_same(host, snapped)


def test_figure_while_a_program_is_busy(board: Emulator, tmp_path: Path) -> None:
    """Events, errors, texts, pins and refused writes of the flash: the same edges as at rest."""
    lines = queue(FIGURE)
    host = host_edges(lines, tmp_path)
    program = BUSY.replace(BUSY_BEGINS, "\n".join([*lines[: lines.index(WAIT)], BUSY_BEGINS]))
    board.send("AUTOSAVE\r" + program.replace("\n", "\r") + "\x1a")
    board.until("\n> ", 5000)
    assert DONE in board.command("RUN", timeout_ms=200_000)
    snapped = snap_to_ticks(Edges.from_rows(board.edges()), board.tick_runs())
    assert_same(host, snapped)


def test_grid_can_be_found_from_the_edges_alone(board: Emulator, tmp_path: Path) -> None:
    """For a trace of which nobody noted the ticks."""
    lines = queue(FIGURE)
    raw, _ = board_edges(board, lines)
    (run,) = board.tick_runs()
    moving = raw.time_ns >= run.first_ns
    alone = Edges(raw.time_ns[moving], raw.gpio[moving], raw.level[moving])
    assert_same(host_edges(lines, tmp_path), snap_to_ticks(alone, [estimate_tick_run(alone)]))


def test_name_plate(board: Emulator, tmp_path: Path) -> None:
    """The part of the demo: a minute of motion, half a million edges."""
    blocks = (PROJECT / "examples" / "nameplate.nc").read_text().splitlines()
    lines = queue(blocks)
    host = host_edges(lines, tmp_path)
    _, snapped = board_edges(board, lines)
    assert len(train(host)) > 400_000
    assert_same(host, snapped)


@pytest.mark.parametrize("fault", ["late tick", "lost edge", "other pin"])
def test_comparison_sees_a_planted_difference(tmp_path: Path, fault: str) -> None:
    host = host_edges(queue(FIGURE[:6]), tmp_path)
    times, gpios, levels = host.time_ns.copy(), host.gpio.copy(), host.level.copy()
    middle = len(times) // 2
    if fault == "late tick":
        times[middle:] += TICK_NS
    elif fault == "other pin":
        gpios[middle] = SPINDLE
    other = Edges(times, gpios, levels)
    if fault == "lost edge":
        keep = [i for i in range(len(times)) if i != middle]
        other = Edges(times[keep], gpios[keep], levels[keep])
    assert first_difference(train(host), train(other)) is not None
