"""Judges the step edges of a G-code file by what the reader on the PC makes of it."""

from __future__ import annotations

import numpy as np
from cam_files import (
    DIR,
    FLOOD,
    MACHINE,
    MIST,
    SCALE,
    SPINDLE,
    SPINDLE_DIR,
    SPINDLE_RPM,
    STEP,
)

from stepmite.follow import follow
from stepmite.gcode import AXES, Block, target_steps
from stepmite.limits import Finding, Judge
from stepmite.path import build
from stepmite.trace import AxisPins, AxisTrace, Edges, axis_trace

PWM_NS = 1_000_000
SPEED, HARDNESS = 1.02, 1.02
"""Of the limits, as much may be used."""
DUTY_ERROR = 0.002
STABLE_PERIODS = 3


def traces_of(edges: Edges) -> list[AxisTrace]:
    """Return what each axis did."""
    pins = zip(AXES, STEP, DIR, SCALE, strict=True)
    return [axis_trace(edges, AxisPins(name, *gpios, False, scale)) for name, *gpios, scale in pins]


def expect(finding: Finding | None, most: float) -> None:
    """A limit is kept."""
    assert finding is None or finding.used <= most, str(finding)


def judge_motion(blocks: list[Block], traces: list[AxisTrace]) -> None:
    """The motors followed the path, ended where it ends, and kept the limits of the machine."""
    ends = tuple(trace.end_steps() for trace in traces)
    assert ends == target_steps(blocks[-1].target, SCALE)
    path = build(blocks, MACHINE, SCALE)
    moved = [trace for trace in traces if len(trace.step_ns)]
    judge = Judge(path, MACHINE, follow(path, moved), moved)
    assert judge.deviation_steps().value <= 1.0, str(judge.deviation_steps())
    expect(judge.feed(), SPEED)
    expect(judge.path_acceleration(), HARDNESS)
    for axis in judge.progress.axes:
        expect(judge.axis_speed(axis), SPEED)
        expect(judge.axis_acceleration(axis), HARDNESS)


def judge_bounds(
    traces: list[AxisTrace], said: dict[str, tuple[float, float]], rounded_mm: float = 0.0
) -> None:
    """Each axis went as far as STEPPER CHECK has said, to the step, and no other one moved.

    Corners that are rounded off (G64 P) stay behind by as much.
    """
    for trace, scale in zip(traces, SCALE, strict=True):
        if len(trace.step_ns) == 0:
            assert trace.name not in said
            continue
        places = np.concatenate([[0], trace.steps()]) / scale
        low, high = said[trace.name]
        error = 1.5 / scale
        assert -error <= places.min() - low <= error + rounded_mm, trace.name
        assert -error <= high - places.max() <= error + rounded_mm, trace.name


# ---- Spindle and coolant -------------------------------------------------------------------------


def _changes(edges: Edges, gpios: tuple[int, ...]) -> list[tuple[int, ...]]:
    """Return the levels of some pins each time they differ, those at the start first."""
    levels = dict.fromkeys(gpios, 0)
    found = [tuple(levels.values())]
    mine = np.isin(edges.gpio, gpios)
    rows = zip(edges.time_ns[mine], edges.gpio[mine], edges.level[mine], strict=True)
    together: dict[int, list[tuple[int, int]]] = {}
    for time_ns, gpio, level in rows:
        together.setdefault(int(time_ns), []).append((int(gpio), int(level)))
    for _, row in sorted(together.items()):
        levels.update(row)
        if tuple(levels.values()) != found[-1]:
            found.append(tuple(levels.values()))
    return found


def _without_repeats(values: list) -> list:
    return [value for i, value in enumerate(values) if i == 0 or value != values[i - 1]]


def judge_coolant(blocks: list[Block], edges: Edges) -> None:
    """Flood and mist were switched as the file says."""
    wanted: list[tuple[int, ...]] = [(0, 0)]
    for block in blocks:
        if block.kind == "coolant":
            wanted.append((int("flood" in block.coolant), int("mist" in block.coolant)))
    assert _changes(edges, (FLOOD, MIST)) == _without_repeats(wanted)


def judge_turning(blocks: list[Block], edges: Edges) -> None:
    """The spindle turned the way the file says."""
    wanted = [(0,)]
    for block in blocks:
        if block.kind == "spindle" and block.spindle_on:
            wanted.append((int(not block.clockwise),))
    assert _changes(edges, (SPINDLE_DIR,)) == _without_repeats(wanted)


def duties(edges: Edges) -> list[float]:
    """Return the duties of the spindle's PWM that lasted for some periods, one after the other."""
    mine = edges.gpio == SPINDLE
    time_ns, level = edges.time_ns[mine], edges.level[mine]
    rises, falls = time_ns[level == 1], time_ns[level == 0]
    runs: list[list[float]] = []
    for rise in rises:
        after = np.searchsorted(falls, rise, side="right")
        duty = (int(falls[after] - rise) if after < len(falls) else PWM_NS) / PWM_NS
        if runs and abs(runs[-1][0] - duty) < DUTY_ERROR:
            runs[-1][1] += 1
        else:
            runs.append([duty, 1])
    return _without_repeats([duty for duty, count in runs if count >= STABLE_PERIODS])


def judge_speeds(blocks: list[Block], edges: Edges) -> None:
    """Each speed above 0 shows in the duty of the PWM, and no other; in the end it is off."""
    wanted = set()
    for block in blocks:
        speed = min(block.speed_rpm, SPINDLE_RPM) / SPINDLE_RPM
        if block.kind in ("spindle", "move") and speed > 0:
            wanted.add(speed)
    found = duties(edges)
    assert bool(found) == bool(wanted)
    for speed in wanted:
        assert min(abs(np.array(found) - speed)) <= DUTY_ERROR, f"{speed} is missing"
    for duty in found:
        assert min(abs(np.array(sorted(wanted)) - duty)) <= DUTY_ERROR, f"{duty} is strange"
    levels = edges.level[edges.gpio == SPINDLE]
    assert not any(levels[-1:])


def judge_outputs(blocks: list[Block], edges: Edges) -> None:
    """All that is no motor."""
    judge_coolant(blocks, edges)
    judge_turning(blocks, edges)
    judge_speeds(blocks, edges)


__all__ = ["judge_bounds", "judge_motion", "judge_outputs", "traces_of"]
