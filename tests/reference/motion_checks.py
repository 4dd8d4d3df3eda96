"""What the edges of a session say about speed and smoothness."""

from __future__ import annotations

import numpy as np
from typed import Session

from stepmite.trace import merge, path_speed


def speeds(session: Session, axes: str = "X") -> tuple[np.ndarray, np.ndarray]:
    """Time in s from the first step and speed along the path in mm/s (or degrees/s)."""
    return path_speed([session.axis(name) for name in axes])


def duration_s(session: Session, axes: str = "X") -> float:
    """Time from the first step to the last."""
    traces = [session.axis(name) for name in axes]
    return (
        float(
            max(trace.step_ns[-1] for trace in traces) - min(trace.step_ns[0] for trace in traces)
        )
        / 1e9
    )


def slowest_between(session: Session, axes: str, start_s: float, end_s: float) -> float:
    """The lowest speed between two times, counted from the first step."""
    time, speed = speeds(session, axes)
    return float(speed[(time >= start_s) & (time <= end_s)].min())


def hardest_acceleration(session: Session, axis: str, window_s: float = 0.02) -> float:
    """The greatest change of an axis's velocity over a window, as acceleration.

    The velocity keeps its sign, so turning round counts. A jump of the speed by v shows as
    v / window. Counting whole steps adds up to 4 steps / window^2.
    """
    trace = session.axis(axis)
    scale = trace.pins.steps_per_unit
    times = np.arange(trace.step_ns[0] - 5e7, trace.step_ns[-1] + 5e7, window_s * 1e9 / 8)
    place = trace.position_at(times) / scale
    velocity = (place[8:] - place[:-8]) / window_s
    return float(np.abs(velocity[8:] - velocity[:-8]).max() / window_s)


def places(session: Session, axes: str) -> np.ndarray:
    """All points of the path in mm, a row for each moment with a step."""
    return merge([session.axis(name) for name in axes]).units()
