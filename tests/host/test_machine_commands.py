"""The commands of the machine: what they take, refuse and show, and with which words."""

from __future__ import annotations

import re

import pytest
from test_host_port import run

INIT = ["STEPPER INIT"]
AXES = [*INIT, "STEPPER AXIS X,GP2,GP3,,,80,6000,500", "STEPPER AXIS A,GP8,GP9,,,10,3600,500"]
READY = [*AXES, "STEPPER POSITION HOME", "STEPPER RUN", "PAUSE 1"]


def answers(*lines: str) -> list[str]:
    """Type lines; return the answer to each, its lines joined by \\n."""
    text = "".join(f'{line}\r?"<{i}>"\r' for i, line in enumerate(lines))
    shown = run(text=text).stdout.decode().replace("\r", "")
    found = []
    for i, line in enumerate(lines):
        before, mark, shown = shown.partition(f'> ?"<{i}>"\n<{i}>\n')
        assert mark, line
        found.append(before.partition(f"> {line}\n")[2].removesuffix("\n"))
    return found


def number(text: str) -> float:
    """Return what PRINT has shown."""
    return float(text.strip())


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("STEPPER SCURVE", "Missing on"),
        ("STEPPER SCURVE 2", "on: 2 is invalid (valid is 0 to 1)"),
        ("STEPPER SCURVE on + 2", "on: 2 is invalid (valid is 0 to 1)"),
        (
            "PRINT PEEK(STEPPER FOO)",
            "what: FOO is invalid (valid is X, Y, Z, A, ACTIVE, STATUS, BUFFER, SPEED, EVENT, "
            "LINE, PERCENT, SPINDLE, COOLANT)",
        ),
        ("STEPPER ARC LEGACY", "Missing on"),
        ("STEPPER ARC LEGACY 2", "on: 2 is invalid (valid is 0 to 1)"),
        ("STEPPER ARC 0", "tolerance: 0 is invalid (valid is above 0 to 10)"),
        ("STEPPER JERK", "Missing value"),
        ("STEPPER JERK 0", "value: 0 is invalid (valid is 0.001 to 1000000000)"),
        ("STEPPER JERK -1", "value: -1 is invalid (valid is 0.001 to 1000000000)"),
        ("STEPPER JERK 1e10", "value: 1e+10 is invalid (valid is 0.001 to 1000000000)"),
        ("STEPPER JERK 100,,0", "y: 0 is invalid (valid is 0.001 to 1000000000)"),
        ("STEPPER JERK 1,2,3,4,5,6", "Too many arguments"),
        ("STEPPER OVERRIDE FEED", "Missing percent"),
        ("STEPPER OVERRIDE ,50", "Missing what"),
        ("STEPPER OVERRIDE FEED,9", "percent: 9 is invalid (valid is 10 to 200)"),
        ("STEPPER OVERRIDE FEED,201", "percent: 201 is invalid (valid is 10 to 200)"),
        ("STEPPER OVERRIDE RAPID,101", "percent: 101 is invalid (valid is 10 to 100 for RAPID)"),
        ("STEPPER OVERRIDE FAST,50", "what: FAST is invalid (valid is FEED, RAPID)"),
        ("STEPPER JOG", "Missing axis"),
        ("STEPPER JOG X", "Missing distance"),
        ("STEPPER JOG Y,1", "Y axis not configured (use STEPPER AXIS)"),
        ("STEPPER JOG Q,1", "axis: Q is invalid (valid is X, Y, Z, A)"),
        ("STEPPER JOG X,1,0", "feed: 0 is invalid (valid is 0.001 to 1000000000)"),
        (
            'STEPPER JOG X,"up"',
            "distance: up is invalid (valid is -1000000000 to 1000000000, +, -)",
        ),
        ("STEPPER GC G1 X1 F0", "F: 0 is invalid (valid is 0.001 to 1e+09)"),
        ("STEPPER GC G1 X1 F-5", "F: -5 is invalid (valid is 0.001 to 1e+09)"),
        ("STEPPER GCODE G1,X,1,F,0", "F: 0 is invalid (valid is 0.001 to 1e+09)"),
        ("STEPPER GC G1 F X1", "Missing value for F"),
    ],
)
def test_what_is_refused_is_named(line: str, error: str) -> None:
    """The message says which argument it is and what it may be."""
    assert answers(*READY, line)[-1] == f"Error : {error}"


@pytest.mark.parametrize(
    "line",
    [
        "SCURVE 1",
        "ARC LEGACY 1",
        "JERK 1",
        "OVERRIDE",
        "OVERRIDE FEED,50",
        "JOG X,1",
        "JOG STOP",
        "HOLD",
        "RESUME",
    ],
)
def test_nothing_works_before_init(line: str) -> None:
    """Each says so, and what to do."""
    assert answers(f"STEPPER {line}") == ["Error : Stepper not initialized (use STEPPER INIT)"]


def test_a_line_without_words_is_fine() -> None:
    """Nothing, blanks and comments."""
    assert answers(*INIT, "STEPPER GC", "STEPPER GC ' nothing", 'STEPPER GS ""')[1:] == [""] * 3


def test_status_shows_the_profile_and_init_resets_it() -> None:
    """Jerk limits of axes only where there are some."""
    change = ["STEPPER SCURVE 1", "STEPPER JERK 20000,,,,0.25", "STEPPER JUNCTION 0.1"]
    shown = answers(*AXES, *change, "STEPPER STATUS", "STEPPER CLOSE", *INIT, "STEPPER STATUS")
    assert "S-curve: ON, Jerk: 20000.0 mm/s^3, A 0.250 deg/s^3" in shown[-4].splitlines()
    assert "Junction deviation: 0.1 mm, arc tolerance: 0.05 mm" in shown[-4].splitlines()
    assert "S-curve: OFF, Jerk: 10000.0 mm/s^3" in shown[-1].splitlines()
    assert "Junction deviation: 0.02 mm, arc tolerance: 0.05 mm" in shown[-1].splitlines()


def test_status_shows_the_path_mode_and_init_resets_it() -> None:
    """As G-code would say it."""
    for code, shown in {
        "G61": "G61 exact path",
        "G61.1": "G61.1 exact stop",
        "G64": "G64",
        "G64 P0.1": "G64 P0.1",
    }.items():
        status = answers(*AXES, f"STEPPER GC {code}", "STEPPER ARC LEGACY 1", "STEPPER STATUS")[-1]
        assert f"Path mode: {shown}, A on arcs: ignored" in status.splitlines()
    again = ["STEPPER CLOSE", *INIT, "STEPPER STATUS"]
    status = answers(*AXES, "STEPPER GC G61", "STEPPER ARC LEGACY 1", *again)[-1]
    assert "Path mode: G64, A on arcs: turns along" in status.splitlines()


def test_s_curves_are_driven() -> None:
    """A move from rest to rest takes 4 (way / 2 jerk)^(1/3) if nothing else limits it.

    Below 1 mm/s the jerk may be more.
    """
    move = "TIMER=0:STEPPER GC G1 X50 F6000:DO:LOOP WHILE PEEK(STEPPER ACTIVE)=1:PRINT TIMER"
    for jerk in ("STEPPER JERK 1000", "STEPPER JERK 1e9,1000"):
        took_ms = number(answers(*READY, "STEPPER SCURVE 1", jerk, move)[-1])
        assert 0.93 < took_ms / (4000 * (50 / 2 / 1000) ** (1 / 3)) < 1.02
    trapezoid_ms = number(answers(*READY, "STEPPER SCURVE 0", "STEPPER JERK 1000", move)[-1])
    assert trapezoid_ms == pytest.approx(1000 * (50 / 100 + 100 / 500), rel=0.01)


def test_override_is_shown() -> None:
    """Without arguments, and by STATUS."""
    shown = answers(
        *INIT, "STEPPER OVERRIDE RAPID,50", "STEPPER OVERRIDE FEED,130", "STEPPER OVERRIDE"
    )
    assert shown[-1] == "Override: feed 130 %, rapid 50 %"


def test_hold_in_a_dwell() -> None:
    """The rest of the dwell comes behind the hold."""
    lines = [
        "STEPPER GC G4 P1000",
        "TIMER=0:STEPPER GC G1 X10 F6000",
        "PAUSE 500:STEPPER HOLD:PAUSE 3000:PRINT PEEK(STEPPER X)",
        "STEPPER STATUS",
        "STEPPER RESUME:DO:LOOP WHILE PEEK(STEPPER X)=0:PRINT TIMER",
    ]
    shown = answers(*READY, *lines)
    assert number(shown[-3]) == 0
    assert "motion: HOLD" in shown[-2]
    assert number(shown[-1]) == pytest.approx(4000, abs=50)


def test_jog_to_a_distance_to_a_limit_and_until_stopped() -> None:
    """With and without a known position; STATUS shows it."""
    shown = answers(
        *AXES,
        "STEPPER RUN",
        "PAUSE 1:STEPPER JOG X,-2*2.5,600",
        "PAUSE 100",
        "STEPPER STATUS",
        "PAUSE 2000:PRINT PEEK(STEPPER X)",
        "STEPPER POSITION HOME:STEPPER LIMITS X,-10,20",
        "STEPPER JOG X,+:PAUSE 5000:PRINT PEEK(STEPPER X)",
        'd$="-":STEPPER JOG X,d$,600:PAUSE 1000:STEPPER JOG STOP:PAUSE 500:PRINT PEEK(STEPPER X)',
        "STEPPER JOG A,-:PAUSE 500:STEPPER JOG A,0:PAUSE 3000:PRINT PEEK(STEPPER ACTIVE)",
    )
    state, first, _, limit, stopped, back = shown[-6:]
    assert "motion: JOG" in state
    assert number(first) == -5
    assert number(limit) == 20
    assert number(stopped) == pytest.approx(10, abs=0.3)
    assert number(back) == 0


def test_job_and_jog_exclude_each_other() -> None:
    """Neither starts while the other is under way."""
    shown = answers(
        *READY,
        "STEPPER JOG X,+,60",
        "STEPPER GC G1 X5 F600",
        "STEPPER JOG STOP:PAUSE 500",
        "STEPPER GC G1 X5 F600",
        "STEPPER JOG X,1",
    )
    assert shown[-4] == "Error : A jog is under way (use STEPPER JOG STOP)"
    assert shown[-2] == ""
    assert shown[-1] == "Error : No jogging while motion is active or G-code is queued"


@pytest.mark.parametrize(
    ("axis", "scale", "speed", "warning"),
    [
        ("X", 400, 7500, ""),
        ("X", 400, 7501, "X axis max speed limited to 7500.0 mm/min by the 50 kHz step rate"),
        ("A", 1000, 6000, "A axis max speed limited to 3000.0 deg/min by the 50 kHz step rate"),
    ],
)
def test_axis_warns_of_the_step_rate(axis: str, scale: int, speed: int, warning: str) -> None:
    """The speed that can be reached is in the warning and in STATUS; a move at it ends."""
    line = f"STEPPER AXIS {axis},GP2,GP3,,,{scale},{speed},5000"
    shown = answers(*INIT, line, "STEPPER STATUS")
    assert shown[1] == (f"Warning: {warning}" if warning else "")
    reached = re.search(r"max ([\d.]+) ", shown[2])
    assert reached
    assert float(reached[1]) == min(speed, 50_000 * 60 / scale)
    go = f"STEPPER GC G0 {axis}50:PAUSE 2500:PRINT PEEK(STEPPER {axis}); PEEK(STEPPER ACTIVE)"
    shown = answers(*INIT, line, "STEPPER POSITION HOME", "STEPPER RUN", go)
    assert shown[-1].split() == ["50", "0"]


def test_axes_may_follow_run_at_once() -> None:
    """The time that drivers get to wake up refuses nothing behind RUN and AXIS."""
    shown = answers(
        "STEPPER INIT : STEPPER RUN : STEPPER AXIS X,GP2,GP3,GP4 : STEPPER AXIS Y,GP5,GP6,GP7 "
        ": STEPPER POSITION X,3 : STEPPER SPINDLE GP8 : PRINT PEEK(STEPPER X)"
    )
    assert shown == ["Stepper initialized, buffer 32\nStepper armed\n 3"]


def test_on_and_off_where_0_or_1_is_asked_for() -> None:
    """Everywhere in STEPPER commands; OFF would be a variable, and ON as well, and 0."""
    status = answers(
        *INIT,
        "STEPPER SCURVE ON",
        "STEPPER HWLIMITS KEEP on",
        "STEPPER STATUS",
        "STEPPER SCURVE off",
        "STEPPER HWLIMITS KEEP OFF",
        "STEPPER STATUS",
    )
    for shown, scurve, keep in ((status[3], "ON", "YES"), (status[6], "OFF", "NO")):
        assert f"S-curve: {scurve}, " in shown
        assert f"drivers stay on behind a limit: {keep}" in shown


def test_peek_of_what_a_string_names() -> None:
    """A panel program may keep the names in an array."""
    words = ("EVENT", "LINE", "PERCENT", "SPINDLE", "COOLANT", "ACTIVE", "SPEED")
    shown = answers(*[f'PRINT PEEK(STEPPER "{word}")' for word in words])
    for word, answer in zip(words, shown, strict=True):
        assert number(answer) == (-1 if word == "ACTIVE" else 0), word
