"""Section 2.3 of the STEPPER reference: STEPPER TUNE."""

from __future__ import annotations

from pathlib import Path

import pytest
from motion_checks import duration_s
from typed import ENABLE_X, READY, SET_UP, WAIT, error_of, typed

MOVE = "STEPPER GC G1 X10 F6000"
STATUS = "STEPPER STATUS"


def motion_line(answer: str, axis: str) -> str:
    """What STATUS says of the motion of an axis."""
    return answer.partition(f"{axis} motion: ")[2].partition("\n")[0]


def test_example_only_the_scale(tmp_path: Path) -> None:
    """`X,,80`: steps/mm change, the rest stays."""
    session = typed(
        tmp_path,
        "STEPPER INIT",
        "STEPPER AXIS X,GP2,GP3,GP4,1,40,1200,90",
        "STEPPER TUNE X,,80",
        STATUS,
    )
    assert session.errors() == []
    assert motion_line(session.last, "X") == "80 steps/mm, max 1200 mm/min, 90 mm/s^2"
    assert "dir GP3 (pin 5) inverted" in session.last


def test_example_only_speed_and_acceleration(tmp_path: Path) -> None:
    """`Y,,,3000,750`: they are in force for the next move, and the position stays known."""
    session = typed(
        tmp_path, *READY, "STEPPER TUNE Y,,,3000,750", STATUS, "STEPPER GC G0 Y100", WAIT
    )
    assert session.errors() == []
    assert motion_line(session.answers[-3], "Y") == "100 steps/mm, max 3000 mm/min, 750 mm/s^2"
    assert duration_s(session, "Y") == pytest.approx(100 / 50 + 50 / 750, rel=0.01)


def test_direction_of_the_next_move(tmp_path: Path) -> None:
    """dir_invert alone; pins and drivers are not touched."""
    session = typed(tmp_path, *READY, "STEPPER TUNE X,1", MOVE, WAIT)
    assert session.errors() == []
    assert session.level_at(3, session.axis("X").step_ns[0] / 1e6) == 0
    assert session.edges.of(ENABLE_X).level.tolist() == [1, 0]


@pytest.mark.parametrize("arguments", ["A,,20", "Z,0,400,600,100,2", "A,,,,,5"])
def test_any_subset(arguments: str, tmp_path: Path) -> None:
    """Of any axis."""
    assert typed(tmp_path, *SET_UP, f"STEPPER TUNE {arguments}").errors() == []


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ("X", ""),
        ("X,,,", ""),
        ("X,2", "dir_invert"),
        ("X,,0", "steps_per_unit"),
        ("X,,,0", "max_vel"),
        ("X,,,,-1", "max_accel"),
        ("X,,,,,0", "home_backoff_mm"),
        ("B,1", "axis"),
    ],
)
def test_bad_values_change_nothing(arguments: str, word: str, tmp_path: Path) -> None:
    """Nothing given, or one value that is wrong behind good ones."""
    session = typed(tmp_path, *SET_UP, f"STEPPER TUNE {arguments}", STATUS)
    assert len(session.errors()) == 1
    assert word in session.errors()[0]
    assert motion_line(session.last, "X") == "80 steps/mm, max 6000 mm/min, 500 mm/s^2"


def test_all_or_nothing(tmp_path: Path) -> None:
    """A bad last value: the good ones before it have not been taken."""
    session = typed(tmp_path, *SET_UP, "STEPPER TUNE X,1,160,3000,-5", STATUS)
    assert len(session.errors()) == 1
    assert motion_line(session.last, "X") == "80 steps/mm, max 6000 mm/min, 500 mm/s^2"
    assert "inverted" not in session.last


def test_axis_must_be_configured(tmp_path: Path) -> None:
    """TUNE names no pins, so there have to be some."""
    session = typed(tmp_path, "STEPPER INIT", "STEPPER TUNE X,,80")
    assert session.errors() == ["X axis not configured (use STEPPER AXIS)"]


def test_only_when_nothing_moves_or_waits(tmp_path: Path) -> None:
    """Refused while a move waits, while it is carried out and in a dwell; allowed behind it."""
    tune = "STEPPER TUNE X,,,3000"
    session = typed(
        tmp_path,
        *SET_UP,
        "STEPPER POSITION HOME",
        MOVE,
        tune,
        "STEPPER RUN",
        "PAUSE 50",
        tune,
        WAIT,
        "STEPPER GC G4 P100",
        tune,
        WAIT,
        tune,
    )
    assert [bool(error_of(session.answers[n])) for n in (-9, -6, -3, -1)] == [True] * 3 + [False]
    assert session.end("X") == 10


def test_a_new_scale_makes_the_position_unknown(tmp_path: Path) -> None:
    """Steps stay, limits keep their place in mm, and motion needs POSITION or G28 first."""
    session = typed(
        tmp_path,
        *READY,
        "STEPPER LIMITS X,-5,50",
        MOVE,
        WAIT,
        "STEPPER TUNE X,,160",
        "PRINT PEEK(STEPPER STATUS) AND 128",
        STATUS,
        "STEPPER GC G1 X20",
        "STEPPER POSITION X,10",
        "STEPPER GC G1 X51",
        "STEPPER GC G1 X50",
        WAIT,
    )
    assert session.number(-7) == 0
    assert "(800 steps)" in session.answers[-6]
    assert "-5.000 to 50.000" in session.answers[-6]
    errors = session.errors()
    assert len(errors) == 2
    assert "position unknown" in errors[0]
    assert "soft limits" in errors[1]
    assert session.axis("X").end_steps() == 800 + 40 * 160


def test_the_same_scale_keeps_the_position(tmp_path: Path) -> None:
    """Given again, it has not changed."""
    session = typed(tmp_path, *READY, "STEPPER TUNE X,,80", "STEPPER GC G0 X1", WAIT)
    assert session.errors() == []


@pytest.mark.parametrize(
    ("arguments", "shown"), [("X,,400,12000", "7500.0 mm/min"), ("A,,1000", "3000.0 deg/min")]
)
def test_the_rate_cap_warns(arguments: str, shown: str, tmp_path: Path) -> None:
    """As AXIS does, and is no error."""
    session = typed(tmp_path, *SET_UP, f"STEPPER TUNE {arguments}")
    assert session.errors() == []
    assert "Warning" in session.last
    assert shown in session.last
