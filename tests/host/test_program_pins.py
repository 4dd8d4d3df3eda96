"""Pins of a BASIC program on the host, with events from outside: levels, voltages, the trace."""

from __future__ import annotations

import subprocess
from collections.abc import Iterable
from pathlib import Path

import pytest

STEPMITE = Path(__file__).parents[2] / "build" / "host" / "stepmite"


def run(
    folder: Path, program: str, events: Iterable[str] = (), *, code: int = 0
) -> tuple[list[str], list[tuple[int, int, int]]]:
    """Run a program with these input events; returns what it printed and the edges it made."""
    source, inputs, trace = (folder / name for name in ("p.bas", "in.csv", "edges.csv"))
    source.write_text(program)
    inputs.write_text("\n".join(events) + "\n")
    done = subprocess.run(
        [STEPMITE, "--virtual", "--inputs", inputs, "--trace", trace, source],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == code, done
    rows = [tuple(map(int, row.split(","))) for row in trace.read_text().splitlines()[1:]]
    return done.stdout.split("\n\n", 1)[-1].splitlines(), rows


def square(gpio: int, period_ns: int, count: int, start_ns: int = 0) -> list[str]:
    return [f"{start_ns + i * period_ns // 2},{gpio},{1 - i % 2}" for i in range(2 * count)]


def test_voltages_and_temperature(tmp_path: Path) -> None:
    program = """\
SETPIN GP26, AIN : SETPIN GP28, ARAW
PRINT PIN(GP26); PIN(GP28)
PAUSE 20
PRINT STR$(PIN(GP26), 0, 3); PIN(GP28)
PRINT STR$(PIN(TEMP), 0, 0)
OPTION VCC 3.0
PRINT STR$(PIN(GP26), 0, 3)
SETPIN GP26, DIN : PRINT PIN(GP26)
"""
    events = ["10000000,26,1.1V", "10000000,28,3.3V", "10000000,TEMP,47C"]
    printed, _ = run(tmp_path, program, events)
    assert printed == [" 0 0", "1.100 4095", "47", "1.000", " 0"]


def test_counters(tmp_path: Path) -> None:
    program = """\
SETPIN GP9, FIN, 100 : SETPIN GP10, PIN, 8 : SETPIN GP11, CIN : SETPIN GP12, CIN, 3
PRINT PIN(GP9); PIN(GP10); PIN(GP11); PIN(GP12)
PAUSE 300
PRINT PIN(GP9); PIN(GP10); PIN(GP11); PIN(GP12)
PAUSE 1000
PRINT PIN(GP9); PIN(GP11)
PIN(GP11) = 0 : PRINT PIN(GP11)
"""
    events = [
        *square(9, 20_000, 25_000, 1_000_000),
        *square(10, 125_000, 4000, 1_000_000),
        *square(11, 10_000_000, 20, 1_000_000),
        *square(12, 10_000_000, 20, 1_000_000),
    ]
    printed, _ = run(tmp_path, program, events)
    assert printed == [" 0 0 0 0", " 50000 0.125 20 40", " 0 20", " 0"]


INTERRUPTS = """\
SETPIN GP9, INTH, rising
SETPIN GP10, INTL, falling, PULLUP
SETPIN GP11, INTB, either
TIMER = 0
DO
LOOP UNTIL TIMER > 500
PRINT "end"; r; f; e
SUB rising : r = r + 1 : PRINT "rising" : END SUB
SUB falling : f = f + 1 : PRINT "falling" : END SUB
SUB either : e = e + 1 : PRINT "either"; PIN(GP11) : END SUB
"""


def test_interrupts_call_their_subs(tmp_path: Path) -> None:
    events = [
        *("100000000,9,1", "110000000,9,0", "120000000,9,1"),
        *("200000000,10,0", "210000000,10,1"),
        *("300000000,11,1", "310000000,11,0"),
    ]
    program = INTERRUPTS.replace(" : ", "\n")
    printed, _ = run(tmp_path, program, events)
    assert printed == ["rising", "rising", "falling", "either 1", "either 0", "end 2 1 2"]


def test_interrupts_are_served_while_waiting(tmp_path: Path) -> None:
    program = "SETPIN GP9, INTH, s\nPAUSE 100\nPRINT n\nSUB s\nn = n + 1\nEND SUB\n"
    printed, _ = run(tmp_path, program, square(9, 10_000_000, 5, 20_000_000))
    assert printed == [" 5"]


def test_interrupt_ends_with_the_use_of_the_pin(tmp_path: Path) -> None:
    program = """\
SETPIN GP9, INTH, s
PAUSE 35
SETPIN GP9, DIN
PAUSE 100
PRINT n
SETPIN GP9, INTB, s
SETPIN GP9, OFF
PAUSE 100
PRINT n
SUB s
n = n + 1
END SUB
"""
    printed, _ = run(tmp_path, program, square(9, 10_000_000, 25, 1_000_000))
    assert printed == [" 4", " 4"]


def test_ten_interrupts_and_no_more(tmp_path: Path) -> None:
    lines = [f"SETPIN GP{gpio}, INTH, s" for gpio in range(2, 12)]
    program = "\n".join([*lines, "SETPIN GP2, INTL, s", "SETPIN GP12, INTH, s", "SUB s", "END SUB"])
    printed, _ = run(tmp_path, program, code=1)
    assert printed[-1] == "Error : Too many pins with interrupts (at most 10)"


def test_pwm_edges_in_the_trace(tmp_path: Path) -> None:
    program = """\
SETPIN GP4, PWM2A : SETPIN GP5, PWM2B
PWM 2, 1000, 25, -50
PAUSE 10.4
PWM 2, OFF
PAUSE 5
"""
    _, edges = run(tmp_path, program)
    assert edges == sorted(edges, key=lambda row: row[0])
    a = [(time, level) for time, gpio, level in edges if gpio == 4]
    b = [(time, level) for time, gpio, level in edges if gpio == 5]
    begin = a[0][0]
    assert len(a) == 22
    assert [time - begin for time, level in a if level] == [i * 1_000_000 for i in range(11)]
    assert [time - begin for time, level in a if not level][:10] == [
        i * 1_000_000 + 250_000 for i in range(10)
    ]
    assert [(time - begin, level) for time, level in b][:3] == [
        (500_000, 1),
        (1_000_000, 0),
        (1_500_000, 1),
    ]
    assert a[-1][1] == b[-1][1] == 0
    assert max(time for time, _, _ in edges) - begin <= 10_500_000


def test_pwm_beside_motion_leaves_the_steps_as_they_are(tmp_path: Path) -> None:
    job = """\
STEPPER INIT
STEPPER AXIS X, GP2, GP3, , , 80, 6000, 500
STEPPER POSITION HOME
STEPPER GC G1 X10 F3000
{}
STEPPER RUN
DO : PAUSE 5 : LOOP UNTIL PEEK(STEPPER ACTIVE) = 0
"""
    pwm = "SETPIN GP8, PWM : PWM 4, 20000, 40 : SETPIN GP9, FIN, 10"
    pwm += " : SETPIN GP10, DOUT : PULSE GP10, 50"
    trains = []
    for folder, extra in (("plain", ""), ("busy", pwm)):
        (tmp_path / folder).mkdir()
        _, edges = run(tmp_path / folder, job.format(extra), square(9, 5000, 100_000))
        steps = [(time, gpio, level) for time, gpio, level in edges if gpio == 2]
        trains.append([(time - steps[0][0], gpio, level) for time, gpio, level in steps])
    assert trains[0] == trains[1]
    assert len(trains[0]) >= 1600


PROMPT = """\
SETPIN GP2, DOUT : PIN(GP2) = 1 : SETPIN GP6, PWM : PWM 3, 1000, 100
PRINT PIN(GP2)
RUN
PRINT PIN(GP2)
STEPPER INIT
STEPPER AXIS X, GP6, GP7
SETPIN GP2, DOUT
NEW
SETPIN GP6, DIN : PRINT "free"
"""


def test_run_and_new_put_back_what_is_the_programs(tmp_path: Path) -> None:
    flash = tmp_path / "flash.bin"
    typed = "AUTOSAVE\nPRINT 1\n\x1a" + PROMPT
    done = subprocess.run(
        [STEPMITE, "--virtual", "--flash", flash],
        input=typed,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    answers = [line for line in done.stdout.splitlines() if not line.startswith(">")]
    assert answers[-4:] == [
        " 1",
        "Error : Pin GP2 (pin 4) is not set up (use SETPIN)",
        "Stepper initialized, buffer 32",
        "free",
    ]


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("1,26,1.5A", "or a voltage, for instance 1.65V"),
        ("1,26,V", "or a voltage"),
        ("1,TEMP,1", "for instance 25.5C"),
        ("1,TEMPO,1C", "gpio must be 0 to 29 or TEMP"),
    ],
)
def test_bad_analog_events(tmp_path: Path, row: str, message: str) -> None:
    events = tmp_path / "events.csv"
    events.write_text(row + "\n")
    done = subprocess.run(
        [STEPMITE, "--inputs", events], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 2
    assert "events.csv:1: " in done.stderr
    assert message in done.stderr
