"""G-code lines as users give them: three forms, dialects, messages, what survives INIT."""

from __future__ import annotations

import re

import pytest
from test_machine_commands import answers

AXES = [
    f"STEPPER AXIS {name},GP{2 + 2 * i},GP{3 + 2 * i},,,80,6000,500" for i, name in enumerate("XYZ")
]
SET_UP = ["STEPPER INIT", *AXES, "STEPPER SPINDLE GP10", "STEPPER COOLANT GP11,GP12"]
READY = [*SET_UP, "STEPPER POSITION HOME", "STEPPER RUN", "PAUSE 1"]
END = ["PAUSE 60000", "STEPPER STATUS"]

PROGRAM = """
G90 G94 G17 G49 G40 G80 G21
G10 L2 P2 X5 Y6 Z7
G55 M3 S8000 G0 X1 Y2
M8
G20 G1 X0.1 F10
G21 G91 G1 Z-1 F100
G90 G43.1 Z2
G0 Z0
G92 X3
G93 G1 X5 F2
G94 F300 G2 X7 I1
G54 G53 G0 Y0
G92.1 M9
G61.1 T4 G59.3
""".strip().splitlines()


def as_words(line: str) -> str:
    """Write a line for GCODE, which wants the letters and numbers apart."""
    words = re.findall(r"([A-Z])([-\d.]+)", line)
    pairs = ",".join(f"{letter},{number}" for letter, number in words[1:])
    first = words[0][0] + words[0][1]
    return f"STEPPER GCODE {first}" + (f",{pairs}" if pairs else "")


def test_three_forms_of_a_line_are_one() -> None:
    """The same program by GC, GS and GCODE ends in the same state, modes and positions included."""
    ends = []
    for form in (
        lambda line: f"STEPPER GC {line}",
        lambda line: f'STEPPER GS "{line}"',
        as_words,
    ):
        shown = answers(*READY, *[form(line) for line in PROGRAM], *END)
        assert shown[len(READY) : len(READY) + len(PROGRAM)] == [""] * len(PROGRAM)
        ends.append(shown[-1])
    assert ends[0] == ends[1] == ends[2]
    modes = "G0 G59.3 G17 G21 G90 G91.1 G94 G40 G98 G61.1 G43.1 M3 M9 T0 F300 S8000"
    assert f"G-code: {modes}" in ends[0].splitlines()
    assert "Work zero at machine X0.000 Y0.000 Z2.000" in ends[0].splitlines()
    assert "X: 11.537 mm, machine 11.537 mm (923 steps)" in ends[0].splitlines()


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("GCODE G1,X", "Missing value"),
        ("GCODE G1,XY,1", "Unknown parameter XY"),
        ("GCODE 5", "code: expected a string"),
        ("GCODE G1X1", "Unsupported code G1X1"),
        ("GCODE O100", "O words are not supported - use BASIC (SUB, DO, IF)"),
        ("GCODE G41", "Tool radius compensation (G41, G42) is left to the CAM program"),
        ("GCODE G1,G,0,X,1", "Two motion modes in one line"),
        ('GS "G0 X1 M49"', "Unsupported code M49"),
        ("GC G28 G91 Z0", "Z has no home switch (use STEPPER HWLIMITS)"),
        ("DIALECT", "Missing dialect"),
        ("DIALECT GRBL", "dialect: GRBL is invalid (valid is REFERENCE, NIST)"),
        ("BLOCKDELETE 2", "on: 2 is invalid (valid is 0 to 1)"),
        ("OPTIONALSTOP", "Missing on"),
    ],
)
def test_refusals(line: str, error: str) -> None:
    """Each names what is wrong."""
    assert answers(*READY, f"STEPPER {line}")[-1] == f"Error : {error}"


def test_dialects() -> None:
    """G4 waits milliseconds or seconds; INIT goes back to the reference's."""
    active = "?PEEK(STEPPER ACTIVE)"
    wait = ["STEPPER GC G4 P1.5", "PAUSE 100", active]
    assert answers(*READY, *wait)[-1].strip() == "0"
    nist = ["STEPPER DIALECT NIST", *wait]
    assert answers(*READY, *nist, "PAUSE 1500", active)[-3:] == [" 1", "", " 0"]
    again = ["STEPPER DIALECT NIST", "STEPPER CLOSE", *READY, *wait]
    assert answers(*READY, *again)[-1].strip() == "0"


def test_what_survives_init() -> None:
    """Systems, stored places and tool lengths do; G92 and the modes do not."""
    before = [
        "G10 L2 P1 X5",
        "G10 L1 P2 Z3",
        "G43 H2",
        "G0 X7 Z9",
        "G28.1",
        "G92 Y4",
        "G91 G20 G55",
    ]
    shown = answers(
        *READY,
        *[f"STEPPER GC {line}" for line in before],
        "PAUSE 5000",
        "STEPPER CLOSE",
        *READY,
        "STEPPER STATUS",
        "STEPPER GC G30 P1",
        *END,
    )
    fresh = shown[-4].splitlines()
    assert "G-code: G80 G54 G17 G21 G90 G91.1 G94 G40 G98 G64 G43.1 M5 M9 T0 F0 S0" in fresh
    assert "Work zero at machine X5.000 Y0.000 Z3.000" in fresh
    assert "X: 7.000 mm, machine 12.000 mm (960 steps)" in shown[-1].splitlines()


def test_messages_and_tools() -> None:
    """(MSG,...) when the line is read; the tool when the machine waits for it."""
    lines = ["STEPPER GC (MSG,Part 1 of 2) G0 X60", "STEPPER GC T7 M6", "PAUSE 100", "PAUSE 5000"]
    shown = answers(*READY, *lines)
    assert shown[-4] == "Part 1 of 2"
    assert shown[-2] == ""
    assert shown[-1] == "Tool 7: change it, then Ctrl-R or STEPPER RESUME"


def test_what_waits_for_room_goes_on_by_itself() -> None:
    """A line of three entries with a queue of one; the next line is refused meanwhile."""
    one = ["STEPPER INIT ,1", *READY[1:]]
    shown = answers(
        *one,
        "STEPPER GC M3 G4 P500 G0 X1",
        "STEPPER GC G0 X2",
        "?PEEK(STEPPER ACTIVE)",
        "PAUSE 2000",
        "?PEEK(STEPPER X),PEEK(STEPPER ACTIVE)",
    )
    assert shown[-5:] == ["", "Error : G-code buffer full", " 1", "", " 1\t 0"]


def test_a_stop_drops_what_waits() -> None:
    """Nothing of it comes later."""
    one = ["STEPPER INIT ,1", *READY[1:]]
    line = "STEPPER GC M3 G4 P500 G0 X1"
    shown = answers(*one, line, "STEPPER STOP", "PAUSE 2000", "?PEEK(STEPPER X)")
    assert shown[-1] == " 0"
