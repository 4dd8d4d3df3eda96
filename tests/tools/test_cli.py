"""The commands as a user calls them."""

import re
import signal
import subprocess
import sys
import time

import pytest
from synthetic import edges_of
from typer.testing import CliRunner

from stepmite.cli import app
from stepmite.machine import machine_from_status
from stepmite.stream_cmd import clock, time_left

PART = ["G90 G1 F1200"] + [f"X{i % 7}.5 Y{i}" for i in range(100)]


@pytest.fixture
def part(tmp_path):
    path = tmp_path / "part.nc"
    path.write_text("\n".join(PART) + "\n")
    return path


def call(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


def test_stream_sends_the_file(fake, part):
    machine = fake()
    result = call("stream", part, "--port", machine.device)
    assert result.exit_code == 0, result.output
    assert len(machine.accepted) == len(PART)
    assert "Done: 101 lines" in result.output
    assert "now at X1.500 Y-2.000" in result.output


def test_refused_line_is_shown_with_file_line_and_message(fake, part):
    machine = fake(refuse={"X1.5Y50": "Y position exceeds soft limits"})
    result = call("stream", part, "--port", machine.device)
    assert result.exit_code == 1
    assert "Error: part.nc:52: X1.5 Y50\nY position exceeds soft limits" in result.output
    assert "Stopped at X1.500 Y-2.000" in result.output


def test_setup_file_is_sent_first_and_its_errors_name_the_line(fake, part, tmp_path):
    good, bad = tmp_path / "good.bas", tmp_path / "bad.bas"
    good.write_text("STEPPER RUN\n\n")
    bad.write_text("PRINT 1\nSTEPPER NONSENSE\n")
    machine = fake(armed=False)
    assert call("stream", part, "--port", machine.device, "--setup", good).exit_code == 0
    assert machine.runs == 1
    result = call("stream", part, "--port", fake().device, "--setup", bad)
    assert result.exit_code == 1
    assert "bad.bas:2: STEPPER NONSENSE\nUnknown command" in result.output


def test_missing_port_and_file(part, tmp_path):
    result = call("stream", part, "--port", "/dev/no-such-port")
    assert result.exit_code == 1
    assert "cannot open /dev/no-such-port" in result.output
    assert call("stream", tmp_path / "missing.nc", "--port", "x").exit_code == 2


def test_ctrl_c_stops_the_machine_and_exits_with_130(fake, part):
    machine = fake(drain=0)
    command = [sys.executable, "-m", "stepmite.cli", "stream", part, "--port", machine.device]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    while len(machine.accepted) < 32:
        assert process.poll() is None
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    output, _ = process.communicate(timeout=20)
    assert process.returncode == 130
    assert machine.breaks == 1
    assert "Stopped at X1.500" in output


def test_dry_run_needs_no_board(part):
    result = call("stream", part, "--dry-run")
    assert result.exit_code == 0
    assert re.search(r"Y\s+│ 0.000 to 99.000", result.output)
    assert re.search(r"moves\s+│ 100", result.output)


def test_dry_run_shows_how_far_arcs_reach(part):
    part.write_text("G1 X10 F100\nG3 X-10 I-10\nG64 P0.1\nG1 Y-1\n")
    result = call("stream", part, "--dry-run")
    assert result.exit_code == 0, result.output
    assert "-10.000 to 10.000" in result.output
    assert re.search(r"-1\.000 to (10\.000|9\.99\d)", result.output)


def test_dry_run_finds_the_bad_line(part):
    part.write_text("G1 X1 F100\nG5 X1 I5\n")
    result = call("stream", part, "--dry-run")
    assert result.exit_code == 1
    assert "part.nc:2: G5 X1 I5" in result.output


def test_plot_draws_a_picture(part, tmp_path):
    edges_of(PART)[0].write(tmp_path / "edges.csv")
    picture = tmp_path / "plot.png"
    axes = ["--axis", "X=2,3,80", "--axis", "Y=4,5,inv,80"]
    result = call("plot", tmp_path / "edges.csv", *axes, "-o", picture, "--gcode", part)
    assert result.exit_code == 0, result.output
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("axis", "message"), [("X=2", "expected NAME=step,dir"), ("X=20,21", "no steps on the pins")]
)
def test_plot_says_what_is_wrong(tmp_path, axis, message):
    edges_of(["G1 X1 F600"])[0].write(tmp_path / "edges.csv")
    result = call("plot", tmp_path / "edges.csv", "--axis", axis, "-o", tmp_path / "plot.png")
    assert result.exit_code == 1
    assert message in result.output


def test_ports_answers():
    assert call("ports").exit_code in (0, 1)


def test_clock_and_time_left():
    assert [clock(s) for s in (0, 59.6, 61, 3725)] == ["0:00", "1:00", "1:01", "1:02:05"]
    assert time_left(100, 0, 5) == 100
    assert time_left(100, 50, 60) == 60


def test_limits_are_read_off_the_status_report():
    machine = machine_from_status(
        [
            "Junction deviation: 0.05 mm, arc tolerance: 0.05 mm",
            "Z motion: 400 steps/mm, max 600 mm/min, 120.5 mm/s^2",
            "A motion: 10 steps/deg, max 3600 deg/min, 1e+03 deg/s^2",
        ]
    )
    assert machine.junction_deviation_mm == 0.05
    assert machine.max_velocity == (100, 100, 10, 60)
    assert machine.max_acceleration == (500, 500, 120.5, 1000)
