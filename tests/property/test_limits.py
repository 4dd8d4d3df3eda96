"""Whatever the path: no axis is faster or accelerates harder than it may, and the path is kept."""

import math
import random

import numpy as np
import pytest
from host_machine import Setup, run

from stepmite import oracle
from stepmite.plan import junction_speed

TOLERANCE = 1.02

MACHINES = {
    "equal": Setup(queue_first=True),
    "uneven": Setup(
        steps_per_unit=(80.0, 53.3, 400.0, 8.8889),
        max_velocity_per_min=(4800.0, 3000.0, 600.0, 3600.0),
        max_acceleration=(500.0, 300.0, 100.0, 400.0),
        queue_first=True,
    ),
    "fast": Setup(
        steps_per_unit=(200.0, 250.0, 400.0, 100.0),
        max_velocity_per_min=(15000.0, 12000.0, 7500.0, 30000.0),
        max_acceleration=(3000.0, 2000.0, 1500.0, 2500.0),
        queue_first=True,
    ),
}


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


def test_ends_where_it_was_sent(moved):
    assert moved.end_steps() == moved.corners[-1].tolist()


def test_path_is_kept_within_a_step(moved):
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


def test_speed_and_acceleration_of_every_axis_stay_within_their_limits(moved):
    blocks = oracle.split_blocks(moved.traces, moved.corners)
    machine = moved.setup.machine()
    measured = 0
    for begin, end in zip(blocks.begin_ns, blocks.end_ns, strict=True):
        for axis, trace in enumerate(moved.traces):
            found = oracle.extremes(trace, int(begin), int(end))
            if found is not None:
                measured += 1
                fastest = machine.max_velocity[axis] * TOLERANCE
                hardest = machine.max_acceleration[axis] * TOLERANCE
                assert found.speed <= fastest + found.speed_error
                assert found.acceleration <= hardest + found.acceleration_error
    assert measured > 100


def test_corners_are_passed_no_faster_than_junction_deviation_allows(moved):
    blocks = oracle.split_blocks(moved.traces, moved.corners)
    machine = moved.setup.machine()
    moves = np.diff(moved.targets, axis=0)
    directions = [tuple(move / (math.hypot(*move[:3]) or abs(move[3]))) for move in moves]
    seen = 0
    for index in range(len(moves) - 1):
        hardest = path_limit(directions[index], machine.max_acceleration)
        found = oracle.exit_speed(moved.traces, blocks, index, hardest)
        if found is None:
            continue
        seen += 1
        corner = junction_speed(directions[index], directions[index + 1], machine)
        allowed = math.sqrt((corner * TOLERANCE) ** 2 + 2 * hardest * found.before_corner)
        assert found.speed <= allowed + found.error
    assert seen > 20


def path_limit(direction, limits):
    pairs = zip(direction, limits, strict=True)
    return min(limit / abs(part) for part, limit in pairs if part)
