"""Ctrl-F holds the feed and Ctrl-R goes on, at once, whatever the foreground does.

At a terminal, in virtual time: moves are so long that they are under way whenever a key comes.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator

import pytest
from test_host_port import Terminal, read_until, run

CTRL_C, CTRL_F, CTRL_R = b"\x03", b"\x06", b"\x12"
HELD = b"Feed hold (Ctrl-R or STEPPER RESUME goes on)\r\n"
SETUP = (
    b"STEPPER INIT:STEPPER AXIS X,GP2,GP3,,,80,6000,500:STEPPER POSITION HOME:STEPPER RUN\r",
    b"STEPPER GC G1 X200000 F600\r",  # over five hours
)
# Prints "d" and the way made in 50 ms, for ever.
WATCH = b'DO:x=PEEK(STEPPER X):PAUSE 50:PRINT "d"; INT((PEEK(STEPPER X)-x)*1000):LOOP\r'


@pytest.fixture
def terminal() -> Iterator[Terminal]:
    """Provide the program at a terminal, with X on its way."""
    at = Terminal("--virtual")
    for line in SETUP:
        at.type(line, b"\r\n> ")
    yield at
    at.close()


def ways(at: Terminal, count: int) -> list[int]:
    """Return the next ways that WATCH prints, in um."""
    seen = b""
    while len(found := re.findall(rb"\r\nd ?(\d+)(?=\r)", seen)) < count:
        seen += read_until(at.master, b"\n")
    return [int(way) for way in found[:count]]


def test_hold_and_resume_in_a_running_program(terminal: Terminal) -> None:
    """X stands, then moves as before; the program notices nothing else."""
    terminal.type(WATCH, b"d")
    assert ways(terminal, 8)[-1] == pytest.approx(500, abs=15)
    terminal.type(CTRL_F, HELD)
    assert ways(terminal, 8)[-4:] == [0, 0, 0, 0]
    terminal.type(CTRL_R, b"Resumed\r\n")
    assert ways(terminal, 8)[-1] == pytest.approx(500, abs=15)
    terminal.type(CTRL_C, b"motion stops, what was queued is dropped\r\n> ")


def test_in_a_program_that_never_pauses(terminal: Terminal) -> None:
    """Neither key needs the program's help, nor does Ctrl-C behind them."""
    terminal.type(b'PRINT "on":DO:LOOP\r', b"\r\non\r\n")
    terminal.type(CTRL_F, HELD)
    terminal.type(CTRL_R, b"Resumed\r\n")
    terminal.type(CTRL_C, b"motion stops, what was queued is dropped\r\n> ")


def test_while_a_line_is_typed(terminal: Terminal) -> None:
    """The notice takes the line away and draws it again; what was typed stays."""
    terminal.type(b"PRINT 6*", b"PRINT 6*")
    terminal.type(CTRL_F, b"\r\x1b[J" + HELD + b"> PRINT 6*")
    terminal.type(b"7\r", b"\r\n 42\r\n> ")
    shown = terminal.type(b"STEPPER STATUS\r", b"\r\n> ")
    assert b"motion: HOLD" in shown
    terminal.type(CTRL_R, b"Resumed\r\n> ")
    terminal.type(CTRL_C, b"motion stops, what was queued is dropped\r\n> ")


def test_while_nobody_reads_what_is_printed(terminal: Terminal) -> None:
    """The key acts although the screen is full; the notice comes when there is room."""
    os.write(terminal.master, b'DO:PRINT STRING$(70,"x"):LOOP\r')
    os.write(terminal.master, CTRL_F)
    read_until(terminal.master, HELD + b"x")
    os.write(terminal.master, CTRL_R)
    read_until(terminal.master, b"Resumed\r\nx")
    terminal.type(CTRL_C, b"motion stops, what was queued is dropped\r\n> ")


def test_behind_input_that_nobody_takes(terminal: Terminal) -> None:
    """It overtakes what was typed ahead, which stays."""
    terminal.type(b'PRINT "on":PAUSE 5000000:LINE INPUT a$\r', b"\r\non\r\n")
    os.write(terminal.master, b"typed ahead\r" + CTRL_F)
    shown = read_until(terminal.master, b"typed ahead\r\n> ")
    assert shown.index(HELD) < shown.index(b"typed ahead")
    terminal.type(b"PRINT a$\r", b"\r\ntyped ahead\r\n> ")


def test_at_rest_both_are_ordinary_input(terminal: Terminal) -> None:
    """A program can read them while there is nothing to hold."""
    terminal.type(CTRL_C, b"dropped\r\n> ")
    terminal.type(b"PAUSE 1000\r", b"\r\n> ")
    read = b'DO:k$=INKEY$:LOOP WHILE k$="":PRINT "<";ASC(k$)\r'
    terminal.type(read, b"\r\n")
    terminal.type(CTRL_F, b"< 6\r\n> ")
    terminal.type(read, b"\r\n")
    terminal.type(CTRL_R, b"< 18\r\n> ")


def test_in_a_script_they_wait_for_their_turn() -> None:
    """What a piped script does depends on its order alone: a move, a hold, and on."""
    x = b'PAUSE 400:PRINT "at"; INT(PEEK(STEPPER X)*1000)\r'
    script = b"".join(SETUP) + x + CTRL_F + x + x + CTRL_R + x + b"STEPPER STOP\r"
    shown = run(text=script).stdout
    first, second, third, fourth = (int(um) for um in re.findall(rb"\r\nat ?(\d+)", shown))
    assert 3700 < first < second == third < fourth - 3000
    assert HELD in shown
    assert b"Resumed" in shown
