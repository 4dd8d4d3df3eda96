"""Arcs: the geometry of G2 and G3, from the words of a line to positions along the arc."""

from __future__ import annotations

import math
from dataclasses import dataclass

Position = tuple[float, float, float, float]

PLANES = {"G17": (0, 1), "G18": (2, 0), "G19": (1, 2)}
"""The two axes of each plane; counterclockwise (G3) turns from the first to the second."""

_OFFSETS = "IJK"
_FULL_TURN = 2 * math.pi
_SAME_PLACE_MM = 1e-6
_ROUNDING_MM = 0.0283
"""How far off its circle an arc is with coordinates that are rounded to 0.01 mm."""
_RADIUS_LEAST_MM = 0.00127


@dataclass(frozen=True)
class Arc:
    """An arc in a plane; what is not in the plane (the height of a helix, A) goes along with it."""

    plane: tuple[int, int]
    centre: tuple[float, float]
    """In the plane, mm."""
    start_angle: float
    """Radians from the first axis towards the second."""
    sweep: float
    """Radians; positive: counterclockwise."""
    start_radius: float
    end_radius: float
    """mm; both differ a little if the centre was rounded, the radius changes evenly then."""

    @property
    def radius(self) -> float:
        """Mean radius in mm."""
        return (self.start_radius + self.end_radius) / 2

    def length(self, start: Position, target: Position) -> float:
        """Return the way of X, Y and Z along the arc from `start` to `target`, mm."""
        height = target[self.third] - start[self.third]
        return math.hypot(self.radius * self.sweep, height)

    @property
    def third(self) -> int:
        """The linear axis that is not in the plane."""
        return 3 - sum(self.plane)

    def position(self, start: Position, target: Position, part: float) -> Position:
        """Return where the arc from `start` to `target` is after `part` (0..1) of it."""
        place = [a + (b - a) * part for a, b in zip(start, target, strict=True)]
        radius = self.start_radius + (self.end_radius - self.start_radius) * part
        angle = self.start_angle + self.sweep * part
        place[self.plane[0]] = self.centre[0] + radius * math.cos(angle)
        place[self.plane[1]] = self.centre[1] + radius * math.sin(angle)
        return place[0], place[1], place[2], place[3]

    def slope(self, start: Position, target: Position, part: float) -> Position:
        """Return the change of the position for a change of `part`, mm and degrees."""
        change = [b - a for a, b in zip(start, target, strict=True)]
        angle = self.start_angle + self.sweep * part
        change[self.plane[0]] = -self.radius * self.sweep * math.sin(angle)
        change[self.plane[1]] = self.radius * self.sweep * math.cos(angle)
        return change[0], change[1], change[2], change[3]


def read_arc(
    clockwise: bool, plane: tuple[int, int], start: Position, target: Position, words: dict
) -> Arc:
    """Return the arc from `start` to `target` that the words I J K or R and P say.

    ValueError if there is none.
    """
    offsets = [words.get(_OFFSETS[axis]) for axis in plane]
    if words.get(_OFFSETS[3 - sum(plane)]) is not None:
        raise ValueError(f"{_OFFSETS[3 - sum(plane)]} does not lie in the plane of the arc")
    if ("R" in words) == any(value is not None for value in offsets):
        raise ValueError("an arc needs R or the centre by I J K")
    if "R" in words:
        offsets = _centre_by_radius(clockwise, plane, start, target, words["R"])
    turns = words.get("P", 1)
    if turns < 1 or turns != int(turns):
        raise ValueError("P of an arc must be a whole number of turns, at least 1")
    first, second = plane
    centre = start[first] + (offsets[0] or 0.0), start[second] + (offsets[1] or 0.0)
    before = start[first] - centre[0], start[second] - centre[1]
    after = target[first] - centre[0], target[second] - centre[1]
    radii = math.hypot(*before), math.hypot(*after)
    _check_radii(*radii)
    sweep = _sweep(clockwise, before, after) + (turns - 1) * (
        -_FULL_TURN if clockwise else _FULL_TURN
    )
    return Arc(plane, centre, math.atan2(before[1], before[0]), sweep, *radii)


def _centre_by_radius(
    clockwise: bool, plane: tuple[int, int], start: Position, target: Position, radius: float
) -> list[float]:
    """Return the centre relative to the start; a negative radius asks for the longer arc."""
    x, y = (target[axis] - start[axis] for axis in plane)
    chord = math.hypot(x, y)
    if chord < _SAME_PLACE_MM:
        raise ValueError("an arc with R must end elsewhere")
    square = radius * radius - chord * chord / 4
    if chord / 2 - abs(radius) > _ROUNDING_MM:
        raise ValueError("R is too small")
    height = math.sqrt(max(0.0, square)) / chord
    if clockwise != (radius < 0):
        height = -height
    return [x / 2 - y * height, y / 2 + x * height]


def _check_radii(start: float, end: float) -> None:
    """More than rounding is wrong if it is 0.1 % of the radius or 100 times as much."""
    apart = abs(start - end)
    if start < _RADIUS_LEAST_MM or end < _RADIUS_LEAST_MM:
        raise ValueError("the arc has no radius")
    if apart > _ROUNDING_MM and (apart > 100 * _ROUNDING_MM or apart > 0.001 * max(start, end)):
        raise ValueError(f"the end is {apart:.3f} mm off the arc")


def _sweep(clockwise: bool, before: tuple[float, float], after: tuple[float, float]) -> float:
    """Return the angle between two radii in the direction of the arc; none means a full turn."""
    if math.hypot(after[0] - before[0], after[1] - before[1]) < _SAME_PLACE_MM:
        turn = 0.0
    else:
        cross = before[0] * after[1] - before[1] * after[0]
        turn = math.atan2(cross, before[0] * after[0] + before[1] * after[1])
    if clockwise:
        return turn if turn < 0 else turn - _FULL_TURN
    return turn if turn > 0 else turn + _FULL_TURN
