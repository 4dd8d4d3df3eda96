"""G-code files for lasers with STEPPER LASER 1: what each line burns, by the edges of the output.

With M4 a line burns power * way / feed seconds of full power, however it is ridden; with M3 power
times the time it takes. The beam is off in all that is no line or arc at a feed.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from cam_files import FILES, MACHINE, SCALE, SPINDLE, blocks_of, checked
from cam_oracle import judge_bounds, judge_coolant, judge_motion, traces_of
from test_cam_files import assert_done, carry_out

from stepmite.follow import follow
from stepmite.gcode import Block
from stepmite.path import build
from stepmite.trace import Edges

LASER_FILES = [file for file in FILES if file.stem.startswith("lightburn")]
S_MAX, PWM_HZ = 1000.0, 20_000
LASER = (f"STEPPER SPINDLE GP{SPINDLE},,{S_MAX:g},,{PWM_HZ}", "STEPPER LASER 1")
EDGE_S = 2.5 / PWM_HZ
"""The duty changes at the end of a period, and is exact to the tick."""
START_S = 0.003
"""Where a line begins or ends at standstill, the time is known to half a step."""


def burnt_until(edges: Edges, times_ns: np.ndarray) -> np.ndarray:
    """Return for how many seconds the beam was on up to each of these times."""
    mine = edges.gpio == SPINDLE
    time_ns, level = edges.time_ns[mine], edges.level[mine]
    on = np.concatenate([[0.0], np.cumsum(np.diff(time_ns) * level[:-1])])
    return np.interp(times_ns, time_ns, on) * 1e-9


def moves_of(blocks: list[Block]) -> tuple[list[Block], dict[int, bool]]:
    """Return what makes the machine move or stand, and which blocks (by id) are of M4.

    M3, M4, M5 and S alone are no place to stand at.
    """
    dims, dimming = {}, False
    for block in blocks:
        if block.kind == "spindle" and block.spindle_on:
            dimming = not block.clockwise
        dims[id(block)] = dimming
    return [block for block in blocks if block.kind != "spindle"], dims


def judge_beam(blocks: list[Block], edges: Edges) -> None:
    """Each line and arc has burnt what it should, and nothing else has burnt anything."""
    entries, dims = moves_of(blocks)
    moved = [trace for trace in traces_of(edges) if len(trace.step_ns)]
    path = build(entries, MACHINE, SCALE)
    progress = follow(path, moved)
    times_ns = np.interp(path.begin, progress.way, progress.time_ns)
    burnt = np.diff(burnt_until(edges, times_ns))
    seconds = np.diff(times_ns) * 1e-9
    steady = [piece.block.speed_rpm > 0 and not dims[id(piece.block)] for piece in path.pieces]
    expected = []
    for n, piece in enumerate(path.pieces):
        block, feed = piece.block, piece.block.feed_per_min
        power = block.speed_rpm / S_MAX if feed is not None else 0.0
        taken = piece.length / (feed / 60) if feed and dims[id(block)] else seconds[n]
        expected.append(power * taken)
        error = EDGE_S + (START_S if any(steady[max(n - 1, 0) : n + 2]) else 0.0)
        assert burnt[n] == pytest.approx(expected[n], abs=error), block
    assert burnt.sum() == pytest.approx(sum(expected), rel=0.005)
    assert sum(expected) > 0.1
    levels = edges.level[edges.gpio == SPINDLE]
    assert levels[-1] == 0


@pytest.mark.parametrize("curve", [0, 1])
@pytest.mark.parametrize("file", LASER_FILES, ids=lambda file: file.stem)
def test_each_line_burns_what_it_should(tmp_path: Path, file: Path, curve: int) -> None:
    output, edges = carry_out(tmp_path, file, *LASER, f"STEPPER SCURVE {curve}")
    report = checked(output)
    assert_done(output, report, 0.15 if curve else 0.01)
    assert "laser M5" in output
    blocks, _ = blocks_of(file)
    entries, _ = moves_of(blocks)
    traces = traces_of(edges)
    judge_bounds(traces, report.machine)
    judge_coolant(blocks, edges)
    judge_beam(blocks, edges)
    if not curve:
        judge_motion(entries, traces)
