"""What the codes of CAM programs mean to the reader on the PC."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from stepmite.cli import app
from stepmite.gcode import Block, GcodeError, Reader, read_blocks

FILES = sorted((Path(__file__).parents[1] / "gcode" / "files").glob("*.nc"))


def moves(*lines: str, reader: Reader | None = None) -> list[tuple[float, ...]]:
    """Where the moves end, X Y Z."""
    return [
        tuple(round(value, 6) for value in block.target[:3])
        for block in read_blocks(lines, reader)
        if block.kind == "move"
    ]


def kinds(*lines: str) -> list[str]:
    """What the blocks are."""
    return [block.kind for block in read_blocks(lines)]


def last(*lines: str) -> Block:
    """The last block."""
    return list(read_blocks(lines))[-1]


def test_inches_convert_lengths_and_feeds_but_no_angles() -> None:
    block = last("G20 G1 X1 A90 F10")
    assert block.target == (25.4, 0, 0, 90)
    assert block.feed_per_min == 254
    assert last("G20 G64 P0.01 G1 X1 F10").path_mode.tolerance_mm == pytest.approx(0.254)
    arc = last("G20 G1 F10", "G3 X1 I0.5").arc
    assert arc is not None
    assert arc.radius == pytest.approx(12.7)


def test_work_coordinates_add_up() -> None:
    lines = ["G10 L2 P2 X100 Y50", "G55 G0 X1", "G92 X0", "G0 X5", "G53 G0 X7 Y8", "G54 G0 X0 Y0"]
    assert moves(*lines) == [(101, 0, 0), (106, 0, 0), (7, 8, 0), (1, 0, 0)]
    assert moves("G0 X10", "G10 L20 P1 X2", "G0 X0") == [(10, 0, 0), (8, 0, 0)]
    assert moves("G43.1 Z5", "G0 Z1", "G49", "G0 Z1") == [(0, 0, 6), (0, 0, 1)]
    assert moves("G10 L1 P3 Z4", "G43 H3", "G0 Z1") == [(0, 0, 5)]


def test_shifts_come_and_go() -> None:
    lines = ["G0 X10", "G92 X0", "G92.2", "G0 X1", "G92.3", "G0 X1", "G92.1", "G92.3", "G0 X2"]
    assert moves(*lines) == [(10, 0, 0), (1, 0, 0), (11, 0, 0), (2, 0, 0)]


def test_stored_places() -> None:
    lines = ["G0 X5 Y6 Z7", "G30.1", "G0 X0 Y0 Z0", "G30 Z2", "G30"]
    assert moves(*lines) == [(5, 6, 7), (0, 0, 0), (0, 0, 2), (0, 0, 7), (0, 0, 7), (5, 6, 7)]
    lines = ["G0 X5 Z7", "G28.1", "G0 X0 Z0", "G91 G28 Z0"]
    assert moves(*lines, reader=Reader(nist=True)) == [(5, 0, 7), (0, 0, 0), (0, 0, 0), (0, 0, 7)]


def test_home_is_where_homing_ends() -> None:
    assert kinds("G0 X5 Z7", "G28 G91 Z0", "G90 G0 X6") == ["move", "home", "move"]
    assert moves("G0 X5 Z7", "G28 G91 Z0", "G90 G0 X6") == [(5, 0, 7), (6, 0, 0)]


def test_inverse_time() -> None:
    assert last("G93 G1 X30 F2").feed_per_min == 60
    with pytest.raises(GcodeError, match="G93 needs F"):
        last("G93 G1 X30 F2", "X60")
    with pytest.raises(GcodeError, match="before any F"):
        last("G93 G1 X30 F2", "G94 X60")


def test_switches() -> None:
    assert kinds("M3 S1000 G1 X1 F100", "M8", "M6 T2", "M0", "M30", "G0 X9") == [
        "spindle",
        "move",
        "coolant",
        "spindle",
        "pause",
        "pause",
        "coolant",
    ]
    assert last("S500 M4").speed_rpm == 500
    assert not last("S500 M4").clockwise
    assert last("M7", "M8").coolant == "flood mist"
    assert last("M3 S100", "G1 X1 S200 F100").speed_rpm == 200
    assert last("M3 S100", "M5", "G1 X1 S200 F100").speed_rpm == 0


def test_marks_and_skipped_lines() -> None:
    assert moves("%", "N10 G0 X1", "%", "G0 X2") == [(1, 0, 0)]
    assert moves("/G0 X1", "G0 Y1") == [(1, 0, 0), (1, 1, 0)]
    assert moves("/G0 X1", "G0 Y1", reader=Reader(skips=True)) == [(0, 1, 0)]


def test_centres_from_zero() -> None:
    arc = last("G0 X10", "G90.1", "G3 X20 Y0 I15 J0 F100").arc
    assert arc is not None
    assert arc.centre == (15, 0)


def test_a_cycle_drills_at_each_place() -> None:
    lines = ["G0 Z5", "G98 G81 X1 Y2 Z-1 R2 F100", "X3", "G80"]
    assert moves(*lines) == [
        (0, 0, 5),
        (1, 2, 5),
        (1, 2, 2),
        (1, 2, -1),
        (1, 2, 5),
        (3, 2, 5),
        (3, 2, 2),
        (3, 2, -1),
        (3, 2, 5),
    ]
    lines[1] = lines[1].replace("G98", "G99")
    assert moves(*lines)[4:] == [(1, 2, 2), (3, 2, 2), (3, 2, -1), (3, 2, 2)]


def test_a_cycle_from_below_lifts_first() -> None:
    assert moves("G98 G81 X1 Z-1 R2 F100") == [(0, 0, 2), (1, 0, 2), (1, 0, -1), (1, 0, 2)]


def test_relative_cycles_repeat() -> None:
    assert moves("G0 Z5", "G91 G99 G81 X1 Z-1 R-2 L2 F100")[1:] == [
        (1, 0, 5),
        (1, 0, 3),
        (1, 0, 2),
        (1, 0, 3),
        (2, 0, 3),
        (2, 0, 2),
        (2, 0, 3),
    ]


def test_pecks() -> None:
    down = [z for *_, z in moves("G0 Z5", "G99 G83 X0 Z-2 R1 Q1.2 F100")]
    assert down == [5, 1, -0.2, 1, 0.054, -1.4, 1, -1.146, -2, 1]
    down = [z for *_, z in moves("G0 Z5", "G99 G73 X0 Z-2 R1 Q1.2 F100")]
    assert down == [5, 1, -0.2, 0.054, -1.4, -1.146, -2, 1]


def test_a_cycle_may_wait_at_the_bottom() -> None:
    assert last("G82 X1 Z-1 R0 P250 F9", "G80").target[2] == 0
    blocks = list(read_blocks(["G82 X1 Z-1 R0 P250 F9"]))
    assert [block.kind for block in blocks] == ["move", "move", "dwell", "move"]
    assert blocks[2].dwell_s == 0.25


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (["G81 X1 R2 F100"], "G81 without Z"),
        (["G81 X1 Z-2 F100"], "G81 without R"),
        (["G83 X1 Z-2 R1 F100"], "G83 without Q"),
        (["G82 X1 Z-2 R1 F100"], "G82 without P"),
        (["G83 X1 Z-2 R1 Q0 F100"], "Q above 0"),
        (["G81 X1 Z-2 R-3 F100"], "R is below Z"),
        (["G81 X1 Z-2 R1 L1.5 F100"], "L must be"),
        (["G81 X1 A1 Z-2 R1 F100"], "with A"),
        (["G81 X1 Z-2 R1 F100", "G80", "X1"], "without a motion mode"),
        (["G81 X1 Z-2 R1 F100", "G83 X1 Q1 F100"], "G83 without R"),
        (["G20 G21"], "two units"),
        (["G43 H99"], "H must be"),
        (["G10 L3 P1 X1"], "G10 needs"),
        (["M3 S-1"], "S must not"),
        (["G41 D1"], "G41 is not supported"),
        (["G95"], "G95 is not supported"),
    ],
)
def test_what_cannot_be_read_is_named(lines: list[str], message: str) -> None:
    with pytest.raises(GcodeError, match=message):
        list(read_blocks(lines))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_files_of_cam_programs_are_looked_through(file: Path) -> None:
    """The dry run of the tool knows every code in them."""
    done = CliRunner().invoke(app, ["stream", "--dry-run", str(file)])
    assert done.exit_code == 0, done.output
    assert "estimated time" in done.output
