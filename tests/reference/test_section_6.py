"""Section 6 of the STEPPER reference: the rotary A axis."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from motion_checks import duration_s, hardest_acceleration, speeds
from typed import READY, SET_UP, WAIT, typed

START = ["STEPPER POSITION HOME", "STEPPER RUN"]


def test_units_are_degrees(tmp_path: Path) -> None:
    """Steps per degree, degrees/min, degrees/s^2."""
    session = typed(
        tmp_path,
        "STEPPER INIT",
        "STEPPER AXIS A,GP11,GP12,,,10,3600,120",
        *START,
        "STEPPER GC G0 A180",
        WAIT,
        "STEPPER STATUS",
    )
    assert session.axis("A").end_steps() == 1800
    assert duration_s(session, "A") == pytest.approx(180 / 60 + 60 / 120, rel=0.03)
    assert "A motion: 10 steps/deg, max 3600 deg/min, 120 deg/s^2" in session.last


def test_no_soft_limits_and_no_end(tmp_path: Path) -> None:
    """LIMITS refuses A, and A turns on and on."""
    session = typed(
        tmp_path,
        *READY,
        "STEPPER LIMITS A,0,90",
        "STEPPER GC G0 A7200",
        WAIT,
        "PRINT PEEK(STEPPER A)",
    )
    assert session.errors() == ["axis: A is invalid (valid is X, Y, Z)"]
    assert session.number() == 7200


def test_a_travels_along(tmp_path: Path) -> None:
    """F counts along XYZ; A begins and ends with the others."""
    session = typed(tmp_path, *READY, "STEPPER GC G1 X30 Y40 A100 F3000", WAIT)
    assert duration_s(session, "XY") == pytest.approx(50 / 50 + 50 / 500 * 0.8, rel=0.05)
    middle_ns = session.axis("X").step_ns[1200]
    assert session.axis("A").position_at(np.array([middle_ns]))[0] == pytest.approx(500, abs=2)


def test_a_is_never_faster_than_it_may(tmp_path: Path) -> None:
    """A move that would ask for more is slowed down as a whole."""
    session = typed(
        tmp_path,
        *SET_UP,
        "STEPPER AXIS A,GP11,GP12,GP13,,10,3600,500",
        *START,
        "STEPPER GC G1 X10 A360 F6000",
        WAIT,
    )
    _, speed = speeds(session, "A")
    assert np.median(speed) == pytest.approx(60, abs=1)
    assert session.end("X") == 10
    assert hardest_acceleration(session, "A") < 1.1 * 500 + 4 / 10 / 0.02**2


def test_f_of_a_alone_is_degrees(tmp_path: Path) -> None:
    """Upwards and downwards."""
    session = typed(tmp_path, *READY, "STEPPER GC G1 A-60 F600", WAIT)
    assert session.end("A") == -60
    assert duration_s(session, "A") == pytest.approx(6, rel=0.01)


def test_g92_a(tmp_path: Path) -> None:
    """The work offset of A."""
    session = typed(
        tmp_path,
        *READY,
        "STEPPER GC G1 A30 F6000",
        WAIT,
        "STEPPER GC G92 A0",
        "PRINT PEEK(STEPPER A)",
        "STEPPER GC G1 A10",
        WAIT,
        "PRINT PEEK(STEPPER A)",
    )
    assert session.number(-4) == 0
    assert session.number() == 10
    assert session.end("A") == 40
