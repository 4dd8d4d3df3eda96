"""What a program said about its TMC drivers against the log of the model: nothing may be mistaken.

The program (see `program`) carries out statements, toggles a pin behind each and prints a line for
it, so each statement has its own part of the log. The rules:

* a value that was read is the one the driver sent last, in an answer that was whole;
* a write that is said to be done was taken by the driver, with this value, and after that the
  driver said that it has not lost its settings;
* a write that failed has left a kept register as it was, unless the error says that it may not;
* a driver that says that it was reset is told of, by an error or a notice;
* nothing is repeated and no statement fails unless something was wrong.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

Entry = dict[str, Any]

MARK_GPIO = 22
"""Toggled behind each statement."""

GSTAT, IFCNT = 0x01, 0x02
SETUP_REGISTERS = (0x00, 0x10, 0x11, 0x6C, 0x70)
REPLY_LATEST_BITS = 128 + 32
"""Behind the request; the firmware waits for a little longer than the longest SENDDELAY."""
SPOILS = ("silent", "deaf", "bad-crc")
"""Faults after which there is no whole answer. Noise or a cut near its end may leave one."""


@dataclass(frozen=True)
class Driver:
    """A driver as the program sets it up."""

    name: str
    pin: int
    address: int
    chip: int = 2209

    def set_up(self) -> str:
        return f"TMC22xx GP{self.pin},{self.chip},{self.address},800,30,16"


@dataclass(frozen=True)
class Statement:
    """A read (`text` is an expression) or a write of the value of `r`."""

    driver: int
    register: int
    write: bool = False
    mask: int = 0

    def line(self, number: int, drivers: list[Driver]) -> str:
        driver = drivers[self.driver]
        head = f"k={number}:d={self.driver}:"
        if self.write:
            value = f"r=(n*2654435+{number}) AND {self.mask}"
            return (
                f"{head}{value}:TMC22xx WRITE {driver.address},{self.register},r,GP{driver.pin}:o"
            )
        return f"{head}r=PEEK(TMC {driver.address},{self.register},GP{driver.pin}):o"


def program(
    drivers: list[Driver], before: list[str], after: list[str], statements: list[Statement]
) -> str:
    """Repeat the statements for ever; a driver that has lost its settings is set up again.

    `before`, `after`: lines before and behind the first set-up.
    """
    lines = [
        "DIM INTEGER n,k,d,r,t,l",
        f"SETPIN GP{MARK_GPIO},DOUT",
        "TMC22xx MONITOR 0",
        *before,
        *(driver.set_up() for driver in drivers),
        *after,
        'PRINT "begin"',
        "PAUSE 20",
        "ON ERROR IGNORE",
        "DO",
        "n=n+1",
        *(statement.line(number, drivers) for number, statement in enumerate(statements)),
        "LOOP",
        "SUB o",
        "IF MM.ERRNO THEN",
        'l=INSTR(MM.ERRMSG$,"lost its settings")',
        'PRINT k;"!";MM.ERRMSG$',
        "ON ERROR CLEAR",
        "ELSE",
        'PRINT k;"=";HEX$(r)',
        "ENDIF",
        f"t=1-t:PIN(GP{MARK_GPIO})=t",
        "IF l THEN",
        "l=0:k=100+d:r=0",
        *(f"IF d={i} THEN {driver.set_up()}" for i, driver in enumerate(drivers)),
        "o",
        "ENDIF",
        "END SUB",
    ]
    return "\n".join(lines) + "\n"


PROBES = (0x00, 0x06, 0x6C, 0x70)
"""Registers that the firmware also reads to see whether a late answer is outstanding."""

KEPT = 0x13
"""A register that the firmware restores when writing it fails: TPWMTHRS."""

LINE = re.compile(r"^ ?(\d+)(?:=([0-9A-F]+)|!(.*))$")


@dataclass(frozen=True)
class Said:
    """A line of the program: a value, or an error."""

    number: int
    value: int | None
    error: str | None
    notices: tuple[str, ...] = ()
    """That stood before it."""


def said(text: str) -> list[Said]:
    """The complete lines of what the program has printed, with notices of the firmware."""
    lines: list[Said] = []
    notices: list[str] = []
    for line in text.replace("\r", "").split("\n")[:-1]:
        match = LINE.match(line)
        if match is None:
            assert line == "" or line.startswith("TMC2209 at address"), f"what is {line!r}?"
            notices.append(line)
            continue
        value = int(match[2], 16) if match[2] is not None else None
        lines.append(Said(int(match[1]), value, match[3], tuple(notices)))
        notices = []
    return lines


@dataclass
class Count:
    """What was met."""

    reads: int = 0
    writes: int = 0
    set_ups: int = 0
    errors: int = 0
    datagrams: int = 0
    faults: Counter[str] = field(default_factory=Counter)
    """Exchanges that were spoilt by a fault, and faults that began, by name."""

    @property
    def statements(self) -> int:
        return self.reads + self.writes + self.set_ups + self.errors


def taken(entry: Entry) -> bool:
    """The driver has understood the datagram and acted on it."""
    return ("value" in entry or "ifcnt" in entry) and "mistook" not in entry


def answered(entry: Entry) -> bool:
    """A whole answer was sent, early enough; noise may have spoilt it or not."""
    if "value" not in entry or entry.get("fault") in SPOILS or "reply_ns" not in entry:
        return False
    end_ns = entry["time_ns"] + 10 * len(entry["bytes"]) * entry["bit_ns"]
    return bool(entry["reply_ns"] - end_ns <= REPLY_LATEST_BITS * entry["bit_ns"])


def is_wrong(entry: Entry) -> bool:
    """Something was wrong in this exchange."""
    return "fault" in entry or not taken(entry)


def was_reset(frames: list[Entry]) -> bool:
    """The driver has said that it was reset."""
    return any(e["register"] == GSTAT and answered(e) and e["value"] & 1 for e in frames)


def same_line(entry: Entry, driver: Driver) -> bool:
    return entry.get("tx") == driver.pin and entry.get("address") == driver.address


class Oracle:
    """Checks one statement after the other; `check` raises AssertionError if one is wrong."""

    def __init__(self, drivers: list[Driver], statements: list[Statement]) -> None:
        self.drivers = drivers
        self.statements = statements
        self.count = Count()
        self.held_until_ns = 0.0
        """A wire is without plug or power until then."""
        self.disturbed = False
        """Something other than the driver itself may have spoilt any exchange of the statement."""
        self.since_ns = 0.0
        """End of the last statement."""
        self.believed = {driver.name: 0 for driver in drivers}
        """What the firmware believes to be in KEPT."""
        self.held = dict(self.believed)
        """What is there."""
        self.changed: set[str] = set()
        """Drivers whose settings may be partly changed, as the firmware has said."""
        self.lost: set[str] = set()
        """Drivers that were reset and have not been set up since."""
        self.told: set[str] = set()
        """Those of them that the user knows of."""
        self.untold: dict[str, int] = {}
        """Drivers that have said that they were reset: statements since then."""

    def check(self, line: Said, entries: list[Entry], end_ns: float) -> None:
        """`entries`: those that began before the statement's end and after the one before."""
        context = f"{line}, {entries}"
        driver = self.drivers[line.number - 100 if line.number >= 100 else self.of(line).driver]
        faults = [entry for entry in entries if entry["kind"] == "fault"]
        frames = [entry for entry in entries if entry["kind"] != "fault"]
        assert all("error" not in entry for entry in frames), f"no datagram: {context}"
        others = [entry for entry in frames if not same_line(entry, driver)]
        # Who does not answer to a set-up is looked for at the other addresses of the wire.
        looks = line.number >= 100 and line.error is not None
        reads = all(e["tx"] == driver.pin and e["kind"] == "read" for e in others)
        assert others == [] or (looks and reads), f"another driver: {context}"
        self.note(faults, frames)
        wrong = self.was_wrong(faults, frames)
        self.since_ns = end_ns
        self.follow(driver, line, faults, frames)
        if line.error is not None:
            self.count.errors += 1
            lost = "lost" in line.error and driver.name in self.lost
            assert wrong or lost, f"nothing was wrong: {context}"
            if "partly" in line.error:
                self.changed.add(driver.name)
            assert driver.name in self.changed or self.is_kept(driver), f"not as before: {context}"
            return
        self.check_repeats(frames, wrong, context)
        if line.number >= 100:
            self.check_set_up(frames, context)
        elif self.of(line).write:
            self.check_write(line, frames, context)
        else:
            self.check_read(line, frames, context)
            return
        self.changed.discard(driver.name)
        assert self.is_kept(driver), f"a register was forgotten: {context}"

    def of(self, line: Said) -> Statement:
        return self.statements[line.number]

    def note(self, faults: list[Entry], frames: list[Entry]) -> None:
        self.count.datagrams += len(frames)
        for entry in faults:
            self.count.faults[entry["fault"]] += 1
            if entry["fault"] in ("unplugged", "unpowered"):
                self.held_until_ns = max(self.held_until_ns, entry["until_ns"])
        self.count.faults.update(f"{e['fault']} exchange" for e in frames if "fault" in e)

    def follow(self, driver: Driver, line: Said, faults: list[Entry], frames: list[Entry]) -> None:
        """Keep track of the kept register, and of drivers whose reset is still to be told."""
        entries = sorted([*faults, *frames], key=lambda entry: entry["time_ns"])
        is_set_up = line.number >= 100 and line.error is None
        for entry in entries:
            if entry.get("fault") in ("brown-out", "unpowered") and entry["kind"] == "fault":
                self.held[entry["driver"]] = 0
                self.lost.add(entry["driver"])
            elif entry["kind"] == "read" and entry["register"] == GSTAT and is_set_up:
                self.lost.discard(driver.name)  # until then it was not reset; behind it it may be
            elif entry.get("register") == KEPT and "sent" in entry and taken(entry):
                self.held[driver.name] = entry["sent"]
        is_write = line.number < 100 and self.of(line).write
        if line.error is None and is_write and self.of(line).register == KEPT:
            self.believed[driver.name] = line.value or 0
        self.follow_resets(driver, line, frames)
        if is_set_up:
            self.told.discard(driver.name)
            self.untold.pop(driver.name, None)

    def is_kept(self, driver: Driver) -> bool:
        """The kept register holds what the firmware believes, or was lost."""
        return driver.name in self.lost or self.held[driver.name] == self.believed[driver.name]

    def follow_resets(self, driver: Driver, line: Said, frames: list[Entry]) -> None:
        for notice in line.notices:
            where = re.match(r"TMC2209 at address (\d) on GP(\d+) .* has lost", notice)
            told = where and (int(where[1]), int(where[2]))
            self.told |= {d.name for d in self.drivers if (d.address, d.pin) == told}
        whole = [] if self.disturbed else [entry for entry in frames if "fault" not in entry]
        if was_reset(whole) and driver.name not in self.told:
            self.untold.setdefault(driver.name, 0)
        if line.error is not None and "lost" in line.error:
            self.told.add(driver.name)
        self.untold = {name: age for name, age in self.untold.items() if name not in self.told}
        for name in self.untold:
            self.untold[name] += 1
            assert self.untold[name] < 5, f"the reset of {name} was not told: {line}"

    def was_wrong(self, faults: list[Entry], frames: list[Entry]) -> bool:
        self.disturbed = bool(faults) or self.since_ns < self.held_until_ns
        return self.disturbed or was_reset(frames) or any(map(is_wrong, frames))

    def check_repeats(self, frames: list[Entry], wrong: bool, context: str) -> None:
        """Without a fault nothing is asked twice, but IFCNT at writes, GSTAT before and after."""
        if wrong:
            return
        often = Counter((e["kind"], e["register"]) for e in frames if e["register"] != IFCNT)
        often["read", GSTAT] -= 1
        assert all(count <= 1 for count in often.values()), f"repeated for nothing: {context}"

    def check_kept(self, frames: list[Entry], behind: Entry, context: str) -> None:
        """After its last access the driver has said that it was not reset."""
        asked = [e for e in frames if e["register"] == GSTAT and e["kind"] == "read"]
        assert asked, f"GSTAT was not read: {context}"
        assert answered(asked[-1]), f"GSTAT was not answered: {context}"
        assert asked[-1]["value"] & 1 == 0, f"a reset was not told: {context}"
        assert asked[-1]["time_ns"] > behind["time_ns"], f"GSTAT was read before: {context}"

    def check_read(self, line: Said, frames: list[Entry], context: str) -> None:
        self.count.reads += 1
        register = self.of(line).register
        reads = [e for e in frames if e["kind"] == "read" and e["register"] == register]
        assert reads, f"nothing was read: {context}"
        if register in PROBES:
            values = [e["value"] for e in reads if answered(e)]
            assert line.value in values, f"mistaken: {context}"
            return
        assert answered(reads[-1]), f"no answer to the last request: {context}"
        assert reads[-1]["value"] == line.value, f"mistaken: {context}"
        needed = self.disturbed or all(map(is_wrong, reads[:-1]))
        assert needed, f"repeated for nothing: {context}"

    def check_write(self, line: Said, frames: list[Entry], context: str) -> None:
        self.count.writes += 1
        register = self.of(line).register
        writes = [e for e in frames if e["kind"] == "write" and e["register"] == register]
        assert writes, f"nothing was written: {context}"
        assert writes[-1]["sent"] == line.value, f"another value: {context}"
        assert taken(writes[-1]), f"not taken: {context}"
        self.check_kept(frames, writes[-1], context)

    def check_set_up(self, frames: list[Entry], context: str) -> None:
        self.count.set_ups += 1
        writes = [e for e in frames if e["kind"] == "write"]
        last = {e["register"]: e for e in writes}
        assert all(register in last and taken(last[register]) for register in SETUP_REGISTERS), (
            f"not set up: {context}"
        )
        self.check_kept(frames, writes[-1], context)
