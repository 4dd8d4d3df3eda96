"""Measurements of the real UF2 in the emulator, each in a board of its own: nothing here prints."""

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stepmite.emulator import PROJECT, Cycles, Emulator
from stepmite.ticks import latencies_ns
from stepmite.trace import Edges

CYCLES_PER_US = 125
AXES = "XYZA"
STEP_GPIOS = (2, 4, 6, 8)
STEPS_PER_UNIT = 100
# Steps a second, in thousands, of the four axes: near the limit, in no simple ratio, one slow.
RATES_KHZ = (50, 49, 37, 11)
NAME_PLATE = PROJECT / "examples" / "nameplate.nc"
TALK = 'DO: PRINT "some text that goes out over the line, as fast as it can": LOOP'


# Inputs that the tick watches: E-STOP, and a switch at each end of X, Y, Z.
ESTOP_GPIO = 15
LIMIT_GPIOS = (16, 17, 18, 20, 21, 22)
NOISE_US = 200  # from one pulse on a limit input to the next, each of two samples


@dataclass(frozen=True)
class Tick:
    """Cycles of the tick with a number of axes moving."""

    axes: int
    cycles: Cycles
    rates_hz: tuple[float, ...]
    """Steps a second, counted at the pins."""


@dataclass(frozen=True)
class Lateness:
    """How long after its tick a pin changed, in nanoseconds."""

    load: str
    edge: str
    least: float
    median: float
    percentile_99: float
    percentile_99_9: float
    most: float


@dataclass(frozen=True)
class Part:
    """The name plate: queuing its lines, then the governor over some seconds of it."""

    lines: int
    line: Cycles
    governor: Cycles
    seconds: float


def ready(
    uf2: Path, blocks: int, axes: int = 4, acceleration: int = 20000, *, inputs: bool = False
) -> Emulator:
    """A board at its prompt with this many axes set up (mm/s2) and its position known."""
    board = Emulator(uf2)
    board.connect()
    board.until("> ")
    for gpio in (ESTOP_GPIO, *LIMIT_GPIOS) if inputs else ():
        board.set_pin(gpio, 1)
    board.command(f"STEPPER INIT ,{blocks}" + (f",GP{ESTOP_GPIO}" if inputs else ""))
    for index, name in enumerate(AXES[:axes]):
        step = STEP_GPIOS[index]
        board.command(
            f"STEPPER AXIS {name},GP{step},GP{step + 1},,,{STEPS_PER_UNIT},30000,{acceleration}"
        )
    if inputs:
        board.command("STEPPER HWLIMITS " + ",".join(f"GP{gpio}" for gpio in LIMIT_GPIOS))
    board.command("STEPPER POSITION HOME")
    return board


def no_faults(board: Emulator) -> None:
    """A measurement with faults is none."""
    faults = board.faults()
    if faults:
        raise RuntimeError(f"fault in the emulator: {faults[0].text}")


def start_long_move(board: Emulator, axes: int) -> None:
    """Get the axes going at their rates, for three seconds."""
    board.command("STEPPER RUN")
    lengths = [3 * 1000 * rate / STEPS_PER_UNIT for rate in RATES_KHZ[:axes]]
    feed_per_min = math.hypot(*lengths) / 3 * 60
    words = " ".join(f"{name}{length:g}" for name, length in zip(AXES, lengths, strict=False))
    board.command(f"STEPPER GC G1 {words} F{feed_per_min:.3f}")


def make_noise(board: Emulator, ms: int) -> None:
    """Pulses on the limit inputs, one after the other, just too short to trip."""
    for number in range(ms * 1000 // NOISE_US):
        gpio = LIMIT_GPIOS[number % len(LIMIT_GPIOS)]
        start_ns = board.now_ns + number * NOISE_US * 1000
        board.set_pin(gpio, 0, at_ns=start_ns)
        board.set_pin(gpio, 1, at_ns=start_ns + 20_000)


def tick(uf2: Path, axes: int, *, inputs: bool = False, noise: bool = False) -> Tick:
    """The tick while `axes` axes move; with none it runs through a dwell.

    `inputs`: E-STOP and six limit switches are watched; `noise`: there is noise on the switches.
    """
    with ready(uf2, 64, inputs=inputs) as board:
        if axes > 0:
            start_long_move(board, axes)
            board.run_ms(300)  # up to speed
        else:
            board.command("STEPPER RUN")
            board.command("STEPPER GC G4 P2000")
            board.run_ms(50)
        board.clear_profile()
        board.clear_edges()
        if noise:
            make_noise(board, 499)
        board.run_ms(500)
        edges = Edges.from_rows(board.edges())
        rates = tuple(float((edges.of(gpio).level == 1).sum()) * 2 for gpio in STEP_GPIOS[:axes])
        no_faults(board)
        return Tick(axes, board.profile()["systick"], rates)


def governor_in_cruise(uf2: Path) -> Cycles:
    """A governor step with four axes at constant speed."""
    with ready(uf2, 64) as board:
        board.measure("hal_on_governor")
        start_long_move(board, 4)
        board.run_ms(300)
        board.clear_profile()
        board.run_ms(500)
        no_faults(board)
        return board.profile()["hal_on_governor"]


def lateness(uf2: Path, load: str) -> list[Lateness]:
    """Step edges against the grid of ticks, with four axes moving."""
    with ready(uf2, 64) as board:
        start_long_move(board, 4)
        board.run_ms(300)
        if load == "USB output without end":
            board.send(TALK + "\r")
            board.run_ms(20)
        board.clear_edges()
        board.run_ms(1000)
        edges = Edges.from_rows(board.edges())
        runs = board.tick_runs()
        no_faults(board)
    steps = edges.of(STEP_GPIOS[0])
    rows = []
    # The falling edges are the first thing the tick does, so they show the interrupt's own delay.
    for name, level in (("step pin down", 0), ("step pin up", 1)):
        mine = steps.level == level
        late = latencies_ns(Edges(steps.time_ns[mine], steps.gpio[mine], steps.level[mine]), runs)
        middle = [float(np.percentile(late, p)) for p in (50, 99, 99.9)]
        rows.append(Lateness(load, name, float(late.min()), *middle, float(late.max())))
    return rows


def part(uf2: Path, seconds: float, jerk: int = 0) -> Part:
    """Real lines of G-code from the prompt to the queue, then their motion; jerk 0: trapezoid."""
    lines = [line for line in NAME_PLATE.read_text().splitlines() if re.match(r"[A-Z]", line)]
    with ready(uf2, 1024, acceleration=1000) as board:
        board.command("STEPPER SPINDLE GP28")
        limit_jerk(board, jerk)
        board.measure("gcode_line", "hal_on_governor")
        for line in lines:
            board.command(f'STEPPER GS "{line}"')
        line_cycles = board.profile()["gcode_line"]
        board.clear_profile()
        board.command("STEPPER RUN")
        board.run_ms(seconds * 1000)
        no_faults(board)
        return Part(len(lines), line_cycles, board.profile()["hal_on_governor"], seconds)


def limit_jerk(board: Emulator, jerk: int) -> None:
    """S-curves from the next move on, mm/s3; 0: as it is."""
    if jerk > 0:
        board.command(f"STEPPER JERK {jerk}")
        board.command("STEPPER SCURVE 1")


@dataclass(frozen=True)
class Crowd:
    """A full queue of tiny moves while it is executed."""

    name: str
    governor: Cycles
    seconds: float


def share(cycles: Cycles, seconds: float) -> float:
    """What these calls took of the CPU's time."""
    return cycles.calls * cycles.mean / (seconds * 1e6 * CYCLES_PER_US)


CROWDS = {
    "0.02 mm in line": 'X"+STR$(i*.02,4,5)',
    "0.02 mm around r = 5 mm": 'X"+STR$(5*COS(i*.004)-5,4,5)+" Y"+STR$(5*SIN(i*.004),4,5)',
    "0.02 mm zigzag": 'X"+STR$(i*.02,4,5)+" Y"+STR$((i MOD 2)*.02,4,5)',
}


def crowd(uf2: Path, name: str, jerk: int) -> Crowd:
    """A thousand moves of one kind at up to 100 mm/s and 1000 mm/s2: what the governor needs."""
    seconds = 0.2
    with ready(uf2, 1024, axes=2, acceleration=1000) as board:
        limit_jerk(board, jerk)
        board.command(
            f'FOR i=1 TO 1023: STEPPER GS "G1 F6000 {CROWDS[name]}: NEXT', timeout_ms=60_000
        )
        board.measure("hal_on_governor")
        board.command("STEPPER RUN")
        board.clear_profile()
        board.run_ms(seconds * 1000)
        no_faults(board)
        if "underruns: 0" not in board.command("STEPPER STATUS"):
            raise RuntimeError(f"{name}: the tick ran dry")
        return Crowd(name, board.profile()["hal_on_governor"], seconds)


def planned_anew(uf2: Path) -> Cycles:
    """What the governor waits for when the plan of 1024 moves, all with corners, is made anew."""
    with ready(uf2, 1024) as board:
        board.command(
            'FOR i=1 TO 1024: STEPPER GS "G1 F3000 X"+STR$(i*.1)+" Y"+STR$((i MOD 7)*.05): NEXT',
            timeout_ms=60_000,
        )
        board.measure("bind_all")
        board.command("STEPPER OVERRIDE FEED,50")
        no_faults(board)
        return board.profile()["bind_all"]


@dataclass(frozen=True)
class Fed:
    """A program that queues moves of 0.02 mm while they are executed."""

    feed_mm_s: float
    jerk: int
    slowest_mm_s: float
    """Over 50 ms, between the first and the last quarter of a second."""


def fed_by_loop(uf2: Path, feed_mm_s: float, jerk: int) -> Fed:
    """Moves of 0.02 mm from a BASIC FOR loop that waits for room; speed from the step edges."""
    with ready(uf2, 1024, axes=1, acceleration=1000) as board:
        limit_jerk(board, jerk)
        board.command("STEPPER RUN")
        board.clear_edges()
        count = int(1.2 * feed_mm_s / 0.02)
        board.command(
            f"FOR i=1 TO {count}: DO WHILE PEEK(STEPPER BUFFER)=0: LOOP: "
            f'STEPPER GS "G1 F{feed_mm_s * 60:.0f} X"+STR$(i*.02): NEXT',
            timeout_ms=60_000,
        )
        board.run_ms(500)
        no_faults(board)
        edges = Edges.from_rows(board.edges()).of(STEP_GPIOS[0])
        if "underruns: 0" not in board.command("STEPPER STATUS"):
            raise RuntimeError("the tick ran dry")
    times_s = edges.time_ns[edges.level == 1] * 1e-9
    inner = times_s[(times_s > times_s[0] + 0.25) & (times_s < times_s[-1] - 0.25)]
    bins = np.arange(inner[0], inner[-1], 0.05)
    counts = np.histogram(inner, bins)[0]
    return Fed(feed_mm_s, jerk, float(counts.min()) / 0.05 / STEPS_PER_UNIT)


def statement(board: Emulator, body: str, few: int, many: int) -> float:
    """Cycles of one turn of a FOR loop: the difference of two runs, so that the prompt cancels."""
    took = []
    for count in (few, many):
        start_ns = board.now_ns
        answer = board.command(f"FOR i=1 TO {count}: {body}NEXT", timeout_ms=20_000)
        if "rror" in answer:
            raise RuntimeError(answer)
        took.append(board.now_ns - start_ns)
    return (took[1] - took[0]) / (many - few) / 1000 * CYCLES_PER_US


@dataclass(frozen=True)
class Goal:
    """A statement of a program with the cycles it may take, and those of the original there."""

    name: str
    body: str
    limit: int
    original: int


# The original's figures were measured on the same emulated core.
GOALS = (
    Goal("an empty turn of FOR ... NEXT", "", 400, 428),
    Goal("a = a + 1, float", "a = a + 1", 1200, 3070),
    Goal("a% = a% + 1, integer", "c% = c% + 1", 1000, 2720),
    Goal("a SUB with two arguments", "two a, b", 3000, 10_400),
    Goal('s$ = "0123456789" + "abcdefghij"', 's$ = "0123456789" + "abcdefghij"', 1500, 4850),
    Goal("a = SIN(b)", "a = SIN(b)", 2500, 4760),
    Goal("IF a > b THEN, not taken", "IF a > b THEN c% = 1", 1200, 4820),
    Goal(
        '"G1 X" + STR$(a + i / 10, 1, 3) + " F3000"',
        's$ = "G1 X" + STR$(a + i / 10, 1, 3) + " F3000"',
        9000,
        18_500,
    ),
    Goal("STEPPER GS of a line of G1, planned", 'STEPPER GS "G1 X1.2345 Y0.5678"', 25_000, 31_000),
)


def goals(uf2: Path) -> list[float]:
    """Cycles of each of GOALS in a program, the turn of the loop around it taken off."""
    with ready(uf2, 1024) as board:
        board.command("STEPPER GC G91 F1500")
        board.send("AUTOSAVE\r")
        for row, goal in enumerate(GOALS):
            lines = (f"SUB row{row}", "FOR i = 1 TO n", goal.body, "NEXT", "END SUB")
            board.send("\r".join(line for line in lines if line) + "\r")
            board.run_ms(20)
        board.send("SUB two x, y\rEND SUB\r\x1a")
        board.until("\n> ")
        took = []
        for row in range(len(GOALS)):
            few, many = (50, 300) if row == len(GOALS) - 1 else (500, 1500)
            start = board.command(f"a = 1: b = 2: c% = 1: n = {few}")
            assert "rror" not in start, start
            times = []
            for count in (few, many):
                start_ns = board.now_ns
                answer = board.command(f"n = {count}: row{row}", timeout_ms=20_000)
                if "rror" in answer:
                    raise RuntimeError(answer)
                times.append(board.now_ns - start_ns)
            took.append((times[1] - times[0]) / (many - few) / 1000 * CYCLES_PER_US)
        no_faults(board)
    return [took[0]] + [cycles - took[0] for cycles in took[1:]]


def statements(uf2: Path) -> list[tuple[str, float]]:
    """BASIC statements with their share of the interpreter's loop, the empty loop taken off."""
    with ready(uf2, 1024) as board:
        board.command("STEPPER GC G91 F1500")
        board.command('a=1: b%=1: s$="text"')
        empty = statement(board, "", 500, 1500)
        rows = [("FOR ... NEXT, a turn", empty)]
        for body in ("a=i", "a=i*2.5+a", "b%=b%+3", "IF a>5 THEN b%=1", 't$=s$+"x"'):
            rows.append((body, statement(board, f"{body}: ", 500, 1500) - empty))
        for body in ('STEPPER GS "G1 X1.2345 Y0.5678"', "STEPPER GC X.1 Y.05"):
            rows.append((body, statement(board, f"{body}: ", 50, 300) - empty))
        no_faults(board)
        return rows
