"""How long a program takes: the firmware's trapezoid plan, in floating point on the PC.

Corners by junction deviation, look-ahead over the whole program. Used for the time estimate and the
progress bar, and by the tests as the ideal profile to compare a trace with.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass

from stepmite.gcode import Block, Position


@dataclass(frozen=True)
class Machine:
    """What limits the motion; tuples are in the order X Y Z A."""

    max_velocity: Position = (100.0, 100.0, 100.0, 100.0)
    """mm/s, deg/s."""
    max_acceleration: Position = (500.0, 500.0, 500.0, 500.0)
    """mm/s^2, deg/s^2."""
    junction_deviation_mm: float = 0.02


@dataclass
class Planned:
    """A block with its speeds along the path; lengths in mm (degrees where only A moves)."""

    block: Block
    start: Position
    length: float
    direction: Position
    """Movement of each axis for one unit of `length`."""
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


def _describe(block: Block, start: Position, machine: Machine) -> Planned:
    delta = [b - a for a, b in zip(start, block.target, strict=True)]
    length = math.hypot(*delta[:3]) or abs(delta[3])
    if block.kind != "move" or length == 0:
        return Planned(block, start, 0.0, (0.0,) * 4, 0.0, 1.0)
    x, y, z, a = (part / length for part in delta)
    direction = (x, y, z, a)
    nominal = _limit(direction, machine.max_velocity)
    if block.feed_per_min is not None:
        nominal = min(nominal, block.feed_per_min / 60)
    acceleration = _limit(direction, machine.max_acceleration)
    return Planned(block, start, length, direction, nominal, acceleration)


def junction_speed(before: Position, after: Position, machine: Machine) -> float:
    """Return the speed allowed in the corner between two directions, mm/s."""
    norm_before, norm_after = math.hypot(*before), math.hypot(*after)
    unit_before = [part / norm_before for part in before]
    unit_after = [part / norm_after for part in after]
    cosine = -sum(a * b for a, b in zip(unit_before, unit_after, strict=True))
    if cosine > 0.999999:
        return 0.0
    if cosine < -0.999999:
        return math.inf
    sine = math.sqrt((1 - cosine) / 2)
    change = [b - a for a, b in zip(unit_before, unit_after, strict=True)]
    norm = math.hypot(*change)
    x, y, z, a = (part / norm for part in change)
    acceleration = _limit((x, y, z, a), machine.max_acceleration)
    return math.sqrt(acceleration * machine.junction_deviation_mm * sine / (1 - sine))


def plan(
    blocks: Iterable[Block], machine: Machine | None = None, start: Position = (0.0,) * 4
) -> list[Planned]:
    """Return the blocks with their entry and exit speeds; moves of no length are left out."""
    machine = machine or Machine()
    rows: list[Planned] = []
    for block in blocks:
        row = _describe(block, start, machine)
        start = block.target
        if block.kind == "move" and row.length == 0:
            continue
        if rows and row.length and rows[-1].length:
            corner = junction_speed(rows[-1].direction, row.direction, machine)
            row.entry_cap = min(corner, row.nominal, rows[-1].nominal)
        rows.append(row)
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
