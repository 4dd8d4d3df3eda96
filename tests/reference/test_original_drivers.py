"""The faults that TMC22xx of the PicoMite firmware was found to have: none of them is here.

A test for each. Frames on the pins, answers of simulated drivers and error texts are the judges.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from typed import READY, WAIT, Session, error_of, typed
from wire_frames import writes

ONE = ["tmc2209 tx=GP16 address=0"]
TWO = [*ONE, "tmc2209 tx=GP16 address=1"]
SET_UP = "TMC22xx 16, 2209, 0, 800, 30, 16"
NOT_INITIALIZED = "TMC22xx not initialized"
CHOPCONF = 0x6C


def driven(folder: Path, *lines: str, drivers: list[str] | tuple = ONE) -> Session:
    """Type the lines with simulated drivers on the wires."""
    return typed(folder, *lines, drivers=drivers)


def test_3_01_a_second_driver_on_the_pin_is_refused(tmp_path: Path) -> None:
    """Both are set up, each with its own settings."""
    session = driven(
        tmp_path,
        SET_UP,
        "TMC22xx 16, 2209, 1, 800, 30, 64",
        "PRINT PEEK(TMC 0, CHOPCONF) >> 24 AND 15; PEEK(TMC 1, CHOPCONF) >> 24 AND 15",
        drivers=TWO,
    )
    assert session.errors() == []
    assert session.numbers() == [4, 2]


def test_3_02_no_current_is_accepted(tmp_path: Path) -> None:
    """0 mA, and what is less than the chip can give, are refused; the pin stays free."""
    session = driven(
        tmp_path,
        "TMC22xx 16, 2209, 0, 0, 30, 16",
        "TMC22xx 16, 2209, 0, 0.001, 30, 16",
        "SETPIN GP16, DIN",
    )
    assert error_of(session.answers[0]) == "run_mA: 0 is invalid (valid is above 0 to 2000)"
    assert "0.001 mA is too little" in error_of(session.answers[1])
    assert error_of(session.last) == ""
    assert writes(session.edges, 16) == []


@pytest.mark.parametrize("run_ma", [1800, 1900, 2000])
def test_3_03_too_much_current_saturates_silently(run_ma: int, tmp_path: Path) -> None:
    """It is set to the most, and that is told."""
    session = driven(tmp_path, f"TMC22xx 16, 2209, 0, {run_ma}, 30, 16", "TMC22xx STATUS 0")
    told = f"Warning: run_mA: {run_ma} is more than 0.11 ohm allow, the motor gets 1768 mA"
    assert session.answers[0] == told
    assert "1768 mA (CS 31, vsense 0)" in session.last
    assert session.errors() == []


def test_3_04_the_pin_is_taken_before_the_rest_is_checked(tmp_path: Path) -> None:
    """After a line that was refused there is no driver, and nothing goes out anywhere."""
    session = driven(
        tmp_path, "TMC22xx 16, 2209, 0, 800, 30, 5", "TMC22xx SGTHRS 0, 100", "SETPIN GP16, DOUT"
    )
    assert error_of(session.answers[0]).startswith("microsteps: 5 is invalid")
    assert error_of(session.answers[1]).startswith(NOT_INITIALIZED)
    assert error_of(session.last) == ""


def test_3_04_a_refused_line_does_not_move_a_driver(tmp_path: Path) -> None:
    """The one that there is stays on its pin."""
    session = driven(
        tmp_path,
        SET_UP,
        "TMC22xx 17, 2209, 0, 800, 30, 5",
        "TMC22xx SGTHRS 0, 100",
        "SETPIN GP17, DIN",
    )
    assert len(session.errors()) == 1
    assert (0, 0x40, 100) in writes(session.edges, 16)


@pytest.mark.parametrize(
    ("line", "missing"),
    [
        ("TMC22xx", "tx_pin"),
        ("TMC22xx 16", "chip_type"),
        ("TMC22xx 16, 2209", "address"),
        ("TMC22xx 16, 2209, 0", "run_mA"),
        ("TMC22xx 16, 2209, 0, 800", "hold_pct"),
        ("TMC22xx 16, 2209, 0, 800, 30", "microsteps"),
        ("TMC22xx 16, , 0, 800, 30, 16", "chip_type"),
        ("TMC22xx 16, 2209, 0, , 30, 16", "run_mA"),
    ],
)
def test_3_05_short_commands_read_what_is_not_there(
    line: str, missing: str, tmp_path: Path
) -> None:
    """The argument that is missing is named."""
    session = driven(tmp_path, line, "SETPIN GP16, DIN")
    assert session.errors() == [f"Missing {missing}"]


def test_3_05_long_commands(tmp_path: Path) -> None:
    session = driven(tmp_path, f"{SET_UP}, 0.11, 1, 5", "TMC22xx CLOSE 16, 17")
    assert session.errors() == ["Too many arguments"] * 2
    assert writes(session.edges, 16) == []


def test_3_06_sgthrs_goes_to_a_2208(tmp_path: Path) -> None:
    """The chip of each driver is known."""
    session = driven(
        tmp_path,
        "TMC22xx 16, 2208, 0, 600, 50, 32",
        "TMC22xx SGTHRS 0, 100",
        drivers=["tmc2208 tx=GP16"],
    )
    assert "2208" in session.errors()[0]
    assert 0x40 not in {reg for _, reg, _ in writes(session.edges, 16)}


def test_3_07_setting_up_again_needs_close(tmp_path: Path) -> None:
    """It can be said as often as one likes."""
    again = "TMC22xx 16, 2209, 0, 900, 30, 16"
    session = driven(tmp_path, SET_UP, again, SET_UP)
    assert session.errors() == []
    values = [value for _, reg, value in writes(session.edges, 16) if reg == 0x10]
    assert values == [0x00081907, 0x00081C08, 0x00081907]


def test_3_08_setting_up_on_another_pin_leaks_the_first(tmp_path: Path) -> None:
    """Two wires, each released by CLOSE, alone or both."""
    drivers = [*ONE, "tmc2209 tx=GP17 address=0"]
    free = ["SETPIN GP16, DIN : SETPIN GP16, OFF", "SETPIN GP17, DIN : SETPIN GP17, OFF"]
    other = "TMC22xx 17, 2209, 0, 800, 30, 16"
    session = driven(
        tmp_path,
        SET_UP,
        other,
        "TMC22xx CLOSE GP16",
        *free,
        SET_UP,
        "TMC22xx CLOSE",
        *free,
        drivers=drivers,
    )
    errors = [error_of(answer) for answer in session.answers]
    assert errors == ["", "", "", "", "Pin GP17 (pin 22) is in use by TMC22xx wire", "", "", "", ""]


def test_3_09_a_bare_number_is_a_pin_of_the_board(tmp_path: Path) -> None:
    """It is a GPIO number, as the text says, unless the user wants one rule for all pins."""
    session = driven(tmp_path, "TMC22xx 21, 2209, 0, 800, 30, 16", SET_UP)
    assert "GP21 (pin 27)" in session.errors()[0]
    assert len(session.errors()) == 1
    by_board = driven(tmp_path, "OPTION PIN NUMBERS BOARD", "TMC22xx 21, 2209, 0, 800, 30, 16")
    assert by_board.errors() == []
    assert len(writes(by_board.edges, 16)) >= 5


def test_3_10_interrupts_are_off_while_it_sends(tmp_path: Path) -> None:
    """Four axes at speed: every edge is where it is without the traffic."""
    move = "STEPPER GC G1 X40 Y30 Z5 A90 F3000"
    twelve = "FOR i = 1 TO 12 : TMC22xx CURRENT 0, 700+i*10 : x = PEEK(TMC 0, SG) : NEXT"
    drivers = ["tmc2209 tx=GP21 address=0"]
    pin = "TMC22xx 21, 2209, 0, 800, 30, 16"
    quiet = driven(tmp_path, pin, *READY, move, WAIT, drivers=drivers)
    busy = driven(tmp_path, pin, *READY, move, twelve, WAIT, drivers=drivers)
    assert busy.errors() == []
    for axis in "XYZA":
        assert np.array_equal(np.diff(busy.axis(axis).step_ns), np.diff(quiet.axis(axis).step_ns))
    sent_ns = busy.edges.of(21).time_ns
    begin_ns, end_ns = busy.axis("X").step_ns[[0, -1]]
    overlap = (sent_ns > begin_ns) & (sent_ns < end_ns)
    assert np.count_nonzero(overlap) > 1000


def test_3_11_close_before_init_speaks_of_steppers(tmp_path: Path) -> None:
    session = driven(tmp_path, "TMC22xx CLOSE")
    assert session.errors() == [f"{NOT_INITIALIZED} (no wire)"]


def test_3_12_a_driver_that_is_missing_is_not_noticed(tmp_path: Path) -> None:
    """The error names pin and address; no driver is in the table, and the pin is free."""
    session = driven(tmp_path, SET_UP, "TMC22xx SGTHRS 0, 100", "SETPIN GP16, DIN", drivers=())
    assert "GP16 (pin 21)" in session.errors()[0]
    assert "address 0" in session.errors()[0]
    assert error_of(session.answers[1]).startswith(NOT_INITIALIZED)
    assert error_of(session.last) == ""


def test_3_12_a_driver_at_another_address_is_told(tmp_path: Path) -> None:
    drivers = ["tmc2209 tx=GP16 address=2"]
    session = driven(tmp_path, SET_UP, drivers=drivers)
    assert "address 0" in session.errors()[0]
    assert "address 2" in session.errors()[0]
