"""Putting the edges of a board on the grid of its ticks, to compare them with the host's.

On the host a tick's edges carry the tick's own time. On a board they come a little later: the
interrupt is entered, code runs, and sometimes interrupts were masked just then. As long as that
stays below a period, rounding down gives the tick back.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from stepmite.emulator import TickRun
from stepmite.trace import TICK_NS, Edges


@dataclass(frozen=True)
class TickEdge:
    """An edge as the step train knows it."""

    tick: int
    gpio: int
    level: int


def snap_to_ticks(edges: Edges, runs: Sequence[TickRun]) -> Edges:
    """Round the time of every edge down to the last tick; edges outside of all runs stay."""
    times = edges.time_ns.copy()
    for run in runs:
        since = times - run.first_ns
        inside = (since >= 0) & (since < run.count * run.period_ns)
        ticks = np.floor_divide(since, run.period_ns)
        snapped = np.rint(run.first_ns + ticks * run.period_ns).astype(np.int64)
        times = np.where(inside, snapped, times)
    return Edges(times, edges.gpio, edges.level)


def latencies_ns(edges: Edges, runs: Sequence[TickRun]) -> np.ndarray:
    """Return how long after its tick each edge came, for the edges inside the runs (ns)."""
    late = edges.time_ns - snap_to_ticks(edges, runs).time_ns
    inside = np.zeros(len(edges), dtype=bool)
    for run in runs:
        since = edges.time_ns - run.first_ns
        inside |= (since >= 0) & (since < run.count * run.period_ns)
    return late[inside]


def tick_train(edges: Edges, gpios: Iterable[int]) -> list[TickEdge]:
    """Return the edges of these pins by tick, counted from the tick of the first of them.

    Give it edges that lie on one grid: of the host, or after snap_to_ticks.
    """
    mine = np.isin(edges.gpio, list(gpios))
    if not mine.any():
        return []
    times = edges.time_ns[mine]
    ticks = (times - times[0]) // TICK_NS
    rows = zip(ticks.tolist(), edges.gpio[mine].tolist(), edges.level[mine].tolist(), strict=True)
    return [TickEdge(*row) for row in rows]


def first_difference(a: Sequence[TickEdge], b: Sequence[TickEdge]) -> str | None:
    """Compare two trains; return None if they are the same, else where they part."""
    for index, (left, right) in enumerate(zip(a, b, strict=False)):
        if left != right:
            return f"edge {index}: {left} and {right}"
    if len(a) != len(b):
        return f"{len(a)} and {len(b)} edges, the same up to the shorter"
    return None
