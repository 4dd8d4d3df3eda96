"""Keys while a statement waits for a motor driver, at a terminal in virtual time; and no keys."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from test_host_port import Terminal, read_until

CTRL_C = b"\x03"
SET_UP = b"TMC22xx GP21, 2209, 0, 800, 30, 16\r"


@pytest.fixture
def terminal(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Terminal]:
    """Provide the program at a terminal, with a driver that has the test's fault."""
    machine = tmp_path / "machine.txt"
    machine.write_text(f"tmc2209 tx=GP21 address=0 {request.param}\n")
    at = Terminal("--virtual", "--machine", str(machine))
    at.type(SET_UP, b"\r\n> ")
    yield at
    at.close()


@pytest.mark.parametrize("terminal", ["fault=silent@1000"], indirect=True)
def test_ctrl_c_ends_a_reading_without_a_value(terminal: Terminal) -> None:
    """Nearly all the time goes by in the reading: the variable stays as it was."""
    terminal.type(b'PAUSE 1100 : x = 5 : PRINT "on"\r', b"\r\non\r\n> ")
    loop = b'PRINT "in" : DO : ON ERROR IGNORE : x = PEEK(TMC 0, SG) : LOOP\r'
    terminal.type(loop, b"\r\nin\r\n")
    terminal.type(CTRL_C, b"> ")
    terminal.type(b'PRINT "x is"; x\r', b"\r\nx is 5\r\n")


@pytest.mark.parametrize("terminal", [""], indirect=True)
def test_the_driver_can_be_spoken_to_behind_it(terminal: Terminal) -> None:
    """Whatever was under way: what was set counts, and each reading is right."""
    loop = b'PRINT "in" : DO : TMC22xx CURRENT 0, 700 : TMC22xx CURRENT 0, 800 : LOOP\r'
    for _ in range(20):
        terminal.type(loop, b"\r\nin\r\n")
        terminal.type(CTRL_C, b"> ")
        terminal.type(b"TMC22xx CURRENT 0, 800 : PRINT PEEK(TMC 0, GCONF);\r", b" 448")
        terminal.type(b"PRINT PEEK(TMC 0, CHOPCONF)\r", b"\r\n 335741267\r\n")


def test_a_driver_is_missed_while_nobody_types(tmp_path: Path) -> None:
    """In real time, as on a board: the prompt waits, and what the monitor finds is told."""
    machine = tmp_path / "machine.txt"
    machine.write_text("tmc2209 tx=GP21 address=0 fault=unplugged@300\n")
    at = Terminal("--realtime", "--machine", str(machine))
    at.type(SET_UP, b"\r\n> ")
    read_until(at.master, b"does not answer any more")
    at.close()
