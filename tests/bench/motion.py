"""How long motion takes: jobs through the host program against the optimum and other firmware."""

from __future__ import annotations

import math
import sys
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "property"))

import parts
from host_machine import Setup, run

from stepmite.optimum import least_time_s

VELOCITY_MM_MIN, ACCELERATION = 12_000.0, 1000.0
PEERS_MACHINE = Setup(
    steps_per_unit=(80.0,) * 4,
    max_velocity_per_min=(VELOCITY_MM_MIN,) * 4,
    max_acceleration=(ACCELERATION,) * 4,
    queue_first=True,
)
PARTS_MACHINE = Setup(queue_first=True, junction_mm=0.01, max_velocity_per_min=(6000.0,) * 4)
PARTS_JERK = 10_000.0
JERKS = (10_000.0, 50_000.0)
DEVIATIONS = (0.01, 0.05)


@dataclass(frozen=True)
class Job:
    """G-code, and what others take for it."""

    name: str
    lines: list[str]
    feed: float
    """mm/s."""
    peers: str = ""
    """Milliseconds, measured on the same emulated core; grblHAL with a junction deviation of 0.01
    mm, PicoMite with 0.05 mm, unless it says otherwise."""


@dataclass(frozen=True)
class Outcome:
    """One job in one mode."""

    name: str
    mode: str
    deviation_mm: float
    taken_s: float
    motion_s: float
    """From the first to the last step."""
    optimum_s: float
    """Without a limit of the jerk."""
    exact: bool
    """Every step was made, and the end is where it should be."""
    feed_used: float
    """Highest speed relative to F."""
    peers: str
    trapezoid: bool


def jobs() -> list[Job]:
    circle = [
        f"X{20 * math.cos(math.radians(i)) - 20:.6f} Y{20 * math.sin(math.radians(i)):.6f}"
        for i in range(1, 361)
    ]
    zigzag = [f"X{i // 2 + 1}" if i % 2 == 0 else f"Y{1 - i // 2 % 2}" for i in range(200)]
    line = [f"X{i / 6:.6f}" for i in range(1, 301)]
    return [
        Job("one line of 50 mm, F6000", ["G1 F6000", "X50"], 100, "grblHAL 593, PicoMite 594"),
        Job(
            "circle r = 20 mm of 360 chords, F3000",
            ["G1 F3000", *circle],
            50,
            "grblHAL 2538, PicoMite 5052 with 188 steps lost",
        ),
        Job(
            "200 x 1 mm zigzag, F6000",
            ["G1 F6000", *zigzag],
            100,
            "grblHAL 10460 (0.05 mm: 8417), PicoMite 9049",
        ),
        Job(
            "the same circle as one G2",
            ["G1 F3000", "G3 I-20 J0"],
            50,
            "grblHAL 2538, PicoMite 2298 at up to 1.41 F",
        ),
        Job(
            "300 x 1/6 mm in line, F3000",
            ["G1 F3000", *line],
            50,
            "grblHAL 1037, PicoMite 3051 with 100 steps lost",
        ),
    ]


def measure(job: Job, setup: Setup) -> Outcome:
    """Queue a job, then let it go."""
    with tempfile.TemporaryDirectory() as folder:
        result = run(Path(folder), job.lines, setup)
    judge = result.judge()
    feed = judge.feed()
    exact = result.end_steps() == result.corners[-1].tolist() == result.reported_steps()
    mode = "trapezoid" if setup.jerk is None else f"S-curve, {setup.jerk:,.0f} mm/s³"
    best_s = least_time_s(judge.path)
    deviation = setup.machine().junction_deviation_mm
    used = (feed.value - feed.error) / job.feed if feed else 0.0
    return Outcome(
        job.name,
        mode,
        deviation,
        result.taken_s(),
        result.motion_s(),
        best_s,
        exact,
        used,
        job.peers,
        setup.jerk is None,
    )


def peers_outcomes() -> list[Outcome]:
    """The five workloads for which others were measured."""
    rows = []
    for job in jobs():
        for deviation in DEVIATIONS:
            setup = replace(PEERS_MACHINE, junction_mm=deviation)
            rows += [
                measure(job, replace(setup, jerk=jerk))
                for jerk in ((None, *JERKS) if deviation == DEVIATIONS[0] else (None,))
            ]
    return rows


def parts_outcomes() -> list[Outcome]:
    """Parts as CAM programs write them, in both modes."""
    rows = []
    for name, make in {**parts.SHORT, **parts.CONTOUR_LIKE}.items():
        job = Job(name, make(), 100.0)
        rows += [measure(job, replace(PARTS_MACHINE, jerk=jerk)) for jerk in (None, PARTS_JERK)]
    return rows


def goal_of(outcome: Outcome) -> float:
    """Return how much of the optimum's time a part may take in S-curve mode."""
    return 1.10 if outcome.name in parts.SHORT else 1.30
