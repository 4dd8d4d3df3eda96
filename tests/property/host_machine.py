"""Runs G-code through the host build of the firmware and brings back what the motors did.

The host program reads the G-code from its standard input with a small BASIC program, which waits
for room in the queue. Everything is virtual time, so a long job takes as long as computing it.
"""

import math
import re
import subprocess
from dataclasses import dataclass, field
from pathlib import Path as FilePath

import numpy as np

from stepmite.follow import follow
from stepmite.gcode import AXES, Block, read_blocks, target_steps
from stepmite.limits import Judge
from stepmite.path import Path, build
from stepmite.plan import Machine
from stepmite.trace import AxisPins, AxisTrace, Edges, axis_trace

HOST_PROGRAM = FilePath(__file__).parents[2] / "build" / "host" / "stepmite"

RECEIVER = """\
begun = 0
DO
  LINE INPUT code$
  IF code$ = "END" THEN EXIT DO
  IF PEEK(STEPPER BUFFER) = 0 AND begun = 0 THEN
    begun = TIMER
    STEPPER RUN
  ENDIF
  DO WHILE PEEK(STEPPER BUFFER) = 0
    PAUSE 1
  LOOP
  STEPPER GS code$
LOOP
IF begun = 0 THEN
  begun = TIMER
  STEPPER RUN
ENDIF
DO WHILE PEEK(STEPPER ACTIVE) = 1
LOOP
PRINT "Taken"; TIMER - begun; " ms"
STEPPER STATUS
"""


@dataclass(frozen=True)
class Setup:
    """The machine of a test; tuples in the order X Y Z A."""

    steps_per_unit: tuple = (80.0, 80.0, 400.0, 10.0)
    max_velocity_per_min: tuple = (6000.0, 6000.0, 3000.0, 6000.0)
    max_acceleration: tuple = (500.0, 500.0, 500.0, 500.0)
    inverted: tuple = (False, True, False, False)
    blocks: int = 1024
    queue_first: bool = False
    """Arm only when all is queued or the queue is full, so that the plan does not depend on the
    pace of the queuing."""
    junction_mm: float | None = None
    """Junction deviation; None: as it is after INIT."""
    jerk: float | None = None
    """Path jerk in mm/s^3; None: trapezoid."""
    axis_jerk: tuple = ()
    """Jerk of each axis; empty: none of its own."""
    extra: tuple = field(default=())
    """More BASIC lines before the first move."""

    def pins(self) -> list[AxisPins]:
        return [
            AxisPins(name, 2 + 2 * i, 3 + 2 * i, self.inverted[i], self.steps_per_unit[i])
            for i, name in enumerate(AXES)
        ]

    def machine(self) -> Machine:
        return Machine(
            tuple(v / 60 for v in self.max_velocity_per_min),
            tuple(self.max_acceleration),
            0.02 if self.junction_mm is None else self.junction_mm,
            math.inf if self.jerk is None else self.jerk,
            self.axis_jerk or (math.inf,) * 4,
        )

    def axis_lines(self) -> list[str]:
        """INIT and the axes, as typed at the prompt."""
        lines = [f"STEPPER INIT ,{self.blocks}"]
        for i, pin in enumerate(self.pins()):
            lines.append(
                f"STEPPER AXIS {pin.name},GP{pin.step_gpio},GP{pin.dir_gpio},,"
                f"{int(pin.inverted)},{pin.steps_per_unit:.9g},"
                f"{self.max_velocity_per_min[i]:.9g},{self.max_acceleration[i]:.9g}"
            )
        return lines

    def program(self) -> str:
        """The BASIC program that sets the machine up and runs a job."""
        lines = self.axis_lines()
        if self.junction_mm is not None:
            lines.append(f"STEPPER JUNCTION {self.junction_mm:.9g}")
        if self.jerk is not None:
            values = (self.jerk, *self.axis_jerk)
            lines.append("STEPPER JERK " + ",".join(f"{value:.9g}" for value in values))
            lines.append("STEPPER SCURVE 1")
        lines += [*self.extra, "STEPPER POSITION HOME"]
        if not self.queue_first:
            lines += ["STEPPER RUN"]
        return "\n".join(lines) + "\n" + RECEIVER


MACHINES = {
    "equal": Setup(queue_first=True),
    "uneven": Setup(
        steps_per_unit=(80.0, 53.3, 400.0, 8.8889),
        max_velocity_per_min=(4800.0, 3000.0, 600.0, 3600.0),
        max_acceleration=(500.0, 300.0, 100.0, 400.0),
        queue_first=True,
    ),
    "fast": Setup(
        steps_per_unit=(200.0, 250.0, 400.0, 100.0),
        max_velocity_per_min=(15000.0, 12000.0, 7500.0, 30000.0),
        max_acceleration=(3000.0, 2000.0, 1500.0, 2500.0),
        queue_first=True,
    ),
}
"""What paths are tried on: axes that are alike, that are not, and that are quick."""


@dataclass(frozen=True)
class Result:
    setup: Setup
    traces: list[AxisTrace]
    corners: np.ndarray
    """Commanded corners in steps, the start first, without moves that lead nowhere."""
    targets: np.ndarray
    """The same corners in mm and degrees, as commanded."""
    blocks: list[Block]
    output: str

    def end_steps(self) -> list[int]:
        """Position by the edges."""
        return [trace.end_steps() for trace in self.traces]

    def reported_steps(self) -> list[int]:
        """Position as STEPPER STATUS says it."""
        return [int(n) for n in re.findall(r"^[XYZA]: .*\((-?\d+) steps\)", self.output, re.M)]

    def taken_s(self) -> float:
        """Time from STEPPER RUN to the end of the last block, if all was queued first."""
        return float(re.search(r"^Taken ([0-9.]+) ms", self.output, re.M)[1]) / 1000

    def path(self) -> Path:
        """What was commanded."""
        return build(self.blocks, self.setup.machine(), self.setup.steps_per_unit)

    def judge(self) -> Judge:
        """The motion beside what was commanded; TraceError if the path was left."""
        path = self.path()
        return Judge(path, self.setup.machine(), follow(path, self.traces), self.traces)

    def motion_s(self) -> float:
        """Time from the first to the last step."""
        first = min(trace.step_ns[0] for trace in self.traces if len(trace.step_ns))
        last = max(trace.step_ns[-1] for trace in self.traces if len(trace.step_ns))
        return (last - first) / 1e9


def corners_of(lines, steps_per_unit) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners in steps and in units, without moves of no step."""
    corners, targets = [(0, 0, 0, 0)], [(0.0, 0.0, 0.0, 0.0)]
    for block in read_blocks(lines):
        steps = target_steps(block.target, steps_per_unit)
        if block.kind == "move" and steps != corners[-1]:
            corners.append(steps)
            targets.append(block.target)
    return np.array(corners), np.array(targets)


def run(folder: FilePath, lines: list[str], setup: Setup | None = None) -> Result:
    """Carry out G-code lines; fails the test if the firmware refuses one."""
    setup = setup or Setup()
    program, trace = folder / "receiver.bas", folder / "edges.csv"
    program.write_text(setup.program())
    done = subprocess.run(
        [HOST_PROGRAM, "--virtual", "--trace", trace, program],
        input="\r".join([*lines, "END", ""]),
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    edges = Edges.read(trace)
    trace.unlink()
    traces = [axis_trace(edges, pin) for pin in setup.pins()]
    corners = corners_of(lines, setup.steps_per_unit)
    return Result(setup, traces, *corners, list(read_blocks(lines)), done.stdout)
