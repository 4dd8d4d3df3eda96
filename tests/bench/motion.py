"""How long motion takes: jobs through the host program against the exact optimum."""

from __future__ import annotations

import math
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from stepmite.emulator import PROJECT
from stepmite.gcode import read_blocks
from stepmite.plan import Machine, plan
from stepmite.trace import AxisPins, Edges, axis_trace

HOST = PROJECT / "build" / "host" / "stepmite"
PINS = [AxisPins("X", 2, 3, False, 80.0), AxisPins("Y", 4, 5, False, 80.0)]
VELOCITY_MM_MIN, ACCELERATION = 12_000.0, 1000.0


@dataclass(frozen=True)
class Job:
    """G-code and where it ends, in steps from its start."""

    name: str
    lines: list[str]
    end_steps: list[int]


@dataclass(frozen=True)
class Outcome:
    """Seconds until the last block is done, and the best possible."""

    name: str
    deviation_mm: float
    taken_s: float
    optimum_s: float
    exact: bool


def jobs() -> list[Job]:
    circle = [
        f"X{20 * math.cos(math.radians(i)) - 20:.6f} Y{20 * math.sin(math.radians(i)):.6f}"
        for i in range(1, 361)
    ]
    zigzag = [f"X{i // 2 + 1}" if i % 2 == 0 else f"Y{1 - i // 2 % 2}" for i in range(200)]
    line = [f"X{i / 6:.6f}" for i in range(1, 301)]
    return [
        Job("one line of 50 mm, F6000", ["G1 F6000", "X50"], [4000, 0]),
        Job("circle r = 20 mm of 360 chords, F3000", ["G1 F3000", *circle], [0, 0]),
        Job("200 x 1 mm zigzag, F6000", ["G1 F6000", *zigzag], [8000, 0]),
        Job("300 x 1/6 mm in line, F3000", ["G1 F3000", *line], [4000, 0]),
    ]


def run(job: Job, deviation_mm: float) -> Outcome:
    """Queue a job, then let it go."""
    setup = ["STEPPER INIT ,1024", f"STEPPER JUNCTION {deviation_mm}"]
    setup += [
        f"STEPPER AXIS {pins.name},GP{pins.step_gpio},GP{pins.dir_gpio},,,80,"
        f"{VELOCITY_MM_MIN},{ACCELERATION}"
        for pins in PINS
    ]
    program = [*setup, "STEPPER POSITION HOME", *(f"STEPPER GC {line}" for line in job.lines)]
    program += ["STEPPER RUN", "t = TIMER", "DO", "LOOP UNTIL PEEK(STEPPER ACTIVE) = 0"]
    program += ['PRINT "ms"; TIMER - t']
    with tempfile.TemporaryDirectory() as folder:
        source, trace = Path(folder, "job.bas"), Path(folder, "edges.csv")
        source.write_text("\n".join(program) + "\n")
        command = [HOST, "--virtual", "--trace", trace, source]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        edges = Edges.read(trace)
    ends = [axis_trace(edges, pins).end_steps() for pins in PINS]
    speed = VELOCITY_MM_MIN / 60
    machine = Machine((speed,) * 4, (ACCELERATION,) * 4, deviation_mm)
    best_s = sum(row.duration_s() for row in plan(read_blocks(job.lines), machine))
    taken = float(done.stdout.split("ms")[-1]) / 1000
    return Outcome(job.name, deviation_mm, taken, best_s, ends == job.end_steps)


def outcomes() -> list[Outcome]:
    return [run(job, deviation) for deviation in (0.01, 0.05) for job in jobs()]
