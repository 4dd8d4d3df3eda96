"""What TMC22xx has beyond the reference: changes, axes, reading, wires."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from one_driver import (
    COOLCONF,
    IHOLD_IRUN,
    ONE,
    SET_UP,
    SGTHRS,
    TCOOLTHRS,
    TIE,
    TPWMTHRS,
    TX,
    driven,
    last_write,
)
from typed import READY, WAIT
from wire_frames import frames, writes

# ---- Changes -------------------------------------------------------------------------------------


def test_current(tmp_path: Path) -> None:
    """The hold current keeps its percentage unless another one is given."""
    session = driven(tmp_path, SET_UP, "TMC22xx CURRENT 0, 1000", "TMC22xx STATUS 0")
    assert session.errors() == []
    assert last_write(session, IHOLD_IRUN) == 0x00081105
    assert "set to: 994 mA (CS 17, vsense 0)" in session.last
    session = driven(tmp_path, SET_UP, "TMC22xx CURRENT 0, 500, 100")
    assert last_write(session, IHOLD_IRUN) == 0x00080F0F


def test_too_much_current_is_told(tmp_path: Path) -> None:
    session = driven(tmp_path, SET_UP, "TMC22xx CURRENT 0, 1900")
    assert session.last == (
        "Warning: run_mA: 1900 is more than 0.11 ohm allow, the motor gets 1768 mA"
    )


def test_a_current_much_above_the_wish_is_told(tmp_path: Path) -> None:
    """The scale has steps of 31 mA at its low end."""
    session = driven(tmp_path, SET_UP, "TMC22xx CURRENT 0, 20")
    assert session.last == "Warning: run_mA: the nearest to 20 with 0.11 ohm is 31 mA"
    session = driven(tmp_path, SET_UP, "TMC22xx CURRENT 0, 90")
    assert session.last == ""


def test_a_driver_has_the_name_of_its_axis(tmp_path: Path) -> None:
    """From AXIS on, until it is tied to none."""
    session = driven(
        tmp_path,
        SET_UP,
        TIE,
        "TMC22xx SGTHRS X, 77",
        "PRINT PEEK(TMC X, IFCNT) > 5",
        "TMC22xx AXIS X, 0",
        "TMC22xx SGTHRS X, 78",
    )
    assert len(session.errors()) == 1
    assert last_write(session, SGTHRS) == 77
    assert session.number(-3) == 1


def test_stall_computes_the_threshold(tmp_path: Path) -> None:
    """900 mm/min at 80 steps/mm and 16 microsteps are 1200 steps/s: 12 MHz / 19200."""
    session = driven(tmp_path, *READY, SET_UP, TIE, "TMC22xx SGTHRS X, 60", "TMC22xx STALL X, 900")
    assert session.last == "TCOOLTHRS 625 while homing: stalls are told from 900 mm/min up"
    assert TCOOLTHRS not in {reg for _, reg, _ in writes(session.edges, TX)}
    session = driven(
        tmp_path, *READY, SET_UP, TIE, "TMC22xx SGTHRS X, 60", "TMC22xx STALL X, 900, 1"
    )
    assert session.last == "TCOOLTHRS 625: stalls are told from 900 mm/min up"
    assert last_write(session, TCOOLTHRS) == 625


def test_stall_can_be_taken_back(tmp_path: Path) -> None:
    """What homing was to use, and what was written for good."""
    lines = ["TMC22xx STALL X, 900", "TMC22xx STALL X, 0", "TMC22xx STATUS X"]
    session = driven(tmp_path, *READY, SET_UP, TIE, *lines)
    assert session.answers[-2] == "Homing chooses TCOOLTHRS by itself"
    assert "for homing" not in session.last
    lines = ["TMC22xx STALL X, 900, 1", "TMC22xx STALL X, 0, 1"]
    session = driven(tmp_path, *READY, SET_UP, TIE, *lines)
    assert session.last == "TCOOLTHRS 0: no stalls are told"
    assert last_write(session, TCOOLTHRS) == 0


def test_a_driver_that_is_set_up_again_stays_tied(tmp_path: Path) -> None:
    """And keeps what was said about it."""
    session = driven(tmp_path, SET_UP, TIE, "TMC22xx SGTHRS X, 60", SET_UP, "TMC22xx STATUS X")
    assert session.errors() == []
    assert "SGTHRS 60" in session.last


def test_eight_drivers_and_no_more(tmp_path: Path) -> None:
    """On two wires of four; the ninth is an error, and its pin stays free."""
    lines = [f"TMC22xx GP{19 + n % 2}, 2209, {n // 2}, 800, 30, 16" for n in range(8)]
    drivers = [f"tmc2209 tx=GP{19 + n % 2} address={n // 2}" for n in range(8)]
    more = "TMC22xx GP22, 2209, 0, 800, 30, 16"
    blind = "TMC22xx VERIFY 0"
    session = driven(
        tmp_path, *lines, "TMC22xx STATUS", blind, more, "SETPIN GP22, DIN", drivers=drivers
    )
    assert session.answers[8].count("TMC2209, address") == 8
    assert len(session.errors()) == 1
    assert "8" in session.errors()[0]


def test_stall_says_what_keeps_it_from_working(tmp_path: Path) -> None:
    """No sensitivity, no StealthChop, StealthChop that ends earlier."""
    session = driven(tmp_path, *READY, SET_UP, TIE, "TMC22xx STALL X, 900")
    assert "Warning: SGTHRS is 0" in session.last
    session = driven(tmp_path, *READY, f"{SET_UP}, , 0", TIE, "TMC22xx STALL X, 900")
    assert "Warning: StallGuard needs StealthChop" in session.last
    stealth = "TMC22xx STEALTH X, , 600"
    session = driven(tmp_path, *READY, SET_UP, TIE, stealth, "TMC22xx STALL X, 900")
    assert "Warning: TPWMTHRS 938 ends StealthChop" in session.last


def test_stall_needs_an_axis(tmp_path: Path) -> None:
    """One that it is tied to, and that is configured."""
    session = driven(tmp_path, SET_UP, "TMC22xx STALL 0, 900", TIE, "TMC22xx STALL 0, 900")
    assert session.errors() == [
        "The driver is tied to no axis (use TMC22xx AXIS)",
        "X axis not configured (use STEPPER AXIS)",
    ]
    session = driven(tmp_path, "STEPPER INIT", SET_UP, TIE, "TMC22xx STALL 0, 900")
    assert session.errors() == ["X axis not configured (use STEPPER AXIS)"]


@pytest.mark.parametrize(
    ("tail", "told", "threshold"),
    [
        ("", "StealthChop at all speeds", 0),
        (", 0", "StealthChop at all speeds", 0),
        (", 400", "TPWMTHRS 400: StealthChop up to 1406.25 mm/min, SpreadCycle above", 400),
        (", , 900", "TPWMTHRS 625: StealthChop up to 900 mm/min, SpreadCycle above", 625),
    ],
)
def test_stealth(tail: str, told: str, threshold: int, tmp_path: Path) -> None:
    """A threshold or a speed of the axis; it is in force again after SpreadCycle."""
    session = driven(
        tmp_path,
        *READY,
        f"{SET_UP}, , 0",
        TIE,
        f"TMC22xx STEALTH X{tail}",
        "PRINT PEEK(TMC X, GCONF)",
    )
    assert session.answers[-2] == told
    assert last_write(session, TPWMTHRS) == threshold
    assert session.number() == 0x1C0


def test_spreadcycle_at_all_speeds(tmp_path: Path) -> None:
    session = driven(tmp_path, SET_UP, "TMC22xx STEALTH 0, OFF", "PRINT PEEK(TMC 0, GCONF)")
    assert session.answers[-2] == "SpreadCycle at all speeds"
    assert session.number() == 0x1C4


def test_coolstep(tmp_path: Path) -> None:
    """Its fields, and a word about TCOOLTHRS."""
    session = driven(tmp_path, SET_UP, "TMC22xx COOLSTEP 0, 5, 2, 1, 3, 1")
    assert last_write(session, COOLCONF) == 5 | 1 << 5 | 2 << 8 | 3 << 13 | 1 << 15
    assert session.last.startswith("Warning: CoolStep works while TSTEP is at or below TCOOLTHRS")
    session = driven(
        tmp_path,
        SET_UP,
        "TMC22xx TCOOLTHRS 0, 400",
        "TMC22xx COOLSTEP 0, 5, 2",
        "TMC22xx COOLSTEP 0, 0",
    )
    assert session.answers[-2:] == ["", ""]
    assert last_write(session, COOLCONF) == 0


def test_microsteps_wait_for_a_standstill(tmp_path: Path) -> None:
    """In motion they are refused; behind it the scale of the axis is told."""
    change = "TMC22xx GP21, 2209, 0, 800, 30, 32"
    write = "TMC22xx WRITE X, CHOPCONF, &H15030153"
    current = "TMC22xx GP21, 2209, 0, 900, 30, 16"
    session = driven(
        tmp_path,
        *READY,
        SET_UP,
        TIE,
        "STEPPER GC G1 X20 F3000",
        "PAUSE 50",
        change,
        write,
        current,
        WAIT,
        change,
        "TMC22xx STATUS X",
    )
    said = "cannot change while motion is active or queued"
    assert session.errors() == [f"microsteps: {said}", f"MRES: {said}"]
    assert session.answers[-2] == (
        "Warning: with 32 instead of 16 microsteps the X axis needs STEPPER TUNE X,,160"
    )
    assert "32 microsteps" in session.last
    assert session.axis("X").end_steps() == 1600
    session = driven(tmp_path, *READY, SET_UP, TIE, write.replace("15", "12", 1))
    assert session.last.endswith("the X axis needs STEPPER TUNE X,,320")


# ---- Reading -------------------------------------------------------------------------------------


@pytest.mark.parametrize("register", ["CHOPCONF", '"chopconf"', "chopconf", "&H6C", "108", "r$"])
def test_read_shows_a_register_with_its_fields(register: str, tmp_path: Path) -> None:
    """However it is named."""
    session = driven(tmp_path, 'r$ = "CHOPCONF"', SET_UP, f"TMC22xx READ 0, {register}")
    first, *fields = session.last.splitlines()
    assert first == "CHOPCONF (0x6C) 0x14030153"
    values = {field.split()[0]: field.split()[1] for field in fields}
    assert values["TOFF"] == "3"
    assert values["MRES"] == "4"
    assert values["vsense"] == "1"
    assert len(values) == 10


def test_read_of_what_can_only_be_written(tmp_path: Path) -> None:
    """It shows what was written last."""
    session = driven(tmp_path, SET_UP, "TMC22xx READ 0, IHOLD_IRUN")
    assert session.last.startswith("IHOLD_IRUN (0x10) 0x00081907, as written last\n")
    assert re.search(r"^  IHOLD +7\b", session.last, re.MULTILINE)


def test_write(tmp_path: Path) -> None:
    """A change of a setting afterwards keeps what was written to the rest of the register."""
    session = driven(
        tmp_path,
        SET_UP,
        "TMC22xx WRITE 0, GCONF, &H1C8",
        "PRINT PEEK(TMC 0, GCONF)",
        "TMC22xx STEALTH 0, OFF",
        "PRINT PEEK(TMC 0, GCONF)",
    )
    assert session.errors() == []
    assert session.number(-3) == 0x1C8
    assert session.number() == 0x1CC


def test_peek(tmp_path: Path) -> None:
    """At a standstill: no load, the current of the standstill, cool."""
    what = ("SG", "CS", "TEMP", "STATUS", "IFCNT", "IOIN")
    line = "PRINT " + "; ".join(f"PEEK(TMC 0, {name})" for name in what)
    session = driven(tmp_path, SET_UP, "PAUSE 5000", line)
    load, scale, degrees, status, count, pins = map(int, session.numbers())
    assert load == 0
    assert scale == 7
    assert degrees == 0
    assert status >> 31 == 1
    assert status >> 16 & 31 == 7
    assert count >= 5
    assert pins >> 24 == 0x21


def test_peek_tells_the_temperature(tmp_path: Path) -> None:
    hot = ["tmc2209 tx=GP21 address=0 fault=over-temperature:145"]
    session = driven(tmp_path, SET_UP, "PRINT PEEK(TMC 0, TEMP)", drivers=hot)
    assert session.number(-1) == 143


@pytest.mark.parametrize("name", ["SG", "CS", "STATUS"])
def test_a_variable_may_have_the_name_of_what_is_read(name: str, tmp_path: Path) -> None:
    """sg = PEEK(TMC 0, sg) is what one writes."""
    session = driven(
        tmp_path,
        SET_UP,
        "PAUSE 5000",
        f"{name} = 3",
        f"{name} = PEEK(TMC 0, {name})",
        f"PRINT {name} <> 3",
    )
    assert session.errors() == []
    assert session.number() == 1


def test_status_of_all(tmp_path: Path) -> None:
    """Each with its wire and axis, and at the end the switches."""
    drivers = [*ONE, "tmc2208 tx=GP20 rx=GP19", "tmc2209 tx=GP21 address=2"]
    session = driven(
        tmp_path,
        SET_UP,
        TIE,
        "TMC22xx WIRE GP20, GP19, 19200",
        "TMC22xx GP20, 2208, 0, 600, 50, 32",
        "TMC22xx GP21, 2209, 2, 500, 10, 8",
        "TMC22xx STATUS",
        drivers=drivers,
    )
    assert session.errors() == []
    heads = [line for line in session.last.splitlines() if line.startswith("TMC")]
    assert heads == [
        "TMC2209, address 0 on GP21 (pin 27), X axis",
        "TMC2208, address 0 on GP20 (pin 26), listens on GP19 (pin 25), 19200 bit/s",
        "TMC2209, address 2 on GP21 (pin 27)",
    ]
    assert session.last.count("  faults: none\n") == 3
    assert session.last.count("SG_RESULT") == 2
    assert session.last.endswith("verification is ON, monitor is ON")


def test_status_without_drivers(tmp_path: Path) -> None:
    session = driven(tmp_path, "TMC22xx STATUS", drivers=())
    assert session.last == "TMC22xx not initialized; verification is ON, monitor is ON"


def test_status_tells_faults(tmp_path: Path) -> None:
    """In words, and the temperature."""
    drivers = ["tmc2209 tx=GP21 address=0 fault=over-temperature:150@500 fault=short@500"]
    session = driven(
        tmp_path, "TMC22xx MONITOR 0", SET_UP, "PAUSE 600", "TMC22xx STATUS 0", drivers=drivers
    )
    faults = re.search(r"^  faults: (.*)$", session.last, re.MULTILINE)
    assert faults
    assert "short to ground" in faults[1]
    assert "temperature: above 143" in session.last or "temperature: above 150" in session.last


# ---- Wires ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("baud", [9600, 57600, 250000, 500000])
def test_other_rates(baud: int, tmp_path: Path) -> None:
    session = driven(
        tmp_path, f"TMC22xx WIRE GP21, , {baud}", SET_UP, "PRINT PEEK(TMC 0, CHOPCONF)"
    )
    assert session.errors() == []
    assert session.number() == 0x14030153
    assert len(frames(session.edges, TX, baud)) > 10


def test_a_pin_of_its_own_for_replies(tmp_path: Path) -> None:
    """Both are reserved, and released by CLOSE."""
    free = "SETPIN GP19, DIN : SETPIN GP21, DIN"
    session = driven(
        tmp_path,
        "TMC22xx WIRE GP21, GP19",
        SET_UP,
        "PRINT PEEK(TMC 0, CHOPCONF)",
        free,
        "TMC22xx CLOSE",
        free,
        drivers=["tmc2209 tx=GP21 rx=GP19 address=0"],
    )
    assert session.number(-4) == 0x14030153
    assert session.errors() == ["Pin GP19 (pin 25) is in use by TMC22xx wire"]


@pytest.mark.parametrize(
    "taking",
    [
        "SETPIN GP21, DOUT",
        "SETPIN GP21, GP20, COM2",
        "STEPPER PROBE GP21",
        "STEPPER HWLIMITS GP21",
        "STEPPER SPINDLE GP21",
        "STEPPER AXIS A, GP21, GP22",
    ],
)
def test_conflicts_of_pins_are_told_in_both_directions(taking: str, tmp_path: Path) -> None:
    """Who comes second is told who has it, and nothing changes."""
    session = driven(tmp_path, "STEPPER INIT", SET_UP, taking, "TMC22xx CLOSE", taking, SET_UP)
    second, first = session.errors()
    assert re.search(r"GP21 \(pin 27\)( for X_MIN)? is in use by TMC22xx wire", second)
    assert re.search(r"GP21 \(pin 27\) is in use by S", first)
