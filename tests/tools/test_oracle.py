"""Each oracle passes a clean recording and catches a fault that was planted for it."""

import numpy as np
import pytest
from synthetic import PINS, edges_of, traces_of, without_step

from stepmite import oracle
from stepmite.plan import Machine
from stepmite.trace import TICK_NS, AxisPins, Edges, TraceError, axis_trace, merge, path_speed

PROGRAM = [
    "G90 G1 F3000 X20 Y10",
    "X40 Y-5",
    "X0 Y0",
    "G91 G0 X-15 Y15",
    "G1 Y-40 F1200",
]
LINE = ["G1 X40 F3000"]


@pytest.fixture(scope="module")
def clean():
    return edges_of(PROGRAM)


def test_end_position_is_exact(clean):
    edges, corners = clean
    assert [trace.end_steps() for trace in traces_of(edges)] == corners[-1].tolist()


def test_lost_step_is_caught(clean):
    edges, corners = clean
    faulty = traces_of(without_step(edges, gpio=2, number=700))
    assert faulty[0].end_steps() != corners[-1][0]
    with pytest.raises(TraceError, match=r"X: .* steps, .* commanded"):
        oracle.split_blocks(faulty, corners)


def test_split_blocks_finds_every_corner_in_order(clean):
    edges, corners = clean
    blocks = oracle.split_blocks(traces_of(edges), corners)
    assert len(blocks.begin_ns) == len(PROGRAM)
    assert np.all(blocks.end_ns > blocks.begin_ns)


def test_swapped_blocks_are_caught(clean):
    edges, corners = clean
    order = corners.copy()
    order[1] = order[0] + (corners[2] - corners[1])
    with pytest.raises(TraceError, match="wrong way"):
        oracle.split_blocks(traces_of(edges), order)


def test_reordered_collinear_directions_are_caught():
    edges, corners = edges_of(["G1 X10 F3000", "Y10"])
    swapped = np.array([[0, 0], [0, 800], [800, 800]])
    assert oracle.split_blocks(traces_of(edges), corners).begin_ns[0] > 0
    with pytest.raises(TraceError, match="begins before"):
        oracle.split_blocks(traces_of(edges), swapped)


def test_speed_and_acceleration_of_a_clean_line():
    (trace, _) = traces_of(edges_of(LINE)[0])
    found = oracle.extremes(trace, int(trace.step_ns[0]), int(trace.step_ns[-1]))
    assert found.speed == pytest.approx(50.0, rel=0.002)
    assert found.acceleration == pytest.approx(500.0, rel=0.01)
    assert found.speed <= 50.0 + found.speed_error
    assert found.acceleration <= 500.0 + found.acceleration_error
    assert found.acceleration_error < 5.0


def test_five_per_cent_overspeed_is_caught():
    (trace, _) = traces_of(edges_of(LINE, time_scale=1 / 1.05)[0])
    found = oracle.extremes(trace, int(trace.step_ns[0]), int(trace.step_ns[-1]))
    assert found.speed - found.speed_error > 50.0 * 1.02


def test_acceleration_ten_per_cent_too_high_is_caught():
    machine = Machine(max_acceleration=(550.0,) * 4)
    (trace, _) = traces_of(edges_of(LINE, machine)[0])
    found = oracle.extremes(trace, int(trace.step_ns[0]), int(trace.step_ns[-1]))
    assert found.acceleration - found.acceleration_error > 500.0 * 1.02


def test_extremes_does_not_guess_on_short_stretches(clean):
    (trace, _) = traces_of(clean[0])
    assert oracle.extremes(trace, 0, 40_000_000) is None


def test_clean_path_stays_within_a_step(clean):
    edges, corners = clean
    traces = traces_of(edges)
    blocks = oracle.split_blocks(traces, corners)
    assert oracle.block_deviation(traces, blocks).max() <= 1.0
    assert oracle.path_deviation(merge(traces).steps.astype(float), corners.astype(float)) <= 1.0


def test_shifted_path_is_caught(clean):
    edges, corners = clean
    points = merge(traces_of(edges)).steps.astype(float)
    points[len(points) // 3 :, 1] += 2
    assert oracle.path_deviation(points, corners.astype(float)) > 1.5


def test_axis_that_lags_is_caught(clean):
    edges, corners = clean
    late = edges.time_ns + np.where(np.isin(edges.gpio, (4, 5)), 3_000_000, 0)
    order = np.argsort(late, kind="stable")
    lagging = traces_of(Edges(late[order], edges.gpio[order], edges.level[order]))
    # Y begins each block late, so X runs ahead of it: 3 ms at up to 40 mm/s are about 10 steps.
    path = merge(lagging).steps.astype(float)
    assert oracle.path_deviation(path, corners.astype(float)) > 2.0


def test_step_gap_and_pulse_width(clean):
    trace = traces_of(clean[0])[0]
    assert oracle.min_step_gap_ticks(trace) >= 2
    assert oracle.min_pulse_ns(trace)[0] == TICK_NS
    rows = [(0, 2, 1), (5_000, 2, 0), (10_000, 2, 1), (15_000, 2, 0)]
    close = axis_trace(Edges.from_rows(rows), PINS[0])
    assert oracle.min_step_gap_ticks(close) == 1
    assert oracle.min_pulse_ns(close) == (5_000, 5_000)


def test_direction_set_up_time():
    rows = [(0, 3, 1), (30_000, 2, 1), (40_000, 2, 0), (50_000, 3, 0), (60_000, 2, 1)]
    trace = axis_trace(Edges.from_rows(rows), PINS[0])
    assert oracle.min_dir_setup_ns(trace) == 10_000
    assert oracle.min_dir_hold_ns(trace) == 20_000
    assert trace.direction.tolist() == [1, -1]


def test_direction_in_the_same_tick_follows_the_order_of_the_rows():
    before = Edges.from_rows([(0, 3, 1), (0, 2, 1)])
    after = Edges.from_rows([(0, 2, 1), (0, 3, 1)])
    assert axis_trace(before, PINS[0]).direction.tolist() == [1]
    assert axis_trace(after, PINS[0]).direction.tolist() == [-1]
    assert oracle.min_dir_setup_ns(axis_trace(before, PINS[0])) == 0


def test_path_speed_shows_the_cruise():
    times, speed = path_speed(traces_of(edges_of(["G1 X30 Y40 F3000"])[0]))
    cruise = speed[(times > 0.2) & (times < 0.8)]
    assert cruise == pytest.approx(50.0, rel=0.01)


def test_recording_survives_the_file(tmp_path, clean):
    edges, _ = clean
    edges.write(tmp_path / "edges.csv")
    again = Edges.read(tmp_path / "edges.csv")
    assert np.array_equal(again.time_ns, edges.time_ns)
    assert np.array_equal(again.gpio, edges.gpio)
    assert np.array_equal(again.level, edges.level)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time,pin\n", "header"),
        ("time_ns,gpio,level\n1,2\n", "row"),
        ("time_ns,gpio,level\n20,2,1\n10,2,0\n", "order"),
        ("time_ns,gpio,level\n1,x,1\n", "row"),
    ],
)
def test_broken_recordings_are_refused(tmp_path, text, message):
    (tmp_path / "edges.csv").write_text(text)
    with pytest.raises(TraceError, match=message):
        Edges.read(tmp_path / "edges.csv")


def test_snapping_takes_latency_away():
    edges = Edges.from_rows([(1_003_100, 2, 1), (1_013_400, 2, 0), (1_022_999, 2, 1)])
    snapped = edges.snapped(origin_ns=1_003_000).time_ns.tolist()
    assert snapped == [1_003_000, 1_013_000, 1_013_000]


def test_axis_pins_are_read_and_refused():
    assert AxisPins.parse("x=GP2,3,inv,80") == AxisPins("X", 2, 3, True, 80.0)
    assert AxisPins.parse("A=2,3") == AxisPins("A", 2, 3, False, 1.0)
    for text in ("X", "X=2", "X=2,3,4,5", "X=a,b", "X=2,3,-1", "=2,3"):
        with pytest.raises(TraceError):
            AxisPins.parse(text)


SHARP = ["G1 F3000 X30", "Y30", "X0", "Y0"]


def corner_speeds(machine):
    edges, corners = edges_of(SHARP, machine)
    traces = traces_of(edges)
    blocks = oracle.split_blocks(traces, corners)
    return [oracle.exit_speed(traces, blocks, index, 500.0) for index in range(3)]


def test_exit_speed_of_a_clean_corner():
    for found in corner_speeds(Machine()):
        # 90 degrees, 0.02 mm, 500 mm/s^2: 4.91 mm/s, and the last step is half a step early.
        assert found.speed <= np.sqrt(4.92**2 + 2 * 500 * found.before_corner) + found.error
        assert found.speed > 4.9 - found.error


def test_corner_taken_too_fast_is_caught():
    for found in corner_speeds(Machine(junction_deviation_mm=0.06)):
        assert found.speed > np.sqrt(4.92**2 + 2 * 500 * found.before_corner) + found.error
