"""Many short moves take no longer than the geometry demands."""

import math

import pytest
from host_machine import Setup, run

from stepmite.gcode import read_blocks
from stepmite.plan import plan

QUEUED = Setup(queue_first=True)


def test_200_collinear_moves_take_as_long_as_one(tmp_path):
    lines = ["G90 G1 F3000"] + [f"X{n * 0.5:.1f}" for n in range(1, 201)]
    assert run(tmp_path, lines, QUEUED).motion_s() == pytest.approx(2.10, rel=0.01)


def test_circle_of_360_chords(tmp_path):
    points = [(20 * math.cos(a) - 20, 20 * math.sin(a)) for a in map(math.radians, range(1, 361))]
    lines = ["G90 G1 F3000"] + [f"X{x:.4f} Y{y:.4f}" for x, y in points]
    assert run(tmp_path, lines, QUEUED).motion_s() == pytest.approx(2.61, rel=0.03)


@pytest.mark.parametrize(("blocks", "at_least_s"), [(1, 5.0), (4, 2.5), (32, 2.08)])
def test_small_queues_are_slower_but_arrive(tmp_path, blocks, at_least_s):
    lines = ["G90 G1 F3000"] + [f"X{n * 0.5:.1f}" for n in range(1, 201)]
    # One slot: nothing to look ahead at, each move starts and ends at rest.
    result = run(tmp_path, lines, Setup(blocks=blocks))
    assert result.end_steps() == [8000, 0, 0, 0]
    assert result.motion_s() > at_least_s


def test_the_plan_on_the_pc_tells_the_time(tmp_path):
    lines = ["G90 G1 F2400", "X30 Y10", "X10 Y40 Z2", "G0 X0 Y0 Z0", "G1 Y-20 F600", "A90 F5000"]
    expected = sum(row.duration_s() for row in plan(read_blocks(lines), QUEUED.machine()))
    assert run(tmp_path, lines, QUEUED).motion_s() == pytest.approx(expected, rel=0.01)
