"""Bad and extreme input for the motion commands: each row has a defined answer and a live prompt.

Runs in the plain build and in the one with sanitizers, where a division by zero or an overflow ends
the program. Every row ends with a question whose answer is known and with the position.
"""

from __future__ import annotations

import re
import subprocess
from itertools import product
from pathlib import Path

import pytest

BUILD = Path(__file__).parents[2] / "build"
DEADLINE_S = 120.0  # wall time after which a row counts as hung

PINS = {"X": "GP2,GP3", "Y": "GP4,GP5", "Z": "GP6,GP7", "A": "GP8,GP9"}


def axis(name: str, scale: float = 80, speed: float = 6000, acceleration: float = 500) -> str:
    """One axis: steps/unit, units/min, units/s^2."""
    return f"STEPPER AXIS {name},{PINS[name]},,,{scale:.9g},{speed:.9g},{acceleration:.9g}"


MACHINE = ["STEPPER INIT ,64", *[axis(name) for name in PINS]]
START = ["STEPPER POSITION HOME", "STEPPER RUN"]
WAIT = "DO WHILE PEEK(STEPPER ACTIVE)=1: PAUSE 100: LOOP"


@pytest.fixture(scope="module", params=["host", "asan"])
def program(request: pytest.FixtureRequest) -> Path:
    path = BUILD / request.param / "stepmite"
    assert path.exists(), f"{path} is missing: make test builds it"
    return path


def talk(program: Path, lines: list[str]) -> str:
    """Type the lines at the prompt; returns all output. The program has to end by itself."""
    done = subprocess.run(
        [program, "--virtual"],
        input="\r".join([*lines, WAIT, "PRINT 6*7", "STEPPER STATUS", ""]),
        capture_output=True,
        text=True,
        timeout=DEADLINE_S,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    assert re.search(r"PRINT 6\*7\s+42\s", done.stdout), done.stdout[-1000:]
    assert "motion: IDLE" in done.stdout
    assert "underruns: 0" in done.stdout
    return done.stdout


def errors(output: str) -> list[str]:
    return re.findall(r"^Error : (.*?)\s*$", output, re.M)


def steps(output: str) -> list[int]:
    return [int(n) for n in re.findall(r"^[XYZA]: .*\((-?\d+) steps\)", output, re.M)]


REFUSED = {
    "G1 X1": "Feedrate not set",
    "G1 A5": "Feedrate not set",
    "G1 X1 F0": "F: 0 is invalid",
    "G1 X1 F-100": "F: -100 is invalid",
    "G1 X1 F0.0000001": "is invalid",
    "G1 Xnan F100": "Missing value for X",
    "G1 Xinf F100": "Missing value for X",
    "G1 X1e999 F100": "Unknown parameter E",
    "G1 X--1 F100": "Missing value for X",
    "G1 X+-1 F100": "Missing value for X",
    "G1 X. F100": "Missing value for X",
    "G1 X- F100": "Missing value for X",
    "G1 X F100": "Missing value for X",
    "G1 X1.2.3 F100": "",
    "G1 X1 X2 F100": "X given twice",
    "G1 X30000000 F100": "too far",
    "G1 X99999999999999999999999999 F100": "too far",
    "G2 X10 F500": "centre",
    "G2 Z5 F500": "centre",
    "G2 I2 F0": "F: 0 is invalid",
    "G2 X10 R1 F500": "R is less than half the way",
    "G2 X10 R-1 F500": "R is less than half the way",
    "G2 X0 Y0 R1 F500": "end elsewhere",
    "G2 R0 X1 F500": "no radius",
    "G3 X10 I0 J0 F500": "no radius",
    "G2 I0.0005 F500": "no radius",
    "G2 I1e5 F500": "Unknown parameter E",
    "G2 I100000000 F500": "too large",
    "G3 X10 I2 F500": "off the arc",
    "G3 X1 I1 R1 F500": "either",
    "G3 I2 P0 F500": "P: 0 is invalid",
    "G3 I2 P1.5 F500": "P: 1.5 is invalid",
    "G3 I2 P-1 F500": "P: -1 is invalid",
    "G18 G2 X5 J2 F500": "not in the plane",
    "G61 P1": "Nothing in this line uses P",
    "G64 P-1": "P: -1 is invalid",
    "G61 G64": "",
    "G17 G18": "",
    "G2 G3 X1 I1 F100": "",
    "G4": "requires P",
    "G4 P-1": "P: -1 is invalid",
    "G1.5 X1 F100": "Unsupported code",
}


@pytest.mark.parametrize("line", REFUSED)
def test_refused_gcode_moves_nothing(program: Path, line: str) -> None:
    output = talk(program, [*MACHINE, *START, f"STEPPER GC {line}"])
    assert len(errors(output)) == 1, output
    assert REFUSED[line] in errors(output)[0]
    assert steps(output) == [0, 0, 0, 0]
    assert "executed: 0" in output


REFUSED_COMMANDS = {
    "STEPPER JERK 0": "value: 0 is invalid",
    "STEPPER JERK -1": "value: -1 is invalid",
    "STEPPER JERK 1000,-1": "x: -1 is invalid",
    "STEPPER JERK 0/0": "Divide by zero",
    "STEPPER SCURVE 2": "on: 2 is invalid",
    "STEPPER JUNCTION -1": "deviation_mm: -1 is invalid",
    "STEPPER OVERRIDE FEED,0": "percent: 0 is invalid",
    "STEPPER OVERRIDE FEED,201": "percent: 201 is invalid",
    "STEPPER OVERRIDE RAPID,101": "percent: 101 is invalid",
    "STEPPER JOG X,+,0": "feed: 0 is invalid",
    "STEPPER JOG X,1,-1": "feed: -1 is invalid",
    "STEPPER JOG W,1": "axis: W is invalid",
    axis("X", scale=0): "steps_per_unit: 0 is invalid",
    axis("X", speed=0): "max_vel: 0 is invalid",
    axis("X", acceleration=0): "max_accel: 0 is invalid",
    axis("X", acceleration=-1): "max_accel: -1 is invalid",
    "STEPPER GCODE G1,X,1/0,F,100": "Divide by zero",
    "STEPPER GCODE G1,X,LOG(0),F,100": "",
}


@pytest.mark.parametrize("line", REFUSED_COMMANDS)
def test_refused_command_changes_nothing(program: Path, line: str) -> None:
    output = talk(program, [*MACHINE, *START, line, "STEPPER GC G1 X1 F600"])
    assert len(errors(output)) == 1, output
    assert REFUSED_COMMANDS[line] in errors(output)[0]
    assert steps(output) == [80, 0, 0, 0]


# What is accepted although it is nothing, or nearly: lines, and the steps at the end.
ACCEPTED = {
    "nowhere": (["G1 X0 F100"], [0, 0, 0, 0]),
    "nowhere, relative": (["G91", "G1 X0 Y0 Z0 A0 F100"] * 3, [0, 0, 0, 0]),
    "nowhere, rapid": (["G0 X0"], [0, 0, 0, 0]),
    "nowhere, between moves": (["G1 X1 F600", "X1", "X1 Y0", "X2"], [160, 0, 0, 0]),
    "less than half a step": (["G1 X0.006 F100"], [0, 0, 0, 0]),
    "one step": (["G1 X0.0125 F100"], [1, 0, 0, 0]),
    "one step of A": (["G1 A0.0125 F100"], [0, 0, 0, 1]),
    "one step and a long way": (["G1 X0.0125 Y100 F6000"], [1, 8000, 0, 0]),
    "one step to and fro": (["G91", *["G1 X0.0125 F6000", "X-0.0125"] * 20], [0, 0, 0, 0]),
    "slowest feed": (["G1 X0.0125 F0.01"], [1, 0, 0, 0]),
    "fastest feed": (["G1 X10 F999999999"], [800, 0, 0, 0]),
    "dwell of nothing": (["G4 P0"] * 5, [0, 0, 0, 0]),
    "back the same way": (["G1 X5 F6000", "X0", "X5", "X0"], [0, 0, 0, 0]),
    "tiny arc": (["G2 I0.003 F500"], [0, 0, 0, 0]),
    "tiny arc of A": (["G2 I0.003 A1 F500"], [0, 0, 0, 80]),
    "arc of one step": (["G2 X0.0125 I0.00625 F500"], [1, 0, 0, 0]),
    "huge radius": (["G2 X1 R100000 F500"], [80, 0, 0, 0]),
    "circle, many turns": (["G3 I1 P100 F6000"], [0, 0, 0, 0]),
    "helix": (["G3 I1 Z-1 P3 F600"], [0, 0, -80, 0]),
    "blend of nothing": (["G64 P0", "G1 X5 F6000", "Y5"], [400, 400, 0, 0]),
    "blend larger than the moves": (["G64 P1000", "G1 X1 F6000", "Y1", "X0", "Y0"], [0, 0, 0, 0]),
    "blend back the same way": (["G64 P1", "G1 X1 F6000", "X0", "X1"], [80, 0, 0, 0]),
    "exact stops": (["G61.1", "G1 X1 F6000", "X2", "X3"], [240, 0, 0, 0]),
}


@pytest.mark.parametrize("scurve", [0, 1])
@pytest.mark.parametrize("name", ACCEPTED)
def test_accepted_gcode_ends_exactly(program: Path, name: str, scurve: int) -> None:
    lines, expected = ACCEPTED[name]
    commands = [f"STEPPER GC {line}" for line in lines]
    output = talk(program, [*MACHINE, f"STEPPER SCURVE {scurve}", *START, *commands])
    assert errors(output) == []
    assert steps(output) == expected


@pytest.mark.parametrize("jerk", [0, 0.001, 1, 1e9])
@pytest.mark.parametrize("acceleration", [1, 100, 100_000])
@pytest.mark.parametrize("scale", [0.01, 1, 10_000])
def test_machines_of_all_kinds(
    program: Path, scale: float, acceleration: float, jerk: float
) -> None:
    """One step, and some, there and back, on two axes; jerk 0 is the trapezoid."""
    limits = ["STEPPER SCURVE 0"] if jerk == 0 else ["STEPPER SCURVE 1", f"STEPPER JERK {jerk:.9f}"]
    machine = [axis(name, scale, min(50_000 * 60 / scale, 1e7), acceleration) for name in PINS]
    one, some = 1 / scale, min(20 / scale, 1.0) if jerk in (0.001, 1) else 20 / scale
    some = max(round(some * scale), 1) / scale
    lines = [f"G1 X{one:.6f} F1000000", f"Y{some:.6f} X{2 * one:.6f}", f"G0 X0 Y{one:.6f}"]
    commands = [f"STEPPER GC {line}" for line in lines]
    output = talk(program, ["STEPPER INIT", *machine, *limits, *START, *commands])
    assert errors(output) == []
    assert steps(output) == [0, 1, 0, 0]


@pytest.mark.parametrize(("scale", "scurve"), list(product([0.01, 80.0, 2000.0], [0, 1])))
def test_moves_of_ten_metres(program: Path, scale: float, scurve: int) -> None:
    machine = [axis(name, scale, 10_000 * 60, 5000) for name in PINS]
    commands = ["STEPPER GC G0 X10000 Y-10000", "STEPPER GC G1 X0 Y0 Z10000 F1000000"]
    output = talk(
        program, ["STEPPER INIT", *machine, f"STEPPER SCURVE {scurve}", *START, *commands]
    )
    assert errors(output) == []
    assert steps(output) == [0, 0, round(10_000 * scale), 0]


@pytest.mark.parametrize("scurve", [0, 1])
def test_ten_metres_at_ten_thousand_steps_per_mm(scurve: int) -> None:
    """A hundred million steps at 50 kHz; half an hour of motion, so in the plain build only."""
    commands = [axis("X", 10_000, 6000, 1000), f"STEPPER SCURVE {scurve}", *START]
    output = talk(BUILD / "host" / "stepmite", ["STEPPER INIT", *commands, "STEPPER GC G0 X10000"])
    assert errors(output) == []
    assert steps(output) == [100_000_000]
