"""How long a program takes: the firmware's trapezoid plan, in floating point on the PC.

Corners by junction deviation or by blends (G64 P), arcs as one block, look-ahead over the whole
program. Used for the time estimate and the progress bar, and by the tests as the ideal profile to
compare a trace with. What jerk limits add is not in it.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

from stepmite.arcs import Arc, Position
from stepmite.gcode import Block


@dataclass(frozen=True)
class Machine:
    """What limits the motion; tuples are in the order X Y Z A."""

    max_velocity: Position = (100.0, 100.0, 100.0, 100.0)
    """mm/s, deg/s."""
    max_acceleration: Position = (500.0, 500.0, 500.0, 500.0)
    """mm/s^2, deg/s^2."""
    junction_deviation_mm: float = 0.02
    path_jerk: float = math.inf
    """mm/s^3, in SCURVE mode."""
    max_jerk: Position = (math.inf,) * 4
    """mm/s^3, deg/s^3, of each axis."""


@dataclass
class Planned:
    """A block with its speeds along the path; lengths in mm (degrees where only A moves)."""

    block: Block
    start: Position
    length: float
    direction: Position
    """Movement of each axis for one unit of `length`, at the start of the block."""
    end_direction: Position
    """The same at its end; another one on arcs."""
    nominal: float
    """Feed after the limits of the axes, mm/s."""
    acceleration: float
    entry_cap: float = 0.0
    entry: float = 0.0
    exit: float = 0.0

    def peak(self) -> float:
        """Return the highest speed reached, mm/s."""
        top = math.sqrt((self.entry**2 + self.exit**2) / 2 + self.acceleration * self.length)
        return min(self.nominal, top)

    def phases(self) -> tuple[float, float, float]:
        """Return the durations of speeding up, cruising and slowing down, in seconds."""
        if self.block.kind != "move":
            return 0.0, self.block.dwell_s, 0.0
        top = self.peak()
        up = max(0.0, top - self.entry) / self.acceleration
        down = max(0.0, top - self.exit) / self.acceleration
        ramps = (top + self.entry) / 2 * up + (top + self.exit) / 2 * down
        return up, max(0.0, self.length - ramps) / top, down

    def duration_s(self) -> float:
        """Return how long the block takes."""
        return sum(self.phases())

    def distance_at(self, time_s: float) -> float:
        """Return the way done `time_s` after the start of the block."""
        if self.block.kind != "move":
            return 0.0
        up, cruise, down = self.phases()
        top = self.peak()
        in_up = min(time_s, up)
        done = self.entry * in_up + self.acceleration / 2 * in_up**2
        done += top * min(max(0.0, time_s - up), cruise)
        in_down = min(max(0.0, time_s - up - cruise), down)
        return min(self.length, done + top * in_down - self.acceleration / 2 * in_down**2)

    def speed_at(self, time_s: float) -> float:
        """Return the speed `time_s` after the start of the block, mm/s."""
        if self.block.kind != "move":
            return 0.0
        up, cruise, down = self.phases()
        if time_s < up:
            return self.entry + self.acceleration * time_s
        late = time_s - up - cruise
        return self.peak() - self.acceleration * min(max(0.0, late), down)


def _limit(direction: Position, limits: Position) -> float:
    """Return the largest value along the path that keeps every axis within its limit."""
    return min(
        (limit / abs(part) for part, limit in zip(direction, limits, strict=True) if part),
        default=math.inf,
    )


ARC_SHARE = 0.866
"""Part of the acceleration that an arc may use to turn; half is then left along the path."""


def _describe(block: Block, start: Position, machine: Machine) -> Planned:
    delta = [b - a for a, b in zip(start, block.target, strict=True)]
    length = math.hypot(*delta[:3]) or abs(delta[3])
    if block.arc is not None:
        length = block.arc.length(start, block.target)
    if block.kind != "move" or length == 0:
        return Planned(block, start, 0.0, (0.0,) * 4, (0.0,) * 4, 0.0, 1.0)
    if block.arc is not None:
        return _describe_arc(block, block.arc, start, length, machine)
    x, y, z, a = (part / length for part in delta)
    direction = (x, y, z, a)
    nominal = _limit(direction, machine.max_velocity)
    if block.feed_per_min is not None:
        nominal = min(nominal, block.feed_per_min / 60)
    acceleration = _limit(direction, machine.max_acceleration)
    return Planned(block, start, length, direction, direction, nominal, acceleration)


def _describe_arc(
    block: Block, arc: Arc, start: Position, length: float, machine: Machine
) -> Planned:
    x, y, z, a = (part / length for part in arc.slope(start, block.target, 0.0))
    end = arc.slope(start, block.target, 1.0)
    in_plane = arc.radius * abs(arc.sweep) / length
    shares = [abs(x), abs(y), abs(z), abs(a)]
    for axis in arc.plane:
        shares[axis] = in_plane
    along = (shares[0], shares[1], shares[2], shares[3])
    plane_limit = min(machine.max_acceleration[axis] for axis in arc.plane)
    nominal = min(
        _limit(along, machine.max_velocity),
        math.sqrt(ARC_SHARE * plane_limit * arc.radius) / in_plane,
        (block.feed_per_min or math.inf) / 60,
    )
    inwards = (nominal * in_plane) ** 2 / arc.radius
    left = math.sqrt(plane_limit**2 - inwards**2)
    limits = list(machine.max_acceleration)
    for axis in arc.plane:
        limits[axis] = left
    acceleration = _limit(along, (limits[0], limits[1], limits[2], limits[3]))
    end_direction = (end[0] / length, end[1] / length, end[2] / length, end[3] / length)
    return Planned(block, start, length, (x, y, z, a), end_direction, nominal, acceleration)


REVERSAL = 3.99999
STRAIGHT_ON = 1e-9
TANGENTIAL = 7.6e-3
"""Squares of the difference of two unit vectors: back the same way, on the same way, and 5 degrees,
above which G61 stops."""
TANGENTIAL_DEVIATION_MM = 0.0005
"""With which G61 passes what is below."""


def _turn(before: Position, after: Position) -> tuple[Position, float]:
    """Return the change of the unit direction in a corner and its square."""
    norms = math.hypot(*before), math.hypot(*after)
    x, y, z, a = (v / norms[1] - u / norms[0] for u, v in zip(before, after, strict=True))
    return (x, y, z, a), x * x + y * y + z * z + a * a


def junction_speed(
    before: Position, after: Position, machine: Machine, half_length: float = math.inf
) -> float:
    """Return the speed allowed in the corner between two directions, mm/s.

    Junction deviation; and the arc thought in the corner leaves each block by its middle, the
    nearer of which is `half_length` away.
    """
    change, square = _turn(before, after)
    if square > REVERSAL:
        return 0.0
    if square < STRAIGHT_ON:
        return math.inf
    half_sine = math.sqrt(square) / 2
    half_cosine = math.sqrt(1 - square / 4)
    acceleration = _limit(change, machine.max_acceleration) * math.sqrt(square)
    by_deviation = machine.junction_deviation_mm * half_cosine * (1 + half_cosine) / half_sine**2
    by_length = half_length * half_cosine / half_sine
    return math.sqrt(acceleration * min(by_deviation, by_length))


BLEND_SHARE, BLEND_MOST = 0.109, 0.75
"""Part of the acceleration that a blend uses to turn at the speed of its lines, and at most."""
BLEND_TIME_S = 0.001
"""A corner that takes less time at the acceleration of the axes is passed as it is."""


def _blend(before: Planned, after: Planned, machine: Machine) -> Planned | None:
    """Return the parabola that G64 P puts into the corner between two lines, None: there is none.

    It takes as much from the end of one line as from the start of the other, which is cut off here.
    """
    tolerance = after.block.path_mode.tolerance_mm
    change, square = _turn(before.end_direction, after.direction)
    if tolerance <= 0 or before.block.arc or after.block.arc or not STRAIGHT_ON < square < REVERSAL:
        return None
    bend = _limit(change, machine.max_acceleration)
    scales = math.hypot(*before.end_direction), math.hypot(*after.direction)
    meant = min(before.nominal, after.nominal) * max(scales)
    if meant < bend * BLEND_TIME_S:
        return None
    reach = min(4 * tolerance / math.sqrt(square), meant**2 / (2 * bend * BLEND_SHARE))
    for row in (before, after):
        whole = math.dist(row.start, row.block.target)
        reach = min(reach, whole / 2)
    speed = math.sqrt(BLEND_MOST * 2 * reach * bend)
    before.length -= reach / scales[0]
    after.length -= reach / scales[1]
    length = reach / scales[0] + reach / scales[1]
    nominal = min(speed / max(scales), before.nominal, after.nominal)
    acceleration = min(before.acceleration, after.acceleration)
    blend = Planned(
        after.block,
        before.block.target,
        length,
        before.end_direction,
        after.direction,
        nominal,
        acceleration,
    )
    blend.entry_cap = nominal
    after.entry_cap = nominal
    return blend


def _join(rows: list[Planned], row: Planned, machine: Machine) -> None:
    """Say how fast the corner before `row` may be passed; may put a blend into it."""
    before = rows[-1]
    mode = row.block.path_mode
    if mode.kind == "G61.1":
        return
    if mode.kind == "G61":
        if _turn(before.end_direction, row.direction)[1] > TANGENTIAL:
            return
        machine = replace(machine, junction_deviation_mm=TANGENTIAL_DEVIATION_MM)
    blend = _blend(before, row, machine) if mode.kind == "G64" else None
    if blend is not None:
        rows.append(blend)
        return
    lengths = (
        before.length * math.hypot(*before.end_direction),
        row.length * math.hypot(*row.direction),
    )
    ends = before.end_direction, row.direction
    corner = junction_speed(*ends, machine, min(lengths) / 2)
    row.entry_cap = min(corner, row.nominal, before.nominal)


def plan(
    blocks: Iterable[Block], machine: Machine | None = None, start: Position = (0.0,) * 4
) -> list[Planned]:
    """Return the blocks with their entry and exit speeds; moves of no length are left out.

    A blend (G64 P) is a row of its own, with the block that it leads to.
    """
    machine = machine or Machine()
    rows: list[Planned] = []
    for block in blocks:
        row = _describe(block, start, machine)
        start = block.target
        if block.kind == "move" and row.length == 0:
            continue
        if rows and row.length and rows[-1].length:
            _join(rows, row, machine)
        rows.append(row)
    rows = [row for row in rows if row.length > 0 or row.block.kind != "move"]
    after = 0.0
    for row in reversed(rows):
        row.exit = after
        row.entry = min(row.entry_cap, math.sqrt(after**2 + 2 * row.acceleration * row.length))
        after = row.entry
    for row, following in itertools.pairwise(rows):
        reach = math.sqrt(row.entry**2 + 2 * row.acceleration * row.length)
        following.entry = min(following.entry, reach)
        row.exit = following.entry
    return rows
