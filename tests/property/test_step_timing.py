"""Every step at its moment: the whole firmware against the closed form of its moves."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from host_machine import Setup, run

from stepmite.gcode import read_blocks
from stepmite.plan import Machine, Planned, plan
from stepmite.trace import TICK_NS, AxisTrace

TOLERANCE_NS = TICK_NS / 2 + 1000
RATE_TOLERANCE = 50e-6
SCALES = (80.0, 133.3, 400.0, 17.7)
PAUSE = "G4 P50"


@dataclass(frozen=True)
class Move:
    """One move from rest to rest and the steps that were made for it."""

    ideal: Planned
    counts: tuple[int, ...]
    """Steps of each axis, with their sign."""
    step_ns: tuple[np.ndarray, ...]


def ideal_s(move: Planned, way: np.ndarray) -> np.ndarray:
    """Return when each `way` (mm) is done, in seconds from the start of the move."""
    top = move.peak()
    ramp = top * top / (2 * move.acceleration)
    whole_s = move.duration_s()

    def speeding_up(part: np.ndarray) -> np.ndarray:
        in_ramp = np.sqrt(2 * np.minimum(part, ramp) / move.acceleration)
        return in_ramp + np.maximum(part - ramp, 0) / top

    first = way <= move.length / 2
    return np.where(first, speeding_up(way), whole_s - speeding_up(move.length - way))


def lateness_ns(move: Move) -> np.ndarray:
    """Return by how much each step of all axes is late; the mean of the extremes counts as 0.

    A motor stands at the nearest whole step, so a step is due half way between two of them.
    """
    late = []
    for count, times in zip(move.counts, move.step_ns, strict=True):
        way = (np.arange(abs(count)) + 0.5) / max(abs(count), 1) * move.ideal.length
        late.append(times - ideal_s(move.ideal, way) * 1e9)
    every = np.concatenate(late)
    return every - (every.max() + every.min()) / 2


def split(traces: list[AxisTrace], corners: np.ndarray, rows: list[Planned]) -> list[Move]:
    """Cut the recording into its moves by counting."""
    moves = []
    ways = np.diff(corners, axis=0)
    done = np.concatenate([np.zeros((1, len(traces)), int), np.cumsum(np.abs(ways), axis=0)])
    for index, row in enumerate(rows):
        times = [
            trace.step_ns[done[index][axis] : done[index + 1][axis]]
            for axis, trace in enumerate(traces)
        ]
        moves.append(Move(row, tuple(ways[index].tolist()), tuple(times)))
    return moves


def carried_out(folder, moves: list[str], setup: Setup) -> list[Move]:
    """Carry out the moves, each from rest to rest."""
    lines = [line for move in moves for line in (move, PAUSE)]
    result = run(folder, lines, setup)
    assert result.end_steps() == result.corners[-1].tolist()
    machine = Machine(
        tuple(v / 60 for v in setup.max_velocity_per_min), tuple(setup.max_acceleration)
    )
    rows = [row for row in plan(read_blocks(lines), machine) if row.block.kind == "move"]
    return split(result.traces, result.corners, rows)


GRID_MOVES = [
    "G1 X20 Y-7 Z0.31 A3 F6000",
    "G1 X0 Y0 Z0 A0 F20000",
    "G1 X2 F30",
    "G1 X2.05 Y6 F750",
    "G1 Z12 Y6.2 X2.04 A-1 F4000",
    "G0 X0 Y0 Z0 A0",
    "G1 X0.5 Y0.3 F12000",
    "G0 X30 Y31 Z14.2 A200",
]


@pytest.mark.parametrize("acceleration", [20.0, 500.0, 5000.0, 100_000.0])
def test_every_step_is_within_half_a_tick_and_a_microsecond(tmp_path, acceleration):
    setup = Setup(
        steps_per_unit=SCALES,
        max_velocity_per_min=(20000.0, 20000.0, 7500.0, 60000.0),
        max_acceleration=(acceleration,) * 4,
        inverted=(False,) * 4,
        queue_first=True,
    )
    worst = {}
    for move, text in zip(carried_out(tmp_path, GRID_MOVES, setup), GRID_MOVES, strict=True):
        worst[text] = float(np.abs(lateness_ns(move)).max())
    assert max(worst.values()) <= TOLERANCE_NS, worst


def test_mean_rate_is_right_within_50_ppm(tmp_path):
    """Between the first and the last step of the cruise, each of which is known to a tick."""
    rates_hz = [1, 3.3, 47, 999.9, 12_345, 33_333, 49_999, 50_000]
    setup = Setup(
        steps_per_unit=(100.0,) * 4,
        max_velocity_per_min=(30000.0,) * 4,
        max_acceleration=(5000.0,) * 4,
        inverted=(False,) * 4,
        queue_first=True,
    )
    # Whole steps, so that a move is as long as it is asked to be.
    lengths = [round(rate * (15 if rate < 10 else 2)) / 100 for rate in rates_hz]
    lines = [
        f"G91 G1 X{length:.2f} F{rate * 60 / 100:.6f}"
        for rate, length in zip(rates_hz, lengths, strict=True)
    ]
    for move, rate in zip(carried_out(tmp_path, lines, setup), rates_hz, strict=True):
        up, cruise, _ = move.ideal.phases()
        x = move.step_ns[0]
        since_s = (x - x[0]) / 1e9
        inside = x[(since_s > up + 1e-3) & (since_s < up + cruise - 1e-3)]
        duration_s = (inside[-1] - inside[0]) / 1e9
        measured = (len(inside) - 1) / duration_s
        known = TICK_NS / 1e9 / duration_s
        assert math.isclose(measured, rate, rel_tol=RATE_TOLERANCE + known), rate
        assert known < RATE_TOLERANCE


def test_lateness_sees_planted_faults():
    """A step that is a tick late, a staircase of 1 ms, and a slow axis in step with a fast one."""
    row = plan(read_blocks(["G1 X10 Y1 F3000"]), Machine())[0]
    counts = (800, 80, 0, 0)
    exact = [
        ideal_s(row, (np.arange(count) + 0.5) / count * row.length) * 1e9 if count else np.zeros(0)
        for count in counts
    ]
    on_grid = [np.ceil(times / TICK_NS) * TICK_NS for times in exact]
    assert np.abs(lateness_ns(Move(row, counts, tuple(on_grid)))).max() <= TICK_NS / 2

    late = [times.copy() for times in on_grid]
    late[0][400] += TICK_NS
    assert np.abs(lateness_ns(Move(row, counts, tuple(late)))).max() > TOLERANCE_NS

    slow = [times.copy() for times in on_grid]
    slow[1] = slow[0][np.searchsorted(slow[0], slow[1])]
    assert np.abs(lateness_ns(Move(row, counts, tuple(slow)))).max() > TOLERANCE_NS

    corners_s = np.arange(0, row.duration_s() + 1e-3, 1e-3)
    ways = np.array([row.distance_at(time) for time in corners_s])
    stairs = [
        np.interp((np.arange(count) + 0.5) / max(count, 1) * row.length, ways, corners_s) * 1e9
        for count in counts
    ]
    assert np.abs(lateness_ns(Move(row, counts, tuple(stairs)))).max() > TOLERANCE_NS
