"""Whatever the path: no axis is faster or accelerates harder than it may, and the path is kept."""

import math
import random

import pytest
from host_machine import MACHINES, run

from stepmite import oracle

TOLERANCE = 1.02


def random_path(seed, count, reach):
    """Long and short moves, straight on, round and back, on all axes."""
    rng = random.Random(seed)
    lines = ["G91"]
    heading = 0.0
    for _ in range(count):
        kind = rng.random()
        length = reach * rng.choice([0.003, 0.02, 0.2, 1.0]) * rng.uniform(0.5, 1)
        heading += rng.choice([0.0, rng.gauss(0, 0.2), rng.uniform(-math.pi, math.pi)])
        words = f"X{length * math.cos(heading):.3f} Y{length * math.sin(heading):.3f}"
        if kind < 0.3:
            words += f" Z{rng.uniform(-0.2, 0.2) * length:.3f}"
        if kind < 0.15:
            words += f" A{rng.uniform(-2, 2) * length:.3f}"
        elif kind > 0.92:
            words = f"A{rng.uniform(-20, 20):.2f}"
        motion = "G0" if rng.random() < 0.2 else f"G1 F{rng.randint(300, 6000)}"
        lines.append(f"{motion} {words}")
    return lines


@pytest.fixture(scope="module", params=[(name, seed) for name in MACHINES for seed in (1, 2, 3)])
def moved(request, tmp_path_factory):
    name, seed = request.param
    setup = MACHINES[name]
    lines = random_path(seed, 120, reach=60.0)
    return run(tmp_path_factory.mktemp("moved"), lines, setup)


@pytest.fixture(scope="module")
def judge(moved):
    return moved.judge()


def test_ends_where_it_was_sent(moved):
    assert moved.end_steps() == moved.corners[-1].tolist()


def test_path_is_kept_within_a_step(moved, judge):
    assert judge.deviation_steps().value <= 1.0
    blocks = oracle.split_blocks(moved.traces, moved.corners)
    assert oracle.block_deviation(moved.traces, blocks).max() <= 1.0


def test_steps_are_two_ticks_apart_and_directions_have_time(moved):
    for trace in moved.traces:
        assert oracle.min_step_gap_ticks(trace) >= 2
        high, low = oracle.min_pulse_ns(trace)
        assert high >= 10_000
        assert low >= 10_000
        assert oracle.min_dir_setup_ns(trace) >= 10_000
        assert oracle.min_dir_hold_ns(trace) >= 10_000


def test_speed_and_acceleration_of_every_axis_stay_within_their_limits(judge):
    for axis in judge.progress.axes:
        speed, acceleration = judge.axis_speed(axis), judge.axis_acceleration(axis)
        assert speed.used <= TOLERANCE, speed
        assert acceleration.used <= TOLERANCE, acceleration
        assert acceleration.count > 100


def test_feed_and_acceleration_along_the_path(judge):
    feed, acceleration = judge.feed(), judge.path_acceleration()
    assert feed.used <= 1.0, feed
    assert 0.95 < acceleration.used <= TOLERANCE, acceleration


def test_corners_are_passed_no_faster_than_junction_deviation_allows(judge):
    corners = judge.corners()
    assert corners.used <= 1.0, corners
    assert corners.count > 200
