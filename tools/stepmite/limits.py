"""Are speed, acceleration, jerk, corners and path kept? Judged by step edges and the G-code alone.

Every check takes edges that lie one span or a little more apart and forms a divided difference: a
weighted mean of the true speed, acceleration or jerk in between. A mean never exceeds what it is
the mean of, so a limit that is kept is never reported as broken, whatever the motion does, and
nothing is filtered. What the estimate itself may add comes from the time grid alone: an edge lies
within JITTER_NS of the moment at which the axis is half way between two steps. That times the
speed is an error of the position; the divided difference multiplies it by the sum of its weights.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stepmite.follow import SHARE_LEAST, AxisMotion, Progress
from stepmite.path import Corner, Path
from stepmite.plan import Machine
from stepmite.trace import TICK_NS, AxisTrace, Floats, Ints, merge

JITTER_NS = TICK_NS
"""Half a tick by rounding to the grid, half a tick by which a segment may begin off its time."""
CHORD_S = 0.001
"""The longest straight part of a curve: it is a * CHORD_S^2 / 8 from the curve if a turns it."""
CORNER_JITTER_NS = 24 * TICK_NS
"""Around a corner: an axis that turns round stands for two ticks and makes up for it at once, the
last few ticks of a block may share a segment with the next block, and where speeding up turns into
braking a few ticks are not worth a segment."""
CREEP = 0.4
"""Units/s: corners are not judged below this speed where the jerk is limited."""
SLOW = 1.0
"""Units/s: jerk is judged above this speed only."""


@dataclass(frozen=True)
class Finding:
    """The worst place of one check: how much of the limit is certainly used there."""

    what: str
    used: float
    """Measured value without what the estimator may have added, relative to its limit."""
    value: float
    limit: float
    error: float
    """Largest error of `value`."""
    time_ns: int
    count: int
    """How many places were looked at."""

    def __str__(self) -> str:
        return (
            f"{self.what}: {self.used:.3f} of the limit ({self.value:.5g} +- {self.error:.2g}, "
            f"limit {self.limit:.5g}) at {self.time_ns / 1e9:.4f} s, {self.count} places"
        )


@dataclass(frozen=True)
class Differences:
    """Divided differences times the factorial of their order: means of a derivative."""

    value: Floats
    weight: Floats
    """Sum of the sizes of the weights: what multiplies an error of the position."""
    first: Ints
    last: Ints
    """Index of the first and the last moment used."""


def differences(time_ns: Ints, position: Floats, order: int, span_ns: int) -> Differences | None:
    """Return means of the derivative of this order; None if there are not enough moments.

    Neighbouring moments lie `span_ns` or a little more apart. Begins at every fourth of a span.
    """
    if len(time_ns) <= order:
        return None
    starts = np.unique(
        np.searchsorted(time_ns, np.arange(time_ns[0], time_ns[-1] + 1, max(1, span_ns // 4)))
    )
    places = [starts]
    for _ in range(order):
        following = np.searchsorted(time_ns, time_ns[places[-1]] + span_ns)
        fits = following < len(time_ns)
        places = [place[fits] for place in places]
        places.append(following[fits])
    if len(places[0]) == 0:
        return None
    seconds = [(time_ns[place] - time_ns[places[0]]) / 1e9 for place in places]
    value, weight = np.zeros(len(places[0])), np.zeros(len(places[0]))
    for i, place in enumerate(places):
        product = np.full(len(place), 1.0 / math.factorial(order))
        for j, other in enumerate(seconds):
            if j != i:
                product = product * (seconds[i] - other)
        value += position[place] / product
        weight += 1 / np.abs(product)
    return Differences(value, weight, places[0], places[-1])


class RangeMax:
    """The largest of a row of values between two indexes, for many pairs at once."""

    def __init__(self, values: Sequence[float]) -> None:
        self._levels = [np.asarray(values, dtype=float)]
        while 2 ** len(self._levels) <= len(values):
            before, reach = self._levels[-1], 2 ** (len(self._levels) - 1)
            self._levels.append(np.maximum(before[:-reach], before[reach:]))

    def of(self, first: Ints, last: Ints) -> Floats:
        """Return the maxima of values[first..last]."""
        depth = np.frexp(last - first + 1)[1] - 1
        result = np.empty(len(first))
        for level in np.unique(depth):
            mine = depth == level
            row = self._levels[level]
            right = last[mine] - 2**level + 1
            result[mine] = np.maximum(row[first[mine]], row[right])
        return result


def _worst(what: str, value: Floats, limit: Floats, error: Floats, time_ns: Ints) -> Finding | None:
    if len(value) == 0:
        return None
    used = (np.abs(value) - error) / limit
    at = int(used.argmax())
    numbers = (float(row[at]) for row in (used, value, limit, error))
    used_at, value_at, limit_at, error_at = numbers
    return Finding(what, used_at, value_at, limit_at, error_at, int(time_ns[at]), len(value))


@dataclass(frozen=True)
class Judge:
    """The checks of one motion along a path."""

    path: Path
    machine: Machine
    progress: Progress
    traces: list[AxisTrace]
    feed_factor: float = 1.0
    """Highest feed override that was in force."""

    def _along(self, what: str, order: int, span_ns: int, limits: RangeMax) -> Finding | None:
        time_ns, way = self.progress.time_ns, self.progress.way
        found = differences(time_ns, way, order, span_ns)
        if found is None:
            return None
        begin, end = self._pieces(found)
        error = found.weight * self._position_error(found)
        keep = np.ones(len(begin), bool)
        if order == 3:
            slow = np.concatenate([[0], np.cumsum(self._slow())])
            keep = slow[found.last] == slow[found.first]
        values = found.value, limits.of(begin, end), error, time_ns[found.first]
        value, limit, error, when = (row[keep] for row in values)
        return _worst(what, value, limit, error, when)

    def _pieces(self, found: Differences) -> tuple[Ints, Ints]:
        """Return the first and the last piece that can have to do with each difference."""
        way = self.progress.way
        slack = 2e-9 + self._position_error(found)
        first = self.path.piece_at(way[found.first] - slack)
        last = self.path.piece_at(way[found.last] + slack)
        return first, last

    def _position_error(self, found: Differences) -> Floats:
        """Return how far off a position may be because of the grid of time."""
        way, time_ns = self.progress.way, self.progress.time_ns
        took = time_ns[found.last] - time_ns[found.first]
        mean = (way[found.last] - way[found.first]) / took
        # Within the window the speed is above its mean by what the acceleration makes of it.
        hardest = max(piece.acceleration for piece in self.path.pieces)
        fastest = max(piece.speed for piece in self.path.pieces) * max(1.0, self.feed_factor)
        by_time = JITTER_NS * np.minimum(mean + hardest * took / 2e18, fastest / 1e9)
        return by_time + self._chord_error(way[found.first], way[found.last])

    def _chord_error(self, first: Floats, last: Floats) -> Floats:
        """Return how far off a place on a curve may be because it is made of chords."""
        hardest = max(self.machine.max_acceleration)
        curved = RangeMax([hardest * (not piece.is_straight) for piece in self.path.pieces])
        pieces = self.path.piece_at(first - 1e-9), self.path.piece_at(last + 1e-9)
        # The place is told by an axis that is at least this share of the fastest one.
        return curved.of(*pieces) * CHORD_S**2 / 8 / SHARE_LEAST

    def _slow(self) -> Ints:
        """Return for each moment whether the machine may be slower than SLOW soon after it."""
        time_ns, way = self.progress.time_ns, self.progress.way
        later = np.minimum(np.searchsorted(time_ns, time_ns + 2_000_000), len(time_ns) - 1)
        took = np.maximum(1, time_ns[later] - time_ns) / 1e9
        hardest = max(piece.acceleration for piece in self.path.pieces)
        return ((way[later] - way) / took - hardest * took / 2 < SLOW).astype(np.int64)

    def feed(self, span_ns: int = 5_000_000) -> Finding | None:
        """Speed along the path against feed and axes."""
        speeds = [
            min(piece.feed_speed * self.feed_factor, piece.axes_speed, piece.turn_speed)
            for piece in self.path.pieces
        ]
        return self._along("feed", 1, span_ns, RangeMax(speeds))

    def path_acceleration(self, span_ns: int = 12_000_000) -> Finding | None:
        """Acceleration along the path against what the axes allow in its direction."""
        limits = RangeMax([piece.acceleration for piece in self.path.pieces])
        return self._along("path acceleration", 2, span_ns, limits)

    def path_jerk(self, span_ns: int) -> Finding | None:
        """Jerk along the path, where the speed is above 1 mm/s all the time."""
        limits = RangeMax([piece.jerk for piece in self.path.pieces])
        return self._along(f"path jerk, {span_ns / 1e6:.0f} ms", 3, span_ns, limits)

    def axis_speed(self, axis: AxisMotion, span_ns: int = 5_000_000) -> Finding | None:
        """Speed of an axis; nothing is left out."""
        if len(axis.time_ns) < 2:
            return None
        limit = self.machine.max_velocity["XYZA".index(axis.name)]
        found = differences(axis.time_ns, axis.position, 1, span_ns)
        if found is None:
            return None
        error = found.weight * limit * JITTER_NS / 1e9
        limits = np.full(len(error), limit)
        when = axis.time_ns[found.first]
        return _worst(f"speed of {axis.name}", found.value, limits, error, when)

    def axis_acceleration(self, axis: AxisMotion, span_ns: int = 12_000_000) -> Finding | None:
        """Acceleration of an axis, the turn on arcs included.

        In a corner that is passed at speed (path exact, no blend) the axis jumps; the jump that the
        rule of the corner allows is granted to the windows around it, and no more. With blends
        there is no such corner.
        """
        if len(axis.time_ns) < 3:
            return None
        found = differences(axis.time_ns, axis.position, 2, span_ns)
        if found is None:
            return None
        number = "XYZA".index(axis.name)
        limit, fastest = self.machine.max_acceleration[number], self.machine.max_velocity[number]
        begin, end = axis.time_ns[found.first], axis.time_ns[found.last]
        took = (end - begin) / 1e9
        mean = (found.last - found.first) * np.abs(np.diff(axis.position)).max() / took
        offset = np.minimum(fastest, mean + limit * took / 2) * JITTER_NS / 1e9
        offset += self._chord_error(axis.way[found.first], axis.way[found.last])
        error = found.weight * offset
        if len(self.progress.way) == 0:
            return None
        way, size = self._jumps(number)
        times = np.interp(way, self.progress.way, self.progress.time_ns)
        sizes = np.concatenate([[0.0], np.cumsum(size)])
        first = np.searchsorted(times, begin - 1_000_000)
        last = np.searchsorted(times, end + 1_000_000, side="right")
        granted = (sizes[last] - sizes[first]) * 2 / took
        value = np.maximum(0.0, np.abs(found.value) - granted)
        return _worst(
            f"acceleration of {axis.name}", value, np.full(len(value), limit), error, begin
        )

    def _jumps(self, axis: int) -> tuple[Floats, Floats]:
        """Return where on the way the speed of an axis may jump, and how much."""
        jumps = [corner for corner in self.path.corners if 0 < corner.speed < math.inf]
        way = np.array([corner.way for corner in jumps])
        pieces = self.path.piece_at(way - 1e-7), self.path.piece_at(way + 1e-7)
        fastest = RangeMax([piece.speed for piece in self.path.pieces]).of(*pieces)
        rule = np.array([corner.speed for corner in jumps])
        change = np.array([abs(corner.change[axis]) for corner in jumps])
        return way, change * np.minimum(rule, fastest * self.feed_factor)

    def corners(self, tolerance: float = 1.02) -> Finding | None:
        """Speed in the corners against their rule.

        From a place d before it a corner cannot be reached sooner than t, v t + A t^2 / 2 = d, if
        v is the speed in the corner; likewise behind it. So a pair of edges around a corner must be
        at least that far apart in time. `used` is the needed time relative to the time taken.
        """
        time_ns, way = self.progress.time_ns, self.progress.way
        inner = [corner for corner in self.path.corners[1:-1] if corner.speed < math.inf]
        if not inner:
            return None
        hardest = RangeMax([piece.acceleration for piece in self.path.pieces])
        place = np.searchsorted(way, [corner.way for corner in inner])
        rows = []
        for number in (1, 2, 4, 8, 16):
            fits = (place - number >= 0) & (place + number - 1 < len(way))
            before, after = place[fits] - number, place[fits] + number - 1
            mine = [corner for corner, fit in zip(inner, fits, strict=True) if fit]
            needed = self._time_around(mine, way[before], way[after], hardest, tolerance)
            rows.append(
                np.stack([needed, (time_ns[after] - time_ns[before]) / 1e9, time_ns[before]])
            )
        needed, taken, when = np.concatenate(rows, axis=1)
        jitter = CORNER_JITTER_NS / 1e9
        # The time needed is the value, the time taken its limit.
        return _worst("corners", needed, np.maximum(taken, 1e-9), np.full(len(taken), jitter), when)

    def _time_around(
        self, corners: list[Corner], before: Floats, after: Floats, hardest: RangeMax, factor: float
    ) -> Floats:
        pieces = self.path.piece_at(before), self.path.piece_at(after)
        acceleration = hardest.of(*pieces) * factor
        way = np.array([corner.way for corner in corners])
        # With a jerk limit the last way to a corner may be crept.
        least = CREEP if math.isfinite(self.machine.path_jerk) else 0.0
        speed = np.array([max(corner.speed, least) for corner in corners]) * factor
        needed = np.zeros(len(corners))
        for distance in (way - before, after - way):
            needed += (np.sqrt(speed**2 + 2 * acceleration * distance) - speed) / acceleration
        return needed

    def deviation_steps(self) -> Finding | None:
        """Distance of the motors from the path at every step, of the axis that is farthest off.

        Each axis counts in its own steps; half a step of it is rounding. Looked for between the
        last place that was certainly passed and the next.
        """
        moved = merge(self.traces)
        points = np.zeros((len(moved.time_ns), 4))
        for column, name in enumerate(moved.names):
            points[:, "XYZA".index(name)] = moved.steps[:, column]
        points += np.floor(self.path.steps[0] + 0.5)
        way, end = self.progress.way, self.progress.end_way
        passed = np.concatenate([[0.0], np.maximum.accumulate(way), [end]])
        coming = np.concatenate([[0.0], np.minimum.accumulate(way[::-1])[::-1], [end]])
        before = np.searchsorted(self.progress.time_ns, moved.time_ns)
        behind = np.searchsorted(self.progress.time_ns, moved.time_ns, side="right") + 1
        # An edge or two near a corner may come out of order: look as far as both sides say.
        low = np.minimum(passed[before], coming[before])
        high = np.maximum(passed[behind], coming[behind])
        distance = self._nearest(points, low, high, 5)
        for least, count in ((0.6, 101), (0.9, 5001)):
            far = np.flatnonzero(distance > least)
            distance[far] = self._nearest(points[far], low[far], high[far], count)
        ones = np.ones(len(distance))
        return _worst("deviation in steps", distance, ones, 0 * ones, moved.time_ns)

    def _nearest(self, points: Floats, low: Floats, high: Floats, count: int) -> Floats:
        """Return the distances to the nearest of `count` places between two ways."""
        nearest = np.full(len(points), np.inf)
        for part in np.linspace(0, 1, count):
            there = self.path.steps_at(low + (high - low) * part)
            nearest = np.minimum(nearest, np.abs(points - there).max(axis=1))
        return nearest


def of_one_axis(
    trace: AxisTrace, order: int, span_ns: int, limit: float, fastest: float
) -> Finding | None:
    """Judge an axis that moves alone, without a path: speed (1), acceleration (2) or jerk (3).

    Units, units/s of `fastest`, the highest speed; jerk is judged above SLOW only.
    """
    position = (trace.steps() - trace.direction * 0.5) / trace.pins.steps_per_unit
    found = differences(trace.step_ns, position, order, span_ns)
    if found is None:
        return None
    error = found.weight * fastest * JITTER_NS / 1e9
    keep = np.ones(len(error), bool)
    if order == 3:
        gaps = np.diff(trace.step_ns, append=trace.step_ns[-1] + 10**9) / 1e9
        turns = np.diff(trace.direction, append=trace.direction[-1]) != 0
        slow = np.cumsum(turns | (1 / trace.pins.steps_per_unit / gaps < 2 * SLOW))
        keep = slow[found.last] == slow[found.first]
    what = ("speed", "acceleration", "jerk")[order - 1]
    limits = np.full(len(error), limit)
    rows = found.value, limits, error, trace.step_ns[found.first]
    value, limits, error, when = (row[keep] for row in rows)
    return _worst(f"{what} of {trace.name} alone", value, limits, error, when)
