"""Where along the commanded path the motors were, read off the step edges.

A motor stands at the nearest whole step, so at each of its edges an axis is exactly half way from
one step to the next, and on a known path that is one place. Nothing is fitted or smoothed: what is
left is the grid of the ticks. This is what the limits along the path are judged by.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stepmite.path import Path
from stepmite.trace import AxisTrace, Floats, Ints, TraceError

GRAZE_STEPS = 1
"""How many steps further or less far an axis may go where the path of an arc turns it round."""
SHARE_LEAST = 0.6
"""On a curve an edge says where the machine is if its axis is about as fast as the fastest."""


@dataclass(frozen=True)
class Crossings:
    """The half steps that one axis passes, in order."""

    level: Floats
    """Position in steps."""
    direction: Ints
    way: Floats
    """Along the path; not known (0) for recorded ones."""
    telling: NDArray[np.bool_]
    """The way can be told from it: the axis moves evenly, or it is among the fastest there."""


def crossings(path: Path, axis: int, scale: float, fastest: Floats) -> Crossings:
    """Return what axis number `axis` has to do; `fastest` as by fastest_axis()."""
    steps = path.steps[:, axis]
    nearest = np.floor(steps + 0.5).astype(np.int64)
    counts = np.diff(nearest)
    piece = np.repeat(np.arange(len(counts)), np.abs(counts))
    first = np.cumsum(np.abs(counts)) - np.abs(counts)
    number = np.arange(len(piece)) - first[piece]
    direction = np.sign(counts)[piece]
    level = nearest[:-1][piece] + direction * (number + 0.5)
    change = np.diff(steps)[piece]
    part = np.clip((level - steps[:-1][piece]) / change, 0.0, 1.0)
    lengths = np.diff(path.way)
    way = path.way[:-1][piece] + part * lengths[piece]
    share = np.abs(change) / scale / lengths[piece] / fastest[piece]
    telling = path.linear[piece, axis] | ((share >= SHARE_LEAST) & ~path.tiny[piece])
    return Crossings(level, direction, way, telling)


def fastest_axis(path: Path, scale: Floats) -> Floats:
    """Return for each part of the polyline how fast its fastest axis is for one unit of way."""
    with np.errstate(invalid="ignore", divide="ignore"):
        speeds = np.abs(np.diff(path.steps, axis=0)) / scale / np.diff(path.way)[:, None]
    return np.nan_to_num(speeds).max(axis=1, initial=0.0)


@dataclass(frozen=True)
class AxisMotion:
    """The edges of one axis that lie on the path."""

    name: str
    time_ns: Ints
    way: Floats
    position: Floats
    """Units. Free of the rounding of block ends to whole steps, which is no motion: it moves the
    path by up to half a step, and on moves of a few steps it would look like jumps of speed."""


@dataclass(frozen=True)
class Progress:
    """Moments at which the place on the path is known."""

    time_ns: Ints
    way: Floats
    axes: list[AxisMotion]
    end_way: float
    """Where the motion ended: at the end of the path, or where it was last seen."""


def follow(path: Path, traces: list[AxisTrace], *, whole: bool = True) -> Progress:
    """Return when the machine was where; TraceError if it did not follow the path.

    `traces` are all axes that move, in the order X Y Z A. Every edge has to be one that the path
    asks for, in order and in the right direction, and the path has to be followed to its end; with
    `whole` false it may end anywhere.
    """
    scale = np.ones(4)
    for trace in traces:
        scale["XYZA".index(trace.name)] = trace.pins.steps_per_unit
    fastest = fastest_axis(path, scale)
    times, ways, axes = [], [], []
    farthest = 0.0
    for trace in traces:
        axis = "XYZA".index(trace.name)
        wanted = crossings(path, axis, scale[axis], fastest)
        mine, theirs = align(wanted, trace, whole)
        way, time_ns = wanted.way[theirs], trace.step_ns[mine]
        farthest = max(farthest, float(way.max(initial=0.0)))
        slack = np.interp(way, path.way, path.slack[:, axis])
        position = (wanted.level[theirs] - slack) / scale[axis]
        axes.append(AxisMotion(trace.name, time_ns, way, position))
        good = wanted.telling[theirs]
        times.append(time_ns[good])
        ways.append(way[good])
    time_ns, way = np.concatenate(times), np.concatenate(ways)
    order = np.lexsort((way, time_ns))
    end_way = float(path.way[-1]) if whole else farthest
    return Progress(time_ns[order], way[order], axes, end_way)


def align(wanted: Crossings, trace: AxisTrace, whole: bool) -> tuple[Ints, Ints]:
    """Return pairs of indexes of an axis' edges and of the crossings they are.

    The same count and directions in the usual case. Where an arc just touches a half step, edges
    may be there or not: those runs are matched by their levels.
    """
    got, want = trace.direction, wanted.direction
    complete = len(got) == len(want) or (len(got) < len(want) and not whole)
    if complete and np.array_equal(got, want[: len(got)]):
        same = np.arange(len(got))
        return same, same
    recorded, expected = _runs(got), _runs(want)
    if not len(got) or not len(want) or got[0] != want[0]:
        raise TraceError(f"{trace.name}: {len(got)} steps, {len(want)} expected")
    _cancel_grazes(recorded, expected, int(got[0]), trace.name, whole)
    mine: list[Ints] = []
    theirs: list[Ints] = []
    levels = np.cumsum(got) - got * 0.5 + (wanted.level[0] - want[0] * 0.5)
    for (a, b, _), (c, d, _) in zip(recorded, expected, strict=False):
        _, left, right = np.intersect1d(levels[a:b], wanted.level[c:d], return_indices=True)
        order = np.argsort(left)
        mine.append(a + left[order])
        theirs.append(c + right[order])
    return np.concatenate(mine), np.concatenate(theirs)


_Runs = list[tuple[int, int, int]]
"""Begin and end of each stretch in one direction, and how far it leads in that direction."""


def _runs(direction: Ints) -> _Runs:
    turns = np.flatnonzero(np.diff(direction)) + 1
    bounds = [0, *turns.tolist(), len(direction)]
    return [(a, b, b - a) for a, b in itertools.pairwise(bounds) if b > a]


def _cancel_grazes(recorded: _Runs, expected: _Runs, sign: int, name: str, whole: bool) -> None:
    """Make both lists of runs fit each other; TraceError if they are not the same motion.

    A short run back counts as part of the run around it in the list that has it too much. `sign` is
    the direction of the first run.
    """
    index, apart = 0, 0
    while index < min(len(recorded), len(expected)):
        over = recorded[index][2] - expected[index][2]
        if abs(apart + sign * over) <= GRAZE_STEPS:
            apart += sign * over
            sign = -sign
            index += 1
            continue
        if not whole and index == len(recorded) - 1 and over < 0:
            index += 1
            break
        shorter = recorded if over < 0 else expected
        if index + 2 >= len(shorter) or shorter[index + 1][2] > 2 * GRAZE_STEPS:
            break
        before, back, behind = shorter[index : index + 3]
        shorter[index : index + 3] = [(before[0], behind[1], before[2] - back[2] + behind[2])]
    if index < len(recorded) or (whole and (index < len(expected) or apart)):
        step = recorded[min(index, len(recorded) - 1)][0]
        raise TraceError(f"{name}: the path is left in the run that begins with step {step}")
