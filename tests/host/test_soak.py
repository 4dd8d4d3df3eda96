"""A day of virtual time: nothing leaks and nothing drifts.

Virtual time jumps while the program waits, so 24 hours with a move every five seconds, files, texts
and some two million events take seconds.
"""

from __future__ import annotations

import re
import subprocess
from itertools import pairwise
from pathlib import Path

STEPMITE = Path(__file__).parents[2] / "build" / "host" / "stepmite"
PROGRAM = Path(__file__).with_name("soak.bas").read_text()
DAY_S, TURN_S = 24 * 3600, 5
STEPS_PER_MM = 80
TICK_US = 37_000  # of the faster SETTICK


def run(folder: Path, turns: int, *options: str | Path, program: str = PROGRAM) -> str:
    source = folder / "soak.bas"
    source.write_text(program.replace("TURNS\n", f"{turns}\n"))
    done = subprocess.run(
        [STEPMITE, "--virtual", *options, source], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stdout[-1000:] + done.stderr
    return done.stdout


def target_steps(turn: int) -> tuple[int, int]:
    return round(turn * 7 % 11 / 8 * STEPS_PER_MM), round(-(turn * 3 % 5) / 4 * STEPS_PER_MM)


def check(shown: str, turns: int) -> None:
    free = re.findall(r"free (\d+) of (\d+) bytes", shown)
    assert len(free) == 2
    assert free[0] == free[1], "memory was lost"
    counts = re.search(r"seconds (\d+) kicks (\d+) lines (\d+) ms ([\d.]+)", shown)
    assert counts
    us = float(counts[4]) * 1000
    assert turns * TURN_S * 1e6 <= us < turns * TURN_S * 1e6 + 100_000
    assert int(counts[1]) == us // 1_000_000
    assert int(counts[2]) == us // TICK_US
    assert int(counts[3]) == turns // 10 * 10
    assert f"executed: {turns}, underruns: 0" in shown
    steps = tuple(map(int, re.findall(r"\((-?\d+) steps\)", shown)))
    assert steps == target_steps(turns)


def test_a_day(tmp_path: Path) -> None:
    turns = DAY_S // TURN_S
    check(run(tmp_path, turns), turns)


def test_every_step_of_an_hour_is_made(tmp_path: Path) -> None:
    turns = 3600 // TURN_S
    trace = tmp_path / "edges.csv"
    check(run(tmp_path, turns, "--trace", trace), turns)
    rows = [tuple(map(int, row.split(","))) for row in trace.read_text().splitlines()[1:]]
    raised = [sum(gpio == pin and level == 1 for _, gpio, level in rows) for pin in (2, 4)]
    ways = [[target_steps(turn)[axis] for turn in range(turns + 1)] for axis in (0, 1)]
    for axis, way in enumerate(ways):
        assert raised[axis] == sum(abs(b - a) for a, b in pairwise(way))


def test_a_planted_leak_is_seen(tmp_path: Path) -> None:
    leaking = PROGRAM.replace(
        "  note s$, x\n", '  note s$, x\n  EXECUTE "DIM leak" + STR$(turn%) + "%(9)"\n'
    )
    shown = run(tmp_path, 20, program=leaking)
    free = re.findall(r"free (\d+) of", shown)
    assert len(free) == 2
    assert free[0] != free[1]
