"""The G-code reader, the plan and the example part on the PC."""

import math
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stepmite.gcode import (
    GcodeError,
    Reader,
    parse_words,
    read_blocks,
    strip_comments,
    target_steps,
)
from stepmite.nameplate import program
from stepmite.plan import Machine, plan

EXAMPLE = Path(__file__).parents[2] / "examples" / "nameplate.nc"


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("G1 X10 (to the right) Y5 ; and up", "G1X10Y5"),
        ("(only a comment)", ""),
        ("; only a comment", ""),
        ("%", ""),
        ("%1234", ""),
        ("   ", ""),
        ("G1 (a) X1 (b (c", "G1X1(b(c"),
        ("G1 X1 (see ; there) Y2", "G1X1Y2"),
    ],
)
def test_comments_go_and_broken_ones_stay_for_the_firmware(line, code):
    assert strip_comments(line) == code


def test_words_need_no_blanks_and_no_order():
    assert parse_words("y0x-10.5G1") == [("Y", 0.0), ("X", -10.5), ("G", 1.0)]
    for text in ("X", "10", "X1.2.3", "XY", "X--1"):
        with pytest.raises(ValueError, match="not a word"):
            parse_words(text)


def test_modal_state_and_offsets():
    lines = [
        "G90 G1 X10 Y5 F600",
        "X20",
        "G91 X-5 Z1",
        "G92 X0 Y0",
        "G90 X1",
        "G4 P250",
        "M3",
        "G0 A90",
    ]
    reader = Reader()
    blocks = list(read_blocks(lines, reader))
    moves = [block.target for block in blocks if block.kind == "move"]
    assert moves == [
        (10, 5, 0, 0),
        (20, 5, 0, 0),
        (15, 5, 1, 0),
        (16, 5, 1, 0),
        (16, 5, 1, 90),
    ]
    assert [block.kind for block in blocks][-3:] == ["dwell", "spindle", "move"]
    assert blocks[-1].feed_per_min is None
    assert reader.work_position() == (1, 0, 1, 90)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (["G1 X1"], "before any F"),
        (["X1"], "without a motion mode"),
        (["G1 X1 X2 F100"], "X occurs twice"),
        (["G5 X1"], "G5 is not supported"),
        (["G1 X1 U1 F1"], "word U is not supported"),
        (["G2 X1 I1"], "G2 before any F"),
        (["G1 X1 I1 F1"], "without an arc"),
        (["G64 P-1"], "must not be below 0"),
        (["G4"], "G4 without P"),
        (["G92"], "G92 without an axis"),
        (["M3 M4"], "two spindle switches"),
        (["G1 F0"], "F must be"),
    ],
)
def test_what_cannot_be_read_names_the_line(lines, message):
    with pytest.raises(GcodeError, match=f"line 2: .*{message}"):
        list(read_blocks(["(header)", *lines]))


def test_collinear_chords_are_as_fast_as_one_line():
    chords = [f"G1 X{i * 0.5} F3000" for i in range(1, 201)]
    assert sum(row.duration_s() for row in plan(read_blocks(chords))) == pytest.approx(2.1)


def test_circle_of_chords():
    points = [(20 * math.cos(a), 20 * math.sin(a)) for a in map(math.radians, range(1, 361))]
    lines = ["G92 X20 Y0", "G1 F3000"] + [f"X{x:.4f} Y{y:.4f}" for x, y in points]
    assert sum(row.duration_s() for row in plan(read_blocks(lines))) == pytest.approx(
        2.61, rel=0.01
    )


def arc_of(*lines):
    reader = Reader()
    block = list(read_blocks(["F600", *lines], reader))[-1]
    return block.arc, block.target


@pytest.mark.parametrize(
    ("line", "centre", "degrees"),
    [
        ("G3 X20 Y0 I10", (10, 0), 180),
        ("G2 X20 Y0 I10", (10, 0), -180),
        ("G3 X10 Y10 J10", (0, 10), 90),
        ("G2 X10 Y10 J10", (0, 10), -270),
        ("G3 I10", (10, 0), 360),
        ("G2 X0 Y0 I10 P3", (10, 0), -1080),
        ("G3 X10 Y10 J10 P2", (0, 10), 450),
        ("G3 X10 Y10 R10", (0, 10), 90),
        ("G3 X10 Y10 R-10", (10, 0), 270),
        ("G2 X10 Y10 R10", (10, 0), -90),
        ("G2 X10 Y10 R-10", (0, 10), -270),
        ("G3 X20 Y0 R10", (10, 0), 180),
        # The plane ZX: I lies along its second axis.
        ("G18 G3 X10 Z10 I10", (0, 10), 90),
        ("G18 G2 X10 Z10 K10", (10, 0), -90),
        ("G19 G3 Y10 Z10 K10", (0, 10), 90),
    ],
)
def test_arcs(line, centre, degrees):
    arc, target = arc_of(line)
    assert arc.centre == pytest.approx(centre, abs=1e-9)
    assert math.degrees(arc.sweep) == pytest.approx(degrees)
    assert arc.position((0, 0, 0, 0), target, 1.0) == pytest.approx(target, abs=1e-9)


def test_a_helix_rises_evenly_and_turns_a_along():
    arc, target = arc_of("G3 X20 I10 Z6 A90")
    assert arc.position((0, 0, 0, 0), target, 0.5) == pytest.approx((10, -10, 3, 45))
    assert arc.length((0, 0, 0, 0), target) == pytest.approx(math.hypot(10 * math.pi, 6))
    assert next(iter(Reader(arcs_turn_a=False).read(1, "G3 X20 I10 A90 F1"))).target == (
        20,
        0,
        0,
        0,
    )


def test_the_slope_of_an_arc_is_its_derivative():
    arc, target = arc_of("G18 G2 X7 Z3 Y5 A9 R8")
    start = (0, 0, 0, 0)
    for part in (0.0, 0.3, 1.0):
        ahead, behind = (arc.position(start, target, part + h) for h in (1e-6, -1e-6))
        wanted = [(a - b) / 2e-6 for a, b in zip(ahead, behind, strict=True)]
        assert arc.slope(start, target, part) == pytest.approx(wanted, abs=1e-5)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("G2 X10", "needs R or the centre"),
        ("G2 X10 I5 R5", "needs R or the centre"),
        ("G2 R5", "must end elsewhere"),
        ("G2 X10 R4", "R is too small"),
        ("G2 X10 I0 J0", "the arc has no radius"),
        ("G2 X10 I5.6", "off the arc"),
        ("G2 X10 I5 K1", "K does not lie in the plane"),
        ("G2 X10 I5 P1.5", "whole number of turns"),
    ],
)
def test_arcs_that_are_none(line, message):
    with pytest.raises(GcodeError, match=message):
        arc_of(line)


def test_path_modes_stay_in_force():
    lines = ["G61 G1 X1 F60", "X2", "G61.1 X3", "G64 X4", "G64 P0.05", "X5"]
    modes = [block.path_mode for block in read_blocks(lines)]
    assert [mode.kind for mode in modes] == ["G61", "G61", "G61.1", "G64", "G64"]
    assert [mode.tolerance_mm for mode in modes] == [0, 0, 0, 0, 0.05]


def seconds(*lines, machine=None):
    return sum(row.duration_s() for row in plan(read_blocks(lines), machine))


FAST = Machine((200.0,) * 4, (1000.0,) * 4, 0.01)


def test_a_circle_is_as_fast_as_its_feed():
    wanted = 40 * math.pi / 50 + 50 / 1000
    assert seconds("G1 F3000", "G3 I20", machine=FAST) == pytest.approx(wanted, rel=0.001)


def test_a_small_arc_is_limited_by_its_curvature():
    # v^2 / 1 mm = 866 mm/s^2: 29.4 mm/s, reached and left with half the acceleration.
    (row,) = plan(read_blocks(["G1 F9000", "G3 I1"]), FAST)
    assert row.nominal == pytest.approx(29.43, rel=0.001)
    assert row.acceleration == pytest.approx(500, rel=0.001)


def test_arcs_and_lines_that_meet_tangentially_do_not_stop():
    lines = ["G1 F3000 X10", "G3 X20 Y10 J10", "G1 Y20"]
    way = 20 + 5 * math.pi
    assert seconds(*lines, machine=FAST) == pytest.approx(way / 50 + 50 / 1000, rel=0.01)


def test_exact_stops_stop_and_exact_paths_at_corners_only():
    lines = ["G1 F3000 X10", "X20", "Y10"]
    alone = [seconds(f"G1 F3000 X{length}", machine=FAST) for length in (10, 20)]
    assert seconds("G61.1", *lines, machine=FAST) == pytest.approx(3 * alone[0])
    assert seconds("G61", *lines, machine=FAST) == pytest.approx(alone[1] + alone[0])


def test_a_blend_passes_the_corner_by_acceleration():
    rows = plan(read_blocks(["G64 P0.1 G1 F6000 X20", "Y20"]), FAST)
    assert len(rows) == 3
    # 90 degrees: it begins 0.283 mm before the corner; v^2 = 0.75 A * 2 * 0.283 mm.
    assert rows[1].length == pytest.approx(0.5657, rel=0.001)
    assert rows[1].nominal == pytest.approx(20.6, rel=0.001)
    assert rows[0].length == pytest.approx(20 - 0.2828, rel=0.001)
    assert rows[1].entry == rows[1].exit == pytest.approx(rows[1].nominal)


def test_a_corner_of_short_moves_is_limited_by_their_middle():
    # 1 mm moves at 90 degrees, deviation 1 mm: the arc may not be larger than r = 0.5 mm.
    rows = plan(
        read_blocks(["G1 F9000", "X1", "Y1", "X2"]), Machine((200.0,) * 4, (1000.0,) * 4, 1.0)
    )
    diagonal = 1000 * math.sqrt(2)
    assert rows[1].entry_cap == pytest.approx(math.sqrt(diagonal * 0.5))


coordinate = st.integers(-20_000, 20_000).map(lambda n: n / 1000)
feed = st.integers(60, 6000)


@settings(deadline=None, max_examples=100)
@given(st.lists(st.tuples(coordinate, coordinate, coordinate, feed), min_size=1, max_size=30))
def test_every_plan_keeps_its_limits(points):
    machine = Machine(max_velocity=(80, 60, 10, 100), max_acceleration=(500, 300, 100, 100))
    lines = [f"G1 X{x} Y{y} Z{z} F{f}" for x, y, z, f in points]
    rows = plan(read_blocks(lines), machine)
    for row, after in zip(rows, [*rows, None][1:], strict=True):
        assert row.exit == pytest.approx(after.entry if after else 0.0, abs=1e-9)
        change = abs(row.exit**2 - row.entry**2)
        assert change <= 2 * row.acceleration * row.length * (1 + 1e-9) + 1e-9
        for part, v, a in zip(
            row.direction, machine.max_velocity, machine.max_acceleration, strict=True
        ):
            assert abs(part) * row.peak() <= v * (1 + 1e-9)
            assert abs(part) * row.acceleration <= a * (1 + 1e-9)
        assert row.distance_at(row.duration_s()) == pytest.approx(row.length)


def test_targets_are_rounded_away_from_zero_at_the_half():
    assert target_steps((0.00625, -0.00625, 0.0099, 0), (80, 80, 80, 1)) == (1, -1, 1, 0)


def test_example_is_what_the_script_writes():
    assert EXAMPLE.read_text().splitlines() == program()


def test_example_fits_the_largest_queue_and_is_a_real_part():
    lines = EXAMPLE.read_text().splitlines()
    blocks = list(read_blocks(lines))
    assert len(lines) >= 300
    assert len(blocks) < 1000
    assert {block.kind for block in blocks} == {"move", "dwell", "spindle"}
    lengths = [row.length for row in plan(blocks) if row.block.target[2] < 0]
    assert sum(0.1 <= length <= 0.5 for length in lengths) > 100
    seconds = sum(row.duration_s() for row in plan(blocks, Machine((100, 100, 50, 100))))
    assert 45 < seconds < 90
