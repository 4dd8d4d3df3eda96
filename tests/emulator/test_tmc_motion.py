"""Talking to drivers disturbs no step: the edges of a part that is cut with and without it.

The part comes from a file, which main reads between the statements of a program that asks and
writes drivers all the time, or while the monitor does.
"""

import json
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from test_identity import BEGIN, FIGURE, HOST, PINS, SETUP

from stepmite.emulator import PROJECT, Emulator
from stepmite.ticks import TickEdge, first_difference, latencies_ns, snap_to_ticks, tick_train
from stepmite.trace import Edges

TX = 16
PLATE = (PROJECT / "examples" / "nameplate.nc").read_text().splitlines()
DRIVERS = [f"TMC22xx {TX},2209,0,800,30,16", f"TMC22xx {TX},2209,1,700,50,16"]
QUIET = "PAUSE 1"
TRAFFIC = """\
TMC22xx WRITE n MOD 2, "SGTHRS", n MOD 256
v = PEEK(TMC n MOD 2, SG)
n = n + 1"""


def program(part: list[str], drivers: list[str], body: str) -> str:
    """A program that cuts a part from a file; all is queued in time, behind a dwell."""
    setup = [line.replace("1024", "256") for line in SETUP]
    write = [f'PRINT #1, "{line}"' for line in ["G4 P1000", *part] if line]
    return "\n".join(
        [
            *setup,
            'OPEN "part.nc" FOR OUTPUT AS #1',
            *write,
            "CLOSE #1",
            *drivers,
            "STEPPER RUN",
            'STEPPER FILE "part.nc"',
            "DO",
            body,
            "LOOP WHILE PEEK(STEPPER ACTIVE) = 1",
            'PRINT "turns"; n',
            "",
        ]
    )


def of_motion(edges: Edges) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (ns, from the first step on), pins and levels of what moves the machine."""
    mine = np.isin(edges.gpio, PINS)
    first = np.flatnonzero(np.isin(edges.gpio, BEGIN))[0]
    mine[:first] = False
    return edges.time_ns[mine] - edges.time_ns[first], edges.gpio[mine], edges.level[mine]


# ---- On the host: to the nanosecond --------------------------------------------------------------


def host_edges(
    folder: Path, drivers: list[str], body: str, fault: str = ""
) -> tuple[Edges, dict[str, int], int]:
    """The edges, what was asked of the second driver, and how often the body ran."""
    machine, source = folder / "machine.txt", folder / "part.bas"
    trace, report = folder / "edges.csv", folder / "report.jsonl"
    machine.write_text("".join(f"tmc2209 tx=GP{TX} address={n} {fault}\n" for n in range(2)))
    source.write_text(program(PLATE, drivers, body))
    files = ["--machine", machine, "--machine-report", report, "--trace", trace, source]
    done = subprocess.run(
        [HOST, "--virtual", *files], text=True, capture_output=True, check=True, timeout=120
    )
    last = json.loads(report.read_text().splitlines()[-1])
    return Edges.read(trace), last["drivers"][1], int(done.stdout.split("turns")[1].split()[0])


@pytest.fixture(scope="module")
def quiet(tmp_path_factory: pytest.TempPathFactory) -> Edges:
    """The plate without a driver."""
    return host_edges(tmp_path_factory.mktemp("quiet"), [], QUIET)[0]


def assert_same(a: Edges, b: Edges) -> None:
    left, right = of_motion(a), of_motion(b)
    assert len(left[0]) > 400_000
    assert all(np.array_equal(x, y) for x, y in zip(left, right, strict=True))


def test_host_with_a_program_that_asks_and_writes(quiet: Edges, tmp_path: Path) -> None:
    edges, driver, turns = host_edges(tmp_path, DRIVERS, TRAFFIC)
    assert turns > 5000
    assert driver["writes"] > turns / 2
    assert driver["reads"] > turns
    assert_same(quiet, edges)


def test_host_with_the_monitor(quiet: Edges, tmp_path: Path) -> None:
    edges, driver, _ = host_edges(tmp_path, DRIVERS, QUIET)
    assert driver["reads"] > 50
    assert_same(quiet, edges)


@pytest.mark.parametrize("fault", ["silent", "garbled", "late", "brown-out"])
def test_host_with_drivers_that_fail(quiet: Edges, tmp_path: Path, fault: str) -> None:
    """Repeats, pauses, errors and what the monitor tells are of no matter either."""
    body = "\n".join(f"ON ERROR SKIP 1\n{line}" for line in TRAFFIC.splitlines())
    edges, driver, turns = host_edges(tmp_path, DRIVERS, body, f"fault={fault}@2000")
    assert turns > 500
    assert driver["writes"] + driver["reads"] > 20
    assert_same(quiet, edges)


def test_host_comparison_sees_another_feed(quiet: Edges, tmp_path: Path) -> None:
    edges, _, _ = host_edges(tmp_path, [], "IF n = 0 THEN STEPPER OVERRIDE FEED, 99\nn = 1")
    with pytest.raises(AssertionError):
        assert_same(quiet, edges)


# ---- On the board: to the tick, and within it as ever --------------------------------------------

# The plate's first lines, its border, and a figure of four axes.
PART = [*PLATE[:55], "G0 X0 Y0 Z1", "M5", *FIGURE]


LATEST_NS = 2600
"""An edge at a place where main has masked interrupts: the worst of all programs in the bench."""


@dataclass(frozen=True)
class Cut:
    """What a board did while it cut the part."""

    train: list[TickEdge]
    late_ns: np.ndarray
    """How long after their ticks the edges came."""
    turns: int
    datagrams: int


def cut(uf2: Path, drivers: list[str], body: str) -> Cut:
    """Cut the part on a fresh board with two drivers on a wire."""
    with Emulator(uf2) as board:
        board.connect()
        board.until("> ")
        for n in range(2):
            board.add_tmc2209(f"D{n}", TX, address=n)
        board.send("AUTOSAVE\r" + program(PART, drivers, body).replace("\n", "\r") + "\x1a")
        board.until("\n> ", 5000)
        board.send("RUN\r")
        board.expect("Stepper armed", 20_000)
        board.tmc_log()
        printed = board.until("\n> ", 200_000)
        assert "rror" not in printed, printed
        assert board.faults() == []
        edges, runs = Edges.from_rows(board.edges(PINS)), board.tick_runs()
        return Cut(
            tick_train(snap_to_ticks(edges, runs), PINS, BEGIN),
            latencies_ns(edges, runs),
            int(printed.split("turns")[1].split()[0]),
            len(board.tmc_log()),
        )


@pytest.fixture(scope="module")
def quiet_board(uf2: Path) -> Cut:
    return cut(uf2, [], QUIET)


def assert_same_ticks(quiet: Cut, other: Cut) -> None:
    """Each edge in the same tick, as long behind it as ever.

    How long depends on the instruction that main is at. While main sets the alarm before it sleeps,
    the SDK masks interrupts for about a microsecond; whether a tick comes just then is chance.
    """
    assert len(quiet.train) > 40_000
    difference = first_difference(quiet.train, other.train)
    assert difference is None, difference
    assert other.late_ns.min() >= quiet.late_ns.min() - 100
    assert other.late_ns.max() <= LATEST_NS
    assert np.percentile(other.late_ns, 99.9) <= np.percentile(quiet.late_ns, 99.9) + 100
    assert abs(other.late_ns.mean() - quiet.late_ns.mean()) < 20


def test_board_with_a_program_that_asks_and_writes(quiet_board: Cut, uf2: Path) -> None:
    busy = cut(uf2, DRIVERS, TRAFFIC)
    assert busy.turns > 500
    assert busy.datagrams > 4 * busy.turns
    assert_same_ticks(quiet_board, busy)


def test_board_with_the_monitor(quiet_board: Cut, uf2: Path) -> None:
    watched = cut(uf2, DRIVERS, QUIET)
    assert watched.datagrams > 10
    assert_same_ticks(quiet_board, watched)
