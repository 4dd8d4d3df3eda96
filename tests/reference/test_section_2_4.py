"""Section 2.4 of the STEPPER reference: STEPPER HWLIMITS, LIMITS and ESTOP."""

from __future__ import annotations

from pathlib import Path

import pytest
from motion_checks import hardest_acceleration
from typed import (
    AXES,
    ENABLE_X,
    ENABLE_Z,
    ESTOP,
    READY,
    SET_UP,
    SPINDLE,
    WAIT,
    X_MAX,
    X_MIN,
    Y_MAX,
    Y_MIN,
    Z_MAX,
    Z_MIN,
    Event,
    Switch,
    error_of,
    typed,
)

ALL_SIX = "STEPPER HWLIMITS GP16,GP17,GP18,GP19,GP20,GP21"
ASK = "PRINT PEEK(STEPPER STATUS)"
MOVE = "STEPPER GC G1 X50 F3000"
START = ["STEPPER POSITION HOME", "STEPPER RUN"]
BITS = {X_MIN: 0, X_MAX: 1, Y_MIN: 2, Y_MAX: 3, Z_MIN: 4, Z_MAX: 5}
"""Bits of PEEK(STEPPER STATUS)."""
MASK_BITS = {X_MIN: 0, Y_MIN: 1, Z_MIN: 2, X_MAX: 3, Y_MAX: 4, Z_MAX: 5}
"""Bits of invert_mask."""


# ---- HWLIMITS ------------------------------------------------------------------------------------


@pytest.mark.parametrize("gpio", BITS)
def test_active_low_with_pull_up(gpio: int, tmp_path: Path) -> None:
    """Open inputs are off; grounded ones show in their bit."""
    session = typed(tmp_path, *SET_UP, ALL_SIX, ASK, "PAUSE 20", ASK, events=[Event(10, gpio, 0)])
    assert session.errors() == []
    assert int(session.number(-3)) & 63 == 0
    assert int(session.number()) & 63 == 1 << BITS[gpio]


@pytest.mark.parametrize("gpio", MASK_BITS)
def test_invert_mask_makes_active_high_with_pull_down(gpio: int, tmp_path: Path) -> None:
    """The pin of the bit: open is off, high is on. The others are as they were."""
    mask = 1 << MASK_BITS[gpio]
    session = typed(
        tmp_path, *SET_UP, f"{ALL_SIX},{mask}", ASK, "PAUSE 20", ASK, events=[Event(10, gpio, 1)]
    )
    assert session.errors() == []
    assert int(session.number(-3)) & 63 == 0
    assert int(session.number()) & 63 == 1 << BITS[gpio]


def test_example_mask_7(tmp_path: Path) -> None:
    """All three minimum pins active-high, the maximum slots 0 for none."""
    events = [Event(10, gpio, 1) for gpio in (X_MIN, Y_MIN, Z_MIN)]
    session = typed(
        tmp_path,
        *SET_UP,
        "STEPPER HWLIMITS GP16,GP17,GP18,0,0,0,7",
        ASK,
        "PAUSE 20",
        ASK,
        events=events,
    )
    assert session.errors() == []
    assert int(session.number(-3)) & 63 == 0
    assert int(session.number()) & 63 == 0b010101


@pytest.mark.parametrize(
    "slots", ["GP16,GP17,GP18", "GP16,GP17,GP18,0,0,GP21", "GP16", "0,0,GP18", ",,,GP19"]
)
def test_slots_may_stay_unassigned(slots: str, tmp_path: Path) -> None:
    """0 or nothing in any slot, the minimum ones included."""
    session = typed(tmp_path, *SET_UP, f"STEPPER HWLIMITS {slots}", ASK)
    assert session.errors() == []
    assert int(session.number()) & 63 == 0


@pytest.mark.parametrize(
    ("slots", "pin"),
    [
        ("GP2,GP17,GP18", "GP2"),
        ("GP3,GP17,GP18", "GP3"),
        ("GP16,GP4,GP18", "GP4"),
        ("GP16,GP17,GP14", "GP14"),
        ("GP16,GP17,GP22", "GP22"),
        ("GP16,GP16,GP18", "GP16"),
        ("GP16,GP17,GP18,GP17", "GP17"),
    ],
    ids=["step", "dir", "enable", "spindle", "estop", "minima", "two axes"],
)
def test_pins_must_be_of_their_own(slots: str, pin: str, tmp_path: Path) -> None:
    """Not those of axes, spindle, E-STOP or another axis's switch; nothing is taken then."""
    session = typed(
        tmp_path,
        "STEPPER INIT ,,GP22",
        *AXES,
        f"STEPPER SPINDLE GP{SPINDLE}",
        f"STEPPER HWLIMITS {slots}",
        "SETPIN GP18,DIN",
        "SETPIN GP18,OFF",
        ALL_SIX,
    )
    assert len(session.errors()) == 1
    assert pin in session.errors()[0]


def test_axis_pins_must_avoid_limit_pins(tmp_path: Path) -> None:
    """The other way round as well."""
    session = typed(tmp_path, *SET_UP, ALL_SIX, "STEPPER SPINDLE GP16", "STEPPER AXIS X,GP17,GP3")
    assert len(session.errors()) == 2


def test_shared_pin_of_one_axis(tmp_path: Path) -> None:
    """Minimum and maximum in one; both bits show it."""
    session = typed(
        tmp_path,
        *SET_UP,
        "STEPPER HWLIMITS GP16,GP17,GP18,GP16",
        "PAUSE 20",
        ASK,
        events=[Event(10, X_MIN, 0)],
    )
    assert session.errors() == []
    assert int(session.number()) & 63 == 0b000011


@pytest.mark.parametrize(("mask", "fine"), [(0, True), (9, True), (1, False), (8, False)])
def test_bits_of_a_shared_pin_must_agree(mask: int, fine: bool, tmp_path: Path) -> None:
    """One pin has one polarity."""
    line = f"STEPPER HWLIMITS GP16,GP17,GP18,GP16,0,0,{mask}"
    session = typed(tmp_path, *SET_UP, line)
    assert bool(session.errors()) != fine


@pytest.mark.parametrize("mask", [-1, 64])
def test_mask_has_six_bits(mask: int, tmp_path: Path) -> None:
    """0 to 63."""
    session = typed(tmp_path, *SET_UP, f"{ALL_SIX},{mask}")
    assert "invert_mask" in session.errors()[0]


def test_may_be_given_again(tmp_path: Path) -> None:
    """With the same pins or others; those left out are free."""
    session = typed(
        tmp_path,
        *SET_UP,
        ALL_SIX,
        ALL_SIX,
        "STEPPER HWLIMITS GP19,GP17,GP18",
        "SETPIN GP16,DIN",
        "SETPIN GP20,DIN",
        "SETPIN GP16,OFF",
        "SETPIN GP20,OFF",
    )
    assert session.errors() == []


def test_a_trip_stops_within_a_tick_of_the_filter(tmp_path: Path) -> None:
    """No step later; drivers and spindle off, queue empty, disarmed, position unknown."""
    session = typed(
        tmp_path,
        *SET_UP,
        f"STEPPER SPINDLE GP{SPINDLE}",
        ALL_SIX,
        *START,
        "STEPPER GC M3",
        MOVE,
        "STEPPER GC G1 X0",
        "PAUSE 1000",
        ASK,
        "STEPPER STATUS",
        events=[Event(400.003, X_MAX, 0)],
    )
    step_ns = session.axis("X").step_ns
    # Three samples in a row count, 10 us apart, and the tick that finds the third is the last.
    assert step_ns[-1] <= 400.003e6 + 40_000
    assert step_ns[-1] > 399e6
    assert session.level(ENABLE_X) == 1
    assert session.level(SPINDLE) == 0
    assert int(session.number(-2)) & 128 == 0
    assert "Armed: NO" in session.last
    assert "Buffer: 0 of" in session.last
    assert session.output.count("X_MAX") >= 1


# ---- LIMITS --------------------------------------------------------------------------------------


@pytest.mark.parametrize("axis", ["X", "Y", "Z"])
def test_soft_limits(axis: str, tmp_path: Path) -> None:
    """Up to the limit, not beyond; a refused move changes nothing."""
    session = typed(
        tmp_path,
        *READY,
        f"STEPPER LIMITS {axis},-2,3",
        f"STEPPER GC G1 {axis}3.01 F6000",
        f"STEPPER GC G1 {axis}-2.01 F6000",
        f"STEPPER GC G1 {axis}3 F6000",
        f"STEPPER GC G1 {axis}-2",
        WAIT,
        f"PRINT PEEK(STEPPER {axis})",
    )
    assert session.errors() == [f"{axis} position exceeds soft limits"] * 2
    assert session.number() == -2
    assert session.axis(axis).steps().max() / session.axis(axis).pins.steps_per_unit == 3


def test_soft_limits_hold_for_arcs_and_jogs(tmp_path: Path) -> None:
    """An arc whose ends are inside and whose way is not; a jog ends at the limit."""
    session = typed(
        tmp_path,
        *READY,
        "STEPPER LIMITS Y,-1,4",
        "STEPPER GC G2 X10 I5 F600",
        "STEPPER GC G2 X6 I3 F6000",
        WAIT,
        "STEPPER JOG Y,+",
        WAIT,
        "PRINT PEEK(STEPPER Y)",
    )
    assert session.errors() == ["Y position exceeds soft limits"]
    assert session.end("X") == 6
    assert session.number() == 4


@pytest.mark.parametrize(
    ("arguments", "word"),
    [("A,0,10", "axis"), ("X,10,10", "Min"), ("X,10,0", "Min"), ("X,1", "max_mm")],
)
def test_soft_limits_are_checked(arguments: str, word: str, tmp_path: Path) -> None:
    """A has none; min lies below max."""
    assert word in typed(tmp_path, *SET_UP, f"STEPPER LIMITS {arguments}").errors()[0]


# ---- ESTOP ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("keep", [0, 1])
def test_software_estop(keep: int, tmp_path: Path) -> None:
    """At once: queue empty, spindle off, drivers as INIT says; position unknown after speed."""
    session = typed(
        tmp_path,
        f"STEPPER INIT ,,,{keep}",
        *AXES,
        f"STEPPER SPINDLE GP{SPINDLE}",
        *START,
        "STEPPER GC M3",
        MOVE,
        "STEPPER GC G1 X0",
        "PAUSE 400",
        "STEPPER ESTOP",
        "PAUSE 500",
        ASK,
        "PRINT PEEK(STEPPER BUFFER)",
        "STEPPER GC G1 X1 F600",
    )
    at_ms = session.typed_ms[-5]
    assert session.axis("X").step_ns[-1] / 1e6 <= at_ms
    assert 100 < len(session.axis("X").step_ns) < 4000
    assert session.level(ENABLE_X) == (0 if keep else 1)
    assert session.level(SPINDLE) == 0
    assert int(session.number(-3)) & 128 == 0
    assert session.number(-2) == 32
    assert len(session.errors()) == 1


def test_software_estop_at_rest_keeps_the_position(tmp_path: Path) -> None:
    """Nothing moved, so nothing is lost."""
    session = typed(
        tmp_path,
        *READY,
        "STEPPER GC G1 X2 F600",
        WAIT,
        "STEPPER ESTOP",
        ASK,
        "STEPPER RUN",
        "STEPPER GC G1 X3 F600",
        WAIT,
    )
    assert session.errors() == []
    assert int(session.number(-4)) & 128 == 128
    assert session.end("X") == 3


def test_motion_before_a_trip_was_smooth(tmp_path: Path) -> None:
    """Switches that do not trip change nothing about a move."""
    session = typed(tmp_path, *SET_UP, ALL_SIX, *START, MOVE, WAIT)
    assert session.end("X") == 50
    assert hardest_acceleration(session, "X") < 1.1 * 500 + 4 / 80 / 0.02**2


def test_estop_input_ends_homing(tmp_path: Path) -> None:
    """Under all circumstances: in the middle of an approach no further step."""
    session = typed(
        tmp_path,
        "STEPPER INIT ,,GP22",
        *AXES,
        "STEPPER HWLIMITS GP16,GP17,GP18",
        "STEPPER RUN",
        "STEPPER GC G28 X",
        "PAUSE 500",
        ASK,
        switches=[Switch(X_MIN, "X", -100)],
        events=[Event(0, ESTOP, 1), Event(300, ESTOP, 0)],
    )
    assert len(session.axis("X").step_ns) > 0
    assert session.axis("X").step_ns[-1] <= 300e6 + 10_000
    assert session.level(ENABLE_Z) == 1
    assert error_of(session.answers[-3])
    assert int(session.number()) & 192 == 64
