"""The judges of these tests find what they are for, in motions that are wrong on purpose."""

from __future__ import annotations

import numpy as np
import pytest
from motion_checks import hardest_acceleration, slowest_between
from typed import DIR_X, STEP_X, Session, error_of

from stepmite.trace import Edges


def session_of(times_s: np.ndarray, directions: np.ndarray) -> Session:
    """A session in which X has made steps at these times, +1 or -1."""
    rows = []
    level = 0
    for time_ns, direction in zip((times_s * 1e9).astype(int), directions, strict=True):
        if level != (direction > 0):
            level = int(direction > 0)
            rows.append((time_ns - 5000, DIR_X, level))
        rows += [(time_ns, STEP_X, 1), (time_ns + 10_000, STEP_X, 0)]
    return Session([], [], Edges.from_rows(rows), "")


def at_speeds(speeds_mm_s: list[float], steps_each: int) -> Session:
    """So many steps at each speed, without a ramp between them."""
    gaps = np.concatenate([np.full(steps_each, 1 / (80 * abs(v))) for v in speeds_mm_s])
    signs = np.concatenate([np.full(steps_each, np.sign(v)) for v in speeds_mm_s])
    return session_of(np.cumsum(gaps), signs)


def test_a_jump_of_speed_is_found() -> None:
    """From 100 to 22 mm/s at once, as at a badly planned joint."""
    jump = hardest_acceleration(at_speeds([100, 22.4, 100], 4000), "X")
    assert jump > 3000


def test_turning_round_at_speed_is_found() -> None:
    """The same speed the other way is a jump as well."""
    assert hardest_acceleration(at_speeds([50, -50], 4000), "X") > 4500


def test_an_even_ramp_is_measured_as_it_is() -> None:
    """500 mm/s^2 up and down."""
    steps = np.arange(1, 1601)
    up = np.sqrt(2 * steps / 80 / 500)
    times = np.concatenate([up, 2 * up[-1] - up[:-1][::-1]])
    measured = hardest_acceleration(session_of(times, np.ones(len(times))), "X")
    assert measured == pytest.approx(500, rel=0.2)


def test_a_stop_between_two_moves_is_found() -> None:
    """A slow place in the middle of a fast way."""
    session = at_speeds([50, 1, 50], 400)
    assert slowest_between(session, "X", 0.05, session.edges.time_ns[-1] / 1e9 - 0.1) < 2


def test_an_error_is_seen_in_an_answer() -> None:
    """Behind other lines as well."""
    assert error_of("Homing\nError : No luck") == "No luck"
    assert error_of("Error of nothing") == ""
