"""Section 7 of the STEPPER reference: TMC22xx, set-up of Trinamic drivers over one wire.

The frames are taken from the edges of the pin, the answers come from a simulated driver.
"""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import pytest
from typed import READY, WAIT, Session, error_of, typed
from wire_frames import crc, frames, writes

TX = 16
GCONF, IHOLD_IRUN, TPOWERDOWN, TCOOLTHRS = 0x00, 0x10, 0x11, 0x14
SGTHRS, CHOPCONF, PWMCONF = 0x40, 0x6C, 0x70

ONE = ["tmc2209 tx=GP16 address=0"]
TWO = [*ONE, "tmc2209 tx=GP16 address=1"]
A_2208 = ["tmc2208 tx=GP16"]
SET_UP = "TMC22xx 16, 2209, 0, 800, 30, 16"

TAILS = {
    "16, 2209, 0, 800, 30, 16": (
        "05 00 80 00 00 01 C0 F6",
        "05 00 90 00 08 19 07 15",
        "05 00 91 00 00 00 14 1F",
        "05 00 EC 14 03 01 53 69",
        "05 00 F0 CF 0D 0E 24 96",
    ),
    "16, 2208, 0, 600, 50, 32, 0.15, 0": (
        "05 00 80 00 00 01 C4 16",
        "05 00 90 00 08 19 0C 2B",
        "05 00 91 00 00 00 14 1F",
        "05 00 EC 13 03 01 53 0D",
        "05 00 F0 CF 0D 0E 24 96",
    ),
    "16, 2209, 1, 1000, 25, 16": (
        "05 01 80 00 00 01 C0 1A",
        "05 01 90 00 08 11 04 E0",
        "05 01 91 00 00 00 14 F3",
        "05 01 EC 14 01 01 53 03",
        "05 01 F0 CF 0D 0E 24 7A",
    ),
    "16, 2209, 0, 2000, 100, 256": (
        "05 00 80 00 00 01 C0 F6",
        "05 00 90 00 08 1F 1F A8",
        "05 00 91 00 00 00 14 1F",
        "05 00 EC 10 01 01 53 21",
        "05 00 F0 CF 0D 0E 24 96",
    ),
}
"""What the original sends for the arguments of TMC22xx."""


def driven(folder: Path, *lines: str, drivers: list[str] | tuple = ONE) -> Session:
    """Type the lines with a simulated driver on the wire."""
    return typed(folder, *lines, drivers=drivers)


def registers_of(session: Session, address: int = 0) -> dict[int, int]:
    """What was written to each register of a driver last."""
    return {reg: value for driver, reg, value in writes(session.edges, TX) if driver == address}


# ---- 7, 7.3: five registers ----------------------------------------------------------------------


@pytest.mark.parametrize("arguments", TAILS)
def test_five_registers_in_order(arguments: str, tmp_path: Path) -> None:
    """Blind, as the original: the same frames, 200 us between them, nothing else on the wire."""
    session = driven(tmp_path, "TMC22xx VERIFY 0", f"TMC22xx {arguments}", drivers=())
    assert session.errors() == []
    sent = frames(session.edges, TX)
    assert tuple(frame.text for frame in sent) == TAILS[arguments]
    gaps = [after.start_ns - before.end_ns for before, after in itertools.pairwise(sent)]
    assert all(199_000 <= gap <= 260_000 for gap in gaps), gaps


def test_the_line_is_high_until_the_first_frame(tmp_path: Path) -> None:
    """The first thing that a driver sees is a start bit."""
    session = driven(tmp_path, "TMC22xx VERIFY 0", SET_UP, drivers=())
    mine = session.edges.of(TX)
    falling = mine.time_ns[mine.level == 0]
    assert falling[0] == frames(session.edges, TX)[0].start_ns


@pytest.mark.parametrize(
    ("arguments", "drivers"),
    [
        ("16, 2209, 0, 800, 30, 16", ONE),
        ("16, 2208, 0, 600, 50, 32, 0.15, 0", A_2208),
        ("16, 2209, 1, 1000, 25, 16", TWO),
    ],
)
def test_the_same_registers_are_written_when_the_driver_answers(
    arguments: str, drivers: list[str], tmp_path: Path
) -> None:
    """Between the writes it is asked; what is written is the same, each once."""
    session = driven(tmp_path, f"TMC22xx {arguments}", drivers=drivers)
    assert session.errors() == []
    sent = [frame for frame in frames(session.edges, TX) if frame.is_write]
    ours = [frame.text for frame in sent if frame.write[1] not in (0x01, 0x03)]
    assert tuple(ours) == TAILS[arguments]
    assert len(frames(session.edges, TX)) > len(sent) + 4


def test_the_driver_has_taken_them(tmp_path: Path) -> None:
    """Read back from the driver."""
    read = "; ".join(f"PEEK(TMC 0, {reg})" for reg in ("GCONF", "CHOPCONF", "PWMCONF", "IFCNT"))
    session = driven(tmp_path, SET_UP, f"PRINT {read}")
    gconf, chopconf, pwmconf, count = session.numbers()
    assert (gconf, chopconf, pwmconf) == (0x1C0, 0x14030153, 0xCF0D0E24)
    assert count >= 5


def test_said_again_with_other_settings(tmp_path: Path) -> None:
    """Without CLOSE, as often as one likes; the last one counts."""
    again = "TMC22xx 16, 2209, 0, 1000, 25, 32"
    session = driven(tmp_path, SET_UP, again, "PRINT PEEK(TMC 0, CHOPCONF)")
    assert session.errors() == []
    assert session.number() == 0x13010153
    assert registers_of(session)[IHOLD_IRUN] == 0x00081104


def test_settings_stay_when_the_pin_is_released(tmp_path: Path) -> None:
    """CLOSE writes nothing, and the registers are as they were."""
    blind = ["TMC22xx CLOSE", "TMC22xx VERIFY 0", "PAUSE 10"]
    before = writes(driven(tmp_path, SET_UP).edges, TX)
    session = driven(tmp_path, SET_UP, *blind)
    assert writes(session.edges, TX) == before


@pytest.mark.parametrize("when", ["before", "after", "moving"])
def test_independent_of_stepper(when: str, tmp_path: Path) -> None:
    """Before INIT, after it, in motion: the motors' edges are the same as without it."""
    move = "STEPPER GC G1 X20 Y10 F3000"
    pause = "PAUSE 100"
    pin = ["tmc2209 tx=GP21 address=0"]
    line = "TMC22xx 21, 2209, 0, 800, 30, 16"
    orders = {
        "before": [line, *READY, move, pause],
        "after": [*READY, line, move, pause],
        "moving": [*READY, move, pause, line],
    }
    session = driven(tmp_path, *orders[when], WAIT, drivers=pin)
    assert session.errors() == []
    plain = typed(tmp_path, *READY, move, pause, WAIT)
    for axis in "XY":
        with_it, without = session.axis(axis).step_ns, plain.axis(axis).step_ns
        assert (with_it - with_it[0] == without - without[0]).all()


# ---- 7.1: arguments ------------------------------------------------------------------------------


@pytest.mark.parametrize("pin", ["16", "GP16", '"GP16"', "p", "8+8"])
def test_the_pin_is_a_gpio_number(pin: str, tmp_path: Path) -> None:
    """However it is written."""
    session = driven(tmp_path, "p = 16", f"TMC22xx {pin}, 2209, 0, 800, 30, 16")
    assert session.errors() == []
    assert len(writes(session.edges, TX)) >= 5


def test_the_pin_is_reserved_until_close(tmp_path: Path) -> None:
    """Nobody else gets it, and everybody does behind CLOSE."""
    others = ["SETPIN GP16, DIN", "STEPPER PROBE GP16"]
    session = driven(
        tmp_path, "STEPPER INIT", SET_UP, *others, "TMC22xx CLOSE", others[0], "SETPIN GP16, OFF"
    )
    assert session.errors() == ["Pin GP16 (pin 21) is in use by TMC22xx wire"] * 2
    assert error_of(session.last) == ""


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        ("16, 2210, 0, 800, 30, 16", "chip_type: 2210 is invalid (valid is 2208, 2209)"),
        ("16, 2209, 4, 800, 30, 16", "address: 4 is invalid (valid is 0 to 3)"),
        ("16, 2209, -1, 800, 30, 16", "address: -1 is invalid (valid is 0 to 3)"),
        ("16, 2209, 0, 2001, 30, 16", "run_mA: 2001 is invalid (valid is above 0 to 2000)"),
        ("16, 2209, 0, -1, 30, 16", "run_mA: -1 is invalid (valid is above 0 to 2000)"),
        ("16, 2209, 0, 800, 101, 16", "hold_pct: 101 is invalid (valid is 0 to 100)"),
        (
            "16, 2209, 0, 800, 30, 3",
            "microsteps: 3 is invalid (valid is 1, 2, 4, 8, 16, 32, 64, 128, 256)",
        ),
        (
            "16, 2209, 0, 800, 30, 16, 0.07",
            "r_sense_ohm: 0.07 is invalid (valid is 0.08 to 0.2)",
        ),
        (
            "16, 2209, 0, 800, 30, 16, 0.21",
            "r_sense_ohm: 0.21 is invalid (valid is 0.08 to 0.2)",
        ),
        ("16, 2209, 0, 800, 30, 16, , 2", "stealthchop: 2 is invalid (valid is 0 to 1)"),
    ],
)
def test_ranges_are_told(arguments: str, error: str, tmp_path: Path) -> None:
    """And the pin stays free."""
    session = driven(tmp_path, f"TMC22xx {arguments}", "SETPIN GP16, DIN")
    assert session.errors() == [error]
    assert writes(session.edges, TX) == []


@pytest.mark.parametrize("address", [0, 1, 2, 3])
def test_only_the_addressed_driver_answers(address: int, tmp_path: Path) -> None:
    """Four of them on one wire."""
    four = [f"tmc2209 tx=GP16 address={n}" for n in range(4)]
    peeks = "; ".join(f"PEEK(TMC {address}, {reg})" for reg in ("GCONF", "CHOPCONF"))
    session = driven(
        tmp_path, f"TMC22xx 16, 2209, {address}, 800, 30, 16", f"PRINT {peeks}", drivers=four
    )
    assert session.numbers() == [0x1C0, 0x14030153]
    assert {driver for driver, _, _ in writes(session.edges, TX)} == {address}


def test_a_2208_has_address_0(tmp_path: Path) -> None:
    """Any other one is an error that says so."""
    session = driven(tmp_path, "TMC22xx 16, 2208, 1, 600, 50, 32", drivers=A_2208)
    assert len(session.errors()) == 1
    assert re.search(r"(?i)^address.*\b1\b.*2208", session.errors()[0])


@pytest.mark.parametrize(
    ("run_ma", "r_sense", "scale", "vsense"),
    [
        (100, 0.11, 2, 1),
        (500, 0.11, 15, 1),
        (800, 0.11, 25, 1),
        (900, 0.11, 28, 1),
        (1000, 0.11, 17, 0),
        (1500, 0.11, 26, 0),
        (600, 0.15, 25, 1),
        (1900, 0.08, 25, 0),
    ],
)
def test_the_current_is_scaled_by_the_resistor(
    run_ma: int, r_sense: float, scale: int, vsense: int, tmp_path: Path
) -> None:
    """RMS, with the finer range where it reaches."""
    session = driven(tmp_path, f"TMC22xx 16, 2209, 0, {run_ma}, 100, 16, {r_sense}")
    assert session.answers == [""]
    written = registers_of(session)
    assert written[IHOLD_IRUN] >> 8 & 31 == scale
    assert written[CHOPCONF] >> 17 & 1 == vsense


@pytest.mark.parametrize(("percent", "scale"), [(0, 0), (25, 6), (30, 7), (99.9, 24), (100, 25)])
def test_the_current_at_standstill_is_a_part_of_it(
    percent: float, scale: int, tmp_path: Path
) -> None:
    session = driven(tmp_path, f"TMC22xx 16, 2209, 0, 800, {percent}, 16")
    assert registers_of(session)[IHOLD_IRUN] & 31 == scale


@pytest.mark.parametrize("power", range(9))
def test_microsteps(power: int, tmp_path: Path) -> None:
    """Each power of two, always interpolated."""
    session = driven(
        tmp_path, f"TMC22xx 16, 2209, 0, 800, 30, {1 << power}", "PRINT PEEK(TMC 0, CHOPCONF)"
    )
    chopconf = int(session.number())
    assert chopconf >> 24 & 15 == 8 - power
    assert chopconf >> 28 & 1 == 1


@pytest.mark.parametrize(
    ("tail", "gconf"), [("", 0x1C0), (", , 1", 0x1C0), (", 0.11, 0", 0x1C4), (", , OFF", 0x1C4)]
)
def test_stealthchop_or_spreadcycle(tail: str, gconf: int, tmp_path: Path) -> None:
    session = driven(tmp_path, SET_UP + tail, "PRINT PEEK(TMC 0, GCONF)")
    assert session.number() == gconf


# ---- 7.4: thresholds -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "frame"),
    [
        ("TCOOLTHRS 0, 200", "05 00 94 00 00 00 C8 4D"),
        ("SGTHRS 0, 120", "05 00 C0 00 00 00 78 D7"),
        ("SGTTHRS 0, 120", "05 00 C0 00 00 00 78 D7"),
        ("TCOOLTHRS 0, 0", "05 00 94 00 00 00 00 34"),
    ],
)
def test_a_threshold_is_one_datagram(line: str, frame: str, tmp_path: Path) -> None:
    """With both spellings."""
    blind = "TMC22xx VERIFY 0"
    session = driven(tmp_path, blind, SET_UP, f"TMC22xx {line}", drivers=())
    assert [sent.text for sent in frames(session.edges, TX)[5:]] == [frame]


@pytest.mark.parametrize(
    "line",
    ["SGTHRS 0, 100", "SGTTHRS 0, 100", "TCOOLTHRS 0, 200", "READ 0, GCONF", "STATUS 0", "CLOSE"],
)
def test_a_driver_has_to_be_set_up_first(line: str, tmp_path: Path) -> None:
    """One that is there; also when another one is, or was."""
    session = driven(tmp_path, f"TMC22xx {line}", SET_UP, "TMC22xx CLOSE", f"TMC22xx {line}")
    assert [error.partition(" (")[0] for error in session.errors()] == [
        "TMC22xx not initialized"
    ] * 2


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("SGTHRS 0, 256", "value: 256 is invalid (valid is 0 to 255)"),
        ("SGTHRS 0, -1", "value: -1 is invalid (valid is 0 to 255)"),
        ("TCOOLTHRS 0, 1048576", "value: 1048576 is invalid (valid is 0 to 1048575)"),
        ("TCOOLTHRS 4, 200", "driver: 4 is invalid (valid is 0, 1, 2, 3, X, Y, Z, A)"),
        ("SGTHRS 0", "Missing value"),
        ("SGTHRS", "Missing driver"),
    ],
)
def test_ranges_of_thresholds_are_told(line: str, error: str, tmp_path: Path) -> None:
    session = driven(tmp_path, SET_UP, f"TMC22xx {line}")
    assert session.errors() == [error]
    assert not {SGTHRS, TCOOLTHRS} & set(registers_of(session))


@pytest.mark.parametrize("line", ["SGTHRS 0, 100", "TCOOLTHRS 0, 200", "STALL 0, 600"])
def test_a_2208_has_no_stallguard(line: str, tmp_path: Path) -> None:
    """The error says so, and nothing is written."""
    set_up = "TMC22xx 16, 2208, 0, 600, 50, 32"
    session = driven(tmp_path, set_up, f"TMC22xx {line}", drivers=A_2208)
    assert len(session.errors()) == 1
    assert "2208" in session.errors()[0]
    assert not {SGTHRS, TCOOLTHRS} & set(registers_of(session))


def test_the_load_can_be_read(tmp_path: Path) -> None:
    """SG_RESULT of a motor that turns."""
    axis = "axis X step=GP2 dir=GP3"
    move = "STEPPER GC G1 X30 F3000 : PAUSE 300 : PRINT PEEK(TMC 0, SG); PEEK(TMC 0, TSTEP)"
    session = driven(tmp_path, SET_UP, *READY, move, drivers=[axis, f"{ONE[0]} axis=X"])
    load, tstep = session.numbers()
    assert 0 < load <= 510
    assert tstep == pytest.approx(12e6 / (50 * 80 * 16), rel=0.05)


# ---- 7.5 -----------------------------------------------------------------------------------------


def test_example_of_a_2209(tmp_path: Path) -> None:
    session = driven(tmp_path, "TMC22xx 16, 2209, 0, 800, 30, 16", "TMC22xx CLOSE")
    assert session.answers == ["", ""]


def test_example_of_a_2208(tmp_path: Path) -> None:
    lines = ["TMC22xx 16, 2208, 0, 600, 50, 32, 0.15, 0", "PRINT PEEK(TMC 0, GCONF)"]
    session = driven(tmp_path, *lines, drivers=A_2208)
    assert session.number() == 0x1C4


def test_example_of_two_drivers_on_a_wire(tmp_path: Path) -> None:
    """As printed; each has got what was meant for it."""
    session = driven(
        tmp_path,
        "TMC22xx 16, 2209, 0, 1000, 25, 16",
        "TMC22xx 16, 2209, 1, 1000, 25, 16",
        "TMC22xx TCOOLTHRS 0, 200",
        "TMC22xx SGTTHRS 0, 120",
        "TMC22xx TCOOLTHRS 0, 0",
        "PRINT PEEK(TMC 0, CHOPCONF); PEEK(TMC 1, CHOPCONF)",
        "TMC22xx CLOSE",
        drivers=TWO,
    )
    assert session.errors() == []
    assert session.numbers(-2) == [0x14010153, 0x14010153]
    thresholds = [
        (reg, value) for _, reg, value in writes(session.edges, TX) if reg in (0x14, 0x40)
    ]
    assert thresholds == [(TCOOLTHRS, 200), (SGTHRS, 120), (TCOOLTHRS, 0)]


def test_every_frame_has_its_checksum(tmp_path: Path) -> None:
    """The decoder's own is right, and so are all that were sent."""
    assert crc(bytes.fromhex("0500800000 01C0".replace(" ", ""))) == 0xF6
    session = driven(tmp_path, SET_UP, "TMC22xx STATUS")
    sent = frames(session.edges, TX)
    assert len(sent) > 15
    assert all(frame.data[-1] == crc(frame.data[:-1]) for frame in sent)
