"""Speed, acceleration and jerk for pictures, from the edges of a motion that is known."""

import numpy as np
import pytest
from synthetic import edges_along, jerk_law

from stepmite import path
from stepmite.derivatives import along_axes, along_path
from stepmite.follow import follow
from stepmite.gcode import read_blocks
from stepmite.plan import Machine
from stepmite.trace import AxisPins, axis_trace

SCALE = (800.0, 800.0, 400.0, 10.0)
PINS = [AxisPins(name, 2 + 2 * i, 3 + 2 * i, False, SCALE[i]) for i, name in enumerate("XYZA")]
PHASES = [(5_000, 0.1), (0, 0.1), (-5_000, 0.1), (0, 0.2)]


@pytest.fixture(scope="module", params=[along_path, along_axes])
def course(request):
    times, ways, _ = jerk_law([*PHASES, (-5_000, 0.1), (0, 0.1), (5_000, 0.1)])
    line = path.build(
        read_blocks([f"G1 F9000 X{ways[-1] * 0.6:.9f} Y{ways[-1] * 0.8:.9f}"]), Machine(), SCALE
    )
    edges = edges_along(line, PINS, (times, ways * (line.way[-1] / ways[-1])))
    traces = [axis_trace(edges, pins) for pins in PINS[:2]]
    if request.param is along_path:
        return along_path(follow(line, traces))
    return along_axes(traces)


@pytest.mark.parametrize(
    ("begin_s", "end_s", "value", "wanted", "tolerance"),
    [
        (0.02, 0.08, "jerk", 5_000, 400),
        (0.12, 0.18, "acceleration", 500, 10),
        (0.22, 0.28, "jerk", -5_000, 600),
        (0.32, 0.48, "speed", 100, 0.5),
        (0.62, 0.68, "acceleration", -500, 10),
    ],
)
def test_values_in_the_middle_of_each_phase(course, begin_s, end_s, value, wanted, tolerance):
    inside = (course.time_s > begin_s) & (course.time_s < end_s)
    assert inside.sum() > 20
    assert np.median(getattr(course, value)[inside]) == pytest.approx(wanted, abs=tolerance)


def test_the_machine_is_at_rest_before_and_behind(course):
    ends = (course.time_s < -0.015) | (course.time_s > 0.815)
    assert np.abs(course.speed[ends]).max(initial=0.0) < 0.5
