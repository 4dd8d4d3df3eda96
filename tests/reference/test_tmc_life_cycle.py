"""How long a set-up lasts, what happens while a statement waits, and what the monitor tells."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from one_driver import BARE, SET_UP, SGTHRS, TIE, TX, driven, last_write
from typed import READY, WAIT, Event, error_of, program
from wire_frames import frames, writes

# ---- Life cycle ----------------------------------------------------------------------------------


@pytest.mark.parametrize("ending", ["RUN", "NEW"])
def test_a_new_program_finds_all_wires_free(ending: str, tmp_path: Path) -> None:
    """RUN and NEW release them, write nothing, and put the switches back."""
    session = driven(
        tmp_path,
        "AUTOSAVE\rPRINT 7\r\x1a",
        SET_UP,
        TIE,
        "TMC22xx VERIFY 0",
        "TMC22xx MONITOR 0",
        ending,
        "TMC22xx STATUS",
        "SETPIN GP21, DIN",
    )
    assert session.errors() == []
    assert session.answers[-2] == "TMC22xx not initialized; verification is ON, monitor is ON"
    assert len(writes(session.edges, TX)) == len(writes(driven(tmp_path, SET_UP).edges, TX))


@pytest.mark.parametrize("ending", ["RUN", "NEW", "TMC22xx CLOSE"])
def test_no_frame_is_cut_off(ending: str, tmp_path: Path) -> None:
    """Whenever the end comes, while the monitor asks: all frames are whole."""
    asked = set()
    for tenths in (0, *range(3, 8), *range(22, 27)):
        wait = f"TIMER = 0 : DO : LOOP UNTIL TIMER >= {1000 + tenths / 10}"
        session = driven(tmp_path, "AUTOSAVE\rx = 1\r\x1a", f"{SET_UP} : {wait} : {ending}")
        assert session.errors() == []
        sent = frames(session.edges, TX)
        assert {len(frame.data) for frame in sent} == {4, 8}
        asked.add(len([frame for frame in sent if frame.start_ns > 1e9]))
    assert len(asked) > 1  # some came in the middle


@pytest.mark.parametrize(
    "line", ["STEPPER CLOSE", "STEPPER RESET", "CLEAR", "x = 1/0", "STEPPER CLOSE : STEPPER INIT"]
)
def test_what_does_not_concern_the_drivers(line: str, tmp_path: Path) -> None:
    """They stay set up and tied."""
    session = driven(tmp_path, *READY, SET_UP, TIE, line, "TMC22xx SGTHRS X, 5")
    assert error_of(session.last) == ""
    assert last_write(session, SGTHRS) == 5


def test_an_error_ends_the_program_and_leaves_the_drivers(tmp_path: Path) -> None:
    """Its message has the line, and the driver can be spoken to at the prompt."""
    text = f"AUTOSAVE\r{SET_UP}\rTMC22xx SGTHRS 0, 999\rPRINT 1\r\x1a"
    session = driven(tmp_path, text, "RUN", "PRINT PEEK(TMC 0, GCONF)")
    assert "[2]" in session.answers[-2]
    assert "value: 999 is invalid (valid is 0 to 255)" in session.answers[-2]
    assert session.number() == 0x1C0


@pytest.mark.parametrize(
    ("before", "end_mm"),
    [("OPTION ERROR STOP", 0), ("OPTION ERROR RUN", 100), ("ON ERROR IGNORE", 100)],
)
def test_a_driver_that_fails_is_an_error_like_others(
    before: str, end_mm: float, tmp_path: Path
) -> None:
    """It ends the program, and motion as OPTION ERROR says, unless ON ERROR has it skipped."""
    text = "\n".join(
        [before, *READY, SET_UP, TIE, "STEPPER GC G1 X100 F3000", "PAUSE 1200",
         "TMC22xx CURRENT X, 900", "PRINT MM.ERRNO <> 0", WAIT, "PRINT 3"]
    )  # fmt: skip
    drivers = ["tmc2209 tx=GP21 address=0 fault=unplugged@1000"]
    skipped = before.startswith("ON")
    session = program(tmp_path, text, drivers=drivers, code=0 if skipped else 1)
    assert ("No answer from address 0 on GP21 (pin 27)" in session.last) != skipped
    assert ("motion stops, what was queued is dropped" in session.last) == (end_mm == 0)
    assert session.last.endswith(" 1\n 3") == skipped
    if end_mm > 0:
        assert session.end("X") == end_mm
    else:
        assert 50 < session.end("X") < 75


# ---- Waiting -------------------------------------------------------------------------------------


def test_waiting_inside_an_expression(tmp_path: Path) -> None:
    """Operands that were computed before stay, through EVAL, functions and nested calls."""
    text = """
    TMC22xx GP21, 2209, 0, 800, 30, 16
    FUNCTION both(a, b$) : both = a + PEEK(TMC 0, CHOPCONF) : b$ = b$ + "!" : END FUNCTION
    a$ = "left" : n = 1000
    PRINT n + PEEK(TMC 0, CHOPCONF) * 2 - n = &H14030153 * 2
    PRINT LEFT$(a$ + STR$(PEEK(TMC 0, GCONF)), 7)
    PRINT EVAL("n + PEEK(TMC 0, GCONF)")
    PRINT MAX(PEEK(TMC 0, GCONF), PEEK(TMC 0, IOIN) AND 0, 3)
    DIM v(3) = (1, 2, PEEK(TMC 0, GCONF), 4)
    PRINT v(2)
    PRINT both(both(1, a$), a$) - 2 * &H14030153
    PRINT a$
    """
    shown = program(tmp_path, text, drivers=BARE).last
    assert shown.split() == ["1", "left448", "1448", "448", "448", "1", "left!!"]


def test_events_come_between_statements_only(tmp_path: Path) -> None:
    """SETTICK at 1 ms while each reading takes longer: none runs inside the statement."""
    text = """
    TMC22xx GP21, 2209, 0, 800, 30, 16
    SETTICK 1, tick
    FOR i = 1 TO 50
      inside = -ticks + 0 * PEEK(TMC 0, GCONF) + 0 * PEEK(TMC 0, CHOPCONF) + ticks
      IF inside <> 0 THEN PRINT "inside"
    NEXT
    SETTICK 0, 0
    PRINT ticks > 20
    SUB tick
      INC ticks
    END SUB
    """
    assert program(tmp_path, text, drivers=BARE).last.split() == ["1"]


# ---- Notices -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("fault", "told"),
    [
        ("over-temperature:125@2000", "hot"),
        ("over-temperature:165@2000", "overheated"),
        ("short@2000", "short circuit"),
        ("brown-out@2000", "lost its settings"),
        ("unplugged@2000", "does not answer"),
    ],
)
def test_the_monitor_tells_once(fault: str, told: str, tmp_path: Path) -> None:
    """While a program waits, naming pin and address; motion goes on."""
    drivers = [f"tmc2209 tx=GP21 address=0 fault={fault}"]
    session = driven(
        tmp_path,
        *READY,
        SET_UP,
        TIE,
        "STEPPER GC G1 X100 F600",
        "PAUSE 8000",
        WAIT,
        drivers=drivers,
    )
    assert session.output.count(told) == 1, session.output[-1500:]
    line = next(line for line in session.output.splitlines() if told in line)
    assert "GP21" in line
    assert "axis X" in line
    assert session.axis("X").end_steps() == 8000


def test_the_monitor_can_be_switched_off(tmp_path: Path) -> None:
    """Nothing is on the wire then, and nothing is told."""
    drivers = ["tmc2209 tx=GP21 address=0 fault=short@2000"]
    session = driven(tmp_path, SET_UP, "TMC22xx MONITOR 0", "PAUSE 8000", drivers=drivers)
    assert "short" not in session.output
    sent = frames(session.edges, TX)
    assert sent[-1].end_ns < 1e9


def test_the_monitor_does_not_move_an_edge(tmp_path: Path) -> None:
    """Once a second while four axes move."""
    move = "STEPPER GC G1 X150 Y100 Z30 A500 F3000"
    edges = []
    for switch in (0, 1):
        session = driven(
            tmp_path, SET_UP, f"TMC22xx MONITOR {switch}", *READY, move, WAIT, drivers=BARE
        )
        edges.append([np.diff(session.axis(axis).step_ns) for axis in "XYZA"])
        asked = [frame for frame in frames(session.edges, TX) if frame.start_ns > 1e9]
        assert (len(asked) > 2) == bool(switch)
    assert all(np.array_equal(off, on) for off, on in zip(*edges, strict=True))


def test_the_monitor_does_not_keep_the_program_from_ending(tmp_path: Path) -> None:
    """At the end of input the host program ends, and no time passes for the drivers."""
    session = driven(tmp_path, SET_UP, events=[Event(1, 9, 0)])
    assert frames(session.edges, TX)[-1].end_ns < 1e9
