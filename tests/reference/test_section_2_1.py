"""Section 2.1 of the STEPPER reference: STEPPER INIT."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from motion_checks import places
from typed import AXES, ENABLE_X, ESTOP, READY, WAIT, Event, typed

MOVE = "STEPPER GC G1 X50 F3000"


@pytest.mark.parametrize(
    "command",
    [
        "AXIS X,GP2,GP3",
        "TUNE X,,80",
        "HWLIMITS GP16,GP17,GP18",
        "LIMITS X,0,100",
        "ESTOP",
        "GC G1 X10 F500",
        'GS "G1 X10 F500"',
        "GCODE G1, X, 10, F, 500",
        "POSITION HOME",
        "POSITION X, 5",
        "SCURVE 1",
        "JERK 1000",
        "SPINDLE GP14",
        "RUN",
        "CLEAR",
    ],
)
def test_nothing_before_init(command: str, tmp_path: Path) -> None:
    """Each other command says that INIT comes first, and takes nothing."""
    session = typed(tmp_path, f"STEPPER {command}", "STEPPER INIT", *AXES)
    assert session.errors() == ["Stepper not initialized (use STEPPER INIT)"]


def test_init_alone_is_enough(tmp_path: Path) -> None:
    """No argument is needed."""
    session = typed(tmp_path, "STEPPER INIT", "STEPPER AXIS X,GP2,GP3", "PRINT PEEK(STEPPER X)")
    assert session.errors() == []
    assert session.number() == 0


@pytest.mark.parametrize(
    ("arguments", "tolerance", "slots"),
    [
        ("", 0.05, 32),
        ("0.1", 0.1, 32),
        (",64", 0.05, 64),
        (",,GP22", 0.05, 32),
        ("0.2,,GP22,1", 0.2, 32),
        (",,,1", 0.05, 32),
        ("0.05,1024", 0.05, 1024),
        ("0.05,1", 0.05, 1),
    ],
)
def test_defaults_and_blank_arguments(
    arguments: str, tolerance: float, slots: int, tmp_path: Path
) -> None:
    """0.05 mm and 32 slots; what is left out in the middle keeps its default."""
    session = typed(
        tmp_path,
        f"STEPPER INIT {arguments}",
        "PRINT PEEK(STEPPER BUFFER)",
        "STEPPER STATUS",
        events=[Event(0, ESTOP, 1)],
    )
    assert session.errors() == []
    assert session.number(1) == slots
    assert f"arc tolerance: {tolerance:g} mm" in session.last


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (",1025", "buffer_size"),
        (",0", "buffer_size"),
        (",-1", "buffer_size"),
        ("0", "arc_tolerance"),
        ("-0.1", "arc_tolerance"),
        (",,GP22,2", "estop_keep_enabled"),
        (",,GP99", "estop_pin"),
    ],
)
def test_ranges_are_told(arguments: str, name: str, tmp_path: Path) -> None:
    """The error names the argument, and INIT may be tried again."""
    session = typed(tmp_path, f"STEPPER INIT {arguments}", "STEPPER INIT")
    assert len(session.errors()) == 1
    assert name in session.errors()[0] or "GP99" in session.errors()[0]


def test_arcs_keep_the_tolerance(tmp_path: Path) -> None:
    """With the default no step of a circle is farther than 0.05 mm and a step from it."""
    session = typed(tmp_path, *READY, "STEPPER GC G2 I20 F3000", WAIT)
    points = places(session, "XY")
    radius = np.hypot(points[:, 0] - 20, points[:, 1])
    assert np.abs(radius - 20).max() < 0.05 + 1 / 80


@pytest.mark.parametrize("keep", [0, 1, None])
def test_estop_pin_stops_everything(keep: int | None, tmp_path: Path) -> None:
    """Active low; drivers go off unless 1 was given; the position is unknown behind it."""
    init = f"STEPPER INIT ,,GP{ESTOP}" + ("" if keep is None else f",{keep}")
    session = typed(
        tmp_path,
        init,
        *AXES,
        "STEPPER SPINDLE GP14",
        "STEPPER POSITION HOME",
        "STEPPER RUN",
        "STEPPER GC M3",
        MOVE,
        "PAUSE 1000",
        "PRINT PEEK(STEPPER STATUS)",
        events=[Event(0, ESTOP, 1), Event(400, ESTOP, 0)],
    )
    steps = session.axis("X").step_ns
    assert steps[-1] <= 400e6 + 10_000
    assert 1 < len(steps) < 4000
    assert session.level_at(ENABLE_X, 399) == 0
    assert session.level(ENABLE_X) == (0 if keep == 1 else 1)
    assert session.level_at(14, 399) == 1
    assert session.level(14) == 0
    assert int(session.number()) & 0b1100_0000 == 0b0100_0000


def test_estop_pin_is_pulled_up(tmp_path: Path) -> None:
    """An open input is no E-STOP."""
    session = typed(
        tmp_path, f"STEPPER INIT ,,GP{ESTOP}", *AXES, "STEPPER RUN", "PRINT PEEK(STEPPER STATUS)"
    )
    assert session.errors() == []
    assert int(session.number()) & 64 == 0
