"""Step edges: reading a recording of the pins and rebuilding what the axes did.

A recording is a CSV file with the header `time_ns,gpio,level` and one row for every edge of an
output pin, in virtual time. The checks on top of it are in stepmite.oracle.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

TICK_NS = 10_000
"""Period of the step interrupt: every edge of the host build lies on this grid."""

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


class TraceError(Exception):
    """A recording that cannot be read or that does not fit what was asked of it."""


@dataclass(frozen=True)
class AxisPins:
    """The pins and the scale of one axis."""

    name: str
    step_gpio: int
    dir_gpio: int
    inverted: bool = False
    """True: a high direction pin means the negative direction."""
    steps_per_unit: float = 1.0
    """Steps per mm or degree."""

    @classmethod
    def parse(cls, text: str) -> AxisPins:
        """Read "X=2,3", "X=2,3,inv", "X=2,3,80" or "X=GP2,GP3,inv,80"."""
        name, _, rest = text.partition("=")
        parts = [part.strip() for part in rest.split(",") if part.strip()]
        try:
            gpios = [int(part.upper().removeprefix("GP")) for part in parts[:2]]
            inverted = any(part.lower() == "inv" for part in parts[2:])
            scales = [float(part) for part in parts[2:] if part.lower() != "inv"]
        except ValueError:
            gpios, inverted, scales = [], False, []
        if not name.strip() or len(gpios) != 2 or len(scales) > 1 or min(scales, default=1.0) <= 0:
            raise TraceError(f"axis '{text}': expected NAME=step,dir[,inv][,steps_per_unit]")
        return cls(name.strip().upper(), gpios[0], gpios[1], inverted, *scales)


@dataclass(frozen=True)
class Edges:
    """All edges of a recording in the order of the file."""

    time_ns: Ints
    gpio: Ints
    level: Ints

    def __len__(self) -> int:
        return len(self.time_ns)

    def of(self, gpio: int) -> Edges:
        """Return the edges of one pin."""
        mine = self.gpio == gpio
        return Edges(self.time_ns[mine], self.gpio[mine], self.level[mine])

    def snapped(self, origin_ns: int = 0, tick_ns: int = TICK_NS) -> Edges:
        """Round all times down to the tick grid that goes through `origin_ns`.

        Takes away the few microseconds of interrupt latency of a board or the emulator.
        """
        since = (self.time_ns - origin_ns) // tick_ns * tick_ns
        return Edges(since + origin_ns, self.gpio, self.level)

    @classmethod
    def from_rows(cls, rows: list[tuple[int, int, int]]) -> Edges:
        """Make a recording of (time_ns, gpio, level) rows."""
        table = np.array(rows, dtype=np.int64).reshape(-1, 3)
        return cls(table[:, 0], table[:, 1], table[:, 2])

    @classmethod
    def read(cls, path: Path) -> Edges:
        """Read EDGES.csv; TraceError tells what is wrong with it."""
        with path.open(encoding="ascii", errors="replace") as file:
            header = file.readline().strip()
            if header != "time_ns,gpio,level":
                raise TraceError(f"{path}: the header is '{header}', not 'time_ns,gpio,level'")
            text = file.read()
        try:
            flat = np.fromstring(text.replace("\n", ","), dtype=np.int64, sep=",") if text else []
        except ValueError:
            flat = [0]
        if len(flat) != 3 * text.count("\n"):
            raise TraceError(f"{path}: a row is not time_ns,gpio,level")
        table = np.asarray(flat, dtype=np.int64).reshape(-1, 3)
        if np.any(np.diff(table[:, 0]) < 0):
            raise TraceError(f"{path}: the times are not in order")
        return cls(table[:, 0].copy(), table[:, 1].copy(), table[:, 2].copy())

    def write(self, path: Path) -> None:
        """Write EDGES.csv."""
        rows = zip(self.time_ns.tolist(), self.gpio.tolist(), self.level.tolist(), strict=True)
        with path.open("w", encoding="ascii") as file:
            file.write("time_ns,gpio,level\n")
            file.writelines(f"{time},{gpio},{level}\n" for time, gpio, level in rows)


@dataclass(frozen=True)
class AxisTrace:
    """The movement of one axis."""

    pins: AxisPins
    step_ns: Ints
    """Times of the rising step edges."""
    direction: Ints
    """+1 or -1 for each step."""
    fall_ns: Ints
    """Times of the falling step edges."""
    dir_ns: Ints
    """Times at which the direction pin changed."""

    @property
    def name(self) -> str:
        """Letter of the axis."""
        return self.pins.name

    def steps(self) -> Ints:
        """Return the position after each step."""
        return np.cumsum(self.direction)

    def end_steps(self) -> int:
        """Return the position after the last step, counted from 0."""
        return int(self.direction.sum())

    def position_at(self, time_ns: Floats | Ints) -> Floats:
        """Return the position in steps at any times, straight lines between the steps.

        At the moment of its step edge the axis counts as being at the full step.
        """
        if len(self.step_ns) == 0:
            return np.zeros(len(time_ns))
        return np.interp(time_ns, self.step_ns, self.steps())

    def count_at(self, time_ns: Ints) -> Ints:
        """Return the position in whole steps just after each of the times."""
        counts = np.concatenate([[0], self.steps()])
        return counts[np.searchsorted(self.step_ns, time_ns, side="right")]


def axis_trace(edges: Edges, pins: AxisPins) -> AxisTrace:
    """Pick one axis out of a recording.

    The direction of a step is the level of the direction pin after all rows before the step's row,
    so the order of rows with equal times counts. A direction pin without edges counts as low.
    """
    rows = np.flatnonzero((edges.gpio == pins.step_gpio) & (edges.level == 1))
    falls = np.flatnonzero((edges.gpio == pins.step_gpio) & (edges.level == 0))
    dir_rows = np.flatnonzero(edges.gpio == pins.dir_gpio)
    levels = np.concatenate([[0], edges.level[dir_rows]])
    high = levels[np.searchsorted(dir_rows, rows)] == 1
    direction = np.where(high != pins.inverted, 1, -1).astype(np.int64)
    return AxisTrace(
        pins, edges.time_ns[rows], direction, edges.time_ns[falls], edges.time_ns[dir_rows]
    )


@dataclass(frozen=True)
class Path4:
    """The axes together: one row for every moment at which any of them made a step."""

    time_ns: Ints
    steps: Ints
    """Shape (moments, axes), in steps, counted from 0."""
    names: tuple[str, ...]
    steps_per_unit: tuple[float, ...]

    def units(self) -> Floats:
        """Return the positions in mm and degrees."""
        return self.steps / np.array(self.steps_per_unit)


def merge(traces: list[AxisTrace]) -> Path4:
    """Put the axes on one time line."""
    times = np.unique(np.concatenate([trace.step_ns for trace in traces]))
    steps = np.stack([trace.count_at(times) for trace in traces], axis=1)
    return Path4(
        times,
        steps,
        tuple(trace.name for trace in traces),
        tuple(trace.pins.steps_per_unit for trace in traces),
    )


def path_speed(traces: list[AxisTrace], window_ns: int = 5_000_000) -> tuple[Floats, Floats]:
    """Return times (s) and the speed along the path (units/s) over the whole recording.

    The mean speed over `window_ns` around each time; rows lie a quarter of the window apart. Its
    error is below (2 ticks * speed + 1 step) / window for each axis.
    """
    first = min(trace.step_ns[0] for trace in traces if len(trace.step_ns))
    last = max(trace.step_ns[-1] for trace in traces if len(trace.step_ns))
    middles = np.arange(first, last + window_ns, window_ns // 4)
    total = np.zeros(len(middles))
    for trace in traces:
        change = trace.position_at(middles + window_ns // 2)
        change = change - trace.position_at(middles - window_ns // 2)
        total += (change / trace.pins.steps_per_unit) ** 2
    return (middles - first) / 1e9, np.sqrt(total) / (window_ns / 1e9)
