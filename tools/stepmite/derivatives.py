"""Speed, acceleration and jerk over time, rebuilt from edges for pictures.

A cubic is fitted around each moment, so what lasts shorter than the window is smeared: pictures
show the course of things, limits are judged by stepmite.limits, which does not smooth.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stepmite.follow import Progress
from stepmite.trace import AxisTrace, Floats, Ints

REST_STEP_NS = 250_000
"""Distance of the samples that stand for a machine at rest."""


@dataclass(frozen=True)
class Course:
    """Values along the path over time."""

    time_s: Floats
    speed: Floats
    acceleration: Floats
    jerk: Floats


def fit(time_ns: Ints, position: Floats, at_ns: Floats, half_ns: float) -> Floats:
    """Return speed, acceleration and jerk at the given moments, shape (3, moments).

    Weights fall towards the ends of the window, where a neighbour's samples come and go.
    """
    result = np.zeros((3, len(at_ns)))
    first = np.searchsorted(time_ns, at_ns - half_ns)
    last = np.searchsorted(time_ns, at_ns + half_ns, side="right")
    for index, (a, b) in enumerate(zip(first, last, strict=True)):
        # At low speed edges are rare: two more on each side.
        a, b = max(0, min(a, b - 4)), min(len(time_ns), max(b, a + 4))
        if b - a < 4:
            continue
        x = (time_ns[a:b] - at_ns[index]) / half_ns
        reach = max(1.0, float(np.abs(x).max()) * 1.001)
        weight = (1 - np.minimum(np.abs(x) / reach, 1) ** 3) ** 1.5
        powers = np.stack([np.ones_like(x), x, x * x, x * x * x], axis=1) * weight[:, None]
        factors = np.linalg.lstsq(powers, position[a:b] * weight, rcond=None)[0]
        unit_s = half_ns / 1e9
        result[:, index] = factors[1:] * [1 / unit_s, 2 / unit_s**2, 6 / unit_s**3]
    return result


def with_rest(time_ns: Ints, position: Floats, rest: float, around_ns: int) -> tuple[Ints, Floats]:
    """Put samples of the machine at rest before the first and behind the last moment.

    `rest` is how far from the first and the last sample the motor really stands, in units.
    """
    gaps = np.diff(time_ns[[0, 1, -2, -1]])[[0, 2]] * 2
    before = np.arange(time_ns[0] - around_ns, time_ns[0] - gaps[0], REST_STEP_NS)
    behind = np.arange(time_ns[-1] + gaps[1], time_ns[-1] + around_ns, REST_STEP_NS)
    ends = np.sign(position[[1, -1]] - position[[0, -2]]) * rest
    values = [
        np.full(len(before), position[0] - ends[0]),
        position,
        np.full(len(behind), position[-1] + ends[1]),
    ]
    return np.concatenate([before, time_ns, behind]), np.concatenate(values)


def _moments(first_ns: int, last_ns: int, count: int | None, around_ns: int) -> Floats:
    if count is None:
        count = int(np.clip((last_ns - first_ns) / 1_000_000, 600, 6000))
    return np.linspace(first_ns - around_ns * 0.7, last_ns + around_ns * 0.7, count)


JERK_SHARE = 2.2
"""The window for the jerk is so much wider: the noise of a third derivative grows quickly."""


def along_path(progress: Progress, half_s: float = 0.005, count: int | None = None) -> Course:
    """Return the course of a motion whose path is known: exact in corners too."""
    order = np.unique(progress.time_ns, return_index=True)[1]
    time_ns, way = progress.time_ns[order], progress.way[order]
    around = int(4e9 * half_s)
    times, ways = with_rest(time_ns, way, float(way[0]), around)
    at = _moments(int(time_ns[0]), int(time_ns[-1]), count, around)
    speed, acceleration, _ = fit(times, ways, at, half_s * 1e9)
    jerk = fit(times, ways, at, half_s * 1e9 * JERK_SHARE)[2]
    return Course((at - time_ns[0]) / 1e9, speed, acceleration, jerk)


def along_axes(traces: list[AxisTrace], half_s: float = 0.006, count: int | None = None) -> Course:
    """Return the course from the axes alone; a corner at speed shows as a short dip."""
    around = int(4e9 * half_s)
    first = min(int(trace.step_ns[0]) for trace in traces)
    last = max(int(trace.step_ns[-1]) for trace in traces)
    at = _moments(first, last, count, around)
    axes = []
    for trace in traces:
        if len(trace.step_ns) < 4:
            continue
        scale = trace.pins.steps_per_unit
        position = (trace.steps() - trace.direction * 0.5) / scale
        moments = with_rest(trace.step_ns, position, 0.5 / scale, around)
        axes.append(fit(*moments, at, half_s * 1e9))
    if not axes:
        return Course((at - first) / 1e9, *np.zeros((3, len(at))))
    stack = np.stack(axes)
    speed = np.sqrt((stack[:, 0] ** 2).sum(axis=0))
    along = (stack[:, 0] * stack[:, 1]).sum(axis=0) / np.maximum(speed, 0.05)
    return Course((at - first) / 1e9, speed, along, np.gradient(along, at / 1e9))
