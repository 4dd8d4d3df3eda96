"""Section 2.2 of the STEPPER reference: STEPPER AXIS."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from motion_checks import duration_s, hardest_acceleration, speeds
from typed import PINS, READY, SCALES, SET_UP, WAIT, typed

START = ["STEPPER POSITION HOME", "STEPPER RUN"]


@pytest.mark.parametrize("name", ["X", "Y", "Z", "A"])
def test_each_axis_steps_on_its_pins(name: str, tmp_path: Path) -> None:
    """So many pulses for each mm or degree, with direction high upwards."""
    session = typed(tmp_path, *READY, f"STEPPER GC G1 {name}5 F600", WAIT)
    assert session.errors() == []
    trace = session.axis(name)
    assert len(trace.step_ns) == 5 * SCALES[name]
    assert (trace.direction == 1).all()
    other = [session.axis(axis) for axis in PINS if axis != name]
    assert all(len(trace.step_ns) == 0 for trace in other)


@pytest.mark.parametrize("axis", ["x", '"Y"', "B", "1"])
def test_only_four_letters(axis: str, tmp_path: Path) -> None:
    """In either case, as a letter or a string."""
    session = typed(tmp_path, "STEPPER INIT", f"STEPPER AXIS {axis},GP2,GP3")
    wanted = [] if axis in ("x", '"Y"') else ["axis:"]
    assert [error.split()[0] for error in session.errors()] == wanted


def test_defaults(tmp_path: Path) -> None:
    """What is left out: 200 steps, 6000 per minute, 500 per s^2, not inverted."""
    session = typed(tmp_path, "STEPPER INIT", "STEPPER AXIS X,GP2,GP3", "STEPPER STATUS")
    assert "X motion: 200 steps/mm, max 6000 mm/min, 500 mm/s^2" in session.last
    assert "inverted" not in session.last.partition("X pins")[2].partition("\n")[0]
    assert "enable none" in session.last


@pytest.mark.parametrize(("invert", "level"), [("", 1), ("0", 1), ("1", 0)])
def test_dir_invert(invert: str, level: int, tmp_path: Path) -> None:
    """1 turns the meaning of the direction pin round."""
    session = typed(
        tmp_path,
        "STEPPER INIT",
        f"STEPPER AXIS X,GP2,GP3,,{invert}",
        *START,
        "STEPPER GC G0 X1",
        WAIT,
    )
    assert session.level_at(3, session.axis("X").step_ns[0] / 1e6) == level


def test_enable_is_active_low_and_optional(tmp_path: Path) -> None:
    """High from AXIS on, low from RUN on; an axis without it moves as well."""
    session = typed(tmp_path, *SET_UP, *START, "STEPPER GC G0 X1", WAIT)
    run_ms = session.typed_ms[len(SET_UP) + 1]
    assert session.level_at(4, run_ms - 0.05) == 1
    assert session.level_at(4, run_ms + 0.05) == 0
    bare = typed(
        tmp_path, "STEPPER INIT", "STEPPER AXIS X,GP2,GP3", *START, "STEPPER GC G0 X1", WAIT
    )
    assert len(bare.axis("X").step_ns) == 200
    assert set(bare.edges.gpio.tolist()) == {2, 3}


@pytest.mark.parametrize(("name", "scale"), [("X", 80), ("A", 10)])
def test_speed_and_acceleration_are_limits(name: str, scale: int, tmp_path: Path) -> None:
    """G0 goes as fast as max_vel says (per minute) and no faster, within max_accel (per s^2)."""
    session = typed(
        tmp_path,
        "STEPPER INIT",
        f"STEPPER AXIS {name},GP{PINS[name].step_gpio},GP{PINS[name].dir_gpio},,,{scale},3000,250",
        *START,
        f"STEPPER GC G0 {name}100",
        WAIT,
    )
    assert duration_s(session, name) == pytest.approx(100 / 50 + 50 / 250, rel=0.03)
    _, speed = speeds(session, name)
    assert 49 < np.median(speed) < 51
    assert hardest_acceleration(session, name) < 1.1 * 250 + 4 / scale / 0.02**2


@pytest.mark.parametrize(
    ("axis", "scale", "speed", "shown"),
    [("X", 400, 12000, "7500.0 mm/min"), ("A", 100, 36000, "30000.0 deg/min")],
)
def test_step_rate_is_capped_at_50_khz(
    axis: str, scale: int, speed: int, shown: str, tmp_path: Path
) -> None:
    """A warning with the speed that can be reached, no error, and the axis runs at it."""
    step, direction = PINS[axis].step_gpio, PINS[axis].dir_gpio
    session = typed(
        tmp_path,
        "STEPPER INIT",
        f"STEPPER AXIS {axis},GP{step},GP{direction},,,{scale},{speed},5000",
        *START,
        f"STEPPER GC G0 {axis}200",
        WAIT,
    )
    assert session.errors() == []
    assert session.answers[1].startswith("Warning:")
    assert shown in session.answers[1]
    gaps_ns = np.diff(session.axis(axis).step_ns)
    assert gaps_ns.min() == 20_000
    assert np.median(gaps_ns) == 20_000
    assert len(gaps_ns) + 1 == 200 * scale


def test_low_time_is_a_whole_tick(tmp_path: Path) -> None:
    """At the highest rate each pulse is a tick high and a tick low."""
    session = typed(
        tmp_path,
        "STEPPER INIT",
        "STEPPER AXIS X,GP2,GP3,,,400,12000,5000",
        *START,
        "STEPPER GC G0 X50",
        WAIT,
    )
    trace = session.axis("X")
    assert (trace.fall_ns - trace.step_ns).min() >= 9_000
    assert (trace.step_ns[1:] - trace.fall_ns[:-1]).min() >= 10_000


def test_coarser_steps_raise_the_top_speed(tmp_path: Path) -> None:
    """Half the scale: no warning, and the full speed."""
    session = typed(
        tmp_path,
        "STEPPER INIT",
        "STEPPER AXIS X,GP2,GP3,,,200,12000,5000",
        *START,
        "STEPPER GC G0 X200",
        WAIT,
    )
    assert session.answers[1] == ""
    assert duration_s(session) == pytest.approx(200 / 200 + 200 / 5000, rel=0.01)


def test_backoff_of_a_is_taken_and_ignored(tmp_path: Path) -> None:
    """A is not homed, so the value changes nothing; XYZ check it."""
    session = typed(
        tmp_path,
        "STEPPER INIT",
        "STEPPER AXIS A,GP2,GP3,,,10,3600,500,5",
        "STEPPER AXIS X,GP5,GP6,,,10,3600,500,5",
        "STEPPER AXIS X,GP5,GP6,,,10,3600,500,0",
    )
    assert [error.split(":")[0] for error in session.errors()] == ["home_backoff_mm"]


@pytest.mark.parametrize(
    ("line", "name"),
    [
        ("X,GP2,GP3,,2", "dir_invert"),
        ("X,GP2,GP3,,,0", "steps_per_unit"),
        ("X,GP2,GP3,,,80,0", "max_vel"),
        ("X,GP2,GP3,,,80,6000,-1", "max_accel"),
        ("X,GP2", "dir_pin"),
        ("X,GP2,GP2", "GP2"),
        ("X,GP2,GP3,GP8", "GP8"),
    ],
)
def test_a_failed_axis_changes_nothing(line: str, name: str, tmp_path: Path) -> None:
    """The error names what is wrong; the axis is what it was, and may be given again."""
    session = typed(
        tmp_path,
        *READY,
        f"STEPPER AXIS {line}",
        "STEPPER GC G1 X2 F600",
        WAIT,
        "STEPPER AXIS X,GP2,GP3,GP4,,160",
    )
    assert len(session.errors()) == 1
    assert name in session.errors()[0]
    assert len(session.axis("X").step_ns) == 160
