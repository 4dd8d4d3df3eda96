"""Section 8 of the STEPPER reference: sensorless homing, with DIAG as an active-high input.

What is written to the driver itself is left out; that DIAG rises while the axis pushes against its
end and falls when it backs off is what the switches of these tests do.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from typed import (
    AXES,
    ENABLE_X,
    WAIT,
    X_MIN,
    Y_MIN,
    Z_MIN,
    Event,
    Session,
    Switch,
    typed,
)

SET_UP = ["STEPPER INIT", *AXES, "STEPPER HWLIMITS GP16,GP17,GP18,0,0,0,7", "STEPPER RUN"]
DIAG = [
    Switch(X_MIN, "X", -20, active_high=True),
    Switch(Y_MIN, "Y", -12.5, active_high=True),
    Switch(Z_MIN, "Z", -4, active_high=True),
]
PLACES = "PRINT PEEK(STEPPER X), PEEK(STEPPER Y), PEEK(STEPPER Z)"
STATUS = "PRINT PEEK(STEPPER STATUS)"


def homed(folder: Path, *lines: str) -> Session:
    return typed(folder, *SET_UP, *lines, switches=DIAG)


def test_the_recipe_works_as_printed(tmp_path: Path) -> None:
    """RUN with the position unknown, then G28 with a BASIC comment behind it, then moves."""
    session = homed(
        tmp_path,
        "STEPPER GC G28                            ' run the homing cycle",
        PLACES,
        STATUS,
        "STEPPER GC G1 X5 Y5 Z1 F3000",
        WAIT,
        PLACES,
    )
    assert session.errors() == []
    assert session.numbers(-5) == [0, 0, 0]
    assert int(session.number(-4)) & 128 == 128
    assert session.numbers() == [5, 5, 1]
    assert session.level(ENABLE_X) == 0


def test_run_arms_with_the_position_unknown(tmp_path: Path) -> None:
    """Moves other than homing are still refused."""
    session = homed(tmp_path, "STEPPER GC G1 X5 F600")
    assert len(session.errors()) == 1
    assert "position unknown" in session.errors()[0]
    assert len(session.axis("X").step_ns) == 0


def test_each_axis_stands_off_its_end(tmp_path: Path) -> None:
    """All ended at zero, the same distance from where DIAG rose, in the order Z, X, Y."""
    session = homed(tmp_path, "STEPPER GC G28", PLACES)
    assert session.errors() == []
    for diag in DIAG:
        trace = session.axis(diag.axis)
        place = trace.end_steps() / trace.pins.steps_per_unit
        assert diag.at_mm < place < diag.at_mm + 10, diag.axis
        assert trace.steps().min() / trace.pins.steps_per_unit > diag.at_mm - 10
    ends = {name: session.axis(name).step_ns[-1] for name in "XYZ"}
    begins = {name: session.axis(name).step_ns[0] for name in "XYZ"}
    assert ends["Z"] < begins["X"]
    assert ends["X"] < begins["Y"]
    assert len(session.axis("A").step_ns) == 0


def test_the_fast_approach_comes_before_a_slow_one(tmp_path: Path) -> None:
    """DIAG is met at speed first; a slow pass follows."""
    session = homed(tmp_path, "STEPPER GC G28 X")
    trace = session.axis("X")
    turns = np.flatnonzero(np.diff(trace.direction))
    assert len(turns) == 3
    rate = 1e9 / np.diff(trace.step_ns)
    assert rate[: turns[0]].max() > 5 * rate[turns[1] + 2 : turns[2]].max()


def test_the_slow_pass_can_be_skipped(tmp_path: Path) -> None:
    """A latch feed of 0: the fast approach is the home position, then pull off."""
    session = homed(tmp_path, "STEPPER HOME X,,,0", "STEPPER GC G28 X", PLACES)
    assert session.errors() == []
    trace = session.axis("X")
    assert len(np.flatnonzero(np.diff(trace.direction))) == 1
    assert session.numbers()[0] == 0


@pytest.mark.parametrize("armed_again", [True, False])
def test_a_driver_fault_is_a_limit_trip(armed_again: bool, tmp_path: Path) -> None:
    """DIAG that rises in normal motion: motion halts, drivers off, position unknown."""
    lines = ["STEPPER POSITION HOME", "STEPPER GC G1 X50 F3000", "PAUSE 1000", STATUS]
    if armed_again:
        lines += ["STEPPER POSITION HOME", "STEPPER RUN", "STEPPER GC G1 X5 F3000", WAIT]
    levels = [Event(0, gpio, 0) for gpio in (X_MIN, Y_MIN, Z_MIN)]
    events = [*levels, Event(400, Y_MIN, 1), Event(600, Y_MIN, 0)]
    session = typed(tmp_path, *SET_UP, *lines, events=events)
    assert session.errors() == []
    assert "Y_MIN" in session.output
    steps_ms = session.axis("X").step_ns / 1e6
    assert not ((steps_ms > 400.04) & (steps_ms < 1000)).any()
    assert session.level_at(ENABLE_X, 500) == 1
    status = int(session.number(-5 if armed_again else -1))
    assert status & 128 == 0
    if armed_again:
        assert session.level(ENABLE_X) == 0
        assert steps_ms[-1] > 1000


def test_motors_that_stall_at_their_ends(tmp_path: Path) -> None:
    """DIAG as drivers make it: short, only at speed, while the motor is held and steps are lost."""
    stalls = [Switch(diag.gpio, diag.axis, diag.at_mm, stall_rate=1000) for diag in DIAG]
    lines = ["STEPPER GC G28", PLACES, STATUS, "STEPPER GC G1 X5 Y5 Z1 F3000", WAIT, PLACES]
    session = typed(tmp_path, *SET_UP, *lines, switches=stalls)
    assert session.errors() == []
    assert session.numbers(-5) == [0, 0, 0]
    assert int(session.number(-4)) & 128 == 128
    assert session.numbers() == [5, 5, 1]
    for diag in DIAG:
        trace = session.axis(diag.axis)
        steps = np.array([0])
        at = round(diag.at_mm * trace.pins.steps_per_unit)
        for direction in trace.direction:  # the end of the axis holds the motor
            steps = np.maximum(steps + direction, at)
        stands_mm = int(steps[0]) / trace.pins.steps_per_unit
        wanted_mm = diag.at_mm + 3 + {"X": 5, "Y": 5, "Z": 1}[diag.axis]
        assert stands_mm == pytest.approx(wanted_mm, abs=1e-9), diag.axis
        assert len(np.flatnonzero(trace.steps() < at)) == 0, diag.axis


@pytest.mark.parametrize("profile", [0, 1])
def test_a_stall_ends_motion_at_once(profile: int, tmp_path: Path) -> None:
    """The motor is held and DIAG rises: no step behind the filter of 30 us, none is lost.

    Without an alarm, the drivers stay on, and the home place is the same from wherever it starts.
    """
    stalls = [Switch(diag.gpio, diag.axis, diag.at_mm, stall_rate=1000) for diag in DIAG]
    set_up = [*SET_UP, f"STEPPER SCURVE {profile}"]
    again = ["STEPPER GC G28", "STEPPER GC G1 X7.3 F3000", WAIT, "STEPPER GC G28 X0", PLACES]
    session = typed(tmp_path, *set_up, *again, STATUS, switches=stalls)
    assert session.errors() == []
    assert "alarm" not in session.output
    assert session.level(ENABLE_X) == 0
    assert session.numbers(-2)[0] == 0
    assert int(session.number(-1)) & 0x3F == 0
    trace = session.axis("X")
    at = round(DIAG[0].at_mm * trace.pins.steps_per_unit)
    places = trace.steps()
    assert places.min() == at
    assert trace.end_steps() == at + 3 * trace.pins.steps_per_unit
    for reached in np.flatnonzero(places == at):
        gap_ns = trace.step_ns[reached + 1] - trace.step_ns[reached]
        assert gap_ns > 15e6  # the next one leads away, and nothing is braked before
