"""What an error does to motion: OPTION ERROR STOP|RUN for programs, nothing at the prompt."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from test_host_port import run

from stepmite.trace import Edges

SETUP = """\
STEPPER INIT
STEPPER AXIS X,GP2,GP3,GP4,,80,6000,500
STEPPER POSITION HOME
STEPPER RUN
STEPPER GC G1 X50 F3000
STEPPER GC G1 X0
"""
STEP_GPIO, ENABLE_GPIO = 2, 4
STEPS_PER_MM, SPEED_MM_S, ACCELERATION = 80, 50, 500
WHOLE_STEPS = 2 * 50 * STEPS_PER_MM
NOTICE = "Error: motion stops, what was queued is dropped"
ENDINGS = ["PAUSE 400\nPRINT 1/0\n", "SETTICK 400, t\nDO: LOOP\nSUB t\nPRINT 1/0\nEND SUB\n"]


def carry_out(tmp_path: Path, ending: str, *options: str) -> tuple[str, Edges]:
    """What the program prints that ends by an error, and its edges."""
    source = tmp_path / "error.bas"
    source.write_text(SETUP + ending)
    trace = tmp_path / "edges.csv"
    done = run("--virtual", "--trace", trace, *options, source, code=1)
    return done.stdout.decode(), Edges.read(trace)


def step_times_s(edges: Edges) -> np.ndarray:
    steps = edges.of(STEP_GPIO)
    return steps.time_ns[steps.level == 1] * 1e-9


@pytest.mark.parametrize("ending", ENDINGS)
def test_an_error_brings_motion_to_a_controlled_stop(tmp_path: Path, ending: str) -> None:
    """Full speed at the error; braking from there takes v/a, and no driver is dropped."""
    output, edges = carry_out(tmp_path, ending)
    assert NOTICE in output
    assert "Divide by zero" in output
    times = step_times_s(edges)
    braking = times[times > times[-1] - SPEED_MM_S / ACCELERATION]
    way_mm = SPEED_MM_S**2 / ACCELERATION / 2
    assert len(braking) == pytest.approx(way_mm * STEPS_PER_MM, rel=0.1)
    speeds = 1 / np.diff(times) / STEPS_PER_MM
    assert speeds.max() == pytest.approx(SPEED_MM_S, rel=0.02)
    assert 0.4 < times[-1] - times[0] < 0.55
    drivers = edges.of(ENABLE_GPIO)
    assert drivers.level[-1] == 0


@pytest.mark.parametrize("ending", ENDINGS)
def test_motion_runs_out_if_the_option_says_so(tmp_path: Path, ending: str) -> None:
    flash = tmp_path / "flash.bin"
    run("--virtual", "--flash", flash, text="OPTION ERROR RUN\r")
    output, edges = carry_out(tmp_path, ending, "--flash", str(flash))
    assert NOTICE not in output
    assert len(step_times_s(edges)) == WHOLE_STEPS
    run("--virtual", "--flash", flash, text="OPTION ERROR STOP\r")
    assert NOTICE in carry_out(tmp_path, ending, "--flash", str(flash))[0]


@pytest.mark.parametrize("line", ["PRINT 1/0", "NOSUCH", "ERROR", "STEPPER GC G1 X5 Q7"])
def test_an_error_at_the_prompt_disturbs_nothing(tmp_path: Path, line: str) -> None:
    trace = tmp_path / "edges.csv"
    text = SETUP + f"PAUSE 400\n{line}\nPAUSE 10000\n"
    output = run("--virtual", "--trace", trace, text=text).stdout.decode()
    assert "Error" in output
    assert len(step_times_s(Edges.read(trace))) == WHOLE_STEPS


def test_an_error_that_is_ignored_disturbs_nothing(tmp_path: Path) -> None:
    ending = "ON ERROR IGNORE\nPAUSE 400\nPRINT 1/0\nPAUSE 5000\nON ERROR ABORT\nPRINT 1/0\n"
    output, edges = carry_out(tmp_path, ending)
    assert NOTICE not in output
    assert len(step_times_s(edges)) == WHOLE_STEPS


def test_an_error_drops_what_waits_for_run(tmp_path: Path) -> None:
    """It must not surprise whoever says STEPPER RUN later."""
    text = SETUP.replace("STEPPER RUN\n", "")
    typed = f"AUTOSAVE\n{text}PRINT 1/0\n\x1aRUN\nPRINT PEEK(STEPPER BUFFER)\n"
    output = run("--virtual", text=typed).stdout.decode()
    assert output.replace("\r", "").split("\n")[-2].strip() == "32"  # all free
