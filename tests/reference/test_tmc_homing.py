"""StallGuard around homing: who is armed, with what, what is refused, and what comes of faults.

That the axes find their ends is in test_section_8.py.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from typed import WAIT, Session, typed

END = -1600
AXES = [f"axis X step=GP2 dir=GP3 stops={END}:1000000", "axis Y step=GP6 dir=GP7 stops=-1000:9000"]
X_DRIVER = "tmc2209 tx=GP5 address=0 axis=X diag=GP10 microsteps=16"
Y_DRIVER = "tmc2209 tx=GP5 address=1 axis=Y diag=GP11 microsteps=16"
BOTH = [*AXES, X_DRIVER, Y_DRIVER]

MACHINE = [
    "STEPPER INIT",
    "STEPPER AXIS X,GP2,GP3,GP4,,80,6000,500",
    "STEPPER AXIS Y,GP6,GP7,GP8,,80,6000,500",
    "STEPPER HWLIMITS GP10,GP11,0,0,0,0,3",
    "STEPPER RUN",
]
DRIVERS = [f"TMC22xx GP5,2209,{address},800,30,16" for address in (0, 1)]
TIED = [*MACHINE, *DRIVERS, "TMC22xx AXIS 0,X", "TMC22xx AXIS 1,Y"]
READY = [*TIED, "TMC22xx SGTHRS X,120", "TMC22xx SGTHRS Y,120"]
HOME_X = "STEPPER GC G28 X0"
KNOWN = "PRINT PEEK(STEPPER STATUS) >> 7"


def session(folder: Path, *lines: str, machine: list[str] = BOTH) -> Session:
    return typed(folder, *lines, drivers=machine)


def armed(at: Session, driver: int = 0) -> list[int]:
    """What was written to TCOOLTHRS, in order."""
    return [event["value"] for event in at.report.told("write", driver, "TCOOLTHRS")]


def steps(at: Session) -> list[int]:
    """Pulses of each axis."""
    return [axis["pulses"] for axis in at.report.axes]


# ---- With what -----------------------------------------------------------------------------------


def test_without_a_threshold_it_is_60_percent_of_the_seek_feed(tmp_path: Path) -> None:
    """TSTEP at 1200 of 2000 mm/min: 12 MHz / (1600 steps/s * 16)."""
    at = session(tmp_path, *READY, "STEPPER HOME X,,2000", HOME_X)
    assert at.errors() == []
    assert armed(at) == [469, 0]


def test_the_threshold_of_stall(tmp_path: Path) -> None:
    """2400 mm/min are 3200 steps/s. From the home place the end is met before there is speed: the
    axis approaches a second time.
    """
    at = session(tmp_path, *READY, "TMC22xx STALL X,2400", HOME_X, HOME_X)
    assert at.errors() == []
    assert armed(at) == [234, 0] * 3


def test_what_the_user_has_written_comes_back(tmp_path: Path) -> None:
    """A threshold for CoolStep, for instance, which homing uses as well."""
    at = session(tmp_path, *READY, "TMC22xx TCOOLTHRS X,300", HOME_X)
    assert at.errors() == []
    assert set(armed(at)) == {300}
    assert at.report.register("TCOOLTHRS") == 300


def test_a_group_is_armed_one_by_one(tmp_path: Path) -> None:
    """Axes that end at a stall are homed alone."""
    lines = ["STEPPER HOME ORDER XY", "STEPPER GC G28"]
    at = session(tmp_path, *READY, *lines)
    assert at.errors() == []
    order = [
        (event["driver"], event["value"] > 0)
        for event in at.report.events
        if event["do"] == "write" and event["register"] == "TCOOLTHRS"
    ]
    assert order == [(0, True), (0, False), (1, True), (1, False)]


def test_two_motors_of_one_axis(tmp_path: Path) -> None:
    """Both are armed before anything moves, and disarmed."""
    second = "tmc2209 tx=GP5 address=2 axis=Y microsteps=16"
    lines = ["TMC22xx GP5,2209,2,800,30,16", "TMC22xx AXIS 2,X", "TMC22xx SGTHRS 2,100", HOME_X]
    at = session(tmp_path, *READY, *lines, machine=[*AXES, X_DRIVER, second])
    assert at.errors() != []  # there is no driver 1: the rest counts
    assert [value > 0 for value in armed(at, 0)] == [True, False]
    assert [value > 0 for value in armed(at, 1)] == [True, False]


def test_a_driver_that_is_tied_to_no_axis(tmp_path: Path) -> None:
    """It is left alone; the user arms it."""
    lines = [*MACHINE, *DRIVERS, "TMC22xx SGTHRS 0,120", "TMC22xx TCOOLTHRS 0,200", HOME_X]
    at = session(tmp_path, *lines)
    assert at.errors() == []
    assert armed(at) == [200]


def test_homing_in_the_background(tmp_path: Path) -> None:
    """HOME RUN comes back at once, and the drivers are armed while the program waits."""
    at = session(tmp_path, *READY, "STEPPER HOME RUN X", "PAUSE 5000", KNOWN)
    assert at.errors() == []
    assert [value > 0 for value in armed(at)] == [True, False]
    assert at.report.full_steps() == pytest.approx((END + 240) / 16, abs=2)


def test_blind_drivers_are_armed_as_well(tmp_path: Path) -> None:
    """Nothing is read from them."""
    at = session(tmp_path, "TMC22xx VERIFY 0", *READY, HOME_X)
    assert at.errors() == []
    assert [value > 0 for value in armed(at)] == [True, False]
    assert at.report.told("read") == []


# ---- What is refused -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ([], "StallGuard of X needs TMC22xx SGTHRS"),
        (
            ["TMC22xx SGTHRS X,120", "TMC22xx STEALTH X,OFF"],
            "StallGuard of X needs TMC22xx STEALTH at 3000 mm/min",
        ),
        (
            ["TMC22xx SGTHRS X,120", "TMC22xx STEALTH X,,2400"],
            "StallGuard of X needs TMC22xx STEALTH at 3000 mm/min",
        ),
        (
            ["TMC22xx SGTHRS X,120", "TMC22xx STALL X,3600"],
            "StallGuard of X would not work at 3000",
        ),
        (
            ["TMC22xx SGTHRS X,120", "TMC22xx TCOOLTHRS X,9"],
            "StallGuard of X would not work at 3000",
        ),
    ],
)
@pytest.mark.parametrize("home", ["STEPPER GC G28", HOME_X, "STEPPER HOME RUN X"])
def test_a_driver_that_finds_no_stall(
    lines: list[str], said: str, home: str, tmp_path: Path
) -> None:
    """Told before anything moves or is lost."""
    place = ["STEPPER POSITION HOME", *lines, home, KNOWN]
    at = session(tmp_path, *TIED, "TMC22xx SGTHRS Y,120", *place)
    assert len(at.errors()) == 1
    assert at.errors()[0].startswith(said)
    assert at.number() == 1
    assert steps(at) == [0, 0]


def test_a_switch_needs_no_stallguard(tmp_path: Path) -> None:
    """Active high, with a latch feed: whoever gives one has a switch."""
    switch = f"switch pin=GP10 axis=X to={END + 400} high"
    machine = [*AXES, X_DRIVER.replace(" diag=GP10", ""), Y_DRIVER, switch]
    at = session(tmp_path, *TIED, "STEPPER HOME X,,,100", HOME_X, machine=machine)
    assert at.errors() == []
    assert armed(at) == []


def test_a_slow_second_approach_fails(tmp_path: Path) -> None:
    """A latch feed was chosen although no stall is noticed there; a wrong place would be worse."""
    at = session(tmp_path, *READY, "STEPPER HOME X,,3000,300", HOME_X, "PAUSE 50", KNOWN)
    assert "while approaching slowly" in at.errors()[0]
    assert at.number() == 0
    assert at.report.register("TCOOLTHRS") == 0


def test_a_switch_that_is_active_low_needs_none(tmp_path: Path) -> None:
    switch = f"switch pin=GP10 axis=X to={END + 400}"
    machine = [*AXES, X_DRIVER.replace(" diag=GP10", ""), Y_DRIVER, switch]
    lines = ["STEPPER HWLIMITS GP10,GP11,0,0,0,0,2", HOME_X]
    at = session(tmp_path, *TIED, *lines, machine=machine)
    assert at.errors() == []
    assert armed(at) == []


# ---- Faults --------------------------------------------------------------------------------------


def with_fault(fault: str) -> list[str]:
    return [*AXES, f"{X_DRIVER} fault={fault}", Y_DRIVER]


@pytest.mark.parametrize(
    "fault", ["bad-crc:2@3000", "garbled:1@3000", "late:1@3000", "deaf:1@3000"]
)
def test_what_is_repaired_does_not_matter(fault: str, tmp_path: Path) -> None:
    lines = ["TMC22xx MONITOR 0", "PAUSE 3500", HOME_X, KNOWN]
    at = session(tmp_path, *READY, *lines, machine=with_fault(fault))
    assert at.errors() == []
    assert at.report.register("TCOOLTHRS") == 0
    assert at.report.register("SGTHRS") == 120


def test_a_driver_that_is_gone_when_it_is_to_be_disarmed(tmp_path: Path) -> None:
    """It is armed, its axis approaches; the failure is that of homing."""
    machine = [AXES[0].replace(f"{END}", "-8000"), AXES[1], f"{X_DRIVER} fault=unplugged@1500"]
    lines = ["TMC22xx MONITOR 0", HOME_X, KNOWN]
    ready = [line for line in READY if " 1," not in line and "Y,120" not in line]
    ready = [line for line in ready if line != DRIVERS[1]]
    at = session(tmp_path, *ready, *lines, machine=machine)
    assert len(at.errors()) == 1
    said = "Homing X failed: StallGuard is still on: No answer from address 0 on GP5"
    assert at.errors()[0].startswith(said)
    assert at.number() == 0


def test_a_driver_that_could_not_be_armed_needs_no_disarming(tmp_path: Path) -> None:
    """It is gone before homing begins: one error, and nothing about StallGuard that is still on."""
    machine = with_fault("unplugged@500")
    lines = ["TMC22xx MONITOR 0", "PAUSE 600", HOME_X, "PAUSE 500"]
    at = session(tmp_path, *READY, *lines, machine=machine)
    assert at.errors()[0].startswith("Homing X failed: No answer from address 0 on GP5")
    assert "StallGuard" not in at.output


@pytest.mark.parametrize("monitor", [0, 1])
def test_one_that_could_not_be_disarmed_is_later(monitor: int, tmp_path: Path) -> None:
    """The monitor does it when the driver answers again, otherwise whatever is written next."""
    machine = [*AXES, f"{X_DRIVER} fault=unplugged@850-3000", Y_DRIVER]
    lines = ["STEPPER HOME RUN X", "PAUSE 300", "STEPPER ESTOP", "PAUSE 3000", "PAUSE 100"]
    then = ["TMC22xx STATUS X"] if monitor else ["TMC22xx STATUS X", "TMC22xx CURRENT X,700"]
    switch = f"TMC22xx MONITOR {monitor}"
    at = session(tmp_path, *READY, switch, "PAUSE 600", *lines, *then, machine=machine)
    assert armed(at)[-1] == 0
    assert at.report.register("TCOOLTHRS") == 0
    assert ("ARMED" in at.output) == (monitor == 0)


def test_a_driver_that_loses_its_settings_in_the_approach(tmp_path: Path) -> None:
    """It would find no end; homing stops as soon as that is known, and a set-up does not arm it."""
    machine = [AXES[0].replace(f"{END}", "-80000"), AXES[1]]
    machine += [f"{X_DRIVER} fault=brown-out@1500", Y_DRIVER]
    lines = ["PAUSE 600", HOME_X, "PAUSE 1000", DRIVERS[0], KNOWN]
    at = session(tmp_path, *READY, *lines, machine=machine)
    assert at.errors() == ["Homing X stopped while approaching the switch"]
    assert at.output.count("has lost its settings") == 1
    assert at.number() == 0
    assert steps(at)[0] < 80 * 200  # of the 1000 mm that it may search
    assert at.report.register("TCOOLTHRS") == 0


@pytest.mark.parametrize("stop", ["STEPPER STOP", "STEPPER ESTOP"])
def test_disarmed_after_a_stop(stop: str, tmp_path: Path) -> None:
    lines = ["STEPPER HOME RUN X", "PAUSE 200", stop, "PAUSE 500", WAIT]
    at = session(tmp_path, *READY, *lines)
    assert [value > 0 for value in armed(at)] == [True, False]
    assert at.report.register("TCOOLTHRS") == 0


@pytest.mark.parametrize("pause_ms", [1, 2, 3, 4, 6, 8, 10])
@pytest.mark.parametrize("stop", ["STEPPER STOP", "STEPPER ESTOP"])
def test_stopped_while_it_is_being_armed(stop: str, pause_ms: int, tmp_path: Path) -> None:
    """The axis has not moved; what was begun is brought to its end, then taken back."""
    lines = ["STEPPER HOME RUN X", f"PAUSE {pause_ms}", stop, "PAUSE 500", WAIT, HOME_X]
    again = ["STEPPER RUN", HOME_X]
    at = session(tmp_path, *READY, *lines, *again)
    assert at.report.register("TCOOLTHRS") == 0
    assert at.report.full_steps() == pytest.approx((END + 240) / 16, abs=2)


def test_ctrl_c_while_it_is_being_armed(tmp_path: Path) -> None:
    """It is taken at the first wait, which is for the driver."""
    lines = [f"{HOME_X}\r\x03", "PAUSE 500", KNOWN, HOME_X]
    at = session(tmp_path, *READY, *lines[:2])
    assert steps(at) == [0, 0]
    assert at.report.register("TCOOLTHRS") == 0
    (tmp_path / "2").mkdir()
    at = session(tmp_path / "2", *READY, *lines)
    assert at.errors() == []
    assert at.report.full_steps() == pytest.approx((END + 240) / 16, abs=2)


@pytest.mark.parametrize("change", ["TMC22xx CLOSE", "TMC22xx WIRE GP5,GP21"])
def test_a_wire_stays_while_homing_needs_it(change: str, tmp_path: Path) -> None:
    """Or the driver would stay armed."""
    lines = ["STEPPER HOME RUN X", "PAUSE 200", change, "PAUSE 3000", KNOWN]
    at = session(tmp_path, *READY, *lines)
    assert at.errors() == ["Homing is under way (STEPPER STOP or Ctrl-C ends it)"]
    assert [value > 0 for value in armed(at)] == [True, False]
    assert at.report.full_steps() == pytest.approx((END + 240) / 16, abs=2)


@pytest.mark.parametrize("pause_ms", [1, 3, 200])
@pytest.mark.parametrize(
    "close",
    ["STEPPER ESTOP : TMC22xx CLOSE", "STEPPER STOP : PAUSE 150 : TMC22xx CLOSE", "NEW"],
)
def test_disarmed_before_the_wire_is_closed(close: str, pause_ms: int, tmp_path: Path) -> None:
    """However soon that comes."""
    lines = ["STEPPER HOME RUN X", f"PAUSE {pause_ms}", close, "PAUSE 500"]
    at = session(tmp_path, *READY, *lines)
    assert at.errors() == []
    assert at.report.register("TCOOLTHRS") == 0
    if pause_ms == 200:
        assert [value > 0 for value in armed(at)] == [True, False]


def test_disarming_that_fails_behind_the_end_is_told(tmp_path: Path) -> None:
    """Homing has been stopped; its driver does not answer any more."""
    machine = [*AXES, f"{X_DRIVER} fault=unplugged@850", Y_DRIVER]
    lines = ["TMC22xx MONITOR 0", "PAUSE 600", "STEPPER HOME RUN X", "PAUSE 300", "STEPPER ESTOP"]
    at = session(tmp_path, *READY, *lines, "PAUSE 3000", machine=machine)
    told = [line for line in at.output.splitlines() if "StallGuard is still on" in line]
    assert len(told) == 1
    assert "address 0 on GP5" in told[0]
