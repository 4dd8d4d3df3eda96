#!/usr/bin/env python3
"""CPU cycles counted in the emulator, and motion times: prints tables, can write them as a page.

    .venv/bin/python tests/bench/bench_tick.py [--uf2 FILE] [--write docs/performance.md]

Fails if a goal is missed.
"""

import argparse
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import drivers
import measure
import motion
import ram
from rich.console import Console
from rich.table import Table

from stepmite.emulator import PROJECT, Cycles

GOAL_TICK_MEAN, GOAL_TICK_MOST, GOAL_LINE = 130, 230, 20_000
GOAL_MOTION = 0.01
MILLISECOND_CYCLES = 125_000
TICK_CYCLES = 1250

INTRO = """\
# Performance

Cycles of the Cortex-M0+ at 125 MHz, counted while the released UF2 runs in the emulator of
`tests/emulator`; made by `make bench`. The emulator counts instructions by ARM's manual and the
entry of an exception with 15 cycles, its exit with an estimated 13. It knows no misses of the flash
cache, so code that runs from flash (everything but the tick) is slower on a board when it is cold.
One tick lasts 1250 cycles.
"""

PICTURES = """\
Speed, acceleration and jerk along the path, rebuilt from the step edges (`make pictures`):

![A corner](images/motion-corner.png)

![A circle](images/motion-circle.png)

![Short segments](images/motion-short.png)
"""


@dataclass
class Section:
    """A table with the sentence it needs."""

    title: str
    head: list[str]
    rows: list[list[str]] = field(default_factory=list)
    note: str = ""


def whole(number: float) -> str:
    return f"{number:,.0f}"


def of_cycles(name: str, cycles: Cycles, goal: str = "") -> list[str]:
    share = f"{cycles.mean / TICK_CYCLES * 100:.1f} %" if cycles.mean < TICK_CYCLES else ""
    return [name, whole(cycles.calls), whole(cycles.mean), whole(cycles.most), share, goal]


def tick_section(uf2: Path, missed: list[str]) -> Section:
    section = Section("The tick", ["", "ticks", "mean", "worst", "of the CPU", "goal"])
    rates = ", ".join(f"{rate}" for rate in measure.RATES_KHZ)
    section.note = (
        f"Four axes move at {rates} kHz. From the first instruction to the return; the exception's "
        "entry and exit, 28 cycles, come on top. Inputs are E-STOP and six limit switches; noise "
        f"is a pulse of two samples on one of the switches every {measure.NOISE_US} us."
    )
    for name, axes, inputs, noise in (
        ("no axis moves (dwell)", 0, False, False),
        ("1 axis", 1, False, False),
        ("4 axes", 4, False, False),
        ("4 axes, inputs", 4, True, False),
        ("4 axes, inputs, noise", 4, True, True),
    ):
        tick = measure.tick(uf2, axes, inputs=inputs, noise=noise)
        goal = f"{GOAL_TICK_MEAN} / {GOAL_TICK_MOST}" if axes == 4 else ""
        section.rows.append(of_cycles(name, tick.cycles, goal))
        wanted = [1000 * rate for rate in measure.RATES_KHZ[:axes]]
        if any(abs(a - b) > 50 for a, b in zip(tick.rates_hz, wanted, strict=True)):
            missed.append(f"step rates {tick.rates_hz} instead of {wanted}")
        if axes == 4 and (tick.cycles.mean > GOAL_TICK_MEAN or tick.cycles.most > GOAL_TICK_MOST):
            missed.append(f"the tick takes {tick.cycles.mean:.0f}, at worst {tick.cycles.most:.0f}")
    return section


def governor_section(uf2: Path, missed: list[str]) -> Section:
    section = Section("The governor", ["", "calls", "mean", "worst", "of the CPU", "worst", "goal"])
    section.note = (
        "It runs about once a millisecond (125,000 cycles). The name plate is that of `make demo`, "
        "5 s of it; the others are a thousand moves of one kind at up to 100 mm/s, the hardest "
        "there is. 1000 mm/s², S-curve with 10,000 mm/s³."
    )

    def row(name: str, cycles: Cycles, share: float, goal: str) -> list[str]:
        worst = cycles.most / MILLISECOND_CYCLES
        numbers = [whole(cycles.calls), whole(cycles.mean), whole(cycles.most)]
        return [name, *numbers, f"{share:.1%}", f"{worst:.1%}", goal]

    for jerk, profile in ((0, "trapezoid"), (10_000, "S-curve")):
        part = measure.part(uf2, 5, jerk)
        share = measure.share(part.governor, part.seconds)
        section.rows.append(row(f"name plate, {profile}", part.governor, share, "5 % / 40 %"))
        if share > 0.05 or part.governor.most > 0.4 * MILLISECOND_CYCLES:
            missed.append(f"the governor takes {share:.1%} of the time with {profile}")
        for name in measure.CROWDS:
            crowd = measure.crowd(uf2, name, jerk)
            share = measure.share(crowd.governor, crowd.seconds)
            section.rows.append(row(f"{name}, {profile}", crowd.governor, share, ""))
    return section


def queue_section(uf2: Path, missed: list[str]) -> Section:
    section = Section("The queue", ["", "calls", "mean", "worst", "", "goal"])
    part = measure.part(uf2, 0.1, jerk=10_000)
    anew = measure.planned_anew(uf2)
    section.note = (
        f"The {part.lines} lines of the name plate, text to ring, S-curve; and what the governor "
        "waits for when an override plans a full queue anew."
    )
    section.rows += [
        of_cycles("one line of G-code", part.line, f"{GOAL_LINE:,} / {2 * GOAL_LINE:,}"),
        of_cycles("1024 moves planned anew", anew, f"{MILLISECOND_CYCLES:,}"),
    ]
    if part.line.mean > GOAL_LINE or part.line.most > 2 * GOAL_LINE:
        missed.append(f"a line of G-code takes {part.line.mean:.0f} cycles")
    if anew.most > MILLISECOND_CYCLES:
        missed.append(f"planning a full queue anew takes {anew.most:.0f} cycles")
    return section


def fed_section(uf2: Path, missed: list[str]) -> Section:
    section = Section("Fed from a BASIC FOR loop", ["feed", "profile", "slowest 50 ms"])
    section.note = "Moves of 0.02 mm, queued by a program while they are executed; at the step pin."
    for feed, jerk in ((25.0, 0), (25.0, 10_000), (50.0, 0), (50.0, 10_000)):
        fed = measure.fed_by_loop(uf2, feed, jerk)
        profile = "S-curve" if jerk else "trapezoid"
        section.rows.append([f"{feed:.0f} mm/s", profile, f"{fed.slowest_mm_s:.1f} mm/s"])
        if fed.slowest_mm_s < 0.99 * feed:
            missed.append(f"fed by a loop, {feed} mm/s fall to {fed.slowest_mm_s:.1f}")
    return section


def statement_section(uf2: Path) -> Section:
    section = Section("BASIC", ["statement", "cycles", "a second"])
    section.note = "At the prompt, in a FOR loop whose own turn is taken off."
    for text, cycles in measure.statements(uf2):
        section.rows.append([f"`{text}`", whole(cycles), whole(125e6 / cycles)])
    return section


def goals_section(uf2: Path, missed: list[str]) -> Section:
    section = Section("A BASIC program", ["", "cycles", "goal", "original"])
    section.note = (
        "In a FOR loop whose own turn is taken off; beside it PicoMite's MMBasic on the same "
        "emulated core."
    )
    for goal, cycles in zip(measure.GOALS, measure.goals(uf2), strict=True):
        limit, original = whole(goal.limit), f"({whole(goal.original)})"
        section.rows.append([f"{goal.name}", whole(cycles), limit, original])
        if cycles > goal.limit:
            missed.append(f"{goal.name} takes {cycles:.0f} cycles")
    return section


def lateness_section(uf2: Path) -> Section:
    section = Section(
        "Edges against their tick", ["", "edge", "least", "median", "99 %", "99.9 %", "worst"]
    )
    section.note = (
        "Nanoseconds from the tick to the change at the pin, four axes moving. The SDK masks "
        "interrupts in its USB code, and the tick waits for that."
    )
    for load in ("prompt idle", "USB output without end"):
        for row in measure.lateness(uf2, load):
            numbers = (row.least, row.median, row.percentile_99, row.percentile_99_9, row.most)
            section.rows.append([load, row.edge, *[whole(number) for number in numbers]])
    return section


def motion_section(missed: list[str]) -> Section:
    section = Section(
        "Motion times",
        [
            "",
            "mode",
            "corner",
            "taken",
            "optimum",
            "ratio",
            "first to last step",
            "every step",
            "other firmware, ms",
        ],
    )
    section.note = (
        f"80 steps/mm, {motion.VELOCITY_MM_MIN:.0f} mm/min, {motion.ACCELERATION:.0f} mm/s², "
        "queued first, on the host program, whose step train is that of the board. The optimum is "
        "the exact trapezoid for the same corners (junction deviation), from a dense forward and "
        "backward pass over the geometry on the PC; goal: the trapezoid within 1 %. Ends, steps "
        "and that F is never exceeded are read off the step edges. Other firmware did the same "
        "work on the same emulated core, grblHAL with corners by 0.01 mm, PicoMite by 0.05 mm. The "
        "half steps at both ends, 7 ms here, are not in times from the first to the last step."
    )
    for outcome in motion.peers_outcomes():
        more = outcome.taken_s / outcome.optimum_s - 1
        shown = outcome.trapezoid and outcome.deviation_mm == motion.DEVIATIONS[0]
        section.rows.append(
            [
                outcome.name,
                outcome.mode,
                f"{outcome.deviation_mm} mm",
                f"{outcome.taken_s * 1000:.1f} ms",
                f"{outcome.optimum_s * 1000:.1f} ms",
                f"{1 + more:.4f}",
                f"{outcome.motion_s * 1000:.1f} ms",
                "yes" if outcome.exact else "NO",
                outcome.peers if shown else "",
            ]
        )
        if (outcome.trapezoid and more > GOAL_MOTION) or not outcome.exact:
            missed.append(f"{outcome.name} at {outcome.deviation_mm} mm, {outcome.mode}")
        if outcome.feed_used > 1:
            missed.append(f"{outcome.name}: {outcome.feed_used:.3f} of the feed, {outcome.mode}")
    return section


def parts_section(missed: list[str]) -> Section:
    section = Section("Parts", ["", "mode", "taken", "optimum", "ratio", "goal"])
    machine = motion.PARTS_MACHINE.machine()
    section.note = (
        f"Parts as CAM programs write them, {machine.max_acceleration[0]:.0f} mm/s², corners by "
        f"{machine.junction_deviation_mm} mm, up to {machine.max_velocity[0]:.0f} mm/s, a queue "
        "of 1024 blocks. The optimum knows no limit of the jerk."
    )
    for outcome in motion.parts_outcomes():
        ratio = outcome.taken_s / outcome.optimum_s
        goal = 1.01 if outcome.trapezoid else motion.goal_of(outcome)
        section.rows.append(
            [
                outcome.name,
                outcome.mode,
                f"{outcome.taken_s:.3f} s",
                f"{outcome.optimum_s:.3f} s",
                f"{ratio:.3f}",
                f"{goal:.2f}",
            ]
        )
        if outcome.taken_s > goal * outcome.optimum_s + 0.002 or not outcome.exact:
            missed.append(f"{outcome.name}, {outcome.mode}: {ratio:.3f} of the optimum")
    return section


def drivers_section(uf2: Path) -> Section:
    section = Section("Drivers on a wire", ["", "baud", "taken", "cycles", "of the CPU"])
    turn = drivers.turn_beside_drivers(uf2)
    section.note = (
        "A statement that speaks with a TMC2209, at rest: how long it waits, and what the "
        "processor does for it meanwhile; the wire itself is the PIO's. An empty turn of FOR ... "
        f"NEXT while a driver is there and is asked once a second how it is: {turn:.0f} cycles."
    )
    for name in drivers.ACTIONS:
        for baud in drivers.BAUDS:
            action = drivers.action(uf2, name, baud)
            share = action.cycles / (action.taken_ms * MILLISECOND_CYCLES)
            section.rows.append(
                [
                    name,
                    whole(baud),
                    f"{action.taken_ms:.2f} ms",
                    whole(action.cycles),
                    f"{share * 100:.1f} %",
                ]
            )
    return section


def size_text(uf2: Path) -> str:
    """The table of flash and RAM by part, as the audit prints it."""
    script = PROJECT / "tools" / "audit" / "size.py"
    answer = subprocess.run(
        [sys.executable, script, uf2.with_suffix(".elf.map")], capture_output=True, text=True
    )
    return answer.stdout if answer.returncode == 0 else f"not available: {answer.stderr.strip()}"


def show(console: Console, section: Section) -> None:
    table = Table(title=section.title, title_justify="left")
    for index, head in enumerate(section.head):
        table.add_column(head, justify="left" if index == 0 else "right")
    for row in section.rows:
        table.add_row(*row)
    console.print(table)
    console.print(section.note, style="dim")


def markdown(section: Section) -> str:
    lines = [f"## {section.title}", "", section.note, ""]
    lines.append("| " + " | ".join(section.head) + " |")
    lines.append("| --- " + "| ---: " * (len(section.head) - 1) + "|")
    lines += ["| " + " | ".join(row) + " |" for row in section.rows]
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--uf2", type=Path, default=PROJECT / "build/pico/stepmite-pico.uf2")
    parser.add_argument("--write", type=Path, help="write the tables to this Markdown file")
    options = parser.parse_args()
    missed: list[str] = []
    sections = [
        tick_section(options.uf2, missed),
        governor_section(options.uf2, missed),
        queue_section(options.uf2, missed),
        fed_section(options.uf2, missed),
        goals_section(options.uf2, missed),
        statement_section(options.uf2),
        lateness_section(options.uf2),
        drivers_section(options.uf2),
        motion_section(missed),
        parts_section(missed),
    ]
    console = Console()
    for section in sections:
        show(console, section)
    sizes = f"{size_text(options.uf2).rstrip()}\n\nWho uses the RAM:\n\n{ram.table(options.uf2)}\n"
    console.print(sizes, markup=False, highlight=False)
    if options.write:
        texts = [INTRO, *[markdown(section) for section in sections]]
        texts.insert(-1, PICTURES)
        texts.append(f"## Flash and RAM\n\nThe UF2 for the Pico.\n\n{sizes.rstrip()}\n")
        options.write.write_text("\n".join(texts), encoding="utf-8")
    for text in missed:
        console.print(f"goal missed: {text}", style="red")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
