"""The shortest time in which a path can be made without a limit of the jerk: a reference.

The path is cut into small cells. At each boundary stands the highest speed that feed, axes,
curvature and corners allow; a pass backwards and one forwards lower it to what the acceleration
allows. That is the textbook way and shares nothing with the plan of the firmware: no blocks, no
queue, no closed forms, and on arcs the acceleration along the path is what the turn leaves of it
at each speed.
"""

from __future__ import annotations

import math

from stepmite.path import Path, Piece

CELL_MM = 0.05
CELLS_LEAST = 8
"""Cells of a piece, at least; arcs need them for the acceleration that changes with the speed."""


def _cells(piece: Piece) -> int:
    # On a line the square of the speed is linear, so only the peak needs a fine cell.
    return max(CELLS_LEAST, min(2000, math.ceil(piece.length / CELL_MM)))


def least_time_s(path: Path) -> float:
    """Return the seconds from the first movement to the last, dwells included."""
    caps, pieces = [0.0], []
    for index, piece in enumerate(path.pieces):
        count = _cells(piece)
        top = piece.speed
        caps[-1] = min(caps[-1], top)
        caps += [top] * count
        caps[-1] = min(top, path.corners[index + 1].speed)
        pieces += [(piece, piece.length / count)] * count
    speeds = _pass(caps[::-1], pieces[::-1])[::-1]
    speeds = _pass(speeds, pieces)
    total = sum(seconds for _, seconds in path.pauses)
    for (_, cell), before, after in zip(pieces, speeds[:-1], speeds[1:], strict=True):
        total += 2 * cell / (before + after)
    return total


def _pass(caps: list[float], cells: list[tuple[Piece, float]]) -> list[float]:
    """Lower speeds so that each can be reached from the one before it."""
    result = [caps[0]]
    for (piece, cell), cap in zip(cells, caps[1:], strict=True):
        before = result[-1]
        if cap > before:
            # The middle of the cell says how much the turn leaves; two rounds are plenty.
            reach = math.sqrt(before**2 + 2 * piece.acceleration_at(before) * cell)
            middle = math.sqrt((before**2 + min(reach, cap) ** 2) / 2)
            reach = math.sqrt(before**2 + 2 * piece.acceleration_at(middle) * cell)
            cap = min(cap, reach)
        result.append(cap)
    return result
