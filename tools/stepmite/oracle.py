"""What must be true of every trace: limits kept, no step too early, the path followed.

Every function measures one thing and returns a number (or a row of numbers) that a test compares
with its limit. They know nothing of the planner: they take the edges and the commanded positions
only.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stepmite.trace import TICK_NS, AxisTrace, Floats, Ints, Path4, TraceError, merge


def min_step_gap_ticks(trace: AxisTrace, tick_ns: int = TICK_NS) -> float:
    """Return the shortest time between two steps in ticks; infinity with fewer than 2 steps."""
    if len(trace.step_ns) < 2:
        return float("inf")
    return float(np.diff(trace.step_ns).min() / tick_ns)


def min_pulse_ns(trace: AxisTrace) -> tuple[float, float]:
    """Return the shortest time the step pin was high and the shortest time it was low, in ns."""
    if len(trace.fall_ns) == 0:
        return float("inf"), float("inf")
    rises = trace.step_ns[: len(trace.fall_ns)]
    high = trace.fall_ns[: len(rises)] - rises
    low = trace.step_ns[1:] - trace.fall_ns[: len(trace.step_ns) - 1]
    return float(high.min()), float(low.min()) if len(low) else float("inf")


def min_dir_setup_ns(trace: AxisTrace) -> float:
    """Return the shortest time from a change of direction to the next step, in ns."""
    following = np.searchsorted(trace.step_ns, trace.dir_ns, side="left")
    known = following < len(trace.step_ns)
    if not known.any():
        return float("inf")
    return float((trace.step_ns[following[known]] - trace.dir_ns[known]).min())


def min_dir_hold_ns(trace: AxisTrace) -> float:
    """Return the shortest time from a step to the next change of direction, in ns."""
    before = np.searchsorted(trace.step_ns, trace.dir_ns, side="right") - 1
    known = before >= 0
    if not known.any():
        return float("inf")
    return float((trace.dir_ns[known] - trace.step_ns[before[known]]).min())


@dataclass(frozen=True)
class Blocks:
    """When each commanded block began and ended, read off the step counts."""

    targets: Ints
    """Shape (blocks + 1, axes): the corners of the path in steps, the start first."""
    begin_ns: Ints
    """First step of any axis in the block."""
    end_ns: Ints
    """Last step of any axis in the block."""


def split_blocks(traces: list[AxisTrace], targets: Ints, overlap_ns: int = 1_500_000) -> Blocks:
    """Cut a trace at the commanded corners; TraceError if it does not run through them in order.

    `targets` are the corners in steps, shape (blocks + 1, axes), the start first; corners in which
    nothing moves must be left out. Works because every step is counted: block k owns exactly the
    steps from |travel| up to corner k to |travel| up to corner k + 1 of each axis.
    """
    moves = np.diff(targets, axis=0)
    ends = np.cumsum(np.abs(moves), axis=0)
    begin = np.full(len(moves), np.iinfo(np.int64).max)
    end = np.full(len(moves), np.iinfo(np.int64).min)
    for axis, trace in enumerate(traces):
        wanted = np.repeat(np.sign(moves[:, axis]), np.abs(moves[:, axis]))
        if len(wanted) != len(trace.step_ns):
            raise TraceError(f"{trace.name}: {len(trace.step_ns)} steps, {len(wanted)} commanded")
        wrong = np.flatnonzero(wanted != trace.direction)
        if len(wrong):
            raise TraceError(f"{trace.name}: step {wrong[0]} goes the wrong way")
        used = moves[:, axis] != 0
        last = ends[used, axis] - 1
        first = last - np.abs(moves[used, axis]) + 1
        begin[used] = np.minimum(begin[used], trace.step_ns[first])
        end[used] = np.maximum(end[used], trace.step_ns[last])
    late = np.flatnonzero(end[:-1] > begin[1:] + overlap_ns)
    if len(late):
        raise TraceError(f"block {late[0] + 1} begins before block {late[0]} has ended")
    return Blocks(targets, begin, end)


def block_deviation(traces: list[AxisTrace], blocks: Blocks) -> Floats:
    """Return for each block the largest distance between trace and commanded line, in steps.

    Each axis is measured in its own steps. A moment belongs to its block or, near the corners, to a
    neighbour; a detour along a distant part of the path is not forgiven.
    """
    path = merge_relative(traces, blocks.targets[0])
    points = path.steps.astype(float)
    corners = blocks.targets.astype(float)
    owner = np.searchsorted(blocks.begin_ns, path.time_ns, side="right") - 1
    distance = np.full(len(points), np.inf)
    for shift in (-1, 0, 1):
        block = np.clip(owner + shift, 0, len(corners) - 2)
        distance = np.minimum(
            distance, point_to_segment(points, corners[block], corners[block + 1])
        )
    worst = np.zeros(len(blocks.begin_ns))
    np.maximum.at(worst, owner, distance)
    return worst


def merge_relative(traces: list[AxisTrace], start: Ints) -> Path4:
    """Put the axes on one time line, counted from the position `start` in steps."""
    path = merge(traces)
    return Path4(path.time_ns, path.steps + start, path.names, path.steps_per_unit)


def point_to_segment(points: Floats, a: Floats, b: Floats) -> Floats:
    """Return the distances of points to the segments a-b, row by row."""
    along = b - a
    square = (along * along).sum(axis=-1)
    offset = points - a
    part = (offset * along).sum(axis=-1) / np.where(square > 0, square, 1.0)
    rest = offset - np.clip(part, 0.0, 1.0)[..., None] * along
    return np.sqrt((rest * rest).sum(axis=-1))


def path_deviation(points: Floats, corners: Floats) -> float:
    """Return the largest distance of any point to the nearest part of a polyline, same units.

    Needs no step counts: for recordings whose commands are not exactly known. Points must be in the
    order of the movement (neighbours are near each other), which makes it fast.
    """
    a, b = corners[:-1], corners[1:]
    worst = 0.0
    for chunk in np.array_split(points, max(1, len(points) // 200)):
        middle = chunk[len(chunk) // 2]
        reach = np.sqrt(((chunk - middle) ** 2).sum(axis=1)).max()
        near = point_to_segment(middle[None, :], a, b)
        candidates = np.flatnonzero(near <= near.min() + 2 * reach + 1e-9)
        distances = point_to_segment(chunk[:, None, :], a[None, candidates], b[None, candidates])
        worst = max(worst, float(distances.min(axis=1).max()))
    return worst


@dataclass(frozen=True)
class Extremes:
    """The highest speed and acceleration of an axis and what the estimator itself may add."""

    speed: float
    """Units/s."""
    acceleration: float
    """Units/s^2."""
    speed_error: float
    acceleration_error: float


def extremes(
    trace: AxisTrace, begin_ns: int, end_ns: int, window_ns: int = 25_000_000
) -> Extremes | None:
    """Measure one axis between two times; None if it has no steps two windows apart there.

    The axis must not turn round in between. Takes triples of steps that lie one window or a little
    more apart: speed is the first, acceleration the second divided difference. Both are weighted
    means of the true value, so neither can exceed its true maximum, however far apart the steps
    are. What the estimator adds comes from the time grid alone: a step is seen up to one tick late,
    which moves the position by e = speed * tick, half of it either way around its mean. With the
    window h the errors are at most e/h for the speed and 2e/h^2 for the acceleration.
    """
    first, stop = np.searchsorted(trace.step_ns, [begin_ns, end_ns + 1])
    times = trace.step_ns[first:stop]
    before = np.searchsorted(times, times - window_ns, side="right") - 1
    after = np.searchsorted(times, times + window_ns, side="left")
    here = np.flatnonzero((before >= 0) & (after < len(times)))
    if len(here) == 0:
        return None
    scale = trace.pins.steps_per_unit
    left_s = (times[here] - times[before[here]]) / 1e9
    right_s = (times[after[here]] - times[here]) / 1e9
    left = (here - before[here]) / scale / left_s
    right = (after[here] - here) / scale / right_s
    acceleration = np.abs(right - left) / ((left_s + right_s) / 2)
    hardest = int(acceleration.argmax())
    h = window_ns / 1e9
    speed = float(max(left.max(), right.max()))
    slip = float(max(left[hardest], right[hardest])) * TICK_NS / 1e9
    return Extremes(speed, float(acceleration[hardest]), speed * TICK_NS / 1e9 / h, 2 * slip / h**2)


@dataclass(frozen=True)
class ExitSpeed:
    """Speed along the path at the last step of a block, before the corner."""

    speed: float
    """Units/s."""
    error: float
    """Largest error of the estimate, units/s, for the acceleration given to exit_speed."""
    before_corner: float
    """How far before the corner the last step can lie, in units along the path."""


def exit_speed(
    traces: list[AxisTrace],
    blocks: Blocks,
    index: int,
    acceleration: float,
    window_ns: tuple[int, int] = (4_000_000, 12_000_000),
) -> ExitSpeed | None:
    """Measure how fast block `index` is left; None if it is too short or too slow to tell.

    A parabola through the last step of the axis that makes the most steps and two steps before it,
    one window h or a little more apart; h is the time of the last five steps, within the bounds
    given. Exact for a constant acceleration; whatever the acceleration does between plus and minus
    `acceleration`, the error is at most two thirds of `acceleration` * h (the integral over the
    weight the parabola gives to each moment), to which the time grid adds 2 * speed * tick / h.
    """
    move = blocks.targets[index + 1] - blocks.targets[index]
    axis = int(np.abs(move).argmax())
    trace = traces[axis]
    begin, end = blocks.begin_ns[index], blocks.end_ns[index]
    mine = trace.step_ns[(trace.step_ns >= begin) & (trace.step_ns <= end)]
    if len(mine) < 6 or mine[-1] - mine[-6] > window_ns[1]:
        return None
    window = max(int(mine[-1] - mine[-6]), window_ns[0])
    middle = int(np.searchsorted(mine, mine[-1] - window, side="right")) - 1
    early = int(np.searchsorted(mine, mine[middle] - window, side="right")) - 1
    if middle < 0 or early < 0:
        return None
    last = len(mine) - 1
    late_s = (mine[last] - mine[middle]) / 1e9
    early_s = (mine[middle] - mine[early]) / 1e9
    late, before = (last - middle) / late_s, (middle - early) / early_s
    units = move / np.array([one.pins.steps_per_unit for one in traces])
    length = float(np.sqrt((units[:3] ** 2).sum())) or abs(float(units[3]))
    per_step = length / abs(int(move[axis]))
    speed = float(late + (late - before) / (late_s + early_s) * late_s) * per_step
    error = acceleration * max(late_s, early_s) * 2 / 3 + 2 * speed * TICK_NS / window
    return ExitSpeed(speed, float(error), per_step)
