"""TMC22xx in every state of the machine: it is independent of STEPPER, and disturbs nothing.

Every command of the drivers is carried out in each state of the matrix. Only what needs an axis is
refused without one, and another number of microsteps while motors may move.
"""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from test_state_matrix import ENDS, MOVING_STATES, STATES, SWITCH, still
from typed import STEPMITE, error_of, typed

DRIVER = "tmc2209 tx=GP21 address=0"
SET_UP = "TMC22xx GP21, 2209, 0, 800, 30, 16"

LINES = [
    SET_UP,
    "TMC22xx AXIS 0, X",
    "TMC22xx CURRENT X, 700, 40",
    "TMC22xx SGTHRS X, 60",
    "TMC22xx SGTTHRS X, 61",
    "TMC22xx TCOOLTHRS X, 0",
    "TMC22xx COOLSTEP X, 0",
    "TMC22xx STEALTH X, 0",
    "TMC22xx READ X, IOIN",
    "TMC22xx WRITE X, PWMCONF, &HCF0D0E24",
    "TMC22xx STATUS",
    "TMC22xx VERIFY 1",
    "TMC22xx MONITOR 1",
    "x = PEEK(TMC X, SG)",
    "TMC22xx CLOSE",
    "TMC22xx WIRE GP21, , 57600",
    "TMC22xx CLOSE GP21",
]
NEEDS_AXIS = "TMC22xx STALL X, 300"
MICROSTEPS = "TMC22xx GP21, 2209, 0, 800, 30, 32"
FILLED = (*MOVING_STATES, "queued", "holding", "paused")
"""States in which motion is active or queued."""

ELSEWHERE = ["TMC22XX STALL", "TMC22XX SGTUNE"]
"""Rows with tests of their own, since they need an axis, or move it."""


def test_no_command_is_forgotten() -> None:
    """Each row of the firmware whose name begins with TMC22XX is in the list."""
    shown = subprocess.run(
        [STEPMITE, "--virtual"], input=b"HELP TMC22XX\r", capture_output=True, check=True
    ).stdout.decode()
    names = re.findall(r"TMC22XX [A-Z]+(?: [A-Z]+)*(?=[,\r])", shown.partition("\n> ")[2])
    assert len(names) > 12
    listed = [line.upper() for line in LINES] + ELSEWHERE
    assert [n for n in names if not any(f"{line} ".startswith(f"{n} ") for line in listed)] == []


@pytest.mark.parametrize("state", STATES)
def test_all_is_allowed_and_changes_nothing(state: str, tmp_path: Path) -> None:
    """STEPPER STATUS is as before, and motion ends where it was to end."""
    before, events = STATES[state]
    status = "STEPPER STATUS"
    wait = ["STEPPER RESUME", "DO : PAUSE 10 : LOOP WHILE PEEK(STEPPER ACTIVE) = 1"]
    session = typed(
        tmp_path,
        *before,
        status,
        *LINES,
        status,
        *(wait if state in ENDS else []),
        events=events,
        switches=[SWITCH],
        drivers=[DRIVER],
    )
    answers = session.answers[len(before) :][: len(LINES) + 2]
    assert [error_of(answer) for answer in answers[1:-1] if error_of(answer)] == []
    assert still(answers[-1], state) == still(answers[0], state)
    if state in ENDS:
        assert session.end("X") == ENDS[state]


@pytest.mark.parametrize("state", STATES)
def test_what_is_refused(state: str, tmp_path: Path) -> None:
    """A speed of an axis that is not configured, microsteps in motion; nothing else."""
    before, events = STATES[state]
    lines = [SET_UP, "TMC22xx AXIS 0, X", NEEDS_AXIS, MICROSTEPS, SET_UP]
    session = typed(tmp_path, *before, *lines, events=events, switches=[SWITCH], drivers=[DRIVER])
    *_, stall, microsteps, again = map(error_of, session.answers)
    configured = state not in ("no INIT", "INIT only")
    assert stall == ("" if configured else "X axis not configured (use STEPPER AXIS)")
    said = "microsteps: cannot change while motion is active or queued"
    assert microsteps == (said if state in FILLED else "")
    assert again == ""
