#!/usr/bin/env python3
"""Pictures of motion: trapezoid beside S-curve, rebuilt from the step edges of the host program.

.venv/bin/python tests/bench/pictures.py docs/images
"""

import argparse
import math
import sys
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "property"))

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from host_machine import Result, Setup, run

from stepmite.derivatives import Course, along_path
from stepmite.plot import AXIS_COLOURS, INK, style

MACHINE = Setup(
    steps_per_unit=(800.0, 800.0, 800.0, 100.0),
    max_velocity_per_min=(3600.0, 3600.0, 3600.0, 3600.0),
    max_acceleration=(500.0, 500.0, 500.0, 500.0),
    queue_first=True,
    junction_mm=0.02,
)
JERK = 10_000.0
ACCELERATION_SHOWN = 750.0
COLUMNS = ("trapezoid (SCURVE 0)", "S-curve (SCURVE 1)")
CLIP = 2.2
"""Height of the jerk diagrams in limits; a jump of the acceleration goes beyond."""


@dataclass(frozen=True)
class Subject:
    """What a picture shows."""

    name: str
    title: str
    lines: list[str]
    feed: float


def short_segments() -> list[str]:
    points = [n * 0.05 for n in range(1, 601)]
    lines = [f"X{x:.3f} Y{1.5 * math.sin(x / 30 * 4 * math.pi):.4f}" for x in points]
    return ["G1 F3000", *lines]


SUBJECTS = [
    Subject("corner", "A corner of 90 degrees: G1 X10, then Y10", ["G1 F3000 X10", "Y10"], 50),
    Subject("circle", "A full circle, r = 5 mm, as one G2", ["G1 F2400", "G2 I5 J0"], 40),
    Subject("short", "A wave of 600 segments of 0.05 mm", short_segments(), 50),
]


def measure(subject: Subject, setup: Setup) -> tuple[Course, np.ndarray, float]:
    """The course of the motion, its limit of the acceleration and the seconds it took."""
    with tempfile.TemporaryDirectory() as folder:
        result: Result = run(Path(folder), subject.lines, setup)
    judge = result.judge()
    course = along_path(judge.progress)
    begin = judge.progress.time_ns[0]
    way = np.interp(begin + course.time_s * 1e9, judge.progress.time_ns, judge.progress.way)
    limits = np.array([piece.acceleration for piece in judge.path.pieces])
    return course, limits[judge.path.piece_at(way)], result.taken_s()


def draw_limit(axes, time_s: np.ndarray, *values) -> None:
    for value in values:
        limit = np.broadcast_to(value, time_s.shape)
        axes.plot(
            np.append(time_s, 1e3),
            np.append(limit, limit[-1]),
            color="#c8553d",
            linewidth=0.9,
            linestyle=(0, (5, 3)),
            zorder=1,
        )


def draw(subject: Subject, output: Path) -> None:
    """Draw one picture: speed, acceleration and jerk, both modes beside each other."""
    figure, diagrams = plt.subplots(
        3, 2, figsize=(11, 6.6), sharex=True, sharey="row", layout="constrained", facecolor="white"
    )
    figure.get_layout_engine().set(w_pad=0.1, h_pad=0.07)
    figure.suptitle(subject.title, color=INK, fontsize=13, fontweight="bold", x=0.02, ha="left")
    longest = 0.0
    setups = (MACHINE, replace(MACHINE, jerk=JERK))
    for column, (name, setup) in enumerate(zip(COLUMNS, setups, strict=True)):
        course, limit, taken_s = measure(subject, setup)
        rows = (
            (course.speed, AXIS_COLOURS["X"], (subject.feed,), "speed\nin mm/s"),
            (
                course.acceleration,
                AXIS_COLOURS["Z"],
                (limit, -limit),
                "acceleration along\nthe path in mm/s²",
            ),
            (
                course.jerk / 1000,
                AXIS_COLOURS["A"],
                (JERK / 1000, -JERK / 1000),
                "jerk along the\npath in m/s³",
            ),
        )
        for axes, (values, colour, limits, label) in zip(diagrams[:, column], rows, strict=True):
            axes.fill_between(course.time_s, values, color=colour, alpha=0.15, linewidth=0)
            axes.plot(course.time_s, values, color=colour, linewidth=1.2)
            draw_limit(axes, course.time_s, *limits)
            style(axes, "", label if column == 0 else "")
            axes.set_xlim(course.time_s[0], None)
        diagrams[0, column].set_title(
            f"{name}: {taken_s * 1000:.0f} ms", color=INK, fontsize=10, loc="left"
        )
        diagrams[2, column].set_xlabel("time in s", color=INK)
        longest = max(longest, course.time_s[-1])
    for axes in diagrams.flat:
        axes.set_xlim(right=longest)
    diagrams[0, 0].set_ylim(0, subject.feed * 1.15)
    diagrams[1, 0].set_ylim(-ACCELERATION_SHOWN, ACCELERATION_SHOWN)
    diagrams[2, 0].set_ylim(-CLIP * JERK / 1000, CLIP * JERK / 1000)
    diagrams[2, 0].text(
        0.5,
        0.04,
        "jumps of the acceleration go far beyond the diagram",
        transform=diagrams[2, 0].transAxes,
        ha="center",
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 2},
        fontsize=8,
        color=INK,
    )
    diagrams[0, 1].plot(
        [], [], color="#c8553d", linewidth=0.9, linestyle=(0, (5, 3)), label="limit"
    )
    diagrams[0, 1].legend(
        loc="upper right", frameon=False, fontsize=8, labelcolor=INK, bbox_to_anchor=(1, 1.22)
    )
    figure.savefig(output, dpi=110)
    plt.close(figure)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="where motion-*.png are written")
    parser.add_argument("--only", help="name of one picture")
    options = parser.parse_args()
    for subject in SUBJECTS:
        if options.only in (None, subject.name):
            draw(subject, options.folder / f"motion-{subject.name}.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
