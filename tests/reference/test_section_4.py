"""Section 4 of the STEPPER reference: SCURVE, JERK, SPINDLE."""

from __future__ import annotations

from pathlib import Path

import pytest
from motion_checks import hardest_acceleration
from typed import READY, SET_UP, SPINDLE, typed

TIMED = "TIMER = 0 : {} : DO : LOOP WHILE PEEK(STEPPER ACTIVE) = 1 : PRINT TIMER / 1000"
MOVE = "STEPPER GC G1 X50 F6000"


def test_scurve_switches_the_profile(tmp_path: Path) -> None:
    """1: with the jerk limit; 0: the trapezoid, which is faster."""
    on = typed(tmp_path, *READY, "STEPPER JERK 2000", "STEPPER SCURVE 1", TIMED.format(MOVE))
    assert on.number() == pytest.approx(4 * (50 / 4000) ** (1 / 3), rel=0.04)
    off = typed(
        tmp_path,
        *READY,
        "STEPPER JERK 2000",
        "STEPPER SCURVE 1",
        "STEPPER SCURVE 0",
        TIMED.format(MOVE),
    )
    assert off.number() == pytest.approx(50 / 100 + 100 / 500, rel=0.01)
    assert hardest_acceleration(on, "X") < 1.1 * 500 + 4 / 80 / 0.02**2


@pytest.mark.parametrize("jerk", [500, 4000])
def test_jerk_is_in_mm_per_s3(jerk: int, tmp_path: Path) -> None:
    """A short move from rest to rest takes 4 (way / 2 jerk)^(1/3)."""
    move = "STEPPER GC G1 X5 F6000"
    session = typed(
        tmp_path, *READY, f"STEPPER JERK {jerk}", "STEPPER SCURVE 1", TIMED.format(move)
    )
    assert session.number() == pytest.approx(4 * (5 / 2 / jerk) ** (1 / 3), rel=0.05)


@pytest.mark.parametrize("line", ["SCURVE 2", "SCURVE -1", "SCURVE", "JERK 0", "JERK -5", "JERK"])
def test_bad_values_are_refused(line: str, tmp_path: Path) -> None:
    """With the valid range."""
    session = typed(tmp_path, *SET_UP, f"STEPPER {line}")
    assert len(session.errors()) == 1


@pytest.mark.parametrize(("invert", "on"), [("", 1), (",0", 1), (",1", 0)])
def test_spindle_pin(invert: str, on: int, tmp_path: Path) -> None:
    """Off from the start, on by M3, off by M5; inverted: low is on."""
    lines = [f"STEPPER SPINDLE GP{SPINDLE}{invert}", "STEPPER POSITION HOME", "STEPPER RUN"]
    session = typed(
        tmp_path, *SET_UP, *lines, "STEPPER GC M3", "PAUSE 50", "STEPPER GC M5", "PAUSE 50"
    )
    assert session.errors() == []
    run_ms, switched_ms = session.typed_ms[-5], session.typed_ms[-3]
    assert session.level_at(SPINDLE, run_ms) == 1 - on
    assert session.level_at(SPINDLE, switched_ms) == on
    assert session.level(SPINDLE) == 1 - on


@pytest.mark.parametrize("pin", ["GP2", "GP3", "GP4", "GP22"])
def test_spindle_pin_must_be_free(pin: str, tmp_path: Path) -> None:
    """Not one of an axis or the E-STOP input; the error says whose it is."""
    session = typed(
        tmp_path, "STEPPER INIT ,,GP22", *SET_UP[1:], f"STEPPER SPINDLE {pin}", "STEPPER GC M3"
    )
    assert pin in session.errors()[0]
    assert session.errors()[1].startswith("Spindle pin not configured")


def test_m3_without_a_spindle_pin(tmp_path: Path) -> None:
    """Says which command is missing."""
    session = typed(tmp_path, *READY, "STEPPER GC M3")
    assert session.errors() == ["Spindle pin not configured (use STEPPER SPINDLE)"]
