"""The oracle for TMC drivers finds what it is there for: each planted mistake is told."""

from collections.abc import Callable
from typing import Any

import pytest
from tmc_oracle import GSTAT, IFCNT, KEPT, Driver, Entry, Oracle, Said, Statement

DRIVER = Driver("D", 5, 0)
REGISTER = 0x6A
STATEMENTS = [Statement(0, REGISTER), Statement(0, KEPT, True, 0xFFFFF)]
BIT_NS = 8680.0


def frame(kind: str, register: int, **more: Any) -> Entry:
    """A datagram to the driver that was answered or taken as it should."""
    return {"tx": 5, "address": 0, "bit_ns": BIT_NS, "kind": kind, "register": register, **more}


def read(register: int, value: int, **more: Any) -> Entry:
    return frame("read", register, value=value, bytes=[5, 0, register, 0], **more)


def write(register: int, sent: int, **more: Any) -> Entry:
    return frame("write", register, sent=sent, bytes=[0] * 8, ifcnt=1, **more)


def fault(name: str) -> Entry:
    return {"kind": "fault", "fault": name, "driver": "D", "until_ns": 1e15, "tx": 5}


def in_time(entries: list[Entry], begin_ns: float) -> list[Entry]:
    """The entries one after the other; answers come soon behind their requests."""
    for place, entry in enumerate(entries):
        entry["time_ns"] = begin_ns + place * 2e6
        if "value" in entry and entry.get("fault") != "silent":
            entry.setdefault("reply_ns", entry["time_ns"] + 60 * BIT_NS)
    return entries


def reading(value: int = 0x123) -> tuple[Said, list[Entry]]:
    return Said(0, value, None), [read(REGISTER, 0x123), read(GSTAT, 0)]


def writing(value: int = 0x55) -> tuple[Said, list[Entry]]:
    entries = [read(IFCNT, 0), write(KEPT, 0x55), read(IFCNT, 1), read(GSTAT, 0)]
    return Said(1, value, None), entries


def check(*statements: tuple[Said, list[Entry]]) -> None:
    oracle = Oracle([DRIVER], STATEMENTS)
    for number, (line, entries) in enumerate(statements):
        begin_ns = number * 1e9
        oracle.check(line, in_time(entries, begin_ns), begin_ns + 9e8)


def test_what_is_right_passes() -> None:
    repeated = [read(REGISTER, 0x99, fault="silent"), read(REGISTER, 0x123), read(GSTAT, 0)]
    check(reading(), writing(), (Said(0, 0x123, None), repeated))
    check((Said(0, None, "No answer"), [read(REGISTER, 1, fault="silent")]))
    again = [write(KEPT, 0x55), write(KEPT, 0)]
    check((Said(1, None, "No answer"), [fault("silent"), *again]))


def stale() -> tuple[Said, list[Entry]]:
    """The value of the first answer, which came late, is taken for that of the second."""
    entries = [read(REGISTER, 0x99, fault="late"), read(REGISTER, 0x123), read(GSTAT, 0)]
    return Said(0, 0x99, None), entries


def spoilt() -> tuple[Said, list[Entry]]:
    line, entries = reading()
    entries[0]["fault"] = "bad-crc"
    return line, entries


def not_taken() -> tuple[Said, list[Entry]]:
    line, entries = writing()
    del entries[1]["ifcnt"]
    return line, entries


def taken_for_another() -> tuple[Said, list[Entry]]:
    line, entries = writing()
    entries[1]["mistook"] = [5, 0, 0x93, 0, 0, 0, 0x54, 0]
    return line, entries


def not_looked_behind() -> tuple[Said, list[Entry]]:
    line, entries = writing()
    return line, entries[:-1]


def lost() -> tuple[Said, list[Entry]]:
    line, entries = writing()
    entries[3] = read(GSTAT, 1)
    return line, entries


def not_restored() -> tuple[Said, list[Entry]]:
    return Said(1, None, "No answer"), [fault("silent"), write(KEPT, 0x55)]


def to_another() -> tuple[Said, list[Entry]]:
    line, entries = reading()
    entries[0]["address"] = 1
    return line, entries


MISTAKES: list[tuple[str, Callable[[], tuple[Said, list[Entry]]]]] = [
    ("mistaken", lambda: reading(0x124)),
    ("mistaken", stale),
    ("no answer to the last", spoilt),
    ("another value", lambda: writing(0x56)),
    ("not taken", not_taken),
    ("not taken", taken_for_another),
    ("GSTAT was not read", lambda: (writing()[0], writing()[1][:3])),
    ("GSTAT was not read", not_looked_behind),
    ("a reset was not told", lost),
    ("not as before", not_restored),
    ("another driver", to_another),
    ("nothing was wrong", lambda: (Said(0, None, "No answer"), reading()[1])),
    ("repeated for nothing", lambda: (reading()[0], [*reading()[1], *reading()[1]])),
]


@pytest.mark.parametrize(("told", "mistake"), MISTAKES)
def test_what_is_wrong_is_told(told: str, mistake: Callable[[], tuple[Said, list[Entry]]]) -> None:
    check(reading())
    with pytest.raises(AssertionError, match=told):
        check(reading(), mistake())


def test_a_reset_that_nobody_tells_of() -> None:
    seen = (Said(0, 0x123, None), [read(REGISTER, 0x123), read(GSTAT, 1)])
    notice = "TMC2209 at address 0 on GP5 (pin 7) has lost its settings (was its power off?)"
    others = [reading() for _ in range(6)]
    with pytest.raises(AssertionError, match="was not told"):
        check(seen, *others)
    check(seen, (Said(0, 0x123, None, (notice,)), reading()[1]), *(reading() for _ in range(6)))
