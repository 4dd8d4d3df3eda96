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
        (["X1"], "without G0 or G1"),
        (["G1 X1 X2 F100"], "X occurs twice"),
        (["G2 X1 I1"], "word I"),
        (["G2 X1"], "G2 is not supported"),
        (["G4"], "G4 without P"),
        (["G92"], "G92 without an axis"),
        (["M3 G0 X1"], "a line each"),
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
