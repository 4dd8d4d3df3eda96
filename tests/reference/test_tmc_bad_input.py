"""Bad input for the drivers: each line has a clear error, and what was set stays as it was.

The settings before and after are those that the driver itself gives back, and STATUS; motion under
way makes the same edges as without the bad lines.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from typed import READY, WAIT, Session, error_of, typed
from wire_frames import writes

TX = 21
DRIVERS = ["tmc2209 tx=GP21 address=0", "tmc2208 tx=GP20", "tmc2209 tx=GP20 address=1"]
SET_UP = [
    "TMC22xx GP21, 2209, 0, 800, 30, 16",
    "TMC22xx GP20, 2208, 0, 600, 50, 32",
    "TMC22xx AXIS 0, X, GP21",
    "TMC22xx SGTHRS X, 90",
    "TMC22xx TCOOLTHRS X, 210",
    "TMC22xx STALL X, 900",
]
READBACK = "PRINT " + "; ".join(
    f"PEEK(TMC 0,{reg},{pin})"
    for pin in (21, 20)
    for reg in ("GCONF", "CHOPCONF", "PWMCONF", "IHOLD_IRUN", "IFCNT")
)

BAD = {
    # Set-up
    "TMC22xx GP21, 2207, 0, 800, 30, 16": "chip_type: 2207 is invalid (valid is 2208, 2209)",
    "TMC22xx GP21, TMC2209, 0, 800, 30, 16": "chip_type: TMC2209 is invalid",
    "TMC22xx GP21, 2208, 1, 800, 30, 16": "ddress",
    "TMC22xx GP21, 2209, 4, 800, 30, 16": "address: 4 is invalid (valid is 0 to 3)",
    "TMC22xx GP21, 2209, 0, 0, 30, 16": "run_mA: 0 is invalid (valid is above 0 to 2000)",
    "TMC22xx GP21, 2209, 0, 1e9, 30, 16": "run_mA: 1e+09 is invalid",
    'TMC22xx GP21, 2209, 0, "x", 30, 16': "run_mA: expected a number",
    "TMC22xx GP21, 2209, 0, 1, 30, 16": "too little",
    "TMC22xx GP21, 2209, 0, 800, -1, 16": "hold_pct: -1 is invalid (valid is 0 to 100)",
    "TMC22xx GP21, 2209, 0, 800, 30, 0": "microsteps: 0 is invalid",
    "TMC22xx GP21, 2209, 0, 800, 30, 512": "microsteps: 512 is invalid",
    "TMC22xx GP21, 2209, 0, 800, 30, 16.5": "microsteps: 16.5 is invalid",
    "TMC22xx GP21, 2209, 0, 800, 30, 16, 0": "r_sense_ohm: 0 is invalid",
    "TMC22xx GP21, 2209, 0, 800, 30, 16, 0.11, 7": "stealthchop: 7 is invalid (valid is 0 to 1)",
    "TMC22xx GP29, 2209, 0, 800, 30, 16": "Invalid pin GP29 for tx_pin",
    "TMC22xx 40, 2209, 0, 800, 30, 16": "Invalid pin 40 for tx_pin",
    "TMC22xx GP2, 2209, 0, 800, 30, 16": "in use by STEPPER X step",
    "TMC22xx GP21, 2209, 0, 800, 30": "Missing microsteps",
    "TMC22xx GP21, 2209, 0, 800, 30, 16, 0.11, 1, 1": "Too many arguments",
    "TMC22xx": "Missing tx_pin",
    "TMC22xx GP21, 2208, 0, 800, 30, 16": "2209",  # the chip says what it is
    "TMC22xx GP21, 2209, 3, 800, 30, 16": "address 3",  # nobody is there
    "TMC22xx GP15, 2209, 0, 800, 30, 16": "GP15",
    # Wires
    "TMC22xx WIRE": "Missing tx_pin",
    "TMC22xx WIRE GP21, , 9599": "baud: 9599 is invalid (valid is 9600 to 500000)",
    "TMC22xx WIRE GP21, , 500001": "baud: 500001 is invalid (valid is 9600 to 500000)",
    "TMC22xx WIRE GP21, GP2": "in use by STEPPER X step",
    "TMC22xx WIRE GP22, GP20": "in use by TMC22xx",
    "TMC22xx CLOSE GP15": "TMC22xx not initialized",
    # Which driver
    "TMC22xx CURRENT 0, 800": "",  # two wires have an address 0
    "TMC22xx CURRENT 3, 800": "TMC22xx not initialized",
    "TMC22xx CURRENT Y, 800": "",
    "TMC22xx CURRENT Q, 800": "driver: Q is invalid (valid is 0, 1, 2, 3, X, Y, Z, A)",
    "TMC22xx CURRENT X, 800, , GP20": "GP20 (pin 26)",
    "TMC22xx CURRENT 0, 800, , GP15": "TMC22xx not initialized",
    "TMC22xx STATUS 4": "driver: 4 is invalid (valid is 0, 1, 2, 3, X, Y, Z, A)",
    # Changes
    "TMC22xx CURRENT X, 0": "run_mA: 0 is invalid",
    "TMC22xx CURRENT X, 1": "too little",
    "TMC22xx CURRENT X, 800, 101": "hold_pct: 101 is invalid",
    "TMC22xx CURRENT X": "Missing run_mA",
    "TMC22xx SGTHRS X, 256": "value: 256 is invalid (valid is 0 to 255)",
    "TMC22xx SGTHRS X": "Missing value",
    "TMC22xx SGTTHRS X, -1": "value: -1 is invalid (valid is 0 to 255)",
    "TMC22xx TCOOLTHRS X, 1048576": "value: 1048576 is invalid (valid is 0 to 1048575)",
    "TMC22xx SGTHRS 0, 100, GP20": "2208",
    "TMC22xx TCOOLTHRS 0, 100, GP20": "2208",
    "TMC22xx STALL 0, 600, , GP20": "2208",
    "TMC22xx COOLSTEP 0, 5, 2, , , , GP20": "2208",
    "TMC22xx STALL X, -1": "feed: -1 is invalid (valid is 0 to 10000000)",
    "TMC22xx STALL X, 6001": "feed: 6001 is invalid (valid is above 0 to 6000, the max_vel of X)",
    "TMC22xx STALL X, 600, 2": "always: 2 is invalid (valid is 0 to 1)",
    "TMC22xx STEALTH X, 5, 600": "threshold, feed: only one of them can be given",
    "TMC22xx STEALTH X, , 6001": "feed: 6001 is invalid",
    "TMC22xx STEALTH X, -1": "threshold: -1 is invalid",
    "TMC22xx STEALTH 0, , 600, GP20": "tied to no axis",
    "TMC22xx COOLSTEP X, 16": "semin: 16 is invalid (valid is 0 to 15)",
    "TMC22xx COOLSTEP X, 5, 16": "semax: 16 is invalid (valid is 0 to 15)",
    "TMC22xx COOLSTEP X, 5, 2, 4": "seup: 4 is invalid (valid is 0 to 3)",
    "TMC22xx COOLSTEP X, 5, 2, 0, 4": "sedn: 4 is invalid (valid is 0 to 3)",
    "TMC22xx COOLSTEP X, 5, 2, 0, 0, 2": "seimin: 2 is invalid (valid is 0 to 1)",
    "TMC22xx AXIS X, B": "axis: B is invalid (valid is 0, X, Y, Z, A)",
    "TMC22xx AXIS 2, X": "TMC22xx not initialized",
    # Registers
    "TMC22xx READ X, NOSUCH": "register: NOSUCH is no register",
    "TMC22xx READ X, 128": "register: 128 is invalid (valid is 0 to 127)",
    "TMC22xx READ X, 127": "register: there is none at address 127",
    "TMC22xx READ X, OTP_PROG": "register: OTP_PROG cannot be read",
    "TMC22xx READ 0, SG_RESULT, GP20": "register: a TMC2208 has no SG_RESULT",
    "TMC22xx READ X": "Missing register",
    "TMC22xx WRITE X, DRV_STATUS, 0": "DRV_STATUS",
    "TMC22xx WRITE X, OTP_PROG, 0": "OTP_PROG",
    "TMC22xx WRITE X, GCONF, -1": "value: -1 is invalid (valid is 0 to 4294967295)",
    "TMC22xx WRITE X, GCONF, 4294967296": "value: 4294967296 is invalid",
    "TMC22xx WRITE X, GCONF": "Missing value",
    "TMC22xx WRITE 0, SGTHRS, 5, GP20": "register: a TMC2208 has no SGTHRS",
    "x = PEEK(TMC X, NOSUCH)": "what: NOSUCH is no register",
    "x = PEEK(TMC 2, SG)": "TMC22xx not initialized",
    "x = PEEK(TMC 0, SG, GP20)": "what: a TMC2208 has no SG_RESULT",
    "x = PEEK(TMC X)": "Missing what",
    # Switches and words
    "TMC22xx VERIFY": "Missing on",
    "TMC22xx VERIFY 2": "on: 2 is invalid (valid is 0 to 1)",
    "TMC22xx MONITOR 7": "on: 7 is invalid (valid is 0 to 1)",
    "TMC22xx STATUS X, GP15, 1": "Too many arguments",
    "TMC22xx STATSU": "Unknown TMC22XX subcommand",
    "TMC22xx CURENT X, 800": "Unknown TMC22XX subcommand",
}
"""What is typed, and what its error says; '': any error."""


def driven(folder: Path, *lines: str, drivers: list[str] | tuple = DRIVERS) -> Session:
    """Type the lines at a machine of four axes, with three drivers on two wires."""
    return typed(folder, *READY, *lines, drivers=drivers)


def settings(status: str) -> str:
    """STATUS without what changes by itself: counters of what was asked, and the current."""
    return re.sub(r"^  (wire|motor): .*$", "", status, flags=re.MULTILINE)


def groups() -> list[list[str]]:
    """The bad lines, some in each session."""
    lines = list(BAD)
    return [lines[at : at + 16] for at in range(0, len(lines), 16)]


@pytest.mark.parametrize("lines", groups(), ids=lambda lines: lines[0])
def test_the_error_is_clear_and_nothing_changes(lines: list[str], tmp_path: Path) -> None:
    """The registers, the count of writes the driver has taken, and all that STATUS tells."""
    rest = [text for line in lines for text in (line, READBACK, "TMC22xx STATUS")]
    start = [*SET_UP, "TMC22xx MONITOR 0", READBACK, "TMC22xx STATUS"]
    session = driven(tmp_path, *start, *rest)
    *_, numbers, status = session.answers[: -len(rest)]
    assert len(numbers.split()) == 10
    for i, line in enumerate(lines):
        answer, numbers_behind, status_behind = session.answers[-len(rest) :][3 * i : 3 * i + 3]
        assert error_of(answer) != "", line
        assert BAD[line] in error_of(answer), line
        assert numbers_behind == numbers, line
        assert settings(status_behind) == settings(status), line


def test_motion_goes_on(tmp_path: Path) -> None:
    """All of them while four axes move: the same edges."""
    move = "STEPPER GC G1 X200 Y150 Z20 A300 F3000"
    plain = driven(tmp_path, *SET_UP, move, WAIT)
    spoiled = driven(tmp_path, *SET_UP, move, *BAD, "PRINT PEEK(STEPPER ACTIVE)", WAIT)
    assert len(spoiled.errors()) == len(BAD)
    assert spoiled.number(-2) == 1
    for axis in "XYZA":
        assert np.array_equal(
            np.diff(plain.axis(axis).step_ns), np.diff(spoiled.axis(axis).step_ns)
        )


# ---- The cable -----------------------------------------------------------------------------------

UNPLUGGED = ["tmc2209 tx=GP21 address=0 fault=unplugged@1000"]


def test_a_cable_that_is_unplugged_in_the_middle(tmp_path: Path) -> None:
    """Motion goes on to its end; the error names pin, address and axis, and settings stay."""
    session = driven(
        tmp_path,
        *SET_UP[0:1],
        *SET_UP[2:],
        "STEPPER GC G1 X100 F3000",
        "PAUSE 1000",
        "TMC22xx CURRENT X, 1000",
        "x = 5 : x = PEEK(TMC X, SG)",
        "PRINT x; PEEK(STEPPER ACTIVE)",
        "TMC22xx STATUS",
        WAIT,
        "PRINT PEEK(STEPPER X)",
        drivers=UNPLUGGED,
    )
    current, peek, numbers, status, _, place = session.answers[-6:]
    for answer in (current, peek):
        assert "GP21 (pin 27)" in error_of(answer)
        assert "address 0" in error_of(answer)
    assert numbers.split() == ["5", "1"]
    assert "set to: 795 mA (CS 25, vsense 1)" in status
    assert "answer" in status
    assert place.split() == ["100"]
    assert session.axis("X").end_steps() == 8000


def test_a_set_up_without_cable_changes_nothing(tmp_path: Path) -> None:
    """Neither a driver that is known nor a new one."""
    session = driven(
        tmp_path,
        SET_UP[0],
        "PAUSE 1200",
        "TMC22xx GP21, 2209, 0, 1000, 30, 16",
        "TMC22xx GP21, 2209, 1, 1000, 30, 16",
        "TMC22xx SGTHRS 1, 5",
        "TMC22xx STATUS",
        drivers=UNPLUGGED,
    )
    assert len(session.errors()) == 3
    assert session.errors()[2].startswith("TMC22xx not initialized")
    assert "set to: 795 mA" in session.last
    assert session.last.count("TMC2209, address") == 1


def test_a_cable_that_comes_back(tmp_path: Path) -> None:
    """After an outage everything can be said again, and is done."""
    drivers = ["tmc2209 tx=GP21 address=0 fault=unplugged:30@1000"]
    again = "ON ERROR IGNORE : DO : ON ERROR CLEAR : TMC22xx CURRENT 0, 1000 : LOOP WHILE MM.ERRNO"
    session = driven(
        tmp_path,
        SET_UP[0],
        "PAUSE 1200",
        f"{again} : ON ERROR ABORT",
        "PRINT PEEK(TMC 0, CHOPCONF) >> 17 AND 1",
        drivers=drivers,
    )
    assert session.errors() == []
    assert session.number() == 0
    assert writes(session.edges, TX)[-2:] != []


REGISTERS = {"GCONF": 0x1C0, "IHOLD_IRUN": 0x00081907, "CHOPCONF": 0x14030153, "TPOWERDOWN": 20}
"""Of SET_UP[0]."""
OTHER_LINE = "TMC22xx GP21, 2209, 0, 1000, 25, 32, , 0"
OTHERS = {"GCONF": 0x1C4, "IHOLD_IRUN": 0x00081104, "CHOPCONF": 0x13010153, "TPOWERDOWN": 20}
FAULTS = ["unplugged", "deaf", "silent", "bad-crc", "late", "garbled"]


@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("late_ms", range(0, 24, 3))
def test_a_set_up_that_fails_half_way(fault: str, late_ms: int, tmp_path: Path) -> None:
    """Behind the next statement the driver has one set of settings whole, that which is told."""
    start = 1000 + late_ms
    drivers = [f"tmc2209 tx=GP21 address=0 fault={fault}@{start}-{start + 150}"]
    session = typed(
        tmp_path,
        SET_UP[0],
        "TMC22xx MONITOR 0",
        f"DO : LOOP UNTIL TIMER >= 1000 : {OTHER_LINE}",
        "PAUSE 500",
        "TMC22xx SGTHRS 0, 7",
        "TMC22xx STATUS",
        drivers=drivers,
    )
    done = error_of(session.answers[2]) == ""
    assert error_of(session.answers[4]) == ""
    assert session.report.register("SGTHRS") == 7
    for name, value in (OTHERS if done else REGISTERS).items():
        assert session.report.register(name) == value, name
    told = "994 mA (CS 17, vsense 0)" if done else "795 mA (CS 25, vsense 1)"
    assert told in session.last
