"""A session at the prompt of the host program, in virtual time, with a world around the pins.

`typed()` types lines, applies edges to inputs at their times, lets the axes press their switches
and brings back the answer to each line, when it was typed, every edge of the outputs, and what
became of the simulated drivers.
"""

from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from simulated_drivers import Driver, Report

from stepmite.trace import AxisPins, AxisTrace, Edges, axis_trace

STEPMITE = Path(__file__).resolve().parents[2] / "build" / "host" / "stepmite"
DEADLINE_S = 120.0  # wall time after which a session counts as hung

WAIT = "DO : PAUSE 1 : LOOP WHILE PEEK(STEPPER ACTIVE) = 1"
"""The line that waits for the end of motion."""

STEP_X, DIR_X, ENABLE_X = 2, 3, 4
STEP_Y, DIR_Y, ENABLE_Y = 5, 6, 7
STEP_Z, DIR_Z, ENABLE_Z = 8, 9, 10
STEP_A, DIR_A, ENABLE_A = 11, 12, 13
SPINDLE, ESTOP = 14, 22
X_MIN, Y_MIN, Z_MIN, X_MAX, Y_MAX, Z_MAX = 16, 17, 18, 19, 20, 21

SCALES = {"X": 80, "Y": 100, "Z": 400, "A": 10}
"""Steps per mm or degree of AXES."""

AXES = [
    f"STEPPER AXIS X,GP{STEP_X},GP{DIR_X},GP{ENABLE_X},,80,6000,500",
    f"STEPPER AXIS Y,GP{STEP_Y},GP{DIR_Y},GP{ENABLE_Y},,100,6000,500",
    f"STEPPER AXIS Z,GP{STEP_Z},GP{DIR_Z},GP{ENABLE_Z},,400,3000,500",
    f"STEPPER AXIS A,GP{STEP_A},GP{DIR_A},GP{ENABLE_A},,10,36000,5000",
]
SET_UP = ["STEPPER INIT ,64", *AXES]
READY = [*SET_UP, "STEPPER POSITION HOME", "STEPPER RUN"]
"""Four axes at zero of the machine, armed."""

PINS = {
    "X": AxisPins("X", STEP_X, DIR_X, False, 80.0),
    "Y": AxisPins("Y", STEP_Y, DIR_Y, False, 100.0),
    "Z": AxisPins("Z", STEP_Z, DIR_Z, False, 400.0),
    "A": AxisPins("A", STEP_A, DIR_A, False, 10.0),
}


@dataclass(frozen=True)
class Event:
    """An edge that the world applies to an input."""

    ms: float
    gpio: int
    level: int

    def row(self) -> str:
        return f"{round(self.ms * 1e6)},{self.gpio},{self.level}"


@dataclass(frozen=True)
class Switch:
    """A switch that an axis presses at and beyond a place (mm from where it stood at power-up)."""

    gpio: int
    axis: str
    at_mm: float
    below: bool = True
    """Pressed at `at_mm` and below; else at and above."""
    active_high: bool = False
    bounce_us: int = 0
    stall_rate: int = 0
    """Above 0: no switch but the output of a driver whose motor stalls at this place, where the
    axis ends; it notices stalls at so many steps/s and faster."""

    def at_steps(self) -> int:
        return round(self.at_mm * PINS[self.axis].steps_per_unit)

    def row(self) -> str:
        at_steps = self.at_steps()
        if self.stall_rate > 0:
            return (
                f"stall pin=GP{self.gpio} axis={self.axis} to={at_steps} rate={self.stall_rate}"
                " hold_us=2000"
            )
        return (
            f"switch pin=GP{self.gpio} axis={self.axis} {'to' if self.below else 'from'}={at_steps}"
            f" bounce_us={self.bounce_us}" + (" high" if self.active_high else "")
        )


def _ends(switches: list[Switch] | tuple, drivers: list[Driver]) -> dict[str, str]:
    """The ends of the axes that have some, as low:high in steps."""
    ends = {s.axis: f"{s.at_steps()}:1000000" for s in switches if s.stall_rate > 0}
    for driver in drivers:
        if driver.ends_mm is not None:
            scale = PINS[driver.axis].steps_per_unit
            ends[driver.axis] = ":".join(f"{round(end * scale)}" for end in driver.ends_mm)
    return ends


def machine_rows(
    switches: list[Switch] | tuple, drivers: list[Driver | str] | tuple = ()
) -> list[str]:
    """The axes that have switches or drivers, and these; a driver may be a line as it is."""
    chips = [driver for driver in drivers if isinstance(driver, Driver)]
    ends = _ends(switches, chips)
    rows = []
    for name in dict.fromkeys(part.axis for part in (*switches, *chips) if part.axis):
        pins = PINS[name]
        stops = f" stops={ends[name]}" if name in ends else ""
        rows.append(f"axis {name} step=GP{pins.step_gpio} dir=GP{pins.dir_gpio}{stops}")
    rows += [switch.row() for switch in switches]
    return rows + [driver if isinstance(driver, str) else driver.row() for driver in drivers]


@dataclass(frozen=True)
class Session:
    """What came of the lines."""

    answers: list[str]
    """The answer to each line, its lines joined by \\n."""
    typed_ms: list[float]
    """When each line had been carried out."""
    edges: Edges
    output: str
    """All of the screen."""
    report: Report = field(default_factory=Report)

    @property
    def last(self) -> str:
        return self.answers[-1]

    def number(self, index: int = -1) -> float:
        """The number that a line has printed last."""
        return float(self.answers[index].split()[-1])

    def numbers(self, index: int = -1) -> list[float]:
        """All numbers that a line has printed."""
        return [float(text) for text in self.answers[index].split()]

    def errors(self) -> list[str]:
        """The errors of all lines."""
        return [error for error in map(error_of, self.answers) if error]

    def axis(self, name: str) -> AxisTrace:
        """The motion of an axis."""
        return axis_trace(self.edges, PINS[name])

    def end(self, name: str) -> float:
        """Where the motor of an axis stands, counted from the start, in mm or degrees."""
        return self.axis(name).end_steps() / PINS[name].steps_per_unit

    def level_at(self, gpio: int, ms: float) -> int:
        """The level of an output at a time; low before its first edge."""
        mine = self.edges.of(gpio)
        at = int(np.searchsorted(mine.time_ns, ms * 1e6, side="right"))
        return int(mine.level[at - 1]) if at > 0 else 0

    def level(self, gpio: int) -> int:
        """The level of an output at the end."""
        return self.level_at(gpio, 1e12)


def error_of(answer: str) -> str:
    """The error of an answer; empty if it has none."""
    found = re.search(r"^Error : (.*)$", answer, re.MULTILINE)
    return found[1] if found else ""


def _run(arguments: list[str | Path], keys: str, code: int | None) -> str:
    """Run the host program, `keys` typed; return what it printed, without carriage returns."""
    done = subprocess.run(
        [STEPMITE, "--virtual", *arguments],
        input=keys.encode(),
        capture_output=True,
        timeout=DEADLINE_S,
        check=False,
    )
    output = done.stdout.decode(errors="replace").replace("\r", "")
    assert code is None or done.returncode == code, output[-2000:] + done.stderr.decode()
    return output


def typed(
    folder: Path,
    *lines: str,
    events: list[Event] | tuple = (),
    switches: list[Switch] | tuple = (),
    drivers: list[Driver | str] | tuple = (),
    code: int | None = 0,
) -> Session:
    """Type the lines one after the other; `events` happen at their times.

    `drivers` are motor drivers on their wires, or further lines of the machine as they are.
    """
    trace, machine, report = folder / "edges.csv", folder / "machine.txt", folder / "report.jsonl"
    machine.write_text("".join(row + "\n" for row in machine_rows(switches, drivers)))
    text = "".join(f'{line}\r?"<{i}>";TIMER\r' for i, line in enumerate(lines))
    inputs = write_events(folder / "events.csv", events)
    world = ["--inputs", inputs, "--machine", machine, "--machine-report", report]
    output = _run(["--trace", trace, *world], text, code)
    answers, times, shown = [], [], output
    for i, line in enumerate(lines):
        found = re.search(rf'^> \?"<{i}>";TIMER\n<{i}> ([\d.e+]+)\n', shown, re.MULTILINE)
        assert found, f"no prompt after {line!r}: {shown[-1500:]}"
        before, shown = shown[: found.start()], shown[found.end() :]
        answers.append(before.partition(f"> {line}\n")[2].removesuffix("\n"))
        times.append(float(found[1]))
    return Session(answers, times, Edges.read(trace), output, Report.read(report))


def write_events(file: Path, events: list[Event] | tuple) -> Path:
    """Write the events in their order, for --inputs."""
    rows = sorted(events, key=lambda event: event.ms)
    file.write_text("time_ns,gpio,level\n" + "".join(event.row() + "\n" for event in rows))
    return file


def program(
    folder: Path,
    text: str,
    *,
    keys: str = "",
    events: list[Event] | tuple = (),
    drivers: list[Driver | str] | tuple = (),
    code: int | None = 0,
) -> Session:
    """Run a BASIC program from a file; its whole output is the one answer."""
    source, trace, machine, report = (
        folder / name for name in ("program.bas", "edges.csv", "machine.txt", "report.jsonl")
    )
    source.write_text(text)
    machine.write_text("".join(row + "\n" for row in machine_rows((), drivers)))
    inputs = write_events(folder / "events.csv", events)
    world = ["--inputs", inputs, "--machine", machine, "--machine-report", report]
    output = _run(["--trace", trace, *world, source], keys, code)
    _, _, printed = output.partition("\n\n")  # behind the banner
    edges = Edges.read(trace)
    return Session([printed.rstrip("\n")], [0.0], edges, output, Report.read(report))
