"""What is allowed in which state: every STEPPER command and class of G-code in every state.

The matrix below says it; a dot is allowed, a letter the error. A refused command changes nothing:
STEPPER STATUS is the same before and after, and motion under way ends where it was to end. A row of
the firmware that is in no line of the matrix is a fault.
"""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from typed import AXES, STEPMITE, Event, Session, Switch, error_of, typed

X_MIN, Y_MIN, Z_MIN, ESTOP = 16, 17, 18, 22

# X's own switch, which homing finds; that of Y is pressed by hand.
SWITCH = Switch(X_MIN, "X", -5.0)
FILE = 'OPEN "f.nc" FOR OUTPUT AS #1 : PRINT #1, "G1 X1 F600" : CLOSE #1'
SLOW_FILE = 'OPEN "s.nc" FOR OUTPUT AS #1 : PRINT #1, "G1 X50 F300" : CLOSE #1'
PROBING_FILE = 'OPEN "p.nc" FOR OUTPUT AS #1 : PRINT #1, "G38.3 X50 F300" : CLOSE #1'
INIT = [FILE, SLOW_FILE, PROBING_FILE, f"STEPPER INIT ,64,GP{ESTOP}"]
SET_UP = [
    *INIT,
    *AXES,
    f"STEPPER HWLIMITS GP{X_MIN},GP{Y_MIN},GP{Z_MIN}",
    "STEPPER SPINDLE GP14",
    "STEPPER COOLANT GP15",
    "STEPPER PROBE GP26",
]
KNOWN = [*SET_UP, "STEPPER POSITION HOME", "STEPPER GC G30.1"]
IDLE = [*KNOWN, "STEPPER RUN", "PAUSE 1"]
MOVING = [*IDLE, "STEPPER GC G1 X50 F300", "PAUSE 100"]
SLOW = "STEPPER HOME X,,60"

STATES: dict[str, tuple[list[str], list[Event]]] = {
    "no INIT": ([FILE, SLOW_FILE], []),
    "INIT only": (INIT, []),
    "configured": (KNOWN, []),
    "unknown": ([*SET_UP, "STEPPER RUN", "PAUSE 1"], []),
    "idle": (IDLE, []),
    "queued": ([*KNOWN, "STEPPER GC G1 X50 F300"], []),
    "moving": (MOVING, []),
    "dwelling": ([*IDLE, "STEPPER GC G4 P20000", "PAUSE 100"], []),
    "holding": ([*MOVING, "STEPPER HOLD", "PAUSE 500"], []),
    "paused": ([*IDLE, "STEPPER GC M0", "STEPPER GC G1 X50 F300", "PAUSE 100"], []),
    "stopping": (
        [
            *KNOWN,
            "STEPPER TUNE X,,,6000,10",
            "STEPPER RUN",
            "STEPPER GC G1 X900 F6000",
            "PAUSE 5000",
            "STEPPER STOP",
        ],
        [],
    ),
    "jogging": ([*IDLE, "STEPPER JOG X,50,300", "PAUSE 100"], []),
    "homing": ([*KNOWN, SLOW, "STEPPER HOME RUN X", "PAUSE 100"], []),
    "file": ([*IDLE, 'STEPPER FILE "s.nc"', "PAUSE 100"], []),
    "probing": ([*IDLE, 'STEPPER FILE "p.nc"', "PAUSE 100"], []),
    "E-STOP": (MOVING, [Event(50, ESTOP, 0)]),
    "was E-STOP": ([*MOVING, "PAUSE 100"], [Event(50, ESTOP, 0), Event(110, ESTOP, 1)]),
    "limit": (MOVING, [Event(50, Y_MIN, 0)]),
    "on limit": ([*KNOWN, "STEPPER RUN", "PAUSE 1"], [Event(0, Y_MIN, 0)]),
}

ERRORS = {
    "I": "Stepper already initialized (use STEPPER CLOSE to start anew)",
    "N": "Stepper not initialized (use STEPPER INIT)",
    "B": "Not possible while motion is active or G-code is queued",
    "H": "Homing is under way (STEPPER STOP or Ctrl-C ends it)",
    "x": "X axis not configured (use STEPPER AXIS)",
    "E": "E-STOP active - clear E-STOP and re-home",
    "R": "Not possible while armed (STEPPER RECOVER disarms)",
    "p": "Probing is under way (STEPPER STOP or Ctrl-C ends it)",
    "F": "A G-code file is running (STEPPER STOP ends it)",
    "e": "E-STOP alarm - home (G28), STEPPER POSITION or STEPPER RECOVER first",
    "l": "Limit switch Y_MIN alarm - home (G28), STEPPER POSITION or STEPPER RECOVER first",
    "M": "Cannot clear buffer while motion active",
    "r": "Not armed (use STEPPER RUN)",
    "j": "No jogging while motion is active or G-code is queued",
    "S": "Motion is being stopped",
    "J": "A jog is under way (use STEPPER JOG STOP)",
    "k": "Line 1: X axis not configured (use STEPPER AXIS)",
    "P": "Machine position unknown - use STEPPER POSITION or G28 homing first",
    "L": "Limit switch Y_MIN is active - home (G28) or jog off it",
    "s": "Spindle pin not configured (use STEPPER SPINDLE)",
    "c": "Coolant pin not configured (use STEPPER COOLANT)",
    "g": "No position stored yet (use G30.1)",
}
"""What the letters stand for."""

# In each line a command and its columns, one for each state in the order of STATES. w: it waits,
# for the user has the machine held.
MATRIX = """
STEPPER INIT                              . I I I I I I I I I I I I I I I I I I
STEPPER AXIS X,GP2,GP3,GP4,,80,6000,500   N . . . . B B B B B B B H B p . . . .
STEPPER TUNE X,,,5000                     N x . . . B B B B B B B H B p . . . .
STEPPER INVERT X,0                        N x . . . B B B B B B B H B p . . . .
STEPPER ENABLE X,1                        N x . . . B B B B B B B H B p E . . .
STEPPER ENABLE X,0                        N x . R R B B B B B B B H B p . . . R
STEPPER RESET                             N . . . . B B B B B B B H B p . . . .
STEPPER LIMITS X,-500,500                 N x . . . B B B B B B B H B p . . . .
STEPPER SPINDLE GP14                      N . . . . B B B B B B B H B p . . . .
STEPPER LASER 0                           N . . . . B B B B B B B H B p . . . .
STEPPER COOLANT GP15                      N . . . . B B B B B B B H B p . . . .
STEPPER PROBE GP26                        N . . . . B B B B B B B H B p . . . .
STEPPER HWLIMITS GP16,GP17,GP18           N . . . . B B B B B B B H B p . . . .
STEPPER HWLIMITS FILTER 3                 N . . . . . . . . . . . . . . . . . .
STEPPER HWLIMITS KEEP 0                   N . . . . . . . . . . . . . . . . . .
STEPPER HOME X,,500                       N x . . . . . . . . . . H . p . . . .
STEPPER HOME ORDER "ZXY"                  N . . . . . . . . . . . H . p . . . .
STEPPER JUNCTION 0.05                     N . . . . . . . . . . . . . . . . . .
STEPPER SCURVE 1                          N . . . . . . . . . . . . . . . . . .
STEPPER JERK 20000                        N . . . . . . . . . . . . . . . . . .
STEPPER ARC 0.1                           N . . . . . . . . . . . . . . . . . .
STEPPER ARC LEGACY 1                      N . . . . . . . . . . . . . . . . . .
STEPPER DIALECT REFERENCE                 N . . . . . . . . . . . . F F . . . .
STEPPER BLOCKDELETE 1                     N . . . . . . . . . . . . . . . . . .
STEPPER OPTIONALSTOP 0                    N . . . . . . . . . . . . . . . . . .
STEPPER OVERRIDE FEED,100                 N . . . . . . . . . . . . . . . . . .
STEPPER BUFFER                            N . . . . . . . . . . . . . . . . . .
STEPPER STATUS                            . . . . . . . . . . . . . . . . . . .
STEPPER RUN                               N . . . . . . . . . . . H . p E e l .
STEPPER CLEAR                             N . . . . . M M M M M M H M p . . . .
STEPPER STOP                              N . . . . . . . . . . . . . . . . . .
STEPPER HOLD                              N . . . . . . . . . . . . . . . . . .
STEPPER RESUME                            N . . . . . . . . . . . . . . . . . .
STEPPER JOG STOP                          N . . . . . . . . . . . . . . . . . .
STEPPER JOG X,1,600                       N r r . . j j j j j S . H F F E e l .
STEPPER ESTOP                             N . . . . . . . . . . . . . . . . . .
STEPPER RECOVER                           N . . . . . . . . . . . . . . E . . .
STEPPER CLOSE                             N . . . . . . . . . . . . . . . . . .
STEPPER POSITION HOME                     N . . . . B B B B B B B H B p E . . .
STEPPER POSITION X,5                      N x . . . B B B B B B B H B p E . . .
STEPPER HOME RUN X                        N x . . . r . . . . S J H F F E . . .
STEPPER FILE "f.nc"                       N r r . . r . . . . S J H F F E e l .
STEPPER CHECK "f.nc"                      N k . . . . . . . . . . . . . . . . .
STEPPER GC G90                            N . . . . . . . . . . . . F F . . . .
STEPPER GC G1 X1 F600                     N x . P . . . . . . S J H F F e e l L
STEPPER GC G2 I1 F600                     N P . P . . . . . . S J H F F e e l L
STEPPER GC G81 X1 Z-1 R1 F600             N x . P . . . . . . S J H F F e e l L
STEPPER GC G4 P10                         N . . . . . . . . . S J H F F e e l .
STEPPER GC M3                             N s . . . . . . . . S J H F F e e l .
STEPPER GC M5                             N s . . . . . . . . S J H F F e e l .
STEPPER GC M8                             N c . . . . . . . . S J H F F e e l .
STEPPER GC M0                             N . . . . . . . . . S J H F F e e l .
STEPPER GC M30                            N . . . . . . . . . . . . F F . . . .
STEPPER GC T1 M6                          N . . . . . . . . . S J H F F e e l .
STEPPER GC G92 X0                         N x . P . . . . . . S J H F F P P P .
STEPPER GC G10 L2 P1 X1                   N x . . . . . . . . . . . F F . . . .
STEPPER GC G28.1                          N P . P . . . . . . S J H F F P P P .
STEPPER GC G28 X0                         N x . . . r . . w w S J H F F E . . .
STEPPER GC G30                            N g . g . . . . . . S J H F F e e l L
STEPPER GC G38.3 X1 F600                  N x r P . r . . w w S J H F F e e l L
STEPPER GS "G91"                          N . . . . . . . . . . . . F F . . . .
STEPPER GCODE G1,X,1,F,600                N x . P . . . . . . S J H F F e e l L
"""


def run(state: str, lines: list[str], folder: Path) -> Session:
    """Type lines in a state."""
    before, events = STATES[state]
    return typed(folder, *before, *lines, events=events, switches=[SWITCH])


def rows() -> dict[str, list[str]]:
    """The columns of each command."""
    count = 2 * len(STATES)
    return {
        line[: -count + 1].rstrip(): line[-count + 1 :].split()
        for line in MATRIX.strip().splitlines()
    }


def column(state: str) -> dict[str, str]:
    """The letter of each command in a state."""
    place = list(STATES).index(state)
    return {command: letters[place] for command, letters in rows().items()}


def test_every_state_has_a_column() -> None:
    """Nothing is missing, and no letter is unknown."""
    for command, letters in rows().items():
        assert len(letters) == len(STATES), command
        assert set(letters) <= {".", "w", *ERRORS}, command


def test_no_command_is_forgotten() -> None:
    """Each row of the firmware whose name begins with STEPPER is in the matrix."""
    shown = subprocess.run(
        [STEPMITE, "--virtual"], input=b"HELP STEPPER\r", capture_output=True, check=True
    ).stdout.decode()
    names = re.findall(r"STEPPER [A-Z]+(?: [A-Z]+)*(?=[,\r])", shown.partition("\n> ")[2])
    assert len(names) > 40
    missing = [
        name for name in names if not any(f"{row} ".startswith(f"{name} ") for row in rows())
    ]
    assert missing == []


MOVING_STATES = ("moving", "dwelling", "stopping", "jogging", "homing", "file", "probing")


def still(status: str, state: str) -> str:
    """What must be the same before and after: all of it, or all but where the motors are now."""
    if state in MOVING_STATES:
        return re.sub(r"^[XYZA]: .*$|^Homing.*$|\d+ %", "", status, flags=re.MULTILINE)
    return status


@pytest.mark.parametrize("state", STATES)
def test_what_is_refused_changes_nothing(state: str, tmp_path: Path) -> None:
    """All that a state refuses, one after the other, each with its error."""
    refused = {command: letter for command, letter in column(state).items() if letter not in ".w"}
    lines = [line for command in refused for line in ("STEPPER STATUS", command)]
    session = run(state, [*lines, "STEPPER STATUS"], tmp_path)
    answers = session.answers[-len(lines) - 1 :]
    for i, (command, letter) in enumerate(refused.items()):
        before, answer, after = answers[2 * i : 2 * i + 3]
        assert error_of(answer) == ERRORS[letter], command
        assert still(after, state) == still(before, state), command


@pytest.mark.parametrize("state", STATES)
def test_what_is_allowed_is_done(state: str, tmp_path: Path) -> None:
    """Each in a session of its own, since it changes the state."""
    allowed = [command for command, letter in column(state).items() if letter == "."]
    assert len(allowed) > 0
    for command in allowed:
        assert error_of(run(state, [command], tmp_path).answers[-1]) == "", command


ENDS = {
    "moving": 50.0,
    "dwelling": 0.0,
    "holding": 50.0,
    "paused": 50.0,
    "jogging": 50.0,
    "file": 50.0,
    "probing": 50.0,
}


@pytest.mark.parametrize("state", ENDS)
def test_what_is_refused_does_not_disturb_motion(state: str, tmp_path: Path) -> None:
    """It ends exactly where it was to end."""
    refused = [command for command, letter in column(state).items() if letter not in ".w"]
    wait = "DO : PAUSE 10 : LOOP WHILE PEEK(STEPPER ACTIVE) = 1"
    session = run(state, [*refused, "STEPPER RESUME", wait, "?PEEK(STEPPER X)"], tmp_path)
    assert session.number() == ENDS[state]
    assert session.end("X") == ENDS[state]


@pytest.mark.parametrize("ending", ["RUN", "NEW", "STEPPER CLOSE"])
@pytest.mark.parametrize("state", list(STATES)[1:])
def test_the_machine_can_be_closed_and_set_up_again(
    state: str, ending: str, tmp_path: Path
) -> None:
    """From every state; each pin is free behind it, and the same set-up works."""
    before, events = STATES[state]
    paused = [*before, "STEPPER GC M0"] if state == "queued" else before
    pins = [f"SETPIN GP{gpio}, DIN : SETPIN GP{gpio}, OFF" for gpio in (*range(2, 23), 26)]
    session = typed(
        tmp_path,
        "AUTOSAVE\rPRINT 7\r\x1a",
        *paused,
        ending,
        "STEPPER STATUS",
        *pins,
        *SET_UP,
        "STEPPER POSITION HOME" if state != "E-STOP" else "",
        events=events,
        switches=[SWITCH],
    )
    behind = session.answers[len(paused) + 2 :]
    assert behind[0] == "Stepper not initialized"
    assert [error_of(answer) for answer in behind if error_of(answer)] == []
    assert session.output.count("\n 7\n") == (ending == "RUN")
