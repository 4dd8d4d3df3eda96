"""Interrupts of a BASIC program on the emulated board: when SUBs are called, seen at a pin."""

import numpy as np
import pytest

from stepmite.emulator import Emulator

CTRL_C, CTRL_Z = "\x03", "\x1a"
GPIO = 16
TOGGLE = "SUB toggle\r  p = 1 - p : PIN(GP16) = p\rEND SUB\r"


def start(board: Emulator, body: str) -> None:
    """Type a program in and start it."""
    board.send("AUTOSAVE\r" + f"SETPIN GP16, DOUT\r{body}\r{TOGGLE}" + CTRL_Z)
    board.until("\n> ", 5000)
    board.clear_edges()
    board.send("RUN\r")


def toggles_ms(board: Emulator) -> np.ndarray:
    """Times of the pin's changes, from the second one on: the first may be SETPIN's."""
    return np.array([time for time, _, _ in board.edges([GPIO])])[1:] / 1e6


@pytest.mark.parametrize("load", ["DO : PAUSE 1000 : LOOP", "DO : a = SIN(a + 1) : LOOP"])
def test_a_clock_keeps_its_beat(board: Emulator, load: str) -> None:
    start(board, f"SETTICK 10, toggle\r{load}")
    board.run_ms(3000)
    times = toggles_ms(board)
    late = times - times[0] - 10 * np.arange(len(times))
    assert len(times) >= 280
    assert np.abs(late).max() < 0.1  # a statement, or what USB takes; no drift
    board.send(CTRL_C)
    board.until("\n> ", 1000)


def test_a_clock_that_takes_all_the_time_starves_nobody(board: Emulator) -> None:
    """Its SUB takes longer than its period; the loop, the console and Ctrl-C go on."""
    start(
        board,
        "SETTICK 1, busy\rDO\r  n = n + 1\r  IF n MOD 50 = 0 THEN PRINT n\rLOOP\r"
        "SUB busy\r  PAUSE 2\rEND SUB",
    )
    board.expect(" 50\r\n", 1000)
    board.expect(" 100\r\n", 1000)
    board.send(CTRL_C)
    board.until("> ", 100)


def test_a_key_is_answered_at_once(board: Emulator) -> None:
    start(board, 'ON KEY ASC("x"), toggle\rDO : a = SIN(a + 1) : LOOP')
    board.run_ms(200)
    for _ in range(3):
        board.clear_edges()
        sent_ns = board.now_ns
        board.send("x")
        board.run_ms(20)
        ((time, _, _),) = board.edges([GPIO])
        assert 0 < time - sent_ns < 2e6
    board.send(CTRL_C)
    board.until("\n> ", 1000)
