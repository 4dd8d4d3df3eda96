"""Motion takes as long as the geometry demands, judged by an optimum computed independently."""

import math
from dataclasses import replace

import parts
import pytest
from host_machine import Setup, run

from stepmite.gcode import read_blocks
from stepmite.optimum import least_time_s
from stepmite.path import build
from stepmite.plan import plan

QUEUED = Setup(queue_first=True)
ROUTER = Setup(queue_first=True, max_velocity_per_min=(6000.0,) * 4, junction_mm=0.01)


def test_200_collinear_moves_take_as_long_as_one(tmp_path):
    lines = ["G90 G1 F3000"] + [f"X{n * 0.5:.1f}" for n in range(1, 201)]
    assert run(tmp_path, lines, QUEUED).taken_s() == pytest.approx(2.10, rel=0.001)


def test_circle_of_360_chords(tmp_path):
    points = [(20 * math.cos(a) - 20, 20 * math.sin(a)) for a in map(math.radians, range(1, 361))]
    lines = ["G90 G1 F3000"] + [f"X{x:.4f} Y{y:.4f}" for x, y in points]
    assert run(tmp_path, lines, QUEUED).taken_s() == pytest.approx(2.61, rel=0.005)


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
    assert run(tmp_path, lines, QUEUED).taken_s() == pytest.approx(expected, rel=0.002)


ALL_PARTS = {**parts.SHORT, **parts.CONTOUR_LIKE}


@pytest.mark.parametrize("name", ALL_PARTS)
def test_a_part_takes_the_least_time_that_limits_and_corners_allow(tmp_path, name):
    result = run(tmp_path, ALL_PARTS[name](), ROUTER)
    best_s = least_time_s(result.path())
    # The queue holds 1024 blocks of it; further ahead it cannot look.
    assert best_s * 0.999 <= result.taken_s() <= best_s * 1.01 + 0.002


@pytest.mark.parametrize("name", ALL_PARTS)
def test_a_limited_jerk_costs_little(tmp_path, name):
    """At 500 mm/s^2 and 10,000 mm/s^3, against the optimum without a limit of the jerk."""
    result = run(tmp_path, ALL_PARTS[name](), replace(ROUTER, jerk=10_000.0))
    best_s = least_time_s(result.path())
    assert best_s <= result.taken_s() <= best_s * (1.10 if name in parts.SHORT else 1.30)


@pytest.mark.parametrize("jerk", [None, 10_000.0])
def test_500_short_moves_take_as_long_as_one(tmp_path, jerk):
    setup = replace(ROUTER, jerk=jerk)
    short = ["G90 G1 F6000"] + [f"X{n * 0.1:.1f}" for n in range(1, 501)]
    one = run(tmp_path, ["G1 F6000 X50"], setup).taken_s()
    assert run(tmp_path, short, setup).taken_s() == pytest.approx(one, rel=0.01)


def test_the_optimum_of_a_line_and_of_a_corner():
    machine = ROUTER.machine()
    scale = ROUTER.steps_per_unit
    line = build(read_blocks(["G1 F6000 X50"]), machine, scale)
    assert least_time_s(line) == pytest.approx(0.5 + 0.2, rel=1e-4)
    corner = math.sqrt(500 * math.sqrt(2) * 0.01 * math.sqrt(0.5) / (1 - math.sqrt(0.5)))
    there = (100 + (100 - corner)) / 500 + (25 - 10 - (100**2 - corner**2) / 1000) / 100
    bent = build(read_blocks(["G1 F6000 X25", "Y25"]), machine, scale)
    assert least_time_s(bent) == pytest.approx(2 * there, rel=1e-4)


def test_the_optimum_of_a_tight_circle():
    """Without a feed limit: v^2 = A r sin(2 s / r) until 0.866 A r, by the theory of the turn."""
    machine = ROUTER.machine()
    circle = build(read_blocks(["G0 X0", "F60000 G3 I2"]), machine, ROUTER.steps_per_unit)
    top = math.sqrt(0.866 * 500 * 2)
    ramp = 2 / 2 * math.asin(0.866)
    count = 200_000
    ways = [ramp * (n + 0.5) / count for n in range(count)]
    seconds = sum(ramp / count / math.sqrt(500 * 2 * math.sin(way)) for way in ways)
    expected = 2 * seconds + (4 * math.pi - 2 * ramp) / top
    assert least_time_s(circle) == pytest.approx(expected, rel=0.002)
