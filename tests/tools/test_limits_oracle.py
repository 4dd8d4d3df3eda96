"""The checks of speed, acceleration, jerk, corners and path pass clean motion and catch faults."""

import math

import numpy as np
import pytest
from synthetic import edges_along, jerk_law, without_step

from stepmite import follow, limits, path
from stepmite.gcode import read_blocks
from stepmite.plan import Machine
from stepmite.trace import AxisPins, TraceError, axis_trace

SCALE = (800.0, 800.0, 400.0, 10.0)
PINS = [AxisPins(name, 2 + 2 * i, 3 + 2 * i, False, SCALE[i]) for i, name in enumerate("XYZA")]
MACHINE = Machine((80.0,) * 4, (500.0,) * 4, 0.02, path_jerk=5_000.0)
UNEVEN = Machine((80.0,) * 4, (400.0, 300.0, 500.0, 500.0), 0.02, path_jerk=5_000.0)
"""500 mm/s^2 in the direction of LINE."""

LINE = ["G1 F4200 X16 Y12"]
RAMP = [(5_000, 0.1), (0, 0.04), (-5_000, 0.1)]
"""From rest to 70 mm/s with 500 mm/s^2 and 5,000 mm/s^3."""


JUMPS = [("jump", 500), (0, 0.14), ("jump", -500)]
"""The same without jerk limit."""


def trip(ramp, length=20.0):
    """Up by a ramp, on, and down again, so that it is `length` in all."""
    _, ways, speed = jerk_law(ramp)
    return [*ramp, (0, (length - 2 * ways[-1]) / speed), *reversed(ramp)]


def judge(lines, phases, machine=UNEVEN, spoil=None, drawn=None):
    """Let an ideal machine run along `drawn` (the path itself if None) by phases of jerk."""
    commanded = path.build(read_blocks(lines), machine, SCALE)
    driven = path.build(read_blocks(drawn), machine, SCALE) if drawn else commanded
    edges = edges_along(driven, PINS, law_to(phases, float(driven.begin[-1])))
    if spoil:
        edges = spoil(edges)
    traces = [axis_trace(edges, pin) for pin in PINS]
    traces = [trace for trace in traces if len(trace.step_ns)]
    progress = follow.follow(commanded, traces)
    return limits.Judge(commanded, machine, progress, traces)


def law_to(phases, length):
    """The law, which leads to `length` but for the digits of the phases."""
    times, ways, _ = jerk_law(phases)
    assert ways[-1] == pytest.approx(length, rel=0.001)
    return times, ways * (length / ways[-1])


@pytest.fixture(scope="module")
def clean():
    return judge(LINE, trip(RAMP))


def test_clean_motion_is_within_its_limits_and_close_to_them(clean):
    assert 0.99 < clean.feed().used <= 1.0
    assert 0.97 < clean.path_acceleration().used <= 1.0
    assert 0.9 < clean.path_jerk(30_000_000).used <= 1.0
    assert clean.deviation_steps().value <= 1.0
    for axis in clean.progress.axes:
        assert clean.axis_speed(axis).used <= 1.0
        assert clean.axis_acceleration(axis).used <= 1.0


def test_five_per_cent_more_speed_is_caught():
    fast = [(5_000, 0.1), (0, 0.047), (-5_000, 0.1)]
    found = judge(LINE, trip(fast))
    assert found.feed().used > 1.03


def test_ten_per_cent_more_acceleration_is_caught():
    hard = [(5_000, 0.11), (0, 0.017), (-5_000, 0.11)]
    found = judge(LINE, trip(hard))
    assert found.path_acceleration().used > 1.02
    assert found.axis_acceleration(found.progress.axes[0]).used > 1.02


def test_an_axis_that_is_weaker_counts_in_its_own_direction():
    machine = Machine((80.0,) * 4, (380.0, 300.0, 500.0, 500.0), path_jerk=5_000.0)
    found = judge(LINE, trip(RAMP), machine)
    assert found.path_acceleration().used > 1.02
    assert found.axis_acceleration(found.progress.axes[0]).used > 1.02
    assert found.axis_acceleration(found.progress.axes[1]).used <= 1.0


def test_ten_per_cent_more_jerk_is_caught():
    rough = [(5_500, 0.0909), (0, 0.049), (-5_500, 0.0909)]
    found = judge(LINE, trip(rough))
    assert found.path_acceleration().used <= 1.0
    assert found.path_jerk(25_000_000).used > 1.05


def test_acceleration_that_jumps_is_caught_at_every_span():
    found = judge(LINE, trip(JUMPS))
    assert found.path_acceleration().used <= 1.0
    for span_ms in (5, 10, 20):
        assert found.path_jerk(span_ms * 1_000_000).used > 1.5


def test_short_blocks_hide_nothing():
    lines = ["G1 F4200"] + [f"X{n * 0.016:.3f} Y{n * 0.012:.3f}" for n in range(1, 1001)]
    clean = judge(lines, trip(RAMP))
    assert clean.path_jerk(30_000_000).used <= 1.0
    assert clean.axis_acceleration(clean.progress.axes[0]).used <= 1.02
    rough = [(5_600, 0.0893), (0, 0.051), (-5_600, 0.0893)]
    assert judge(lines, trip(rough)).path_jerk(25_000_000).used > 1.05


CORNER = ["G1 F3000 X10", "Y10"]


def through_corner(speed):
    """Down to `speed` in the corner after 10 mm, without jerk limit."""
    slow = (50 - speed) / 500
    cruise = (10 - 2.5 - (50**2 - speed**2) / 1000) / 50
    down = [("jump", 500), (0, 0.1), ("jump", -500), (0, cruise), ("jump", -500), (0, slow)]
    up = [("jump", 1000), (0, slow), ("jump", -500), (0, cruise), ("jump", -500), (0, 0.1)]
    return down + up


def rule_of_the_corner():
    return math.sqrt(500 * math.sqrt(2) * 0.02 * math.sqrt(0.5) / (1 - math.sqrt(0.5)))


def test_corner_at_its_speed_passes():
    found = judge(CORNER, through_corner(rule_of_the_corner()), MACHINE)
    assert 0.9 < found.corners().used <= 1.0
    assert found.path_acceleration().used <= 1.0
    assert found.axis_acceleration(found.progress.axes[0]).used <= 1.02


def test_corner_ten_per_cent_too_fast_is_caught():
    found = judge(CORNER, through_corner(rule_of_the_corner() * 1.1), MACHINE)
    assert found.corners().used > 1.0


@pytest.mark.parametrize("mode", ["G61", "G61.1"])
def test_a_stop_that_is_none_is_caught(mode):
    found = judge([mode, *CORNER], through_corner(1.0), MACHINE)
    assert found.corners().used > 1.0
    assert judge([mode, *CORNER], through_corner(0.0), MACHINE).corners().used <= 1.0


def through_blend(factor):
    """Pass the blend of P = 0.1 mm in the corner at `factor` of its speed."""
    reach = 0.1 * math.sqrt(8)
    speed = factor * math.sqrt(2 * reach * 500)
    slow = (50 - speed) / 500
    cruise = (10 - reach - 2.5 - (50**2 - speed**2) / 1000) / 50
    down = [("jump", 500), (0, 0.1), ("jump", -500), (0, cruise), ("jump", -500), (0, slow)]
    up = [("jump", 500), (0, slow), ("jump", -500), (0, cruise), ("jump", -500), (0, 0.1)]
    return [*down, ("jump", 500), (0, 2 * reach / speed), *up]


def test_a_blend_is_judged_without_exclusions():
    lines = ["G64 P0.1", *CORNER]
    found = judge(lines, through_blend(1.0), MACHINE)
    assert found.deviation_steps().value <= 1.0
    assert found.corners() is None
    for axis in found.progress.axes:
        assert 0.97 < found.axis_acceleration(axis).used <= 1.01


def test_a_blend_too_fast_is_caught():
    found = judge(["G64 P0.1", *CORNER], through_blend(1.05), MACHINE)
    assert max(found.axis_acceleration(axis).used for axis in found.progress.axes) > 1.04


def test_a_corner_that_jumps_where_a_blend_is_due_is_caught():
    # The exact path instead of the blend: the motors do not do what the blend asks for.
    found = judge(["G64 P0.1", *CORNER], through_corner(16.0), MACHINE, drawn=CORNER)
    assert found.deviation_steps().value > 5


def test_an_arc_uses_acceleration_for_its_turn():
    circle = ["G1 F3000", "G3 I5"]
    way, speed = 10 * math.pi, math.sqrt(0.866 * 500 * 5)
    phases = trip([("jump", 250), (0, speed / 250), ("jump", -250)], way)
    found = judge(circle, phases, MACHINE)
    assert found.deviation_steps().value <= 1.0
    for axis in found.progress.axes:
        assert 0.85 < found.axis_acceleration(axis).used <= 1.01
    fast = judge(circle, phases, Machine((80.0,) * 4, (400.0,) * 4, path_jerk=5e3))
    assert max(fast.axis_acceleration(axis).used for axis in fast.progress.axes) > 1.04


def test_a_lost_step_is_caught():
    with pytest.raises(TraceError, match="X: the path is left"):
        judge(LINE, trip(RAMP), spoil=lambda e: without_step(e, 2, 700))


def test_a_path_cut_short_is_caught_or_allowed():
    commanded = path.build(read_blocks(LINE), MACHINE, SCALE)
    edges = edges_along(commanded, PINS, law_to(trip(RAMP), 20.0))
    first = edges.time_ns < 300_000_000
    half = type(edges)(edges.time_ns[first], edges.gpio[first], edges.level[first])
    traces = [axis_trace(half, pin) for pin in PINS[:2]]
    with pytest.raises(TraceError, match="the path is left"):
        follow.follow(commanded, traces)
    part = follow.follow(commanded, traces, whole=False)
    assert part.way[-1] == pytest.approx(12.53, abs=0.01)


def test_arcs_that_touch_a_half_step_may_make_it_or_not():
    # The top of the circle lies 0.01 steps below or above a half step.
    for shift in (-0.01, 0.01):
        radius = (400.5 + shift) / 800
        commanded = path.build(read_blocks([f"F600 G3 I{radius:.9f}"]), MACHINE, SCALE)
        driven = path.build(read_blocks([f"F600 G3 I{(400.5 - shift) / 800:.9f}"]), MACHINE, SCALE)
        ones = np.ones(len(commanded.way))
        length = float(driven.begin[-1])
        phases = trip([(5_000, 0.02), (-5_000, 0.02)], length)
        edges = edges_along(driven, PINS, law_to(phases, length))
        traces = [axis_trace(edges, pin) for pin in PINS[:2]]
        steps = [len(trace.step_ns) for trace in traces]
        assert steps != [len(follow.crossings(commanded, axis, 800.0, ones).way) for axis in (0, 1)]
        progress = follow.follow(commanded, traces)
        assert np.all(np.diff(progress.way) >= -0.01)
        assert len(progress.way) > 2700
