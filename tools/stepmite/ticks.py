"""Putting the edges of a board on the grid of its ticks, to compare them with the host's.

On the host a tick's edges carry the tick's own time. On a board they come a little later: the
interrupt is entered, code runs, and sometimes interrupts were masked just then. As long as that
stays below a period, rounding down gives the tick back.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stepmite.emulator import TickRun
from stepmite.trace import TICK_NS, Edges


@dataclass(frozen=True)
class TickEdge:
    """An edge as the step train knows it."""

    tick: int
    gpio: int
    level: int


def read_tick_runs(report: Path) -> list[TickRun]:
    """Return the tick runs in a report of `stepmite emulate --report`."""
    content = json.loads(report.read_text(encoding="utf-8"))
    return [TickRun(**run) for run in content["tick_runs"]]


def estimate_tick_run(edges: Edges, period_ns: int = TICK_NS) -> TickRun:
    """Find the grid from the edges of one run alone, where nobody noted it.

    The edges of a tick follow it within a part of the period; the widest part of the period in
    which no edge ever falls ends at the earliest edge. The grid returned goes through that edge, so
    it lies up to the shortest latency late, which does not change any rounding.
    """
    phases = np.unique(edges.time_ns % period_ns)
    gaps = np.diff(np.concatenate([phases, phases[:1] + period_ns]))
    phase = int(phases[(int(np.argmax(gaps)) + 1) % len(phases)])
    first = int(edges.time_ns[0]) - (int(edges.time_ns[0]) - phase) % period_ns
    return TickRun(first, period_ns, (int(edges.time_ns[-1]) - first) // period_ns + 1)


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


def tick_train(edges: Edges, gpios: Iterable[int], begin: Iterable[int]) -> list[TickEdge]:
    """Return the edges of these pins by tick, counted from the first edge of a pin in `begin`.

    What comes before it (pins being set up) is left out. Give it edges that lie on one grid: of the
    host, or after snap_to_ticks.
    """
    mine = np.isin(edges.gpio, list(gpios))
    starts = np.flatnonzero(np.isin(edges.gpio, list(begin)))
    if len(starts) == 0:
        return []
    mine[: starts[0]] = False
    times = edges.time_ns[mine]
    ticks = (times - edges.time_ns[starts[0]]) // TICK_NS
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
