"""Random machines, programs and what an operator does meanwhile; all from a seed."""

import math
from dataclasses import dataclass, field
from random import Random

from host_machine import Setup

from stepmite.arcs import PLANES
from stepmite.gcode import AXES, GcodeError, Reader
from stepmite.plan import Machine, plan

LONGEST_S = 2.5
"""Programs are cut where the plan says that they have lasted this long."""
SCALES = [
    (80.0, 80.0, 400.0, 10.0),
    (800.0, 640.0, 1000.0, 100.0),
    (200.0, 53.3, 266.667, 8.8889),
    (400.0, 400.0, 400.0, 400.0),
]


@dataclass(frozen=True)
class Jog:
    """One use of STEPPER JOG: lines with the pauses before them, in ms."""

    axis: int
    feed_per_min: float
    lines: list[tuple[int, str]]
    end_steps: int | None
    """Where it must end, counted from where it began; None: wherever it was stopped."""


@dataclass
class Program:
    """One program: what is queued, then what the operator does."""

    settings: list[str]
    lines: list[str]
    machine: Machine
    events: list[tuple[int, str]] = field(default_factory=list)
    """(ms to wait, command) after the last line has been queued."""
    feed_factor: float = 1.0
    stopped: bool = False
    jogs: list[Jog] = field(default_factory=list)


def random_setup(rng: Random) -> Setup:
    """A machine whose axes stay below 50 kHz."""
    scale = rng.choice(SCALES)
    velocity = tuple(
        round(60 * min(rng.choice([20, 50, 120, 300]) * rng.uniform(0.8, 1), 49_000 / s), 1)
        for s in scale
    )
    base = 10 ** rng.uniform(2, 3.5)
    acceleration = tuple(round(base * rng.uniform(0.5, 1), 1) for _ in range(4))
    inverted = tuple(rng.random() < 0.3 for _ in range(4))
    return Setup(scale, velocity, acceleration, inverted)


def _exact(value: float) -> str:
    return f"{value:.4f}".rstrip("0").rstrip(".")


class _Writer:
    """Writes the lines of one program; relative, so that it may begin anywhere."""

    def __init__(self, rng: Random, arcs: bool) -> None:
        self.rng = rng
        self.arcs = arcs
        self.heading = rng.uniform(-math.pi, math.pi)
        self.smooth = rng.choice([0.0, 0.02, 0.3, 3.0])
        self.dimensions = rng.choice(["XY", "XY", "XYZ", "XYZA", "mixed"])
        self.shortest = 10 ** rng.uniform(math.log10(0.005), 1)
        self.longest = min(200.0, self.shortest * 10 ** rng.uniform(0, 2.5))

    def length(self) -> float:
        low, high = math.log10(self.shortest), math.log10(self.longest)
        return 10 ** self.rng.uniform(low, high)

    def feed(self) -> str:
        return f"F{round(10 ** self.rng.uniform(1.8, 4.6))}"

    def line(self) -> str:
        rng = self.rng
        if self.dimensions == "mixed" and rng.random() < 0.2:
            return f"G1 {rng.choice('ZA')}{_exact(rng.uniform(-1, 1) * self.length())}"
        if rng.random() < 0.02:
            self.heading += math.pi
        self.heading += rng.gauss(0, self.smooth)
        length = self.length()
        words = [
            f"X{_exact(length * math.cos(self.heading))}",
            f"Y{_exact(length * math.sin(self.heading))}",
        ]
        if "Z" in self.dimensions or (self.dimensions == "mixed" and rng.random() < 0.3):
            words.append(f"Z{_exact(length * rng.gauss(0, 0.2))}")
        if "A" in self.dimensions or (self.dimensions == "mixed" and rng.random() < 0.2):
            words.append(f"A{_exact(length * rng.gauss(0, 2))}")
        return f"{'G0' if rng.random() < 0.1 else 'G1'} {' '.join(words)}"

    def arc(self) -> str:
        """An arc that leaves in the heading of the line before it, most of the time."""
        rng = self.rng
        left = rng.random() < 0.5
        radius = max(0.02, self.length()) * rng.uniform(0.3, 1.5)
        sweep = rng.choice([rng.uniform(0.2, 6), math.pi / 2, math.pi, 2 * math.pi])
        sweep = min(sweep, 200 / radius)
        if rng.random() < 0.3:
            self.heading += rng.uniform(-1, 1)
        side = self.heading + (math.pi / 2 if left else -math.pi / 2)
        first, second = radius * math.cos(side), radius * math.sin(side)
        turned = side + math.pi + (sweep if left else -sweep)
        end = first + radius * math.cos(turned), second + radius * math.sin(turned)
        plane = rng.choice(["G17", "G17", "G18", "G19"])
        letters = {"G17": "XYIJ", "G18": "ZXKI", "G19": "YZJK"}[plane]
        values = (*end, first, second)
        words = [f"{letter}{value:.6f}" for letter, value in zip(letters, values, strict=True)]
        if rng.random() < 0.2:
            words.append(f"{'ZYX'[list(PLANES).index(plane)]}{_exact(self.length())}")
        if rng.random() < 0.2:
            words.append(f"A{_exact(rng.uniform(-20, 20))}")
        if sweep == 2 * math.pi:
            words = words[2:]
            if rng.random() < 0.3:
                words.append("P2")
        self.heading += sweep if left else -sweep
        return f"{plane} {'G3' if left else 'G2'} {' '.join(words)}"

    def write(self, count: int) -> list[str]:
        lines = [f"G91 {self.feed()}"]
        changes = self.rng.choice([0.0, 0.05, 0.3])
        arcs = self.rng.choice([0.0, 0.2, 0.7]) if self.arcs else 0.0
        dwells = self.rng.choice([0.0, 0.0, 0.03])
        for _ in range(count):
            if self.rng.random() < dwells:
                lines.append(f"G4 P{self.rng.randint(0, 30)}")
                continue
            code = self.arc() if self.rng.random() < arcs else self.line()
            lines.append(f"{code} {self.feed()}" if self.rng.random() < changes else code)
        return lines


def cut(lines: list[str], machine: Machine) -> tuple[list[str], float]:
    """Cut a program that would last too long; returns it and what the plan says that it takes."""
    reader = Reader()
    blocks = []
    for number, line in enumerate(lines):
        try:
            blocks += reader.read(number, line)
        except GcodeError:
            lines[number] = "G4 P1"
    total = 0.0
    for row in plan(blocks, machine):
        total += row.duration_s()
        if total > LONGEST_S and row.block.line_number > 2:
            return lines[: row.block.line_number], LONGEST_S
    return lines, total


def random_program(rng: Random, setup: Setup, features: set[str]) -> Program:
    """A program with its settings, limits, events and jogs."""
    junction = round(10 ** rng.uniform(-3, -0.7), 4)
    settings = [f"STEPPER JUNCTION {junction}"]
    machine = setup.machine()
    jerk, axis_jerk = math.inf, (math.inf,) * 4
    if "scurve" in features:
        if rng.random() < 0.6:
            jerk = round(min(setup.max_acceleration) / 10 ** rng.uniform(-2, -0.8))
            settings.append(f"STEPPER JERK {jerk}")
            settings.append("STEPPER SCURVE 1")
        else:
            settings.append("STEPPER SCURVE 0")
    machine = Machine(machine.max_velocity, machine.max_acceleration, junction, jerk, axis_jerk)
    mode = "G90"
    if "modes" in features:
        mode = rng.choice(["G64", "G64", "G61", "G61.1", f"G64 P{10 ** rng.uniform(-2.5, 0):.4f}"])
    writer = _Writer(rng, "arcs" in features)
    count = round(10 ** rng.uniform(0, math.log10(500)))
    lines, seconds = cut([mode, *writer.write(count)], machine)
    program = Program(settings, lines, machine)
    _add_events(rng, program, seconds)
    if "jog" in features and rng.random() < 0.25:
        program.jogs = [random_jog(rng, setup) for _ in range(rng.randint(1, 2))]
    return program


def _add_events(rng: Random, program: Program, seconds: float) -> None:
    moments = rng.choice([0, 0, 1, 2, 4])
    for _ in range(moments):
        wait = round(rng.uniform(0, seconds / moments) * 1000)
        kind = rng.random()
        if kind < 0.4:
            program.events.append((wait, "STEPPER HOLD"))
            program.events.append((rng.choice([0, 1, 7, 40, 300]), "STEPPER RESUME"))
        elif kind < 0.8:
            percent = rng.choice([10, 50, 90, 120, 200])
            program.events.append((wait, f"STEPPER OVERRIDE FEED,{percent}"))
            program.feed_factor = max(program.feed_factor, percent / 100)
        elif kind < 0.9:
            program.events.append((wait, f"STEPPER OVERRIDE RAPID,{rng.choice([25, 50, 100])}"))
        elif _ == moments - 1:
            program.events.append((wait, "STEPPER STOP"))
            program.stopped = True


def random_jog(rng: Random, setup: Setup) -> Jog:
    """By a distance, or on until it is stopped; at times with a new target on the way."""
    axis = rng.randrange(4)
    feed = round(setup.max_velocity_per_min[axis] * rng.uniform(0.05, 1.5))
    name = AXES[axis]
    scale = setup.steps_per_unit[axis]
    if rng.random() < 0.5:
        steps = rng.choice([-1, 1]) * round(10 ** rng.uniform(0, 1.5) * scale)
        lines = [(0, f"STEPPER JOG {name},{steps / scale:.7f},{feed}")]
        return Jog(axis, feed, lines, steps)
    sign = rng.choice("+-")
    lines = [(0, f"STEPPER JOG {name},{sign},{feed}")]
    if rng.random() < 0.5:
        feed_2 = round(feed * rng.uniform(0.3, 1))
        other = rng.choice("+-")
        lines.append((rng.randint(1, 300), f"STEPPER JOG {name},{other},{feed_2}"))
    lines.append((rng.randint(1, 400), "STEPPER JOG STOP"))
    return Jog(axis, feed, lines, None)


def script(setup: Setup, programs: list[Program]) -> str:
    """What is typed at the prompt; the spindle's pin marks the programs in the trace."""
    wait = "DO WHILE PEEK(STEPPER ACTIVE) = 1:PAUSE 2:LOOP"
    lines = [*setup.axis_lines(), "STEPPER SPINDLE GP22", "STEPPER RUN", "PAUSE 2"]
    for program in programs:
        lines += ["STEPPER POSITION HOME", *program.settings]
        lines += ["STEPPER OVERRIDE FEED,100", "STEPPER OVERRIDE RAPID,100", "STEPPER GC M3", wait]
        # Held until all is queued: what is queued then does not depend on the pace of typing.
        lines += ["STEPPER HOLD", *[f"STEPPER GC {line}" for line in program.lines]]
        lines += ["STEPPER RESUME"]
        for pause, command in program.events:
            lines += [f"PAUSE {pause}", command]
        lines += [wait, "STEPPER GC M5", wait, "STEPPER STATUS"]
        for jog in program.jogs:
            lines += ["STEPPER GC M3"]
            for pause, command in jog.lines:
                lines += [f"PAUSE {pause}", command]
            lines += [wait, "STEPPER GC M5", wait]
    return "\r".join([*lines, ""])
