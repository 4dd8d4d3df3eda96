"""Thousands of accesses to two drivers on one wire, whose faults come and go at random times.

What the drivers themselves have noted is the judge: a value that is printed was answered to this
statement, a write that is reported as done is in the register, and nothing fails while all is well.
"""

from __future__ import annotations

import random
import re
from dataclasses import dataclass
from pathlib import Path

import pytest
from simulated_drivers import Driver, Report
from typed import program

ROUNDS = 900
"""Of four accesses."""
WIRE_FAULTS = ["silent", "deaf", "unplugged", "bad-crc", "late", "garbled"]
RESETS = ["brown-out:0", "unpowered"]
HARMLESS = ["over-temperature:130", "open-load"]
RECOVERY_MS = 60
"""Behind a fault: what was under way may fail, and late answers are still to come."""

PROGRAM = f"""\
FOR d = 0 TO 1
  TMC22xx 26, 2209, d, 800, 30, 16
NEXT
TMC22xx MONITOR 0
FOR i = 1 TO {ROUNDS}
  FOR d = 0 TO 1
    began = TIMER
    ON ERROR SKIP
    v = PEEK(TMC d, IFCNT)
    told "R"
    v = (i * 7 + d) MOD 256
    began = TIMER
    ON ERROR SKIP
    TMC22xx SGTHRS d, v
    told "W"
    IF lost THEN
      ON ERROR SKIP
      TMC22xx 26, 2209, d, 800, 30, 16
      lost = 0
      PAUSE 5
    ENDIF
  NEXT
NEXT

SUB told op$
  LOCAL said$ = ""
  IF MM.ERRNO THEN said$ = MM.ERRMSG$
  IF INSTR(said$, "lost its settings") THEN lost = 1
  PRINT op$; " "; STR$(d); " "; STR$(began); " "; STR$(TIMER); " "; STR$(v); " "; said$
END SUB
"""


@dataclass(frozen=True)
class Access:
    """A statement of the program."""

    is_write: bool
    driver: int
    began_ms: float
    ended_ms: float
    value: float
    error: str


@dataclass(frozen=True)
class Trouble:
    """A fault of a driver, from one time to another (ms)."""

    name: str
    driver: int
    from_ms: int
    to_ms: int

    def overlaps(self, access: Access) -> bool:
        return access.began_ms < self.to_ms + RECOVERY_MS and access.ended_ms > self.from_ms

    def word(self) -> str:
        return f"{self.name}@{self.from_ms}-{self.to_ms}"

    def explains(self, access: Access) -> bool:
        """A wire without supply is everybody's; what a driver has lost, it lacks until told."""
        if self.name in RESETS and self.driver == access.driver:
            return access.ended_ms > self.from_ms
        mine = self.driver == access.driver or self.name == "unpowered"
        return mine and self.name not in HARMLESS and self.overlaps(access)


def some_trouble(seed: int) -> list[Trouble]:
    chance = random.Random(seed)
    names = [*WIRE_FAULTS, *HARMLESS, *RESETS]
    chance.shuffle(names)
    troubles, at_ms = [], 150
    for name in names:
        length_ms = (
            chance.randrange(300, 1500) if name in WIRE_FAULTS else chance.randrange(20, 200)
        )
        troubles.append(Trouble(name, chance.randrange(2), at_ms, at_ms + length_ms))
        at_ms += length_ms + chance.randrange(0, 300)
    return troubles


def accesses_of(output: str) -> list[Access]:
    found = re.findall(r"^([RW]) (\d) ([\d.e+]+) ([\d.e+]+) (\S+) (.*)$", output, re.MULTILINE)
    return [
        Access(op == "W", int(d), float(began), float(ended), float(value), error)
        for op, d, began, ended, value, error in found
    ]


def check_reads(accesses: list[Access], report: Report) -> None:
    for driver in range(2):
        answers = report.told("read", driver, "IFCNT")
        for access in accesses:
            if access.is_write or access.error or access.driver != driver:
                continue
            mine = [
                event["value"]
                for event in answers
                if access.began_ms - 0.1 <= event["ms"] <= access.ended_ms + 0.1
            ]
            assert access.value in mine, access


def check_writes(accesses: list[Access], report: Report) -> None:
    for driver in range(2):
        writes = report.told("write", driver, "SGTHRS")
        for access in accesses:
            if not access.is_write or access.error or access.driver != driver:
                continue
            before = [event for event in writes if event["ms"] <= access.ended_ms + 0.1]
            assert before[-1]["value"] == access.value, access
            assert before[-1]["ms"] >= access.began_ms - 0.1, access


@pytest.mark.parametrize("seed", range(8))
def test_nothing_is_mistaken(seed: int, tmp_path: Path) -> None:
    troubles = some_trouble(seed)
    drivers = [
        Driver(address=i, faults=tuple(t.word() for t in troubles if t.driver == i))
        for i in range(2)
    ]
    session = program(tmp_path, PROGRAM, drivers=drivers)
    accesses = accesses_of(session.output)
    assert len(accesses) == 4 * ROUNDS, session.output[-2000:]
    check_reads(accesses, session.report)
    check_writes(accesses, session.report)
    for access in accesses:
        if access.error:
            assert any(trouble.explains(access) for trouble in troubles), access
    assert accesses[-1].ended_ms > troubles[-1].to_ms + RECOVERY_MS
    assert not any(access.error for access in accesses[-8:])
    failed = [access for access in accesses if access.error]
    assert 10 < len(failed) < len(accesses) / 2
