"""Limits, path and end positions of a thousand random programs, judged by step edges alone."""

import re
import subprocess
from dataclasses import dataclass
from random import Random

import numpy as np
import pytest
from host_machine import HOST_PROGRAM, Setup
from random_programs import Jog, Program, random_program, random_setup, script

from stepmite import oracle
from stepmite.follow import follow
from stepmite.gcode import read_blocks, target_steps
from stepmite.limits import Judge, of_one_axis
from stepmite.path import build
from stepmite.trace import AxisTrace, Edges, TraceError, axis_trace

SESSIONS, PROGRAMS = 40, 25
MARK_GPIO = 22
SPEED, ACCELERATION, CORNER, JERK = 1.02, 1.02, 1.02, 1.05
"""Of the limits, as much may be used."""
FEATURES = {"scurve", "modes", "arcs", "jog"}


@dataclass(frozen=True)
class Session:
    """What one run of the host program has done."""

    setup: Setup
    programs: list[Program]
    parts: list[Edges]
    """Edges of each program and each jog, in order."""
    reported: list[list[int]]
    """Position after each program in steps, as STEPPER STATUS says."""


def carry_out(folder, seed: int) -> Session:
    rng = Random(seed)
    setup = random_setup(rng)
    programs = [random_program(rng, setup, FEATURES) for _ in range(PROGRAMS)]
    trace = folder / "edges.csv"
    done = subprocess.run(
        [HOST_PROGRAM, "--virtual", "--trace", trace],
        input=script(setup, programs),
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    assert "Error" not in done.stdout, re.findall(r".*\n.*Error.*", done.stdout)
    edges = Edges.read(trace)
    trace.unlink()
    found = re.findall(r"^[XYZA]: .*\((-?\d+) steps\)", done.stdout, re.M)
    reported = np.array(found, dtype=int).reshape(-1, 4).tolist()
    return Session(setup, programs, cut_at_marks(edges), reported)


def cut_at_marks(edges: Edges) -> list[Edges]:
    """Cut where the spindle's pin goes up and down; direction pins keep their level."""
    ups = np.flatnonzero((edges.gpio == MARK_GPIO) & (edges.level == 1))
    downs = np.flatnonzero((edges.gpio == MARK_GPIO) & (edges.level == 0))
    parts = []
    for up, down in zip(ups, downs, strict=True):
        levels = [
            (edges.time_ns[up], gpio, edges.level[:up][edges.gpio[:up] == gpio][-1])
            for gpio in (3, 5, 7, 9)
            if (edges.gpio[:up] == gpio).any()
        ]
        rows = np.stack([edges.time_ns, edges.gpio, edges.level], axis=1)[up + 1 : down]
        table = np.concatenate([np.array(levels, dtype=np.int64).reshape(-1, 3), rows])
        parts.append(Edges(table[:, 0], table[:, 1], table[:, 2]))
    return parts


def traces_of(edges: Edges, setup: Setup) -> list[AxisTrace]:
    traces = [axis_trace(edges, pins) for pins in setup.pins()]
    for trace in traces:
        assert oracle.min_step_gap_ticks(trace) >= 2
        assert oracle.min_dir_setup_ns(trace) >= 10_000
    return traces


def expect(finding, most: float) -> None:
    assert finding is None or finding.used <= most, str(finding)


def judge_program(program: Program, edges: Edges, setup: Setup, reported: list[int]) -> None:
    traces = traces_of(edges, setup)
    ends = [trace.end_steps() for trace in traces]
    assert ends == reported
    blocks = list(read_blocks(program.lines))
    path = build(blocks, program.machine, setup.steps_per_unit)
    if not program.stopped:
        assert ends == list(target_steps(blocks[-1].target, setup.steps_per_unit))
    moved = [trace for trace in traces if len(trace.step_ns)]
    if len(path.pieces) == 0 or sum(len(trace.step_ns) for trace in moved) < 2:
        return
    progress = follow(path, moved, whole=not program.stopped)
    judge = Judge(path, program.machine, progress, moved, program.feed_factor)
    assert judge.deviation_steps().value <= 1.0, str(judge.deviation_steps())
    expect(judge.feed(), SPEED)
    expect(judge.path_acceleration(), ACCELERATION)
    expect(judge.corners(), CORNER)
    for axis in progress.axes:
        expect(judge.axis_speed(axis), SPEED)
        expect(judge.axis_acceleration(axis), ACCELERATION)
    if np.isfinite(program.machine.path_jerk):
        for span_ms in jerk_spans_ms(program, setup):
            expect(judge.path_jerk(int(span_ms * 1e6)), JERK)


def jerk_spans_ms(program: Program, setup: Setup) -> list[float]:
    """Parts of the time that the acceleration takes to build up."""
    build_up_ms = min(setup.max_acceleration) / program.machine.path_jerk * 1000
    return [build_up_ms * part for part in (0.2, 0.35, 0.6, 1.0) if build_up_ms * part >= 3]


def judge_jog(jog: Jog, program: Program, edges: Edges, setup: Setup) -> None:
    traces = traces_of(edges, setup)
    assert not any(len(trace.step_ns) for n, trace in enumerate(traces) if n != jog.axis)
    trace = traces[jog.axis]
    assert jog.end_steps in (None, trace.end_steps())
    machine = program.machine
    fastest = min(machine.max_velocity[jog.axis], jog.feed_per_min / 60)
    expect(of_one_axis(trace, 1, 5_000_000, fastest, fastest), SPEED)
    hardest = machine.max_acceleration[jog.axis]
    expect(of_one_axis(trace, 2, 12_000_000, hardest, fastest), ACCELERATION)
    if np.isfinite(machine.path_jerk):
        for span_ms in jerk_spans_ms(program, setup):
            found = of_one_axis(trace, 3, int(span_ms * 1e6), machine.path_jerk, fastest)
            expect(found, JERK)


def problems_of(session: Session) -> list[str]:
    """Judge everything; one line for each program or jog that is not as it should be."""
    parts, problems = iter(session.parts), []
    for number, program in enumerate(session.programs):
        jobs = [(f"program {number}", judge_program, (session.reported[number],))]
        jobs += [(f"jog after {number}", judge_jog, ()) for _ in program.jogs]
        for index, (name, judge, rest) in enumerate(jobs):
            edges = next(parts)
            try:
                if judge is judge_program:
                    judge_program(program, edges, session.setup, *rest)
                else:
                    judge_jog(program.jogs[index - 1], program, edges, session.setup)
            except (AssertionError, TraceError) as problem:
                problems.append(f"{name}: {problem}")
    return problems


@pytest.mark.parametrize("seed", range(SESSIONS))
def test_random_programs_keep_all_limits(tmp_path, seed):
    assert not problems_of(carry_out(tmp_path, seed))
