"""TMC22xx SGTUNE: rows while the axis moves, a proposal that homing can live with, and refusals."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from typed import Event, Session, program, typed

from stepmite.sgtune import Tuning, parse

END = -1600
AXIS = f"axis X step=GP2 dir=GP3 stops={END}:1000000"
DRIVER = "tmc2209 tx=GP5 address=0 axis=X diag=GP10 microsteps=16"
MACHINE = [AXIS, DRIVER]
SET_UP = [
    "TMC22xx GP5,2209,0,800,30,16",
    "STEPPER INIT ,,GP22",
    "STEPPER AXIS X,GP2,GP3,GP4,,80,6000,500",
    "STEPPER HWLIMITS GP10,0,0,0,0,0,1",
    "STEPPER RUN",
    "TMC22xx AXIS 0,X",
]
RELEASED = Event(0, 22, 1)


def tuned(
    folder: Path,
    *lines: str,
    machine: list[str] = MACHINE,
    events: list[Event] | tuple = (),
    set_up: list[str] = SET_UP,
) -> tuple[Session, Tuning]:
    """Type the lines; the last one is SGTUNE."""
    at = typed(folder, *set_up, *lines, drivers=machine, events=[RELEASED, *events])
    return at, parse(at.last.splitlines())


def test_rows_while_the_axis_moves(tmp_path: Path) -> None:
    """Every 50 ms time, speed, SG_RESULT and current; what is between the rows counts as well."""
    at, tuning = tuned(tmp_path, "TMC22xx SGTUNE X,3000,60")
    assert at.errors() == []
    assert len(tuning.rows) >= 23
    assert all(50 <= b.ms - a.ms < 56 for a, b in zip(tuning.rows, tuning.rows[1:], strict=False))
    constant = [row for row in tuning.rows if row.speed == 3000]
    assert 18 < len(constant) < 23
    assert all(row.lowest <= row.mean for row in tuning.rows)
    assert tuning.rows[0].mean < constant[5].mean
    assert {row.current_scale for row in tuning.rows} == {25}
    assert len(at.report.told("read", 0, "SG_RESULT")) > 8 * len(tuning.rows)
    assert at.end("X") == pytest.approx(60)


def test_the_proposal(tmp_path: Path) -> None:
    """Two thirds of the lowest reading at constant speed; nothing of it is written."""
    at, tuning = tuned(tmp_path, "TMC22xx SGTUNE X,3000,60")
    found = re.search(r"At 3000 mm/min: SG_RESULT (\d+) lowest, (\d+) mean of (\d+)", at.last)
    assert found
    lowest, mean, count = map(int, found.groups())
    assert lowest <= mean
    assert count > 100
    assert tuning.threshold == 2 * (lowest // 3)
    assert tuning.least_speed == 1800
    assert "TCOOLTHRS 312" in at.last or "TCOOLTHRS 313" in at.last
    assert tuning.commands == [f"TMC22xx SGTHRS X,{lowest // 3}", "TMC22xx STALL X,1800"]
    assert at.report.register("SGTHRS") == 0
    assert at.report.register("TCOOLTHRS") == 0


def test_the_feed_is_named_as_it_was_given(tmp_path: Path) -> None:
    """With slow ramps the last percent takes long, and is no other speed."""
    axis = "STEPPER AXIS X,GP2,GP3,GP4,,80,6000,100"
    for feed in (2900, 3000, 3100):
        folder = tmp_path / str(feed)
        folder.mkdir()
        at, tuning = tuned(folder, axis, f"TMC22xx SGTUNE X,{feed},80")
        assert f"At {feed} mm/min:" in at.last
        assert tuning.least_speed == pytest.approx(0.6 * feed)


@pytest.mark.parametrize("load_ma", [20, 80, 250])
def test_homing_works_with_what_is_proposed(load_ma: int, tmp_path: Path) -> None:
    """And a move that does not reach the end is not mistaken, whatever the friction."""
    (tmp_path / "1").mkdir()
    machine = [AXIS, f"{DRIVER} load_ma={load_ma}"]
    at, tuning = tuned(tmp_path / "1", "TMC22xx SGTUNE X,3000,60", machine=machine)
    assert len(tuning.commands) == 2
    always = f"{tuning.commands[1]},1"
    moves = ["STEPPER GC G1 X50 F3000", "STEPPER GC G1 X0 F3000", "PAUSE 4000"]
    at = typed(
        tmp_path,
        *SET_UP,
        *tuning.commands,
        "STEPPER GC G28",
        always,
        *moves,
        "PRINT PEEK(STEPPER STATUS)",
        drivers=machine,
        events=[RELEASED],
    )
    assert at.errors() == []
    assert int(at.number()) & 128 == 128
    assert "alarm" not in at.output
    assert at.report.full_steps() == pytest.approx((END + 240) / 16, abs=2)


def test_downwards_and_without_a_distance(tmp_path: Path) -> None:
    """One second's way; and back."""
    at, tuning = tuned(tmp_path, "TMC22xx SGTUNE X,600", "TMC22xx SGTUNE X,600,-10")
    assert at.errors() == []
    assert at.end("X") == pytest.approx(0)
    assert len(tuning.commands) == 2


def test_another_feed_than_that_of_homing(tmp_path: Path) -> None:
    """It says so."""
    at, _ = tuned(tmp_path, "TMC22xx SGTUNE X,1500,30")
    assert "Homing goes at 3000 mm/min" in at.last
    (tmp_path / "2").mkdir()
    at, _ = tuned(tmp_path / "2", "STEPPER HOME X,,1500", "TMC22xx SGTUNE X,1500,30")
    assert "Homing" not in at.last


def test_a_driver_that_the_letter_does_not_mean(tmp_path: Path) -> None:
    """The second of an axis: its proposal names wire and address, and can be typed."""
    second = "tmc2209 tx=GP26 address=0 axis=Y microsteps=16"
    machine = [AXIS, "axis Y step=GP2 dir=GP3", DRIVER, second]
    lines = ["TMC22xx GP26,2209,0,800,30,16", "TMC22xx AXIS 0,X,GP26"]
    at, tuning = tuned(tmp_path, *lines, "TMC22xx SGTUNE 0,3000,60,GP26", machine=machine)
    assert at.errors() == []
    assert [bool(re.search("0,.*GP26", command)) for command in tuning.commands] == [True, True]
    (tmp_path / "2").mkdir()
    at, _ = tuned(tmp_path / "2", *lines, *tuning.commands, machine=machine)
    assert at.errors() == []
    assert at.report.register("SGTHRS", 1) > 0


def test_an_axis_in_degrees(tmp_path: Path) -> None:
    """The unit is said, and nothing of homing, which A has not."""
    machine = ["axis A step=GP2 dir=GP3", DRIVER.replace("axis=X", "axis=A")]
    set_up = ["STEPPER INIT", "STEPPER AXIS A,GP2,GP3,GP4,,10,36000,5000", "STEPPER RUN"]
    drivers = [SET_UP[0], "TMC22xx AXIS 0,A"]
    at, tuning = tuned(
        tmp_path, "TMC22xx SGTUNE A,18000,400", machine=machine, set_up=[*set_up, *drivers]
    )
    assert at.errors() == []
    assert tuning.unit == "deg"
    assert "At 18000 deg/min" in at.last
    assert tuning.commands[1] == "TMC22xx STALL A,10800"
    assert "Homing" not in at.last


PROGRAM = """
ON ERROR SKIP
TMC22xx SGTUNE X,6000,4
PRINT "error"; MM.ERRNO <> 0
FOR i = 1 TO -1 STEP -2
  TMC22xx SGTUNE X,3000,i*30
NEXT
PRINT "at"; PEEK(STEPPER X)
"""


def test_in_a_program(tmp_path: Path) -> None:
    """One tunes both ways and goes on, also behind an error."""
    text = "\n".join(SET_UP) + PROGRAM
    shown = program(tmp_path, text, drivers=MACHINE, events=[RELEASED]).answers[0]
    assert "error 1\n" in shown
    assert shown.count("Proposal: a stall is") == 2
    assert shown.endswith("at 4")


# ---- Where it ends early -------------------------------------------------------------------------


def test_soft_limits_count(tmp_path: Path) -> None:
    lines = ["STEPPER LIMITS X,-10,40", "STEPPER POSITION HOME", "TMC22xx SGTUNE X,3000,60"]
    at, tuning = tuned(tmp_path, *lines)
    assert at.errors() == []
    assert at.end("X") == pytest.approx(40)
    assert len(tuning.commands) == 2


def test_too_short_for_a_constant_speed(tmp_path: Path) -> None:
    """The rows are there, the proposal is not."""
    at, tuning = tuned(tmp_path, "TMC22xx SGTUNE X,6000,4")
    assert "constant speed" in at.errors()[0]
    assert tuning.rows
    assert tuning.commands == []


def test_too_slow_for_stallguard(tmp_path: Path) -> None:
    at, tuning = tuned(tmp_path, "TMC22xx SGTUNE X,40,2")
    assert "SG_RESULT fell to" in at.errors()[0]
    assert tuning.commands == []


def test_an_axis_that_is_held(tmp_path: Path) -> None:
    """It is not driven against its end for longer than it takes to be sure."""
    at, tuning = tuned(tmp_path, "TMC22xx SGTUNE X,3000,-400")
    assert "the axis was held" in at.errors()[0]
    assert tuning.commands == []
    assert 20 < -at.end("X") < 50  # its end is at 20


def test_estop_ends_it(tmp_path: Path) -> None:
    """The reason is told, and nothing is concluded from half a jog."""
    at, tuning = tuned(tmp_path, "TMC22xx SGTUNE X,3000,60", events=[Event(600, 22, 0)])
    assert len(at.errors()) == 1
    assert "E-STOP" in at.errors()[0]
    assert tuning.commands == []
    assert at.report.axes[0]["position"] < 3000


@pytest.mark.parametrize("fault", ["unplugged", "silent"])
def test_a_driver_that_does_not_answer_ends_it(fault: str, tmp_path: Path) -> None:
    """The axis brakes, nothing is lost."""
    machine = [AXIS, f"{DRIVER} fault={fault}@600"]
    at, _ = tuned(tmp_path, "TMC22xx SGTUNE X,3000,60", "PAUSE 500", machine=machine)
    assert len(at.errors()) == 1
    assert "address 0 on GP5" in at.errors()[0]
    assert 0 < at.end("X") < 60
    assert at.report.drivers[0]["slips"] == 0


def test_a_reading_that_is_disturbed_is_asked_again(tmp_path: Path) -> None:
    machine = [AXIS, f"{DRIVER} fault=bad-crc:2@600"]
    at, tuning = tuned(tmp_path, "TMC22xx SGTUNE X,3000,60", machine=machine)
    assert at.errors() == []
    assert len(tuning.commands) == 2


# ---- What is refused -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (["TMC22xx AXIS 0"], "tied to no axis"),
        (["TMC22xx STEALTH X,OFF"], "StallGuard needs StealthChop"),
        (["TMC22xx STEALTH X,,1000"], "StallGuard needs StealthChop"),
        (["STEPPER AXIS X,GP2,GP3,GP4,,80,2000,500"], "feed: 3000 is invalid (valid is above 0"),
        (["STEPPER RECOVER"], "Not armed"),
        (["STEPPER POSITION HOME", "STEPPER GC G1 X20 F600"], "No jogging while motion is active"),
        (["STEPPER JOG X,50,300", "PAUSE 50"], "A jog is under way"),
        (
            ["STEPPER HOME X,,,0", "TMC22xx SGTHRS X,99", "STEPPER HOME RUN X"],
            "Homing is under way",
        ),
        (["STEPPER ESTOP", "TMC22xx AXIS 0,X"], "Not armed"),
        (["STEPPER CLOSE"], "axis not configured"),
        (["TMC22xx CLOSE"], "not initialized"),
    ],
)
def test_refused_before_anything_moves(lines: list[str], said: str, tmp_path: Path) -> None:
    tune = "TMC22xx SGTUNE 0,3000" if "AXIS 0" in lines[0] else "TMC22xx SGTUNE X,3000"
    at, tuning = tuned(tmp_path, *lines, tune)
    assert len(at.errors()) == 1
    assert said in at.errors()[0]
    assert tuning.rows == []


def test_a_tmc2208_has_no_stallguard(tmp_path: Path) -> None:
    set_up = [line.replace("2209", "2208") for line in SET_UP]
    machine = [AXIS, "tmc2208 tx=GP5 axis=X microsteps=16"]
    at, _ = tuned(tmp_path, "TMC22xx SGTUNE X,3000", machine=machine, set_up=set_up)
    assert at.errors() == ["A TMC2208 has no StallGuard"]


def test_without_replies_there_is_nothing_to_read(tmp_path: Path) -> None:
    at, _ = tuned(tmp_path, "TMC22xx SGTUNE X,3000", set_up=["TMC22xx VERIFY 0", *SET_UP])
    assert len(at.errors()) == 1
    assert "VERIFY" in at.errors()[0]
    assert at.report.axes[0]["pulses"] == 0


def test_an_axis_that_is_not_configured(tmp_path: Path) -> None:
    at, _ = tuned(tmp_path, "TMC22xx AXIS 0,Y", "TMC22xx SGTUNE Y,3000")
    assert "Y axis not configured" in at.errors()[0]
