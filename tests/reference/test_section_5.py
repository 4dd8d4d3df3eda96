"""Section 5 of the STEPPER reference: RUN, CLEAR, STATUS, CLOSE and the PEEKs."""

from __future__ import annotations

from pathlib import Path

import pytest
from typed import AXES, ENABLE_X, ESTOP, READY, SET_UP, SPINDLE, WAIT, Event, typed

MOVE = "STEPPER GC G1 X5 F3000"
HOME = "STEPPER POSITION HOME"


def test_run_executes_what_is_buffered(tmp_path: Path) -> None:
    """Nothing moves before it; what waits then begins."""
    session = typed(tmp_path, *SET_UP, HOME, MOVE, "PAUSE 500", "STEPPER RUN", WAIT)
    assert session.errors() == []
    assert session.answers[-2].startswith("Stepper armed")
    assert session.axis("X").step_ns[0] / 1e6 > session.typed_ms[-3]
    assert session.end("X") == 5


@pytest.mark.parametrize("line", ["STEPPER RUN", "STEPPER RUN 0", "STEPPER RUN ,0"])
def test_mode_0_keeps_drivers_on(line: str, tmp_path: Path) -> None:
    """Armed and idle: enabled."""
    session = typed(tmp_path, *SET_UP, HOME, line, MOVE, WAIT, "PAUSE 1000", "PRINT 1")
    assert session.level_at(ENABLE_X, session.typed_ms[-2]) == 0
    assert session.edges.of(ENABLE_X).level.tolist() == [1, 0]


@pytest.mark.parametrize("line", ["STEPPER RUN 1", "STEPPER RUN ,1"])
def test_mode_1_turns_drivers_off_when_idle(line: str, tmp_path: Path) -> None:
    """Off when the queue is empty, on again by new work, off again behind it."""
    session = typed(
        tmp_path,
        *SET_UP,
        HOME,
        line,
        MOVE,
        WAIT,
        "PAUSE 1000",
        "STEPPER GC G1 X0",
        WAIT,
        "PAUSE 100",
        "STEPPER STATUS",
    )
    assert session.errors() == []
    assert session.end("X") == 0
    step_ms = session.axis("X").step_ns / 1e6
    assert session.level_at(ENABLE_X, step_ms[0]) == 0
    assert session.level_at(ENABLE_X, session.typed_ms[-5]) == 1
    assert session.level_at(ENABLE_X, step_ms[400]) == 0
    assert session.level(ENABLE_X) == 1
    assert "Drivers off when idle: ON" in session.last


def test_clear_empties_the_buffer_at_rest_only(tmp_path: Path) -> None:
    """What waits is gone; while an axis moves it is refused and the move goes on."""
    session = typed(
        tmp_path,
        *SET_UP,
        HOME,
        MOVE,
        "STEPPER CLEAR",
        "PRINT PEEK(STEPPER BUFFER)",
        "STEPPER RUN",
        "PAUSE 100",
        MOVE,
        "PAUSE 50",
        "STEPPER CLEAR",
        WAIT,
    )
    assert session.number(-7) == 64
    assert session.errors() == ["Cannot clear buffer while motion active"]
    assert session.end("X") == 5


def test_status_tells_all(tmp_path: Path) -> None:
    """Positions, buffer, configuration, mode when idle."""
    session = typed(
        tmp_path,
        "STEPPER INIT ,64,GP22",
        *AXES,
        "STEPPER SPINDLE GP14",
        HOME,
        "STEPPER LIMITS X,-10,200",
        "STEPPER RUN ,1",
        "STEPPER GC G1 X12.5 F6000",
        WAIT,
        "STEPPER GC G92 X0",
        "STEPPER STATUS",
    )
    assert session.errors() == []
    for text in (
        "Armed: YES",
        "motion: IDLE",
        "position known: YES",
        "of 64",
        "Drivers off when idle: ON",
        "S-curve: OFF",
        "E-STOP: GP22",
        "GP14",
        "X: 0.000 mm, machine 12.500 mm (1000 steps)",
        "step GP2 (pin 4), dir GP3 (pin 5), enable GP4 (pin 6)",
        "80 steps/mm, max 6000 mm/min, 500 mm/s^2",
        "-10.000 to 200.000",
        "A: 0.000 deg",
    ):
        assert text in session.last, text


def test_close_gives_the_pins_back(tmp_path: Path) -> None:
    """They can be used otherwise, and INIT starts anew."""
    session = typed(
        tmp_path,
        *SET_UP,
        f"STEPPER SPINDLE GP{SPINDLE}",
        HOME,
        "STEPPER RUN",
        MOVE,
        "STEPPER CLOSE",
        "PRINT PEEK(STEPPER ACTIVE)",
        "SETPIN GP2,DOUT",
        "SETPIN GP14,DIN",
        "SETPIN GP4,OFF",
        "SETPIN GP2,OFF",
        "SETPIN GP14,OFF",
        *SET_UP,
    )
    assert session.errors() == []
    assert session.number(-11) == -1


def test_peek_position_is_of_the_work(tmp_path: Path) -> None:
    """mm and degrees, with the offset of G92, as clean numbers; also on the way."""
    session = typed(
        tmp_path,
        *READY,
        "STEPPER GC G1 X33.3 Y1.5 Z0.25 A40.1 F6000",
        "PAUSE 200",
        "PRINT PEEK(STEPPER X)",
        WAIT,
        "STEPPER GC G92 Y0",
        "PRINT PEEK(STEPPER X), PEEK(STEPPER Y), PEEK(STEPPER Z), PEEK(STEPPER A)",
    )
    assert 0 < session.number(-4) < 33
    assert session.last.split() == ["33.3", "0", "0.25", "40.1"]


def test_peek_of_an_axis_that_is_not_there(tmp_path: Path) -> None:
    """An error that names it."""
    session = typed(tmp_path, "STEPPER INIT", "PRINT PEEK(STEPPER Z)")
    assert session.errors() == ["Z axis not configured (use STEPPER AXIS)"]


def test_peek_active(tmp_path: Path) -> None:
    """-1 before INIT, 0 idle, 1 while there is something to do."""
    ask = "PRINT PEEK(STEPPER ACTIVE)"
    session = typed(
        tmp_path, ask, *READY, WAIT, ask, MOVE, ask, "PAUSE 500", ask, "STEPPER GC G4 P100", ask
    )
    assert [session.number(n) for n in (0, -7, -5, -3, -1)] == [-1, 0, 1, 0, 1]


def test_peek_status_bits_6_and_7(tmp_path: Path) -> None:
    """E-STOP asserted, position known."""
    ask = "PRINT PEEK(STEPPER STATUS)"
    events = [Event(0, ESTOP, 1), Event(100, ESTOP, 0), Event(200, ESTOP, 1)]
    session = typed(
        tmp_path,
        "STEPPER INIT ,,GP22",
        *AXES,
        ask,
        HOME,
        ask,
        "PAUSE 150",
        ask,
        "PAUSE 100",
        ask,
        events=events,
    )
    assert [int(session.number(n)) & 192 for n in (-7, -5, -3, -1)] == [0, 128, 192, 128]


@pytest.mark.parametrize(("gpio", "bit"), [(16, 0), (19, 1), (17, 2), (20, 3), (18, 4), (21, 5)])
def test_peek_status_bits_of_limits(gpio: int, bit: int, tmp_path: Path) -> None:
    """Each switch has its bit, which follows its level."""
    ask = "PRINT PEEK(STEPPER STATUS) AND 63"
    session = typed(
        tmp_path,
        *SET_UP,
        "STEPPER HWLIMITS GP16,GP17,GP18,GP19,GP20,GP21",
        "PAUSE 15",
        ask,
        "PAUSE 10",
        ask,
        events=[Event(10, gpio, 0), Event(20, gpio, 1)],
    )
    assert [int(session.number(n)) for n in (-3, -1)] == [1 << bit, 0]


def test_peek_buffer_throttles(tmp_path: Path) -> None:
    """Free slots: it falls by one for each line; a line into 0 is refused and loses nothing."""
    session = typed(
        tmp_path,
        "STEPPER INIT ,4",
        *AXES,
        HOME,
        *[
            line
            for n in range(1, 6)
            for line in (f"STEPPER GC G1 X{n} F600", "PRINT PEEK(STEPPER BUFFER)")
        ],
        "STEPPER RUN",
        WAIT,
        "PRINT PEEK(STEPPER BUFFER)",
    )
    shown = [session.number(n) for n in (-12, -10, -8, -6, -4)]
    assert shown == [3, 2, 1, 0, 0]
    assert session.errors() == ["G-code buffer full"]
    assert session.number() == 4
    assert session.end("X") == 4
