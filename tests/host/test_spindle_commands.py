"""STEPPER SPINDLE and COOLANT, S words, pauses: what is typed, what is said, and the edges."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import pytest
from test_machine_commands import READY, answers
from test_program_pins import run

SETUP = """\
STEPPER INIT
STEPPER AXIS X,GP2,GP3,GP4,,80,6000,500
STEPPER POSITION HOME
"""
STEP, ENABLE, SPINDLE, DIR, FLOOD, MIST = 2, 4, 20, 21, 18, 19
WAIT = "DO WHILE PEEK(STEPPER ACTIVE) = 1 : PAUSE 1 : LOOP\n"
Edge = tuple[int, int, int]


def edges_of(rows: list[Edge], gpio: int) -> list[tuple[int, int]]:
    """Times in ns and levels of a pin."""
    return [(time, level) for time, pin, level in rows if pin == gpio]


def duty(rows: list[Edge], begin_ns: float, end_ns: float) -> float:
    """The part of the time between that the spindle's pin is high."""
    high, level, last = 0.0, 0, begin_ns
    for time, now in edges_of(rows, SPINDLE):
        if time > end_ns:
            break
        if time > begin_ns:
            high += (time - last) * level
            last = time
        level = now
    return (high + (end_ns - last) * level) / (end_ns - begin_ns)


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("STEPPER SPINDLE GP20,2", "invert: 2 is invalid (valid is 0 to 1)"),
        ("STEPPER SPINDLE GP20,,-1", "max_rpm: -1 is invalid (valid is 0 to 1000000)"),
        ("STEPPER SPINDLE GP20,,1000,1001", "Spindle min_rpm must not be above max_rpm"),
        ("STEPPER SPINDLE GP20,,,1", "Spindle min_rpm must not be above max_rpm"),
        ("STEPPER SPINDLE GP20,,1000,,0", "pwm_hz: 0 is invalid (valid is 1 to 1000000)"),
        (
            "STEPPER SPINDLE GP20,,1000,,2",
            "Frequency is out of reach (valid is 7.5 to 31250000 Hz)",
        ),
        ("STEPPER SPINDLE GP20,,,,,600001", "spinup_ms: 600001 is invalid (valid is 0 to 600000)"),
        ("STEPPER SPINDLE GP2", "Pin GP2 (pin 4) is in use by STEPPER X step"),
        ("STEPPER SPINDLE GP20,,,,,,GP20", "Pin GP20 (pin 26) is named twice"),
        ("STEPPER COOLANT GP18,GP18", "Pin GP18 (pin 24) is named twice"),
        ("STEPPER COOLANT GP3", "Pin GP3 (pin 5) is in use by STEPPER X dir"),
        ("STEPPER GC M3", "Spindle pin not configured (use STEPPER SPINDLE)"),
        ("STEPPER GC M7", "Coolant pin not configured (use STEPPER COOLANT)"),
        ("STEPPER GC M8", "Coolant pin not configured (use STEPPER COOLANT)"),
    ],
)
def test_what_is_refused(line: str, error: str) -> None:
    assert answers(*READY, line)[-1] == f"Error : {error}"
    assert "Spindle: none, OFF" in answers(*READY, line, "STEPPER STATUS")[-1]


def test_the_slice_is_shared_with_nobody() -> None:
    taken = "PWM slice 2 is in use by"
    found = answers(
        *READY,
        "SETPIN GP21,PWM",
        "STEPPER SPINDLE GP20,,1000",
        "SETPIN GP21,OFF",
        "STEPPER SPINDLE GP20,,1000",
        "SETPIN GP21,PWM",
        "PWM 2,OFF",
        "SETPIN GP21,DOUT",
        "STEPPER SPINDLE GP20",
        "SETPIN GP21,OFF",
        "SETPIN GP21,PWM",
    )[len(READY) :]
    assert found == [
        "",
        f"Error : {taken} PWM",
        "",
        "",
        f"Error : {taken} STEPPER spindle",
        f"Error : {taken} STEPPER spindle",
        "",
        "",
        "",
        "",
    ]


def test_status() -> None:
    status = answers(
        *READY,
        "STEPPER SPINDLE GP20,1,10000,500,2000,10,GP21",
        "STEPPER COOLANT GP18,,1",
        "STEPPER GC M4 S2500",
        "STEPPER GC M8",
        "PAUSE 100",
        "STEPPER STATUS",
    )[-1]
    assert "Spindle: GP20 (pin 26) inverted, ON 2500 rpm of 500 to 10000, PWM 2000 Hz, " in status
    assert "dir GP21 (pin 27) CCW, spin-up 10 ms\n" in status
    assert "Coolant: flood GP18 (pin 24) ON, mist none OFF, inverted\n" in status


def test_peek() -> None:
    found = answers(
        *READY,
        "? PEEK(STEPPER SPINDLE); PEEK(STEPPER COOLANT)",
        "STEPPER SPINDLE GP20,1,10000,500,,,GP21",
        "STEPPER COOLANT GP18,GP19",
        "STEPPER GC M4 S2500 M7",
        "PAUSE 10",
        "? PEEK(STEPPER SPINDLE); PEEK(STEPPER COOLANT)",
        "STEPPER GC M3 S1 M8",
        "PAUSE 10",
        "? PEEK(STEPPER SPINDLE); PEEK(STEPPER COOLANT)",
        "STEPPER GC M5 M9",
        "PAUSE 10",
        "? PEEK(STEPPER SPINDLE); PEEK(STEPPER COOLANT)",
        "STEPPER SPINDLE GP20,,,,,,GP21",
        "STEPPER GC M4",
        "PAUSE 10",
        "? PEEK(STEPPER SPINDLE)",
    )
    shown = [line.split() for line in found if re.match(r" *-?[0-9.]+( |$)", line)]
    assert shown == [["0", "0"], ["-2500", "1"], ["500", "3"], ["0", "0"], ["-1"]]


def test_a_speed_too_high_is_said_once(tmp_path: Path) -> None:
    program = f"""\
{SETUP}STEPPER SPINDLE GP20,,1000
STEPPER RUN
STEPPER GC M3 S1001
STEPPER GC G1 X1 F600 S2000
{WAIT}STEPPER GC M5
"""
    printed, _ = run(tmp_path, program)
    assert [line for line in printed if "max_rpm" in line] == [
        "Warning: S is above the spindle's max_rpm and limited to it"
    ]


def test_laser_in_motion(tmp_path: Path) -> None:
    """Each piece of a line with its power, without a stop between them."""
    program = f"""\
{SETUP}STEPPER SPINDLE GP20,,1000,,20000
STEPPER GC M3 S0
STEPPER GC G1 X5 F3000 S100
STEPPER GC X15 S700
STEPPER GC X20 S0
STEPPER GC X25 S300
STEPPER GC M5
STEPPER RUN
{WAIT}PRINT "done"
"""
    printed, rows = run(tmp_path, program)
    assert printed[-1] == "done"
    steps = [time for time, level in edges_of(rows, STEP) if level]
    assert len(steps) == 2000
    gaps = [b - a for a, b in pairwise(steps)]
    assert max(gaps[220:1780]) <= 260_000  # 50 mm/s all the way between the ramps
    for first, last, power in ((0, 400, 100), (400, 1200, 700), (1200, 1600, 0), (1600, 2000, 300)):
        begin, end = steps[first + 1], steps[last - 1]
        assert duty(rows, begin, end) == pytest.approx(power / 1000, abs=0.002)
    assert edges_of(rows, SPINDLE)[-1][1] == 0
    assert steps[-1] < edges_of(rows, SPINDLE)[-1][0] < steps[-1] + 8_000_000  # half a step on


@pytest.mark.parametrize("invert", [0, 1])
def test_coolant_and_spindle_around_a_pause(tmp_path: Path, invert: int) -> None:
    """M0 holds; an event tells the program, which resumes; everything in its order."""
    program = f"""\
{SETUP}STEPPER SPINDLE GP20,{invert},,,,50,GP21
STEPPER COOLANT GP18,GP19,{invert}
ON STEPPER EVENT happened
STEPPER RUN ,1
STEPPER GC M4
STEPPER GC M7
STEPPER GC M8
STEPPER GC G1 X1 F600
STEPPER GC M0
STEPPER GC M9
STEPPER GC G1 X2
STEPPER GC M5
{WAIT}END
SUB happened
  LOCAL kind = PEEK(STEPPER EVENT)
  IF kind <> 8 THEN EXIT SUB
  PRINT "at"; PEEK(STEPPER X); PEEK(STEPPER ACTIVE)
  PAUSE 300
  STEPPER RESUME
END SUB
"""
    printed, rows = run(tmp_path, program)
    assert printed.count("Paused (Ctrl-R or STEPPER RESUME goes on)") == 1
    assert "at 1 1" in printed
    on = 1 - invert
    steps = [time for time, level in edges_of(rows, STEP) if level]
    assert len(steps) == 160
    assert steps[80] - steps[79] > 300e6
    ((start, _),) = [edge for edge in edges_of(rows, SPINDLE) if edge[1] == on]
    assert 50e6 <= steps[0] - start < 70e6
    assert edges_of(rows, SPINDLE)[-1][1] == invert
    assert edges_of(rows, SPINDLE)[-1][0] > steps[-1]
    assert [level for _, level in edges_of(rows, DIR)] == [1]
    for pin in (FLOOD, MIST):
        switched = [edge for edge in edges_of(rows, pin) if edge[0] > start]
        assert [level for _, level in switched[:2]] == [on, invert]
        assert switched[0][0] < steps[0]
        assert steps[79] + 300e6 < switched[1][0] < steps[80]
    # Drivers that go off when idle stay on in the pause.
    assert all(not steps[0] < time < steps[-1] for time, _ in edges_of(rows, ENABLE))


def test_stop_leaves_the_spindle_and_close_does_not(tmp_path: Path) -> None:
    program = f"""\
{SETUP}STEPPER SPINDLE GP20
STEPPER RUN
STEPPER GC M3
STEPPER GC G1 X50 F3000
PAUSE 300
STEPPER STOP
{WAIT}PRINT PIN(GP20)
STEPPER HOLD : STEPPER RESUME
PRINT PIN(GP20)
STEPPER CLOSE
"""
    printed, rows = run(tmp_path, program)
    assert [line.strip() for line in printed if line.strip() in "01"] == ["1", "1"]
    assert [level for _, level in edges_of(rows, SPINDLE)] == [1, 0]


LASER = ["STEPPER SPINDLE GP20,,1000,,20000", "STEPPER LASER 1"]


def test_what_a_laser_needs() -> None:
    found = answers(
        *READY,
        "STEPPER LASER 1",
        "STEPPER SPINDLE GP20,,1000",
        "STEPPER GC M4 S100",
        *LASER,
        "STEPPER GC M4 S100",
        "STEPPER STATUS",
        "? PEEK(STEPPER SPINDLE)",
        "STEPPER SPINDLE GP20",
        "STEPPER LASER 0",
        "STEPPER GC M4",
    )[len(READY) :]
    needs_pwm = "Error : A laser needs PWM (use STEPPER SPINDLE with max_rpm)"
    no_dir = "Error : Spindle has no dir_pin for M4 (use STEPPER SPINDLE)"
    assert found[0] == needs_pwm
    assert found[2] == no_dir
    assert "PWM 20000 Hz, laser M4\n" in found[6]
    assert found[7].strip() == "0"  # nothing moves
    assert found[8:] == [needs_pwm, "", no_dir]


@pytest.mark.parametrize("ending", ["", "M5", "M2", "G1 X1 X2"])
def test_a_laser_is_off_behind_a_file(tmp_path: Path, ending: str) -> None:
    """However it ends; what is typed then burns nothing until M3 or M4."""
    lines = ["M4 S500", "G1 X5 F3000", *([ending] if ending else [])]
    writing = "".join(f'PRINT #1, "{line}"\n' for line in lines)
    setup = "\n".join(LASER)
    program = f"""\
{SETUP}{setup}
OPEN "a.nc" FOR OUTPUT AS #1
{writing}CLOSE #1
STEPPER RUN
STEPPER FILE "a.nc"
{WAIT}PAUSE 5
STEPPER GC G1 X10 F3000 S700
{WAIT}STEPPER GC M3
STEPPER GC G1 X15
{WAIT}STEPPER CLOSE
"""
    _, rows = run(tmp_path, program)
    steps = [time for time, level in edges_of(rows, STEP) if level]
    assert len(steps) == 1200
    end = steps[-1] + 20e6
    seconds = [
        duty(rows, a, b) * (b - a) * 1e-9
        for a, b in ((0, steps[401]), (steps[401], steps[799]), (steps[799], end))
    ]
    assert seconds[0] == pytest.approx(0.5 * 5 / 50, abs=0.0005)
    assert seconds[1] == 0.0
    assert seconds[2] > 0.7 * 5 / 50
