"""Keys while TMC22xx SGTUNE makes an axis move, at a terminal of its own."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from test_host_port import Terminal, read_until

MACHINE = Path(__file__).resolve().parents[2] / "examples" / "sensorless.txt"
SET_UP = [
    "TMC22xx GP5,2209,0,800,30,16",
    "STEPPER INIT",
    "STEPPER AXIS X,GP2,GP3,GP4,,80,6000,500",
    "STEPPER RUN",
    "TMC22xx AXIS 0,X",
]
CTRL_C, CTRL_F = b"\x03", b"\x06"


@pytest.fixture
def terminal() -> Iterator[Terminal]:
    at = Terminal("--virtual", "--machine", str(MACHINE))
    for line in SET_UP:
        at.type(line.encode() + b"\r", b"\r\n> ")
    yield at
    at.close()


def begin(terminal: Terminal, distance: str = "100000") -> None:
    """Tune for half a day, until some rows are there."""
    os.write(terminal.master, f"TMC22xx SGTUNE X,100,{distance}\r".encode())
    read_until(terminal.master, b"SG_RESULT lowest  CS\r\n")
    for _ in range(3):
        read_until(terminal.master, b"25\r\n")


def test_ctrl_c_brakes_the_axis_and_ends_the_statement(terminal: Terminal) -> None:
    """The position stays known to the step, the machine armed; no proposal from half a jog."""
    terminal.type(b"STEPPER POSITION HOME\r", b"> ")
    begin(terminal)
    shown = terminal.type(CTRL_C, b"what was queued is dropped\r\n> ")
    assert b"Proposal" not in shown
    terminal.type(b"DO:LOOP WHILE PEEK(STEPPER ACTIVE)=1\r", b"\r\n> ")
    shown = terminal.type(b"PRINT PEEK(STEPPER STATUS)>>7\r", b"\r\n> ")
    assert re.search(rb"\r\n 1\r", shown)
    terminal.type(b"STEPPER GC G1 X0 F3000\r", b"\r\n> ")


def test_a_program_ends_with_it(terminal: Terminal) -> None:
    """Ctrl-C in a program that tunes."""
    os.write(terminal.master, b'DO : TMC22xx SGTUNE X,100,5000 : PRINT "again" : LOOP\r')
    for _ in range(4):
        read_until(terminal.master, b"25\r\n")
    shown = terminal.type(CTRL_C, b"what was queued is dropped\r\n> ")
    assert b"again" not in shown


def test_a_hold_ends_it(terminal: Terminal) -> None:
    """As it ends every jog; what has been read until then is enough for a proposal."""
    begin(terminal)
    for _ in range(20):
        read_until(terminal.master, b"25\r\n")
    shown = terminal.type(CTRL_F, b"\r\n> ")
    assert b"Proposal" in shown
