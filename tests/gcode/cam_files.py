"""G-code files in the style of the posts of CAM programs, and what is needed to carry them out.

Each was written for these tests; together they have every code that such posts emit.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from stepmite.gcode import Block, Reader, read_blocks, read_lines
from stepmite.plan import Machine

FILES = sorted((Path(__file__).parent / "files").glob("*.nc"))

SCALE = (80.0, 80.0, 400.0, 10.0)
"""Steps per mm and degree."""
VELOCITY = (12000.0, 12000.0, 4800.0, 36000.0)
"""Per minute."""
ACCELERATION = (3000.0, 2500.0, 1000.0, 4000.0)
STEP, DIR = (2, 4, 6, 8), (3, 5, 7, 9)
SPINDLE, SPINDLE_DIR, FLOOD, MIST = 10, 11, 12, 13
SPINDLE_RPM, SPINUP_S = 30000.0, 0.2

MACHINE = Machine(
    tuple(v / 60 for v in VELOCITY),  # type: ignore[arg-type]
    ACCELERATION,
)

SETUP = [
    "STEPPER INIT ,64",
    *(
        f"STEPPER AXIS {letter},GP{step},GP{direction},,,{scale},{velocity},{acceleration}"
        for letter, step, direction, scale, velocity, acceleration in zip(
            "XYZA", STEP, DIR, SCALE, VELOCITY, ACCELERATION, strict=True
        )
    ),
    f"STEPPER SPINDLE GP{SPINDLE},,{SPINDLE_RPM},,,{SPINUP_S * 1000},GP{SPINDLE_DIR}",
    f"STEPPER COOLANT GP{FLOOD},GP{MIST}",
    "STEPPER POSITION HOME",
]

# A pause for the user lasts a few milliseconds here.
PROGRAM = """\
{setup}
STEPPER CHECK "part.nc"
STEPPER RUN
PAUSE 2
TIMER = 0
STEPPER FILE "part.nc"
DO
  PAUSE 2
  IF PEEK(STEPPER EVENT) = 8 THEN STEPPER RESUME
LOOP WHILE PEEK(STEPPER ACTIVE) = 1
PRINT "Taken"; TIMER
STEPPER STATUS
"""


def is_nist(path: Path) -> bool:
    """Tell whether the file's G28 goes to a stored place: without switches nothing can be homed."""
    return path.stem == "fusion_pocket"


def program(path: Path, *settings: str) -> str:
    """Return the BASIC program that checks and runs the file of this name on A:."""
    lines = [*SETUP, *settings]
    if is_nist(path):
        lines += ["STEPPER DIALECT NIST", "STEPPER GC G28.1"]
    return PROGRAM.format(setup="\n".join(lines))


def blocks_of(path: Path) -> tuple[list[Block], Reader]:
    """Return what the reader on the PC makes of the file, and the state it is left in."""
    reader = Reader(nist=is_nist(path))
    return list(read_blocks(read_lines(path), reader)), reader


@dataclass(frozen=True)
class Checked:
    """What STEPPER CHECK has printed."""

    moves: int
    pauses: int
    work: dict[str, tuple[float, float]]
    machine: dict[str, tuple[float, float]]
    seconds: float


def checked(output: str) -> Checked:
    """Read the report of STEPPER CHECK."""
    counts = re.search(r"^Lines: \d+, moves: (\d+), pauses: (\d+)\r?$", output, re.M)
    assert counts, output
    work, machine = {}, {}
    number = r"(-?[\d.]+)"
    rows = rf"^([XYZA]): {number} to {number} \w+, machine {number} to {number} \w+\r?$"
    for letter, *values in re.findall(rows, output, re.M):
        low, high, machine_low, machine_high = map(float, values)
        work[letter] = low, high
        machine[letter] = machine_low, machine_high
    seconds = re.search(r"^Time: \d+:\d\d:\d\d \(([\d.]+) s\)", output, re.M)
    assert seconds, output
    return Checked(int(counts[1]), int(counts[2]), work, machine, float(seconds[1]))
