"""I2C on the emulated board: the controller's registers, devices on the wire."""

import sys
from pathlib import Path

import pytest

from stepmite.emulator import Emulator

sys.path.insert(0, str(Path(__file__).parents[1] / "bas"))
from cases import Case, read_cases

CTRL_C, CTRL_Z = "\x03", "\x1a"


def run(board: Emulator, source: str) -> str:
    """Type a program in, run it, return what was printed up to the next prompt."""
    board.send("AUTOSAVE\r" + source.replace("\n", "\r") + CTRL_Z)
    board.until("\n> ", 5000)
    board.send("RUN\r")
    return board.until("\n> ", 5000)


def with_devices() -> list[Case]:
    return [case for case in read_cases() if case.name.startswith("i2c: I2C devices")]


@pytest.mark.parametrize("case", with_devices(), ids=lambda case: case.name)
def test_devices_answer_as_on_the_host(board: Emulator, case: Case) -> None:
    assert case.answer(run(board, case.source) + "\n") == case.expected()


def test_a_transfer_takes_its_time_and_ctrl_c_ends_one_that_hangs(board: Emulator) -> None:
    program = """\
SETPIN GP4, GP5, I2C
I2C OPEN 100, 0
TIMER = 0
I2C READ &H50, 0, 255, s$
PRINT "took "; TIMER
I2C CHECK &H4F
PRINT "never"
"""
    board.send("AUTOSAVE\r" + program.replace("\n", "\r") + CTRL_Z)
    board.until("\n> ", 5000)
    board.send("RUN\r")
    took_ms = float(board.expect(r"took\s+([\d.]+)", 1000)[1])
    assert 256 * 9 / 100 <= took_ms < 256 * 9 / 100 * 1.15
    board.run_ms(300)
    board.send(CTRL_C)
    assert "never" not in board.until("\n> ", 500)


MOVE = """\
STEPPER INIT
STEPPER AXIS X, GP2, GP3, , , 800, 3000
STEPPER POSITION X, 0
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
STEPPER RUN
STEPPER GC G0 X3
DO
%s
LOOP UNTIL PEEK(STEPPER X) = 3
STEPPER CLOSE
PRINT "reads"; n
"""


def steps_of_move(board: Emulator, body: str) -> tuple[list[int], int]:
    """Times of the step pulses from the first on (ns), and how often the body's counter ran."""
    board.clear_edges()
    printed = run(board, MOVE % body)
    times = [time for time, gpio, level in board.edges([2]) if gpio == 2 and level == 1]
    assert len(times) == 2400, printed
    return [time - times[0] for time in times], int(printed.split("reads")[-1].split()[0])


def test_motion_goes_on_untouched(board: Emulator) -> None:
    quiet, _ = steps_of_move(board, "PAUSE 1")
    busy, reads = steps_of_move(board, "I2C READ &H48, 0, 2, s$ : n = n + 1")
    assert reads > 100
    # Both start on a tick; apart from that the pulses come at the same times.
    assert max(abs(a - b) for a, b in zip(quiet, busy, strict=True)) <= 1500
