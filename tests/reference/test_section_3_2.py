"""Section 3.2 of the STEPPER reference: STEPPER POSITION."""

from __future__ import annotations

from pathlib import Path

from typed import READY, SET_UP, WAIT, typed

ALL = "PRINT PEEK(STEPPER X), PEEK(STEPPER Y), PEEK(STEPPER Z), PEEK(STEPPER A)"


def test_position_home_zeroes_all_and_clears_g92(tmp_path: Path) -> None:
    """Wherever the axes stand and whatever offsets there are."""
    session = typed(
        tmp_path,
        *READY,
        "STEPPER GC G1 X5 Y6 Z1 A20 F6000",
        WAIT,
        "STEPPER GC G92 X100 Y100 Z100 A100",
        ALL,
        "STEPPER POSITION HOME",
        ALL,
        "STEPPER GC G0 X1",
        WAIT,
    )
    assert session.numbers(-5) == [100] * 4
    assert session.numbers(-3) == [0] * 4
    assert session.end("X") == 6


def test_position_of_an_axis(tmp_path: Path) -> None:
    """In mm, A in degrees; only that axis, and nothing moves."""
    lines = ["STEPPER POSITION X, 12.5", "STEPPER POSITION A, -90", "STEPPER POSITION Z, 2 * 3"]
    session = typed(tmp_path, *READY, *lines, ALL)
    assert session.errors() == []
    assert session.numbers() == [12.5, 0, 6, -90]
    assert all(len(session.axis(name).step_ns) == 0 for name in "XYZA")


def test_position_makes_motion_possible(tmp_path: Path) -> None:
    """Moves are refused before it, and start from there behind it."""
    move = "STEPPER GC G1 X12 F600"
    session = typed(tmp_path, *SET_UP, "STEPPER RUN", move, "STEPPER POSITION X, 10", move, WAIT)
    assert len(session.errors()) == 1
    assert "position unknown" in session.errors()[0]
    assert session.end("X") == 2
