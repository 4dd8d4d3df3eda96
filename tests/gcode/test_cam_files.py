"""G-code files of CAM programs from A: on the host program, to the end, judged by step edges."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from cam_files import FILES, SCALE, Checked, blocks_of, checked, program
from cam_oracle import judge_bounds, judge_motion, judge_outputs, traces_of

from stepmite.gcode import target_steps
from stepmite.image import Image
from stepmite.trace import Edges

STEPMITE = Path(__file__).parents[2] / "build" / "host" / "stepmite"
PAUSE_S = 0.01
"""What resuming from a pause may take in these programs."""


def carry_out(folder: Path, file: Path, *settings: str) -> tuple[str, Edges]:
    """Check and run a file on the host program; return its output and the edges."""
    flash, trace, source = folder / "flash.bin", folder / "edges.csv", folder / "job.bas"
    image = Image(flash)
    image.write("part.nc", file.read_bytes())
    image.save()
    source.write_text(program(file, *settings))
    done = subprocess.run(
        [STEPMITE, "--virtual", "--flash", flash, "--trace", trace, source],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-1000:] + done.stderr[-1000:]
    return done.stdout, Edges.read(trace)


def assert_done(output: str, report: Checked, share: float) -> None:
    """The file was carried out, in the time that was estimated."""
    assert "Error" not in output
    assert "G-code file done" in output
    assert "underruns: 0" in output
    taken = re.search(r"^Taken ([\d.]+)", output, re.M)
    assert taken
    taken_s = float(taken[1]) / 1000
    assert report.seconds == pytest.approx(taken_s, rel=share, abs=PAUSE_S * (1 + report.pauses))


def test_there_are_enough() -> None:
    assert len(FILES) == 13
    assert all(30 <= len(file.read_text().splitlines()) <= 400 for file in FILES)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_file_runs_unchanged(tmp_path: Path, file: Path) -> None:
    output, edges = carry_out(tmp_path, file)
    report = checked(output)
    assert_done(output, report, 0.01)
    blocks, _ = blocks_of(file)
    assert report.moves == sum(block.kind == "move" for block in blocks)
    assert report.pauses == sum(block.kind == "pause" for block in blocks)
    traces = traces_of(edges)
    judge_bounds(traces, report.machine)
    judge_motion(blocks, traces)
    judge_outputs(blocks, edges)
    reported = [int(n) for n in re.findall(r"^[XYZA]: .*\((-?\d+) steps\)", output, re.M)]
    assert tuple(reported) == target_steps(blocks[-1].target, SCALE)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_s_curves_take_what_was_estimated(tmp_path: Path, file: Path) -> None:
    for jerk in (10000, 100000):
        output, edges = carry_out(tmp_path, file, "STEPPER SCURVE 1", f"STEPPER JERK {jerk}")
        assert_done(output, checked(output), 0.15)
        ends = tuple(trace.end_steps() for trace in traces_of(edges))
        assert ends == target_steps(blocks_of(file)[0][-1].target, SCALE)
