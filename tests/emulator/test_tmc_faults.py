"""TMC drivers with every fault there is: a program reads and writes 10,000 times, none mistaken.

What the firmware says is compared with the log of the model (tmc_oracle.py). Faults come at random
times, the same in every run.
"""

import random
from dataclasses import dataclass, field
from typing import Any

import pytest
from tmc_oracle import MARK_GPIO, Count, Driver, Oracle, Said, Statement, program, said

from stepmite.emulator import Emulator

CTRL_C, CTRL_Z = "\x03", "\x1a"

SLAVECONF, TPOWERDOWN, TSTEP, TPWMTHRS, VACTUAL, SG_RESULT = 0x03, 0x11, 0x12, 0x13, 0x22, 0x41
MSCNT, CHOPCONF, DRV_STATUS, PWMCONF, PWM_SCALE, PWM_AUTO = 0x6A, 0x6C, 0x6F, 0x70, 0x71, 0x72

READS = [SG_RESULT, MSCNT, TSTEP, PWM_SCALE, PWM_AUTO, DRV_STATUS, CHOPCONF]
"""The first five are different each time they are read."""
WRITES = {SLAVECONF: 0xF00, VACTUAL: 0xFFFFFF, TPWMTHRS: 0xFFFFF}
WRITES_IN_MOTION = {SLAVECONF: 0xF00, TPOWERDOWN: 0xFF}

COUNTED = ["silent", "deaf", "bad-crc", "late", "garbled"]
LASTING = ["unplugged", "unpowered", "over-temperature"]


@dataclass
class Case:
    """Drivers on wires, and how they are treated."""

    drivers: list[Driver]
    before: list[str]
    statements: int
    """To be checked at least."""
    gap_ms: float
    """Mean time between two faults."""
    rx: dict[int, int] = field(default_factory=dict)
    options: dict[str, dict[str, Any]] = field(default_factory=dict)
    faults: list[str] = field(default_factory=lambda: [*COUNTED, *LASTING, "brown-out"])
    writes: dict[int, int] = field(default_factory=lambda: WRITES)
    """Registers and masks of the values."""
    measured: str = "random"
    turning: bool = False
    """The first driver's motor turns all the time."""
    after: list[str] = field(default_factory=list)


CASES = {
    "one driver": Case([Driver("D", 5, 0)], [], 2900, 150),
    "four on a wire": Case(
        [Driver(f"D{address}", 5, address) for address in range(4)],
        ["TMC22xx WIRE GP5,,500000"],
        4000,
        60,
        options={
            "D0": {"clock": 0.98, "skew": 0.02},
            "D1": {"clock": 1.02, "skew": -0.02},
            "D2": {"clock": 0.98, "skew": -0.02},
            "D3": {"clock": 1.02, "skew": 0.02},
        },
    ),
    "two wires": Case(
        [Driver("D", 5, 0), Driver("E", 7, 0), Driver("F", 7, 2)],
        ["TMC22xx WIRE GP5,,250000", "TMC22xx WIRE GP7,GP8,115200"],
        2900,
        120,
        rx={7: 8},
    ),
    "slow": Case([Driver("D", 5, 1), Driver("E", 5, 3)], ["TMC22xx WIRE GP5,,9600"], 500, 700),
    "in motion": Case(
        [Driver("D", 5, 0)],
        [
            "STEPPER INIT",
            "STEPPER AXIS X,GP2,GP3,,,80,6000,500",
            "STEPPER POSITION X,0",
            "STEPPER RUN",
            "STEPPER JOG X,+,3000",
        ],
        1200,
        80,
        faults=["silent", "late", "over-temperature", "stall", "brown-out"],
        writes=WRITES_IN_MOTION,
        measured="motor",
        turning=True,
        after=["TMC22xx SGTHRS 0,60", "TMC22xx TCOOLTHRS 0,200"],
    ),
}
DIAG = 10


def statements_of(case: Case) -> list[Statement]:
    """Reads of every driver and some writes, in turn."""
    found = []
    for index in range(len(case.drivers)):
        found += [Statement(index, register) for register in READS[:4]]
        found += [Statement(index, register, True, mask) for register, mask in case.writes.items()]
        found += [Statement(index, register) for register in READS[4:]]
    return found


def inject(board: Emulator, case: Case, draw: random.Random) -> None:
    """A fault somewhere, from now on."""
    fault, driver = draw.choice(case.faults), draw.choice(case.drivers).name
    if fault in COUNTED:
        board.tmc_fault(fault, driver, times=draw.randint(1, 5))
    elif fault in LASTING:
        board.tmc_fault(fault, driver, for_ms=draw.uniform(0.1, 2) * case.gap_ms)
    elif fault == "stall":
        board.tmc_fault(fault, driver, at=board.axis("X") + 20, for_ms=case.gap_ms)
    else:
        board.tmc_fault(fault, driver)


def run_program(board: Emulator, case: Case, seed: int) -> tuple[list[Said], list[float], list]:
    """What the program has said, when each of its statements ended (ns), and the log."""
    draw = random.Random(seed)
    source = program(case.drivers, case.before, case.after, statements_of(case))
    board.send("AUTOSAVE\r" + source.replace("\n", "\r") + CTRL_Z)
    board.until("\n> ", 5000)
    board.send("RUN\r")
    board.expect("begin\r\n", 5000)
    board.clear_edges()
    board.tmc_log()
    text = ""
    while len(said(text)) < case.statements:
        board.run_ms(draw.expovariate(1 / case.gap_ms))
        inject(board, case, draw)
        text += board.output()
    board.tmc_heal()
    board.run_ms(100)
    text += board.output()
    board.send(CTRL_C)
    board.run_ms(500)
    ends = [float(time) for time, _, _ in board.edges([MARK_GPIO])]
    return said(text), ends, board.tmc_log()


def check_all(case: Case, lines: list[Said], ends: list[float], log: list) -> Count:
    """Let the oracle look at each statement with its part of the log."""
    oracle = Oracle(case.drivers, statements_of(case))
    place = 0
    for line, end_ns in zip(lines, ends, strict=False):
        begin = place
        while place < len(log) and log[place]["time_ns"] < end_ns:
            place += 1
        oracle.check(line, log[begin:place], end_ns)
    return oracle.count


@pytest.mark.parametrize("name", CASES)
def test_nothing_is_mistaken(board: Emulator, name: str) -> None:
    case = CASES[name]
    if case.turning:
        board.add_axis("X", 2, 3)
    for driver in case.drivers:
        turned = case.turning and driver is case.drivers[0]
        board.add_tmc2209(
            driver.name,
            driver.pin,
            rx=case.rx.get(driver.pin),
            address=driver.address,
            measured=case.measured,
            axis="X" if turned else None,
            diag=DIAG if turned else None,
            **case.options.get(driver.name, {}),
        )
    lines, ends, log = run_program(board, case, seed=len(name))
    assert len(lines) >= case.statements
    count = check_all(case, lines, ends, log)
    assert count.statements == len(lines)
    assert [fault for fault in case.faults if count.faults[fault] == 0] == []
    assert 0 < count.errors < count.statements / 4  # else little would have been checked


def test_a_stall_is_seen_on_both_ways(board: Emulator) -> None:
    """SG_RESULT falls and DIAG rises while something holds the motor; motion goes on."""
    case = CASES["in motion"]
    board.add_axis("X", 2, 3)
    board.add_tmc2209("D", 5, axis="X", diag=DIAG)
    for line in [*case.before, case.drivers[0].set_up(), *case.after]:
        assert "rror" not in board.command(line, timeout_ms=5000)
    board.run_ms(300)
    free = int(board.command("PRINT PEEK(TMC 0,SG)").split()[-1])
    assert free > 120
    assert board.level(DIAG) == 0
    board.tmc_fault("stall", at=board.axis("X") + 20, for_ms=100)
    board.run_ms(20)
    assert board.level(DIAG) == 1
    assert int(board.command("PRINT PEEK(TMC 0,SG)").split()[-1]) < 120
    board.run_ms(150)
    assert board.level(DIAG) == 0
    assert int(board.command("PRINT PEEK(TMC 0,SG)").split()[-1]) == free
    assert board.tmc_motor("D")["slips"] > 0
    assert "underruns: 0" in board.command("STEPPER STATUS")


@pytest.mark.parametrize("for_us", [450, 500, 550])
def test_a_line_that_was_held_is_idle_for_long_enough(board: Emulator, for_us: int) -> None:
    """A driver without power holds the line; the other one hears what is sent after that."""
    board.add_tmc2209("D", 5)
    board.add_tmc2209("E", 5, address=1)
    board.command("TMC22xx GP5,2209,0,800,30,16", timeout_ms=5000)
    board.command("TMC22xx MONITOR 0")
    board.run_ms(50)
    board.tmc_log()
    board.send("PRINT PEEK(TMC 0,IFCNT)\r")
    board.tmc_fault("unpowered", "E", for_ms=for_us / 1e3)
    assert int(board.until("\n> ").split()[-1]) == board.tmc("D")["IFCNT"]
    asked = [entry for entry in board.tmc_log() if entry.get("register") == 0x02]
    assert ["value" in entry for entry in asked] == [True]
