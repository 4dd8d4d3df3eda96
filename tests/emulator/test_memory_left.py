"""Memory for BASIC on the RP2040 with the largest block ring: the goal, and that one can use it."""

import sys
from pathlib import Path

from stepmite.emulator import Emulator

sys.path.insert(0, str(Path(__file__).parents[1] / "bench"))
import ram


def test_100_kb_are_left_for_program_and_variables(board: Emulator) -> None:
    left = ram.ready(board)
    assert left >= ram.GOAL_BYTES
    integers = ram.GOAL_BYTES // 8 - 20  # without what an array itself takes
    answer = board.command(
        f"DIM a%({integers - 1}): a%({integers - 1})=7: PRINT a%({integers - 1})"
    )
    assert answer.split()[-1] == "7"
    assert "Not enough memory" in board.command(f"DIM b%({left // 8})")


def test_the_table_knows_all_of_the_ram(board: Emulator, uf2: Path) -> None:
    rows = ram.rows(uf2, ram.ready(board))
    assert sum(count for _, count in rows) == ram.RAM_BYTES
    assert min(count for _, count in rows) >= 0
    assert dict(rows)["small ones and gaps"] < 2048
