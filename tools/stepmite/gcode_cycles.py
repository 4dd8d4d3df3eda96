"""Canned cycles: the moves that one line of G73, G81, G82 or G83 stands for, as RS274/NGC says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from stepmite.arcs import Position

BREAK_MM = 0.254
"""How far G73 lifts to break the chip, and how far above its last depth G83 goes on; 0.010 inch."""


@dataclass(frozen=True)
class Drill:
    """One line of a cycle; positions are machine coordinates."""

    code: str
    start: Position
    plane: tuple[int, int]
    across: int
    """The axis that drills."""
    steps: tuple[tuple[float, float], ...]
    """Of each hole: where it is, along the axes of the plane."""
    clear: float
    """R: from here on the way down is at the feed."""
    bottom: float
    retract: float
    """Where each hole ends."""
    peck: float = 0.0
    """Q, > 0, of G73 and G83."""
    dwell_s: float = 0.0
    """P, of G82."""


@dataclass(frozen=True)
class Step:
    """One entry of a cycle."""

    kind: str
    """"rapid", "feed" or "dwell"."""
    target: Position
    seconds: float = 0.0


def _put(place: Position, axis: int, value: float) -> Position:
    values = list(place)
    values[axis] = value
    return values[0], values[1], values[2], values[3]


def steps_of(drill: Drill) -> Iterator[Step]:
    """Yield what the line does; moves that lead nowhere are left out."""
    place = drill.start
    for step in _all_steps(drill):
        if step.kind == "dwell" or step.target != place:
            yield step
        place = step.target


def _all_steps(drill: Drill) -> Iterator[Step]:
    place = drill.start
    if place[drill.across] < drill.clear:
        place = _put(place, drill.across, drill.clear)
        yield Step("rapid", place)
    for hole in drill.steps:
        for axis, value in zip(drill.plane, hole, strict=True):
            place = _put(place, axis, value)
        yield Step("rapid", place)
        yield Step("rapid", _put(place, drill.across, drill.clear))
        yield from _bore(drill, place)
        place = _put(place, drill.across, drill.retract)
        yield Step("rapid", place)


def _bore(drill: Drill, place: Position) -> Iterator[Step]:
    """Yield the way from the clear plane to the bottom."""

    def at(height: float) -> Position:
        return _put(place, drill.across, height)

    depth = drill.clear
    while drill.peck and depth - drill.peck > drill.bottom:
        depth -= drill.peck
        yield Step("feed", at(depth))
        if drill.code == "G83":
            yield Step("rapid", at(drill.clear))
            yield Step("rapid", at(depth + min(BREAK_MM, drill.peck)))
        else:
            yield Step("rapid", at(depth + min(BREAK_MM, drill.peck)))
    yield Step("feed", at(drill.bottom))
    if drill.code == "G82":
        yield Step("dwell", at(drill.bottom), drill.dwell_s)
