"""Arcs and blends in random programs: limits, path and ends, judged from the edges."""

import itertools
import math
import random

import numpy as np
import pytest
from host_machine import MACHINES, Setup, run

from stepmite import oracle
from stepmite.arcs import PLANES
from stepmite.gcode import AXES
from stepmite.trace import merge

TOLERANCE = 1.02


class Pen:
    """Draws lines and arcs behind each other, tangential or not, in the plane that is on."""

    def __init__(self, seed: int, reach: float) -> None:
        self.rng = random.Random(seed)
        self.reach = reach
        self.heading = 0.0
        self.plane = "G17"
        self.lines = ["G91"]

    def length(self) -> float:
        return self.reach * self.rng.choice([0.003, 0.02, 0.2, 1.0]) * self.rng.uniform(0.5, 1)

    def feed(self) -> str:
        return f"F{self.rng.randint(300, 6000)}"

    def turn(self) -> None:
        """A tangential joint in half of the cases, else any corner."""
        self.heading += self.rng.choice([0.0, 0.0, self.rng.uniform(-math.pi, math.pi)])

    def words(self, first: float, second: float, letters: str = "XYZ") -> str:
        names = [letters[axis] for axis in PLANES[self.plane]]
        return f"{names[0]}{first:.4f} {names[1]}{second:.4f}"

    def also(self) -> str:
        """The third axis and A, now and then."""
        words = ""
        if self.rng.random() < 0.2:
            third = "XYZ"[3 - sum(PLANES[self.plane])]
            words += f" {third}{self.rng.uniform(-0.05, 0.05) * self.reach:.3f}"
        if self.rng.random() < 0.15:
            words += f" A{self.rng.uniform(-1, 1) * self.reach:.3f}"
        return words

    def line(self) -> None:
        self.turn()
        length = self.length()
        way = length * math.cos(self.heading), length * math.sin(self.heading)
        motion = "G0" if self.rng.random() < 0.1 else f"G1 {self.feed()}"
        self.lines.append(f"{motion} {self.words(*way)}{self.also()}")

    def arc(self) -> None:
        self.turn()
        sweep = self.rng.choice([-1, 1]) * self.rng.choice([0.05, 0.5, math.pi, 2 * math.pi])
        if abs(sweep) < 6:
            sweep *= self.rng.uniform(0.5, 1.5)
        radius = max(0.02, min(self.length() / abs(sweep), self.reach))
        side = self.heading + math.copysign(math.pi / 2, sweep)
        centre = radius * math.cos(side), radius * math.sin(side)
        end = [
            centre[n] - radius * (math.cos(side + sweep), math.sin(side + sweep))[n] for n in (0, 1)
        ]
        words = self.words(*end) if abs(sweep) < 6.28 else self.words(0.0, 0.0)
        motion = "G3" if sweep > 0 else "G2"
        turns = f" P{self.rng.randint(1, 3)}" if self.rng.random() < 0.1 else ""
        self.lines.append(
            f"{motion} {self.feed()} {words} {self.words(*centre, 'IJK')}{self.also()}{turns}"
        )
        self.heading += sweep

    def draw(self, count: int, arcs: float = 0.5) -> list[str]:
        for _ in range(count):
            if self.rng.random() < 0.05:
                self.plane = self.rng.choice(list(PLANES))
                self.lines.append(self.plane)
            if self.rng.random() < arcs:
                self.arc()
            else:
                self.line()
        return self.lines


def check(moved) -> None:
    assert moved.end_steps() == moved.corners[-1].tolist()
    judge = moved.judge()
    deviation, feed, along = judge.deviation_steps(), judge.feed(), judge.path_acceleration()
    assert deviation.used <= 1.0, deviation
    assert feed.used <= 1.01, feed
    assert along.used <= TOLERANCE, along
    for axis in judge.progress.axes:
        speed, acceleration = judge.axis_speed(axis), judge.axis_acceleration(axis)
        assert speed.used <= TOLERANCE, speed
        assert acceleration.used <= TOLERANCE, acceleration


@pytest.mark.parametrize("reach", [60.0, 12.0])
@pytest.mark.parametrize("name", MACHINES)
def test_lines_and_arcs(tmp_path, name, reach):
    check(run(tmp_path, Pen(int(reach), reach).draw(150), MACHINES[name]))


@pytest.mark.parametrize(("reach", "tolerance"), [(60.0, 0.1), (60.0, 0.005), (5.0, 2.0)])
@pytest.mark.parametrize("name", MACHINES)
def test_blends(tmp_path, name, reach, tolerance):
    lines = [f"G64 P{tolerance}", *Pen(int(reach), reach).draw(120, arcs=0.1)]
    check(run(tmp_path, lines, MACHINES[name]))


@pytest.mark.parametrize("tolerance", [0.02, 0.5])
def test_blends_stay_within_their_tolerance(tmp_path, tolerance):
    """The motors beside the corners as they were programmed, with nothing known about blends."""
    setup = Setup(steps_per_unit=(100.0,) * 4, queue_first=True)
    pen = Pen(7, 20.0)
    lines = [f"G64 P{tolerance}", *pen.draw(150, arcs=0.0)]
    moved = run(tmp_path, lines, setup)
    path = merge(moved.traces).steps.astype(float)
    points = np.zeros((len(path), 4))
    points[:, [AXES.index(trace.name) for trace in moved.traces]] = path
    distance = oracle.path_deviation(points, moved.corners.astype(float))
    assert distance <= tolerance * 100 + 1
    assert distance >= tolerance * 100 * 0.5


def time_of(folder, mode: str, lines: list[str], **setup) -> float:
    return run(folder, [mode, *lines], Setup(queue_first=True, **setup)).motion_s()


def test_a_wider_tolerance_is_faster_and_none_is_slowest(tmp_path):
    lines = ["G91 F6000", *["G1 X5", "G1 Y5", "G1 X5", "G1 Y-5"] * 10]
    modes = ["G61.1", "G64 P0.02", "G64 P0.1", "G64 P0.5"]
    times = [time_of(tmp_path, mode, lines) for mode in modes]
    assert all(later < sooner * 0.97 for sooner, later in itertools.pairwise(times)), times


def test_arcs_and_lines_that_are_tangential_are_passed_at_speed(tmp_path):
    """An oval: two straight sides, two half circles, at 50 mm/s throughout."""
    lines = ["F3000", "G1 X100", "G3 Y40 J20", "G1 X0", "G3 Y0 J-20"]
    way = 200 + 2 * math.pi * 20
    setup = {"max_acceleration": (500.0,) * 4}
    # Speeds up and slows down once: 50 / 500 s lost; on the arcs with 0.9 of the acceleration.
    assert time_of(tmp_path, "G64", lines, **setup) == pytest.approx(way / 50 + 0.1, abs=0.015)
    assert time_of(tmp_path, "G61", lines, **setup) == pytest.approx(way / 50 + 0.1, abs=0.015)
    stops = time_of(tmp_path, "G61.1", lines, **setup)
    assert stops == pytest.approx(way / 50 + 4 * 0.1, abs=0.03)


def test_peers_circle(tmp_path):
    lines = ["G2 I20 F3000"]
    setup = {"max_acceleration": (1000.0,) * 4, "max_velocity_per_min": (12000.0,) * 4}
    assert 2.54 <= time_of(tmp_path, "G64", lines, **setup) <= 2.57
