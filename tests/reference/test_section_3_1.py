"""Section 3.1 of the STEPPER reference: STEPPER GC, GS and GCODE."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from motion_checks import duration_s, places
from typed import READY, SET_UP, SPINDLE, WAIT, X_MIN, Y_MIN, Z_MIN, Switch, typed

START = ["STEPPER POSITION HOME", "STEPPER RUN"]
WITH_SPINDLE = [*SET_UP, f"STEPPER SPINDLE GP{SPINDLE}", *START]

FORMS = {
    "GC": lambda words: "STEPPER GC " + " ".join(words),
    "GS": lambda words: f'STEPPER GS "{" ".join(words)}"',
    "GCODE": lambda words: (
        "STEPPER GCODE " + ", ".join([words[0], *(f"{w[0]}, {w[1:]}" for w in words[1:])])
    ),
}


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize(
    ("words", "end"),
    [
        (["G0", "X10"], (10, 0, 0, 0)),
        (["G1", "X10", "Y5", "F500"], (10, 5, 0, 0)),
        (["G1", "Z3", "A20", "F6000"], (0, 0, 3, 20)),
        (["G2", "X10", "Y0", "I5", "F6000"], (10, 0, 0, 0)),
        (["G3", "X10", "Y10", "J10", "F6000"], (10, 10, 0, 0)),
        (["G2", "X10", "R8", "F6000"], (10, 0, 0, 0)),
        (["G4", "P100"], (0, 0, 0, 0)),
        (["G90"], (0, 0, 0, 0)),
        (["G91"], (0, 0, 0, 0)),
        (["G92", "X5", "Y6", "Z7", "A8"], (0, 0, 0, 0)),
        (["M3"], (0, 0, 0, 0)),
        (["M5"], (0, 0, 0, 0)),
    ],
    ids=lambda value: value[0] if isinstance(value, list) else "",
)
def test_each_code_in_each_form(form: str, words: list[str], end: tuple, tmp_path: Path) -> None:
    """The motors end where the words say."""
    session = typed(tmp_path, *WITH_SPINDLE, FORMS[form](words), WAIT)
    assert session.errors() == []
    assert tuple(session.end(name) for name in "XYZA") == end


def test_k_is_the_centre_along_z(tmp_path: Path) -> None:
    """In the planes with Z; a circle of radius 5 around X5."""
    session = typed(tmp_path, *READY, "STEPPER GC G18", "STEPPER GC G2 X0 Z0 I3 K4 F3000", WAIT)
    points = places(session, "XZ")
    assert np.abs(np.hypot(points[:, 0] - 3, points[:, 1] - 4) - 5).max() < 0.05


def test_g90_g91(tmp_path: Path) -> None:
    """Absolute and relative coordinates."""
    lines = ["G1 X10 F6000", "G91", "G1 X10", "G1 X-3", "G90", "G1 X1"]
    session = typed(tmp_path, *READY, *[f"STEPPER GC {line}" for line in lines], WAIT)
    assert session.errors() == []
    assert session.axis("X").steps().max() == 20 * 80
    assert session.end("X") == 1


def test_g92_sets_work_coordinates(tmp_path: Path) -> None:
    """This place gets the coordinate; nothing moves."""
    session = typed(
        tmp_path,
        *READY,
        "STEPPER GC G1 X10 F6000",
        WAIT,
        "STEPPER GC G92 X100",
        "PRINT PEEK(STEPPER X)",
        "STEPPER GC G1 X101",
        WAIT,
    )
    assert session.number(-3) == 100
    assert session.end("X") == 11


def test_spindle_and_dwell_wait_their_turn(tmp_path: Path) -> None:
    """Each happens between the moves around it, not when it is typed."""
    lines = ["G1 X5 F3000", "M3", "G4 P200", "G1 X10", "M5", "G1 X15"]
    session = typed(tmp_path, *WITH_SPINDLE, *[f"STEPPER GC {line}" for line in lines], WAIT)
    assert session.errors() == []
    step_ns = session.axis("X").step_ns
    spindle = session.edges.of(SPINDLE)
    assert spindle.level.tolist() == [1, 0]
    on, off = spindle.time_ns.tolist()
    assert step_ns[399] < on < step_ns[400]
    assert step_ns[799] < off < step_ns[800]
    assert step_ns[400] - step_ns[399] >= 200e6


@pytest.mark.parametrize(
    "line",
    ["STEPPER GC G4 P500", "STEPPER GCODE G4, P, 500", 'STEPPER GS "G4 P500"'],
)
def test_g4_is_in_milliseconds(line: str, tmp_path: Path) -> None:
    """P500 is half a second."""
    session = typed(tmp_path, *READY, "STEPPER GC G1 X1 F6000", line, "STEPPER GC G1 X2", WAIT)
    step_ns = session.axis("X").step_ns
    assert 500e6 <= step_ns[80] - step_ns[79] < 520e6


@pytest.mark.parametrize(
    ("line", "axes", "seconds"),
    [
        ("STEPPER GC G1 X10 Y5 F500", "XY", math.hypot(10, 5) / 500 * 60),
        ("STEPPER GC G1 A90 F360", "A", 90 / 360 * 60),
        ("STEPPER GCODE G1, X, 10, Y, 5, F, 500", "XY", math.hypot(10, 5) / 500 * 60),
        ("STEPPER GCODE G1, A, 90, F, 360", "A", 90 / 360 * 60),
        ("STEPPER GC G1 X10 A40 F500", "XA", 10 / 500 * 60),
    ],
)
def test_examples_and_the_meaning_of_f(
    line: str, axes: str, seconds: float, tmp_path: Path
) -> None:
    """mm/min over X, Y, Z with A along; degrees/min if A is alone."""
    session = typed(tmp_path, *READY, line, WAIT)
    assert session.errors() == []
    assert duration_s(session, axes) == pytest.approx(seconds, rel=0.02)


def test_gs_examples(tmp_path: Path) -> None:
    """A concatenation, a variable, a function's result."""
    session = typed(
        tmp_path,
        *READY,
        "x_pos = 3 : y_pos = 4",
        'STEPPER GS "G1 X" + STR$(x_pos) + " Y" + STR$(y_pos) + " F500"',
        'gcode$ = "G1 X6"',
        "STEPPER GS gcode$",
        'STEPPER GS UCASE$("g1 y" + STR$(2 * 4))',
        WAIT,
    )
    assert session.errors() == []
    assert (session.end("X"), session.end("Y")) == (6, 8)


def test_gcode_takes_expressions(tmp_path: Path) -> None:
    """Values and the code may be computed; letters may be strings."""
    session = typed(
        tmp_path,
        *READY,
        "n = 4",
        "STEPPER GCODE G1, X, n * 2.5, F, 500 + 100",
        'c$ = "G1" : STEPPER GCODE c$, "Y", SQR(n)',
        WAIT,
    )
    assert session.errors() == []
    assert (session.end("X"), session.end("Y")) == (10, 2)


@pytest.mark.parametrize(("legacy", "turned"), [(1, 0), (0, 90)])
def test_a_word_on_arcs(legacy: int, turned: float, tmp_path: Path) -> None:
    """Ignored as the reference has it with ARC LEGACY 1; else A turns along."""
    lines = [f"STEPPER ARC LEGACY {legacy}", "STEPPER GC G2 X10 I5 A90 F600", WAIT]
    session = typed(tmp_path, *READY, *lines)
    assert session.errors() == []
    assert session.end("A") == turned


@pytest.mark.parametrize("form", ["STEPPER GC", "STEPPER GCODE"])
def test_other_codes_are_refused_by_name(form: str, tmp_path: Path) -> None:
    """A code that does not exist is an error and changes nothing."""
    session = typed(tmp_path, *READY, f"{form} G77", f"{form} M99", "PRINT PEEK(STEPPER X)")
    assert len(session.errors()) == 2
    assert "G77" in session.errors()[0]
    assert "M99" in session.errors()[1]


# ---- G28 -----------------------------------------------------------------------------------------

SWITCHES = [Switch(X_MIN, "X", -10), Switch(Y_MIN, "Y", -8), Switch(Z_MIN, "Z", -2)]


@pytest.mark.parametrize(
    ("line", "axes"),
    [
        ("STEPPER GC G28", "XYZ"),
        ("STEPPER GC G28 X", "X"),
        ("STEPPER GC G28 X0", "X"),
        ("STEPPER GC G28 X1 Z1", "XZ"),
        ("STEPPER GC G28 Y0 A0", "Y"),
        ("STEPPER GCODE G28", "XYZ"),
        ("STEPPER GCODE G28, X, 0", "X"),
        ("STEPPER GCODE G28, X, 1, Y, 1", "XY"),
        ('STEPPER GS "G28 Z0"', "Z"),
    ],
)
def test_g28_homes_what_is_named(line: str, axes: str, tmp_path: Path) -> None:
    """Only these axes move, to their switches and off them; A never does."""
    session = typed(
        tmp_path,
        *SET_UP,
        "STEPPER HWLIMITS GP16,GP17,GP18",
        "STEPPER RUN",
        line,
        "FOR i = 1 TO 3 : PRINT PEEK(STEPPER X), PEEK(STEPPER Y), PEEK(STEPPER Z) : NEXT",
        switches=SWITCHES,
    )
    assert session.errors() == []
    for switch in SWITCHES:
        moved = session.axis(switch.axis).end_steps() != 0
        assert moved == (switch.axis in axes), switch.axis
    assert session.numbers()[:3] == [0, 0, 0]
    assert len(session.axis("A").step_ns) == 0


def test_g28_of_a_alone_homes_nothing(tmp_path: Path) -> None:
    """A cannot be homed, and nothing else was asked for."""
    session = typed(
        tmp_path, *SET_UP, "STEPPER HWLIMITS GP16,GP17,GP18", "STEPPER RUN", "STEPPER GC G28 A0"
    )
    assert len(session.errors()) == 1
    assert all(len(session.axis(name).step_ns) == 0 for name in "XYZA")
