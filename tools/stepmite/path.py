"""The commanded path as geometry: where it runs, how fast its parts and corners may be passed.

Made from G-code alone and shared by the oracles and the offline optimum; the plan of the firmware
and that of stepmite.plan are not asked. The way along the path counts all four axes, in mm and
degrees, as the firmware's does.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stepmite.arcs import Arc, Position
from stepmite.gcode import Block, target_steps
from stepmite.plan import BLEND_SHARE, BLEND_TIME_S, Machine
from stepmite.trace import Floats, Ints

CENTRIPETAL_SHARE = 0.866
SAGITTA_STEPS = 0.002
"""How far the polyline that stands for an arc or a blend may be from it."""
TINY_STEPS = 5
"""Curves smaller than this do not tell where on them the machine is."""
REVERSAL, STRAIGHT_ON, TANGENTIAL = 3.99999, 1e-9, 7.6e-3
"""Squares of the difference of two unit vectors: G61 stops above the last one, 5 degrees."""
TANGENTIAL_DEVIATION_MM = 0.0005
"""With which G61 passes joints below it."""
LINE_SHARE = 0.4999
"""Part of a line that a blend may take."""


@dataclass
class Piece:
    """A part of the path with one law: a line, an arc or a blend."""

    block: Block
    start: Floats
    target: Floats
    """Ends in mm and degrees, shape (4,)."""
    length: float
    """In all axes."""
    feed_speed: float
    """Programmed speed along the way, infinity for G0."""
    axes_speed: float
    """What the axes allow."""
    turn_speed: float
    """What curvature allows."""
    acceleration: float
    """Along the way, at low speed."""
    jerk: float
    turn_radius: float = math.inf
    """mm, of the projection on the plane of an arc."""
    plane_share: float = 0.0
    """Speed in the plane for one unit of speed along the way."""
    plane_acceleration: float = math.inf
    other_acceleration: float = math.inf
    """Limits of the axes in the plane of an arc and of the others."""
    whole_length: float = 0.0
    """Of the line as programmed, without what blends cut off."""
    blend: Floats | None = None
    """The corner that a blend replaces; None: no blend."""
    slack: Floats | None = None
    """What rounding the ends of blocks to whole steps adds, in steps: at both ends, and at the
    corner between them for a blend."""

    @property
    def is_straight(self) -> bool:
        """Tell whether it is a line."""
        return self.blend is None and self.block.arc is None

    @property
    def linear_axes(self) -> list[bool]:
        """Tell for each axis whether it moves evenly with the way."""
        if self.block.arc is not None:
            return [axis not in self.block.arc.plane for axis in range(4)]
        return [self.blend is None] * 4

    @property
    def speed(self) -> float:
        """The most that is allowed anywhere on it, units/s."""
        return min(self.feed_speed, self.axes_speed, self.turn_speed)

    def acceleration_at(self, speed: float) -> float:
        """Return what is left along the way while it turns at `speed`."""
        if not math.isfinite(self.turn_radius):
            return self.acceleration
        inwards = (speed * self.plane_share) ** 2 / self.turn_radius
        left = math.sqrt(max(0.0, self.plane_acceleration**2 - inwards**2))
        return min(left / self.plane_share, self.other_acceleration)

    def direction(self, part: float) -> Floats:
        """Return the movement of the axes for one unit of way, after `part` of it."""
        if self.blend is not None:
            edges = self.blend - self.start, self.target - self.blend
            return (edges[0] * (1 - part) + edges[1] * part) * 2 / self.length
        if self.block.arc is None:
            return (self.target - self.start) / self.length
        ends = _position(self.start), _position(self.target)
        return np.array(self.block.arc.slope(*ends, part)) / self.length

    def points(self, parts: Floats) -> Floats:
        """Return positions at parts of the way, shape (parts, 4)."""
        if self.blend is not None:
            return _curve(np.stack([self.start, self.blend, self.target]), parts)
        line = _curve(np.stack([self.start, self.target]), parts)
        arc = self.block.arc
        if arc is not None:
            radius = arc.start_radius + (arc.end_radius - arc.start_radius) * parts
            angle = arc.start_angle + arc.sweep * parts
            line[:, arc.plane[0]] = arc.centre[0] + radius * np.cos(angle)
            line[:, arc.plane[1]] = arc.centre[1] + radius * np.sin(angle)
        return line


@dataclass(frozen=True)
class Corner:
    """A place between two pieces."""

    way: float
    change: Floats
    """Change of direction of each axis for one unit of way."""
    speed: float
    """The most with which it may be passed; infinity where it is none."""


def _position(values: Floats) -> Position:
    x, y, z, a = (float(value) for value in values)
    return x, y, z, a


def _curve(controls: Floats, parts: Floats) -> Floats:
    """Return points of the line or parabola with these 2 or 3 control points."""
    u = parts[:, None]
    if len(controls) == 2:
        return controls[0] * (1 - u) + controls[1] * u
    return controls[0] * (1 - u) ** 2 + controls[1] * 2 * u * (1 - u) + controls[2] * u**2


def along(shares: Floats, limits: Iterable[float]) -> float:
    """Return the largest value along a direction that keeps every axis within its limit."""
    pairs = zip(np.abs(shares).tolist(), limits, strict=True)
    return min((limit / share for share, limit in pairs if share > 1e-9), default=math.inf)


@dataclass(frozen=True)
class Path:
    """A whole program from its start to its end."""

    pieces: list[Piece]
    begin: Floats
    """Way at the start of each piece and, last, at the end of the path."""
    corners: list[Corner]
    """Between the pieces; with the start and the end at rest."""
    way: Floats
    steps: Floats
    """A fine polyline: way and position in steps, shapes (vertices,) and (vertices, 4)."""
    slack: Floats
    """What rounding the ends of blocks has added to `steps`."""
    linear: NDArray[np.bool_]
    """For each part of the polyline and each axis: it moves evenly with the way, as all do on lines
    and those outside of its plane on an arc."""
    tiny: NDArray[np.bool_]
    """It is a part of a curve of a few steps: rounding hides where on it the machine is."""
    pauses: list[tuple[float, float]]
    """Way and seconds of the dwells."""

    def steps_at(self, way: Floats) -> Floats:
        """Return the positions in steps at places along the way, shape (places, 4)."""
        columns = [np.interp(way, self.way, self.steps[:, axis]) for axis in range(4)]
        return np.stack(columns, axis=1)

    def piece_at(self, way: Floats) -> Ints:
        """Return the index of the piece at each place along the way."""
        return np.clip(np.searchsorted(self.begin, way, side="right") - 1, 0, len(self.pieces) - 1)


def _is_below_a_step(arc: Arc, scale: Position) -> bool:
    return all(arc.radius * abs(arc.sweep) * scale[axis] < 0.5 for axis in arc.plane)


def _line_or_arc(block: Block, start: Floats, machine: Machine) -> Piece:
    target = np.array(block.target)
    change = target - start
    linear = float(np.linalg.norm(change[:3]))
    shares = np.abs(change)
    if block.arc is not None:
        linear = block.arc.length(_position(start), block.target)
        shares[list(block.arc.plane)] = block.arc.radius * abs(block.arc.sweep)
    length = math.hypot(linear, change[3])
    shares = shares / length
    feed = math.inf
    if block.feed_per_min is not None:
        feed = block.feed_per_min / 60 * length / (linear or length)
    piece = Piece(
        block,
        start,
        target,
        length,
        feed,
        along(shares, machine.max_velocity),
        math.inf,
        along(shares, machine.max_acceleration),
        min(machine.path_jerk, along(shares, machine.max_jerk)),
    )
    if block.arc is not None:
        plane = list(block.arc.plane)
        limit = min(machine.max_acceleration[axis] for axis in plane)
        piece.turn_radius = block.arc.radius
        piece.plane_share = float(shares[plane[0]])
        piece.plane_acceleration = limit
        shares[plane] = 0.0
        piece.other_acceleration = along(shares, machine.max_acceleration)
        turn = math.sqrt(CENTRIPETAL_SHARE * limit * piece.turn_radius)
        piece.turn_speed = turn / piece.plane_share
    return piece


def corner_speed(before: Piece, after: Piece, machine: Machine) -> float:
    """Return what the rule of the corner allows; infinity where two pieces meet tangentially."""
    mode = after.block.path_mode
    change = after.direction(0.0) - before.direction(1.0)
    square = float(change @ change)
    if mode.kind == "G61.1" and before.block is not after.block:
        return 0.0
    if square < STRAIGHT_ON:
        return math.inf
    if square >= 4 or (mode.kind == "G61" and square > TANGENTIAL):
        return 0.0
    deviation = machine.junction_deviation_mm
    if mode.kind == "G61":
        deviation = TANGENTIAL_DEVIATION_MM
    half_sine, half_cosine = math.sqrt(square) / 2, math.sqrt(1 - square / 4)
    acceleration = along(change, machine.max_acceleration) * math.sqrt(square)
    by_deviation = deviation * half_cosine / (1 - half_cosine)
    by_length = min(before.whole_length, after.whole_length) / 2 * half_cosine / half_sine
    return math.sqrt(acceleration * min(by_deviation, by_length))


def _put_blends(pieces: list[Piece], machine: Machine) -> list[Piece]:
    """Replace the corners between lines by parabolas where G64 P asks for it."""
    reach = [0.0] * (len(pieces) + 1)
    for index in range(1, len(pieces)):
        before, after = pieces[index - 1], pieces[index]
        tolerance = after.block.path_mode.tolerance_mm
        if (
            min(tolerance, before.block.path_mode.tolerance_mm) <= 0
            or before.block.arc
            or after.block.arc
        ):
            continue
        change = after.direction(0.0) - before.direction(1.0)
        square = float(change @ change)
        if STRAIGHT_ON < square < REVERSAL:
            wanted = 4 * tolerance / math.sqrt(square)
            bend = along(change, machine.max_acceleration)
            speed = _blend_speed(before, after)
            if speed >= bend * BLEND_TIME_S:
                longest = LINE_SHARE * min(before.length, after.length)
                reach[index] = min(wanted, longest, speed**2 / (2 * bend * BLEND_SHARE))
    result: list[Piece] = []
    for index, piece in enumerate(pieces):
        if reach[index] > 0:
            result.append(_blend(pieces[index - 1], piece, reach[index], machine))
        rest = _cut(piece, reach[index], reach[index + 1])
        if rest.length > 1e-9:
            result.append(rest)
    return result


def _blend_speed(before: Piece, after: Piece) -> float:
    """Return the speed that feed and axes allow in a blend; a rapid goes at the feed of the other.

    Each axis has to bear the larger of its shares in the two lines.
    """
    feeds = [f for f in (before.feed_speed, after.feed_speed) if f < math.inf]
    return min([*feeds, before.axes_speed, after.axes_speed])


def _cut(piece: Piece, first: float, last: float) -> Piece:
    """Return a line without the ends that blends replace."""
    if first == last == 0:
        return piece
    parts = np.array([first, piece.length - last]) / piece.length
    ends = piece.points(parts)
    return replace(
        piece,
        start=ends[0],
        target=ends[1],
        length=piece.length - first - last,
        slack=_curve(piece.slack, parts),
    )


def _blend(before: Piece, after: Piece, reach: float, machine: Machine) -> Piece:
    first, second = before.direction(1.0), after.direction(0.0)
    corner = after.start
    ends = np.array([1 - reach / before.length]), np.array([reach / after.length])
    slack = [_curve(before.slack, ends[0])[0], after.slack[0], _curve(after.slack, ends[1])[0]]
    bend = along(second - first, machine.max_acceleration)
    return Piece(
        after.block,
        corner - first * reach,
        corner + second * reach,
        2 * reach,
        _blend_speed(before, after),
        min(before.axes_speed, after.axes_speed),
        math.sqrt(2 * reach * bend),
        min(before.acceleration, after.acceleration),
        min(before.jerk, after.jerk),
        whole_length=2 * reach,
        blend=corner,
        slack=np.stack(slack),
    )


def build(
    blocks: Iterable[Block], machine: Machine, scale: Position, start: Position = (0.0,) * 4
) -> Path:
    """Return the path of a program that starts at rest in `start`; `scale` is steps per unit.

    A line that ends within the step it starts in is no piece: its way is part of the next one.
    """
    runs: list[list[Piece]] = [[]]
    pauses: list[tuple[int, float]] = []
    here, here_steps = np.array(start), target_steps(start, scale)
    for block in blocks:
        if block.kind != "move":
            pauses.append((len(runs) - 1, block.dwell_s))
            runs.append([])
            if block.kind == "home":
                here, here_steps = np.array(block.target), target_steps(block.target, scale)
            continue
        steps = target_steps(block.target, scale)
        if steps == here_steps and (block.arc is None or _is_below_a_step(block.arc, scale)):
            continue
        piece = _line_or_arc(block, here, machine)
        exact = np.stack([here, piece.target]) * scale
        piece.slack = np.stack([here_steps, steps]) - exact
        piece.whole_length = piece.length
        here, here_steps = piece.target, steps
        runs[-1].append(piece)
    pieces: list[Piece] = []
    ends: list[int] = []
    for run in runs:
        pieces += _put_blends(run, machine)
        ends.append(len(pieces))
    begin = np.concatenate([[0.0], np.cumsum([piece.length for piece in pieces])])
    stops = set(ends[:-1])
    corners = [Corner(0.0, pieces[0].direction(0.0) if pieces else np.zeros(4), 0.0)]
    for index in range(1, len(pieces)):
        before, after = pieces[index - 1], pieces[index]
        change = after.direction(0.0) - before.direction(1.0)
        speed = 0.0 if index in stops else corner_speed(before, after, machine)
        corners.append(Corner(float(begin[index]), change, speed))
    if pieces:
        corners.append(Corner(float(begin[-1]), -pieces[-1].direction(1.0), 0.0))
    dwells = [(float(begin[ends[run]]), seconds) for run, seconds in pauses]
    return Path(pieces, begin, corners, *_polyline(pieces, begin, np.array(scale)), dwells)


def _is_tiny(piece: Piece, scale: Floats) -> bool:
    if piece.blend is not None:
        return bool(np.abs((piece.target - piece.start) * scale).max() < TINY_STEPS)
    arc = piece.block.arc
    return arc is not None and arc.radius * float(scale[list(arc.plane)].min()) < TINY_STEPS


def _polyline(
    pieces: list[Piece], begin: Floats, scale: Floats
) -> tuple[Floats, Floats, Floats, NDArray[np.bool_], NDArray[np.bool_]]:
    """Return way, steps, slack, linear and tiny of a polyline through all pieces."""
    ways, places, slacks = [np.zeros(0)], [np.zeros((0, 4))], [np.zeros((0, 4))]
    linear, tiny = [np.zeros((0, 4), bool)], [np.zeros(0, bool)]
    for index, piece in enumerate(pieces):
        count = 1
        if piece.blend is not None:
            bend = np.linalg.norm((piece.start - 2 * piece.blend + piece.target) * scale)
            count = math.ceil(math.sqrt(bend / 4 / SAGITTA_STEPS))
        elif piece.block.arc is not None:
            steps = piece.turn_radius * float(scale[list(piece.block.arc.plane)].max())
            count = math.ceil(abs(piece.block.arc.sweep) * math.sqrt(steps / 8 / SAGITTA_STEPS))
        parts = np.arange(0 if index == 0 else 1, max(1, count) + 1) / max(1, count)
        linear.append(np.tile(piece.linear_axes, (max(1, count), 1)))
        tiny.append(np.full(max(1, count), _is_tiny(piece, scale)))
        ways.append(begin[index] + parts * piece.length)
        slacks.append(_curve(piece.slack, parts))
        places.append(piece.points(parts) * scale + slacks[-1])
    return tuple(np.concatenate(rows) for rows in (ways, places, slacks, linear, tiny))
