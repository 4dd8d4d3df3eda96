"""E-STOP, limit switches, the alarm they leave, and what a program learns of it."""

from __future__ import annotations

from pathlib import Path

import pytest
from typed import (
    AXES,
    ENABLE_X,
    ESTOP,
    SET_UP,
    SPINDLE,
    WAIT,
    X_MAX,
    X_MIN,
    Y_MIN,
    Event,
    program,
    typed,
)

INIT = "STEPPER INIT ,,GP22"
BOTH_X = f"STEPPER HWLIMITS GP{X_MIN},GP{Y_MIN},0,GP{X_MAX}"
READY = (INIT, *AXES, BOTH_X, "STEPPER POSITION HOME", "STEPPER RUN")
MOVE = "STEPPER GC G1 X50 F3000"
STATUS = "PRINT PEEK(STEPPER STATUS)"
KNOWN = 128


def released(*gpios: int) -> list[Event]:
    """Inputs that nobody presses."""
    return [Event(0, gpio, 1) for gpio in gpios]


def pressed(ms: float, until_ms: float, gpio: int) -> list[Event]:
    """An input that is pressed for a while."""
    return [Event(ms, gpio, 0), Event(until_ms, gpio, 1)]


# ---- What a trip leaves --------------------------------------------------------------------------


@pytest.mark.parametrize("input_name", ["E-STOP", "limit"])
def test_the_alarm_and_what_acknowledges_it(input_name: str, tmp_path: Path) -> None:
    """Everything that moves is refused, saying what to do; then RECOVER, and it goes on."""
    gpio = ESTOP if input_name == "E-STOP" else X_MAX
    alarm = "E-STOP" if input_name == "E-STOP" else "Limit switch X_MAX"
    alarm += " alarm - home (G28), STEPPER POSITION or STEPPER RECOVER first"
    session = typed(
        tmp_path,
        *READY,
        MOVE,
        "PAUSE 600",
        "STEPPER RUN",
        "STEPPER GC G1 X1 F600",
        "STEPPER JOG X,1",
        "STEPPER GC G4 P1",
        STATUS,
        "STEPPER RECOVER",
        "STEPPER RUN",
        "STEPPER GC G1 X1 F600",
        "STEPPER POSITION HOME",
        "STEPPER GC G1 X1 F600",
        WAIT,
        events=[*released(ESTOP, X_MIN, X_MAX, Y_MIN), *pressed(300, 500, gpio)],
    )
    unknown = "Machine position unknown - use STEPPER POSITION or G28 homing first"
    assert session.errors() == [alarm] * 4 + [unknown]
    assert session.answers[-6] == "Stepper recovered - disarmed, buffer cleared"
    assert session.number(-7) == 0
    stopped = session.axis("X").steps()[session.axis("X").step_ns <= 300.03e6][-1]
    assert session.axis("X").end_steps() == stopped + 80


def test_position_acknowledges_too(tmp_path: Path) -> None:
    session = typed(
        tmp_path,
        INIT,
        *AXES,
        "STEPPER POSITION HOME",
        "STEPPER RUN",
        MOVE,
        "PAUSE 400",
        "STEPPER POSITION HOME",
        "STEPPER RECOVER",
        "PAUSE 200",
        "STEPPER POSITION X,7",
        "STEPPER RUN",
        "STEPPER GC G1 X8 F600",
        WAIT,
        events=[*released(ESTOP), *pressed(300, 500, ESTOP)],
    )
    # Neither while E-STOP is pressed.
    assert session.errors() == ["E-STOP active - clear E-STOP and re-home"] * 2
    steps = session.axis("X").steps()
    assert steps[-1] - steps[session.axis("X").step_ns < 400e6][-1] == 80


def test_a_trip_at_rest_keeps_the_position(tmp_path: Path) -> None:
    """Nothing moved, so nothing is lost; the drivers go off all the same."""
    session = typed(
        tmp_path,
        *READY,
        "STEPPER GC G1 X2 F6000",
        "PAUSE 600",
        STATUS,
        "STEPPER RECOVER",
        "STEPPER RUN",
        "STEPPER GC G1 X3 F600",
        WAIT,
        events=[*released(ESTOP, X_MIN, X_MAX, Y_MIN), *pressed(400, 500, Y_MIN)],
    )
    assert session.errors() == []
    assert session.number(-5) == KNOWN
    assert session.level_at(ENABLE_X, 450) == 1
    assert session.end("X") == 3
    assert "Limit switch trip: Y_MIN - motion stopped\n" in session.output


@pytest.mark.parametrize("keep", [0, 1])
def test_drivers_behind_a_limit(keep: int, tmp_path: Path) -> None:
    """KEEP is about limits; E-STOP has its own setting."""
    lines = [
        INIT,
        *AXES,
        f"STEPPER SPINDLE GP{SPINDLE}",
        BOTH_X,
        f"STEPPER HWLIMITS KEEP {keep}",
        "STEPPER POSITION HOME",
        "STEPPER RUN",
        "STEPPER GC M3",
        MOVE,
        "PAUSE 500",
    ]
    levels = released(ESTOP, X_MIN, X_MAX, Y_MIN)
    session = typed(tmp_path, *lines, events=[*levels, Event(300, X_MIN, 0)])
    assert session.level(ENABLE_X) == 1 - keep
    assert session.level_at(SPINDLE, 290) == 1
    assert session.level(SPINDLE) == 0
    session = typed(tmp_path, *lines, events=[*levels, Event(300, ESTOP, 0)])
    assert session.level(ENABLE_X) == 1


# ---- Messages ------------------------------------------------------------------------------------


def test_each_trip_is_told_once_with_all_its_inputs(tmp_path: Path) -> None:
    """What has done it, what is lost, and what to do; the next command is carried out."""
    session = typed(
        tmp_path,
        *READY,
        MOVE,
        "PAUSE 300",
        "PRINT 1",
        "STEPPER RECOVER",
        "STEPPER POSITION HOME",
        "STEPPER RUN",
        MOVE,
        "PAUSE 300",
        "PRINT 2",
        events=[
            *released(ESTOP, X_MIN, X_MAX, Y_MIN),
            *pressed(250, 280, X_MAX),
            *pressed(250, 280, Y_MIN),
            *pressed(500, 510, ESTOP),
        ],
    )
    limit = "Limit switch trip: X_MAX, Y_MIN - motion stopped, position unknown\n"
    estop = "Hardware E-STOP trip - emergency stop, position unknown\n"
    assert session.output.count("trip") == 2
    assert session.output.count(limit + "Home (G28), or STEPPER RECOVER, then STEPPER RUN\n") == 1
    clear = "Clear E-STOP, home (G28) or STEPPER RECOVER, then STEPPER RUN\n"
    assert session.output.count(estop + clear) == 1
    assert session.errors() == []
    assert [session.answers[i].split("\n")[-1].split() for i in (-7, -1)] == [["1"], ["2"]]


# ---- Standing on a switch ------------------------------------------------------------------------


def test_armed_on_a_pressed_switch(tmp_path: Path) -> None:
    """RUN warns; lines and the way further in are refused, the way off is not; then it trips."""
    active = "limit switch X_MIN is active - home (G28) or jog off it"
    session = typed(
        tmp_path,
        *READY,
        "STEPPER GC G1 X1 F600",
        "STEPPER GC G2 X1 I1 F600",
        "STEPPER JOG X,-1",
        "STEPPER JOG Y,1,6000",
        WAIT,
        "STEPPER JOG X,2,600",
        WAIT,
        "PAUSE 400",
        "STEPPER GC G1 X1 F600",
        WAIT,
        "STEPPER STATUS",
        "STEPPER GC G1 X30",
        "PAUSE 1200",
        "STEPPER RUN",
        events=[
            *released(ESTOP, X_MAX, Y_MIN),
            Event(0, X_MIN, 0),
            Event(500, X_MIN, 1),
            Event(1300, X_MIN, 0),
        ],
    )
    assert session.answers[7] == f"Stepper armed\nWarning: {active}"
    errors = session.errors()
    assert errors[:3] == ["L" + active[1:]] * 3
    assert errors[3].startswith("Limit switch X_MIN alarm")
    assert len(errors) == 4
    assert "Alarm: none" in session.answers[-4]
    assert session.axis("X").step_ns[-1] <= 1300.03e6


def test_what_is_queued_does_not_start_on_a_pressed_switch(tmp_path: Path) -> None:
    session = typed(
        tmp_path,
        *SET_UP,
        f"STEPPER HWLIMITS GP{X_MIN},0,0",
        "STEPPER POSITION HOME",
        "STEPPER GC G1 X5 F600",
        "STEPPER RUN",
        "STEPPER CLEAR",
        "STEPPER RUN",
        "STEPPER JOG X,2",
        WAIT,
        events=[Event(0, X_MIN, 0)],
    )
    told = "Limit switch X_MIN is active - use STEPPER CLEAR, then RUN and jog off it"
    assert session.errors() == [told]
    assert session.end("X") == 2


def test_a_switch_that_bounces_while_the_axis_leaves_it_does_not_trip(tmp_path: Path) -> None:
    bounces = [Event(400 + 3 * i, X_MIN, i % 2) for i in range(12)]
    session = typed(
        tmp_path,
        *SET_UP,
        f"STEPPER HWLIMITS GP{X_MIN},0,0",
        "STEPPER RUN",
        "STEPPER JOG X,30,1800",
        WAIT,
        "STEPPER STATUS",
        events=[Event(0, X_MIN, 0), *bounces],
    )
    assert session.errors() == []
    assert session.end("X") == 30
    assert "Alarm: none" in session.last


@pytest.mark.parametrize("distance", [-1, 1])
def test_off_a_shared_pin_both_ways_are_open(distance: int, tmp_path: Path) -> None:
    """Nobody knows which of the two switches is pressed."""
    session = typed(
        tmp_path,
        *SET_UP,
        f"STEPPER HWLIMITS GP{X_MIN},0,0,GP{X_MIN}",
        "STEPPER RUN",
        f"STEPPER JOG X,{distance}",
        WAIT,
        STATUS,
        events=[Event(0, X_MIN, 0)],
    )
    assert session.errors() == []
    assert session.end("X") == distance
    assert session.number() == 3


# ---- FILTER --------------------------------------------------------------------------------------


@pytest.mark.parametrize("samples", [1, 3, 20, 100])
def test_filter(samples: int, tmp_path: Path) -> None:
    """One sample less is noise; that many trip."""
    lines = [
        *SET_UP,
        f"STEPPER HWLIMITS GP{X_MIN},0,0",
        f"STEPPER HWLIMITS FILTER {samples}",
        "STEPPER POSITION HOME",
        "STEPPER RUN",
        MOVE,
        "PAUSE 900",
    ]
    noise = [
        event
        for i in range(20)
        for event in pressed(200 + 5 * i, 200 + 5 * i + samples / 100 - 0.011, X_MIN)
        if samples > 1
    ]
    levels = released(X_MIN)
    assert typed(tmp_path, *lines, WAIT, events=[*levels, *noise]).end("X") == 50
    events = [*levels, *pressed(400, 400 + samples / 100 + 0.001, X_MIN)]
    session = typed(tmp_path, *lines, events=events)
    assert session.axis("X").step_ns[-1] <= 400e6 + samples * 10_000
    assert session.axis("X").step_ns[-1] > 399e6


@pytest.mark.parametrize("arguments", ["0", "101", "3,0", "3,101", ""])
def test_filter_is_checked(arguments: str, tmp_path: Path) -> None:
    assert len(typed(tmp_path, *SET_UP, f"STEPPER HWLIMITS FILTER {arguments}").errors()) == 1


# ---- Events --------------------------------------------------------------------------------------

REACTS = f"""\
STEPPER INIT ,,GP22
STEPPER AXIS X,GP2,GP3,GP4,,80,6000,500
STEPPER HWLIMITS GP{X_MIN},0,0
STEPPER POSITION HOME
ON STEPPER EVENT tell
STEPPER RUN
STEPPER GC G1 X2 F6000
PAUSE 300
STEPPER GC G1 X50 F3000
PAUSE 300
PRINT "after"
STEPPER RECOVER
STEPPER POSITION HOME
STEPPER RUN
STEPPER GC G1 X50 F3000
PAUSE 300
PRINT "end"
END
SUB tell
  LOCAL INTEGER kind
  DO
    kind = PEEK(STEPPER EVENT)
    IF kind = 0 THEN EXIT DO
    PRINT "event";kind
  LOOP
END SUB
"""


def test_a_program_reacts(tmp_path: Path) -> None:
    """Its SUB learns of the end of motion, the limit and the E-STOP, each once."""
    session = program(
        tmp_path,
        REACTS,
        events=[*released(ESTOP, X_MIN), *pressed(500, 550, X_MIN), *pressed(800, 850, ESTOP)],
    )
    told = [line for line in session.last.split("\n") if line.startswith(("event", "after", "end"))]
    assert told == ["event 3", "event 2", "after", "event 1", "end"]


def test_events_are_for_polling_too_and_forgotten_by_run(tmp_path: Path) -> None:
    """PEEK takes the oldest; without a SUB they wait; ON STEPPER EVENT 0 takes the SUB away."""
    text = REACTS.replace("ON STEPPER EVENT tell", "ON STEPPER EVENT tell:ON STEPPER EVENT 0")
    text = text.replace('PRINT "end"', "?PEEK(STEPPER EVENT);PEEK(STEPPER EVENT);\n" * 3)
    session = program(
        tmp_path,
        text,
        events=[*released(ESTOP, X_MIN), *pressed(500, 550, X_MIN), *pressed(800, 850, ESTOP)],
    )
    assert "event" not in session.last
    assert session.last.split("\n")[-1].split() == ["3", "2", "1", "0", "0", "0"]


def test_a_file_is_idle_at_its_end(tmp_path: Path) -> None:
    """Not each time that the queue has run empty on the way."""
    text = REACTS.replace("STEPPER GC G1 X50 F3000\n", "", 1).replace(
        "STEPPER GC G1 X2 F6000\n",
        'OPEN "a.nc" FOR OUTPUT AS #1:PRINT #1,"G1 F6000 X1":'
        'FOR i=1 TO 5:PRINT #1,"G4 P2":PRINT #1,"G1 X";i:NEXT:CLOSE #1\n'
        'STEPPER FILE "a.nc":PAUSE 1500\n',
    )
    session = program(tmp_path, text.replace("INIT ,,", "INIT ,1,"), events=released(ESTOP, X_MIN))
    told = [line for line in session.last.split("\n") if line.startswith(("event", "after"))]
    assert sorted(told[:2]) == ["event 3", "event 7"]
    assert told[2] == "after"


def test_a_sub_that_takes_one_event_is_called_again_for_the_next(tmp_path: Path) -> None:
    """Two at one time."""
    text = REACTS.replace("    IF kind = 0 THEN EXIT DO\n", "")
    text = text.replace("  LOOP\n", "  LOOP UNTIL 1\n").replace("PAUSE 300", "PAUSE 30", 1)
    session = program(tmp_path, text, events=[*released(ESTOP, X_MIN), *pressed(500, 550, X_MIN)])
    told = [line for line in session.last.split("\n") if line.startswith("event")]
    assert "event 2" in told
    assert len(told) == len(set(told))
