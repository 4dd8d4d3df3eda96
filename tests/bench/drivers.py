"""What talking to a TMC2209 takes: time on the wire, and cycles of the processor meanwhile."""

from dataclasses import dataclass
from pathlib import Path

import measure

from stepmite.emulator import Emulator

TX_GPIO = 28
ACTIONS = {
    "PEEK of a register": "v = PEEK(TMC 0, SG): ",
    "one register written, confirmed": "TMC22xx SGTHRS 0, i AND 127: ",
    "set up, confirmed": f"TMC22xx GP{TX_GPIO}, 2209, 0, 800, 30, 16: ",
    "set up with VERIFY 0": f"TMC22xx GP{TX_GPIO}, 2209, 0, 800, 30, 16: ",
}
BAUDS = (9600, 115_200, 500_000)
TURNS = 20


@dataclass(frozen=True)
class Action:
    """A statement that speaks with a driver."""

    name: str
    baud: int
    taken_ms: float
    cycles: float
    """Of all that takes the wire and its jobs on."""


def ready(uf2: Path, baud: int, *, blind: bool) -> Emulator:
    """A board with a driver at the end of a wire, set up; nobody else uses the wire."""
    board = measure.ready(uf2, 64)
    board.add_tmc2209("d", TX_GPIO)
    for line in (
        "TMC22xx MONITOR 0",
        f"TMC22xx WIRE GP{TX_GPIO}, , {baud}",
        f"TMC22xx GP{TX_GPIO}, 2209, 0, 800, 30, 16",
        f"TMC22xx VERIFY {0 if blind else 1}",
    ):
        answer = board.command(line)
        if "rror" in answer:
            raise RuntimeError(answer)
    return board


def action(uf2: Path, name: str, baud: int) -> Action:
    """One of ACTIONS, many times."""
    with ready(uf2, baud, blind="VERIFY 0" in name) as board:
        empty = measure.statement(board, "", TURNS, 10 * TURNS)
        board.measure("tmc22xx_background")
        board.clear_profile()
        cycles = measure.statement(board, ACTIONS[name], TURNS, 2 * TURNS) - empty
        spent = board.profile()["tmc22xx_background"]
        measure.no_faults(board)
    taken_ms = cycles / measure.CYCLES_PER_US / 1000
    return Action(name, baud, taken_ms, spent.mean * spent.calls / (3 * TURNS))


def turn_beside_drivers(uf2: Path) -> float:
    """Cycles of an empty turn of FOR while drivers are there and the monitor asks them."""
    with ready(uf2, BAUDS[1], blind=False) as board:
        board.command("TMC22xx MONITOR 1")
        return measure.statement(board, "", 20_000, 1_000_000 // 5)
