"""What becomes of the machine when programs begin and end: RUN, NEW, END, errors, CLOSE.

Motion ends by a controlled stop, never by letting the steps fall away; a program that sets the
machine up works a second time; nothing is left claimed, floating or moving unnoticed.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from typed import AXES, ENABLE_X, READY, SET_UP, STEP_X, STEPMITE, WAIT, Session, typed

CTRL_Z = "\x1a"
MOVE = "STEPPER GC G1 X100 F3000"
SPEED_STEPS_S = 3000 / 60 * 80
ACCELERATION_STEPS_S2 = 500 * 80
"""Of X in AXES, whose driver is turned on before each move."""


def stored(*lines: str) -> str:
    """What has to be typed to store a program."""
    return "AUTOSAVE\r" + "".join(line + "\r" for line in lines) + CTRL_Z


def step_times_s(session: Session) -> np.ndarray:
    """When X made its steps."""
    steps = session.edges.of(STEP_X)
    return np.asarray(steps.time_ns)[np.asarray(steps.level) == 1] / 1e9


def stops_gently(times_s: np.ndarray) -> bool:
    """Whether the steps end by braking: within the axis's acceleration down to a slow last step."""
    gaps = np.diff(times_s)
    last_speed = 1 / gaps[-1]
    return last_speed < 4 * np.sqrt(ACCELERATION_STEPS_S2) and gaps[-200:].max() == gaps[-1]


def test_the_judge_sees_a_sudden_end() -> None:
    """Even steps that just end are no controlled stop."""
    assert not stops_gently(np.arange(1000) / SPEED_STEPS_S)


@pytest.mark.parametrize(
    "ending",
    ["RUN", "NEW", "STEPPER CLOSE", "STEPPER STOP"],
)
def test_motion_under_way_ends_by_a_controlled_stop(ending: str, tmp_path: Path) -> None:
    """RUN, NEW and CLOSE wait until the motors stand; then the drivers are off."""
    program = stored("PRINT PEEK(STEPPER ACTIVE)")
    session = typed(tmp_path, program, *READY, MOVE, "PAUSE 500", ending, "PAUSE 300")
    times = step_times_s(session)
    assert stops_gently(times)
    assert 1000 < len(times) < 7900, "it was stopped in the middle"
    assert not session.errors()
    ended_ms = session.typed_ms[-2]
    if ending != "STEPPER STOP":
        assert times[-1] * 1000 <= ended_ms, "the command waits for standstill"
        assert session.level(ENABLE_X) == 1
    if ending == "RUN":
        assert session.answers[-2].endswith("-1"), "closed as after power-up"


def test_a_program_that_sets_the_machine_up_runs_again(tmp_path: Path) -> None:
    """INIT and AXIS find their pins free each time; the second run moves as the first did."""
    program = stored(*SET_UP, "STEPPER POSITION HOME", "STEPPER RUN", MOVE, WAIT)
    session = typed(tmp_path, program, "RUN", "RUN", "STEPPER STATUS")
    assert not session.errors()
    times = step_times_s(session)
    assert len(times) == 16000
    first, second = times[:8000], times[8000:]
    assert np.allclose(np.diff(first), np.diff(second), atol=1e-8)


def test_a_program_may_say_run_itself(tmp_path: Path) -> None:
    """The loop over programs closes the machine in between as well."""
    program = stored(
        "PRINT PEEK(STEPPER ACTIVE)",
        *SET_UP,
        "STEPPER POSITION HOME",
        "STEPPER RUN",
        'IF MM.CMDLINE$ <> "again" THEN RUN , "again"',
    )
    session = typed(tmp_path, program, "RUN")
    assert session.answers[1].count("-1") == 2, session.answers[1]
    assert not session.errors()


@pytest.mark.parametrize("ending", ["END", "PRINT 1"])
def test_the_end_of_a_program_leaves_motion_alone(ending: str, tmp_path: Path) -> None:
    """The prompt is back while the machine works, and everything stays as it is."""
    program = stored(*READY, MOVE, ending)
    session = typed(tmp_path, program, "RUN", "?PEEK(STEPPER ACTIVE)", WAIT, "?PEEK(STEPPER X)")
    assert session.number(2) == 1
    assert session.number() == 100
    assert len(step_times_s(session)) == 8000
    assert session.level(ENABLE_X) == 0, "the drivers stay on"


def test_an_error_in_a_program_stops_gently_and_keeps_the_place(tmp_path: Path) -> None:
    """Drivers on, position known; OPTION ERROR RUN lets the queue run out instead."""
    program = stored(*READY, MOVE, "PAUSE 500", "PRINT 1/0")
    session = typed(
        tmp_path, program, "RUN", "PAUSE 300", "?PEEK(STEPPER X)", "?PEEK(STEPPER STATUS)"
    )
    assert "Divide by zero" in session.errors()[0]
    times = step_times_s(session)
    assert stops_gently(times)
    assert session.number(3) == pytest.approx(len(times) / 80, abs=1e-9)
    assert session.number(4) == 128, "position known"
    assert session.level(ENABLE_X) == 0


@pytest.mark.parametrize("mistake", ["PRNT 1", "STEPPER GC G1 X", "STEPPER AXIS X", 'RUN "nofile"'])
def test_a_mistake_at_the_prompt_disturbs_nothing(mistake: str, tmp_path: Path) -> None:
    """Neither a typo nor a refused command touches the motion under way."""
    session = typed(tmp_path, *READY, MOVE, "PAUSE 200", mistake, WAIT, "?PEEK(STEPPER X)")
    assert len(session.errors()) == 1
    assert session.number() == 100
    assert len(step_times_s(session)) == 8000


def test_close_frees_all_pins(tmp_path: Path) -> None:
    """A program may use them; an enable pin is pulled to off until then."""
    pins = [f"SETPIN GP{gpio}, DIN" for gpio in (2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 22)]
    spindle = "STEPPER SPINDLE GP14"
    session = typed(
        tmp_path,
        "STEPPER INIT ,,GP22",
        *AXES,
        spindle,
        "STEPPER CLOSE",
        "PAUSE 1",
        *pins,
    )
    assert not session.errors()
    assert session.level_at(ENABLE_X, session.typed_ms[len(AXES) + 3]) == 1


def test_run_and_new_forget_the_machine(tmp_path: Path) -> None:
    """As after power-up."""
    session = typed(tmp_path, stored("PRINT 1"), *READY, "NEW", "STEPPER STATUS", "SETPIN GP2, DIN")
    assert session.answers[-2] == "Stepper not initialized"
    assert not session.errors()


def test_run_mode_1_turns_drivers_off_between_jobs(tmp_path: Path) -> None:
    """Off when the queue drains, on before the next step; mode 0 keeps them on."""
    session = typed(
        tmp_path,
        *SET_UP,
        "STEPPER POSITION HOME",
        "STEPPER RUN ,1",
        "STEPPER GC G1 X1 F3000",
        WAIT,
        "PAUSE 50",
        "STEPPER GC G1 X2",
        WAIT,
        "PAUSE 50",
        "STEPPER RUN ,0",
        "STEPPER GC G1 X3",
        WAIT,
        "PAUSE 50",
    )
    assert not session.errors()
    enable = session.edges.of(ENABLE_X)
    levels = list(np.asarray(enable.level))
    times = np.asarray(enable.time_ns) / 1e9
    assert levels == [1, 0, 1, 0, 1, 0], "off at AXIS, then on and off for each move, then on"
    steps = step_times_s(session)
    for on, off, move in ((1, 2, steps[:80]), (3, 4, steps[80:160])):
        assert times[on] < move[0]
        assert move[-1] < times[off]
        assert move[0] - times[on] > 20e-6, "time for the driver to wake up"
    assert session.level(ENABLE_X) == 0


FILE = (
    'OPEN "f.nc" FOR OUTPUT AS #1 : FOR i = 1 TO 99 : PRINT #1, "G1 X"; i; "F3000" : NEXT : CLOSE'
)
HOMING = [
    "STEPPER HWLIMITS GP16,GP17,GP18",
    "STEPPER HOME X,,3000",
    "STEPPER HOME RUN X",
    "PAUSE 500",
]
BACKGROUND = {"a file": ['STEPPER FILE "f.nc"', "PAUSE 500"], "homing": HOMING}
"""What may be under way in the background."""


@pytest.mark.parametrize("what", BACKGROUND)
@pytest.mark.parametrize(
    "ending", ["RUN", "NEW", "STEPPER CLOSE", "STEPPER STOP", "STEPPER RECOVER", "PRINT 1\x03"]
)
def test_nothing_runs_on_in_the_background(what: str, ending: str, tmp_path: Path) -> None:
    """A file and homing end with the motion, by a controlled stop, and can be begun again."""
    work = [*READY, *BACKGROUND[what]]
    session = typed(
        tmp_path,
        stored("PRINT PEEK(STEPPER ACTIVE)"),
        FILE,
        *work,
        ending,
        "PAUSE 300",
        "?PEEK(STEPPER ACTIVE)",
        "STEPPER CLOSE : PRINT" if ending.startswith(("STEPPER S", "STEPPER R", "PRINT")) else "",
        *work,
        "?PEEK(STEPPER ACTIVE)",
        "STEPPER STOP",
        "PAUSE 300",
    )
    assert not session.errors()
    assert session.numbers(len(work) + 4)[0] in (-1, 0)
    assert session.number(-3) == 1, "it runs again"
    times = step_times_s(session)
    first = times[times * 1000 < session.typed_ms[len(work) + 4]]
    assert len(first) > 100
    assert stops_gently(first)


def test_an_error_in_a_program_ends_its_file(tmp_path: Path) -> None:
    """As it ends motion; with OPTION ERROR RUN the file goes on."""
    lines = [*READY, 'STEPPER FILE "f.nc"', "PAUSE 500", "PRINT 1/0"]
    session = typed(
        tmp_path,
        FILE,
        stored(*lines),
        "RUN",
        "PAUSE 300",
        "?PEEK(STEPPER ACTIVE)",
        "?PEEK(STEPPER X)",
    )
    assert session.number(4) == 0
    assert stops_gently(step_times_s(session))
    session = typed(
        tmp_path, FILE, "OPTION ERROR RUN", stored(*lines), "RUN", WAIT, "?PEEK(STEPPER X)"
    )
    assert session.number() == 99


def test_init_sets_everything_as_it_was_at_first(tmp_path: Path) -> None:
    """What settings the last set-up had does not matter behind CLOSE and INIT."""
    fresh = ["STEPPER INIT", *AXES, "STEPPER STATUS"]
    changed = [
        "STEPPER JUNCTION 0.5",
        "STEPPER SCURVE 1",
        "STEPPER JERK 123,4,5,6,7",
        "STEPPER ARC 0.3",
        "STEPPER ARC LEGACY 1",
        "STEPPER OVERRIDE FEED,50",
        "STEPPER LIMITS X,1,2",
        "STEPPER SPINDLE GP14",
        "STEPPER COOLANT GP15",
        "STEPPER PROBE GP26",
        "STEPPER HWLIMITS GP16,GP17,GP18",
        "STEPPER HWLIMITS FILTER 9",
        "STEPPER HWLIMITS KEEP 1",
        'STEPPER HOME X,,300 : STEPPER HOME ORDER "XYZ"',
        "STEPPER GC G91 F77 G18 G61",
        "STEPPER RUN ,1",
    ]
    session = typed(tmp_path, *fresh, *changed, "STEPPER STATUS", "STEPPER CLOSE", *fresh)
    assert not session.errors()
    first, last = session.answers[len(fresh) - 1], session.last
    assert session.answers[len(fresh) + len(changed)] != first
    assert last == first


@pytest.mark.parametrize(
    ("axis", "scale", "place", "shown"),
    [
        ("X", "80", "33.3", "33.3"),
        ("X", "80", "40.0375", "40.0375"),
        ("X", "1600", "0.000625", "0.000625"),
        ("X", "66.66667", "33.3", "33.3"),
        ("X", "80", "-0.1", "-0.1"),
        ("A", "8.888889", "90", "90"),
        ("A", "8.888889", "-36000", "-36000"),
        ("X", "3", "0.5", "0.667"),  # the motor stands at two steps
    ],
)
def test_peek_tells_a_neat_place(
    axis: str, scale: str, place: str, shown: str, tmp_path: Path
) -> None:
    """No noise of the arithmetic, and never further from the motor than a hundredth of a step."""
    session = typed(
        tmp_path,
        "STEPPER INIT",
        f"STEPPER AXIS {axis},GP2,GP3,,,{scale}",
        f"STEPPER POSITION {axis},{place}",
        f"?PEEK(STEPPER {axis})",
        f"?PEEK(STEPPER {axis}) = {shown}",
    )
    assert session.number(-2) == float(shown)
    assert session.answers[-2].strip() == shown
    assert session.number() == 1


def test_peek_before_init(tmp_path: Path) -> None:
    """Defined, whatever the pins show."""
    session = typed(
        tmp_path,
        *(f"?PEEK(STEPPER {what})" for what in ("ACTIVE", "STATUS", "BUFFER", "SPEED", "LINE")),
        "?MM.CODE",
        "?PEEK(STEPPER X)",
    )
    assert [session.number(i) for i in range(6)] == [-1, 0, 0, 0, 0, 0]
    assert session.errors() == ["X axis not configured (use STEPPER AXIS)"]


def test_work_offsets_outlive_run_and_init_but_g92_does_not(tmp_path: Path) -> None:
    """They are the user's measurements; where G92 was set is known no more."""
    again = [*SET_UP, "STEPPER POSITION HOME", "?PEEK(STEPPER X)"]
    offsets = ["STEPPER GC G10 L2 P1 X5", "STEPPER GC G92 X100"]
    session = typed(
        tmp_path, stored("PRINT 1"), *READY, *offsets, "?PEEK(STEPPER X)", "RUN", *again
    )
    assert not session.errors()
    assert session.number(len(READY) + 3) == 100
    assert session.number() == -5


def test_what_mm_startup_has_set_up_is_there_for_the_autorun_program(tmp_path: Path) -> None:
    """Power-up is not RUN: nothing is closed in between."""
    flash = tmp_path / "flash.bin"
    program = stored("PRINT PEEK(STEPPER ACTIVE)", "END", "SUB MM.STARTUP", *SET_UP, "END SUB")
    command = [STEPMITE, "--virtual", "--flash", flash]
    typing = f"{program}OPTION AUTORUN ON\r".encode()
    subprocess.run(command, input=typing, capture_output=True, check=True)
    shown = subprocess.run(command, input=b"", capture_output=True, check=True).stdout.decode()
    assert "Stepper initialized" in shown
    assert "\r\n 0\r\n" in shown
