"""Section 8 of the STEPPER reference: sensorless homing, with DIAG as an active-high input.

In the first half what is written to the driver itself is left out; that DIAG rises while the axis
pushes against its end and falls when it backs off is what the switches of these tests do. In the
second half simulated drivers and motors do it, set up and armed over their wire.
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

from stepmite.trace import AxisPins, axis_trace

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


# ---- With drivers --------------------------------------------------------------------------------

ONE_TIME = [
    "TMC22xx GP5, 2209, 0, 800, 30, 16      ' driver init",
    "STEPPER INIT",
    "STEPPER AXIS X, GP2,GP3,GP4,,80,6000,500",
    "STEPPER AXIS Y, GP6,GP7,GP8,,80,6000,500",
    "STEPPER AXIS Z, GP14,GP15,GP13,,400,3000,200",
    "STEPPER HWLIMITS GP10, GP11, GP12, 0, 0, 0, 7  ' DIAG inputs, all active-high",
    "STEPPER RUN",
]
"""As printed in 8.3, with the axes filled in."""
HOME_CYCLE = [
    "TMC22xx TCOOLTHRS 0, 200                ' arm StallGuard for slave 0",
    "TMC22xx SGTHRS 0, 120                    ' set sensitivity (tune empirically)",
    "STEPPER GC G28                            ' run the homing cycle",
    "TMC22xx TCOOLTHRS 0, 0                    ' disarm so normal moves can't trip",
]
"""As printed."""
TIED = [
    *(f"TMC22xx GP5,2209,{address},800,30,16" for address in (1, 2)),
    *(f"TMC22xx AXIS {address},{axis}" for address, axis in enumerate("XYZ")),
    *(f"TMC22xx SGTHRS {axis},120" for axis in "XYZ"),
]
"""All three drivers, and no word of arming."""
INTO_THE_END = ["STEPPER GC G1 X-6 F3000", WAIT]
"""Three mm further than the axis goes, at the speed of homing."""

FULL_STEP = 16  # steps
X_END = -1600
PLACE = "GP20"
"""An input that is low where X stands 10 mm and more from its end, however many steps it lost."""
AXES_WITH_ENDS = [
    f"axis X step=GP2 dir=GP3 stops={X_END}:1000000",
    "axis Y step=GP6 dir=GP7 stops=-1000:1000000",
    "axis Z step=GP14 dir=GP15 stops=-1600:1000000",
    f"switch pin={PLACE} axis=X from={X_END + 800}",
]
DRIVERS = [
    "tmc2209 tx=GP5 address=0 axis=X diag=GP10 microsteps=16",
    "tmc2209 tx=GP5 address=1 axis=Y diag=GP11 microsteps=16",
    "tmc2209 tx=GP5 address=2 axis=Z diag=GP12 microsteps=16",
]
THREE = [*AXES_WITH_ENDS, *DRIVERS]
ONE = [
    *AXES_WITH_ENDS,
    DRIVERS[0],
    "stall pin=GP11 axis=Y to=-1000 rate=1000 hold_us=2000",
    "stall pin=GP12 axis=Z to=-1600 rate=1000 hold_us=2000",
]
"""The others have drivers as well, of which the recipe does not speak."""


def pins_of(axis: str) -> AxisPins:
    step, scale = {"X": (2, 80.0), "Y": (6, 80.0), "Z": (14, 400.0)}[axis]
    return AxisPins(axis, step, step + 1, False, scale)


def thresholds(session: Session, driver: int = 0) -> list[int]:
    """What was written to TCOOLTHRS of a driver, in order."""
    return [event["value"] for event in session.report.told("write", driver, "TCOOLTHRS")]


def check_disarmed(session: Session, drivers: int) -> None:
    for driver in range(drivers):
        assert session.report.register("TCOOLTHRS", driver) == 0
        assert session.report.register("SGTHRS", driver) == 120


def test_the_recipe_with_a_driver(tmp_path: Path) -> None:
    """8.3 as printed: the axis ends at its stop, DIAG rises, G28 ends at zero; then disarmed."""
    session = typed(tmp_path, *ONE_TIME, *HOME_CYCLE, PLACES, STATUS, drivers=ONE)
    assert session.errors() == []
    assert session.numbers(-2) == [0, 0, 0]
    assert int(session.number()) & 0xFF == 128
    assert thresholds(session) == [200, 0]
    check_disarmed(session, 1)
    assert [event["value"] for event in session.report.told("diag")] == [1, 0]
    lowest = axis_trace(session.edges, pins_of("X")).steps().min()
    assert X_END - 2 * FULL_STEP < lowest < X_END  # as far as the field was ahead of the motor
    stands = session.report.full_steps()
    assert stands == pytest.approx((X_END + 240) / FULL_STEP, abs=2)


@pytest.mark.parametrize("armed", [False, True])
def test_a_stall_in_a_normal_move(armed: bool, tmp_path: Path) -> None:
    """Disarmed it does not trip; left armed it does, which shows that the motor really stalls."""
    cycle = HOME_CYCLE[:-1] if armed else HOME_CYCLE
    session = typed(tmp_path, *ONE_TIME, *cycle, *INTO_THE_END, STATUS, drivers=ONE)
    assert session.errors() == []
    assert ("X_MIN" in session.output) == armed
    assert bool(int(session.number()) & 128) != armed
    assert session.level(4) == armed  # drivers off
    assert len(session.report.told("diag")) == (4 if armed else 2)
    if not armed:
        assert session.report.drivers[0]["slips"] > 0


def test_no_arming_lines_at_all(tmp_path: Path) -> None:
    """Three drivers tied to their axes: each is armed for its approach, and only then."""
    session = typed(
        tmp_path,
        *ONE_TIME,
        *TIED,
        "STEPPER GC G28",
        PLACES,
        STATUS,
        *INTO_THE_END,
        STATUS,
        drivers=THREE,
    )
    assert session.errors() == []
    assert session.numbers(-5) == [0, 0, 0]
    assert int(session.number(-4)) & 0xFF == 128
    assert int(session.number()) & 0xFF == 128  # the stall in the end has not tripped
    armed = [
        (event["driver"], event["value"] > 0)
        for event in session.report.events
        if event["do"] == "write" and event["register"] == "TCOOLTHRS"
    ]
    assert list(dict.fromkeys(driver for driver, _ in armed)) == [2, 0, 1]
    for driver in range(3):  # twice where it met its end before it had its speed
        mine = [on for of, on in armed if of == driver]
        assert mine in ([True, False], [True, False] * 2)
    check_disarmed(session, 3)


def test_armed_only_during_the_approach(tmp_path: Path) -> None:
    """At rest before the first step towards the end, and again before the axis pulls off."""
    session = typed(tmp_path, *ONE_TIME, *TIED, "STEPPER GC G28 X0", drivers=THREE)
    assert session.errors() == []
    on_ms, off_ms = (event["ms"] for event in session.report.told("write", 0, "TCOOLTHRS"))
    trace = axis_trace(session.edges, pins_of("X"))
    turn = np.flatnonzero(np.diff(trace.direction))[0]
    assert on_ms < trace.step_ns[0] / 1e6
    assert trace.step_ns[turn] / 1e6 < off_ms < trace.step_ns[turn + 1] / 1e6


def test_it_repeats_within_two_full_steps(tmp_path: Path) -> None:
    """From where homing ends the same place of the axis is the same way off, from all starts."""
    starts = [3, 5.37, 8.1, 11.93, 20, 33.3, 47.77, 60]
    probed = "PRINT PEEK(STEPPER PROBE X)"
    lines = [*ONE_TIME, *TIED, f"STEPPER PROBE {PLACE}"]
    lines += ["STEPPER GC G28"]
    for start in starts:
        lines += ["STEPPER GC G28 X0", "STEPPER GC G38.2 X20 F600", probed]
        lines += [f"STEPPER GC G1 X{start} F3000"]
    session = typed(tmp_path, *lines, drivers=THREE)
    assert session.errors() == []
    found = [session.number(i) for i, line in enumerate(lines) if line == probed]
    assert len(found) == len(starts)
    assert max(found) - min(found) <= 2 * FULL_STEP / 80
    assert all(abs(place - 7) <= 2 * FULL_STEP / 80 for place in found)


@pytest.mark.parametrize("fault", ["unplugged", "silent", "deaf"])
def test_a_driver_that_cannot_be_armed(fault: str, tmp_path: Path) -> None:
    """Its axis does not move; the error names it."""
    broken = [*AXES_WITH_ENDS, f"{DRIVERS[0]} fault={fault}@5000", *DRIVERS[1:]]
    lines = [*ONE_TIME, *TIED, "TMC22xx MONITOR 0", "PAUSE 6000", "STEPPER GC G28 X0", STATUS]
    session = typed(tmp_path, *lines, drivers=broken)
    assert len(session.errors()) == 1
    assert session.errors()[0].startswith("Homing X failed: ")
    assert "address 0 on GP5" in session.errors()[0]
    assert int(session.number()) & 128 == 0
    assert len(axis_trace(session.edges, pins_of("X")).step_ns) == 0


# ---- Thresholds and faults -----------------------------------------------------------------------


def stops_at(folder: Path, sgthrs: int) -> float:
    """Where X was found to stall, in mm from its true end, with a threshold."""
    folder.mkdir()
    lines = [*ONE_TIME, *TIED, f"TMC22xx SGTHRS X,{sgthrs}", "STEPPER GC G28 X0"]
    session = typed(folder, *lines, drivers=THREE)
    lowest = axis_trace(session.edges, pins_of("X")).steps().min()
    return (int(lowest) - X_END) / 80


def test_higher_is_more_sensitive(tmp_path: Path) -> None:
    """The lowest finds the end as well; a very high one takes free running for a stall."""
    lowest, middle, highest = (stops_at(tmp_path / str(value), value) for value in (1, 120, 250))
    assert lowest <= middle < 0
    assert highest > 5


def test_too_slow_for_the_threshold(tmp_path: Path) -> None:
    """TSTEP 200 is 3000 mm/min; at 600 the motor hammers against its end, and homing fails."""
    slow = "STEPPER HOME X,,600,0,,30"
    session = typed(tmp_path, *ONE_TIME, slow, *HOME_CYCLE[:2], "STEPPER GC G28 X0", drivers=ONE)
    assert len(session.errors()) == 1
    assert "never closed within" in session.errors()[0]
    assert session.report.told("diag") == []
    assert session.report.drivers[0]["slips"] > 0


def test_spreadcycle_finds_no_stall(tmp_path: Path) -> None:
    """Armed by hand, so that nobody could refuse it."""
    spread = ONE_TIME[0].replace("16 ", "16,,0 ", 1)
    lines = [spread, *ONE_TIME[1:], "STEPPER HOME X,,,0,,30", *HOME_CYCLE[:2], "STEPPER GC G28 X0"]
    session = typed(tmp_path, *lines, drivers=ONE)
    assert len(session.errors()) == 1
    assert "never closed within" in session.errors()[0]
    assert session.report.told("diag") == []


MOVE = ["STEPPER POSITION HOME", "STEPPER GC G1 X60 F1200", "PAUSE 4000", STATUS]


def test_a_fault_of_a_driver_raises_diag(tmp_path: Path) -> None:
    """Overheated and off, in a normal move: motion halts, drivers off, position unknown."""
    broken = [*AXES_WITH_ENDS, f"{DRIVERS[0]} fault=over-temperature:165@1500", *ONE[-2:]]
    session = typed(tmp_path, *ONE_TIME, *MOVE, drivers=broken)
    assert session.errors() == []
    assert "X_MIN" in session.output
    assert int(session.number()) & 128 == 0
    assert session.level(4) == 1
    assert axis_trace(session.edges, pins_of("X")).step_ns[-1] < 1502e6


def test_the_temperature_warning_does_not(tmp_path: Path) -> None:
    """The move goes on to its end, and the user is told."""
    warm = [*AXES_WITH_ENDS, f"{DRIVERS[0]} fault=over-temperature:130@1500", *ONE[-2:]]
    session = typed(tmp_path, *ONE_TIME, *MOVE, drivers=warm)
    assert session.errors() == []
    assert int(session.number()) & 128 == 128
    assert axis_trace(session.edges, pins_of("X")).end_steps() == 60 * 80
    assert "hot" in session.output
