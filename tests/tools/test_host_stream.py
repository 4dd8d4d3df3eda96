"""The stream against the real firmware, as the host build behind a pty."""

import os
import signal
import subprocess
import sys
import time
import tty
from pathlib import Path

import pytest
from synthetic import PINS, traces_of
from typer.testing import CliRunner

from stepmite.board import Board, BoardError, Cancelled
from stepmite.cli import app
from stepmite.gcode import read_blocks, read_lines, target_steps
from stepmite.stream import Streamer, prepare
from stepmite.stream_cmd import run_setup
from stepmite.trace import Edges

ROOT = Path(__file__).parents[2]
HOST = ROOT / "build" / "host" / "stepmite"
EXAMPLE = ROOT / "examples" / "nameplate.nc"
SETUP = [
    "STEPPER INIT ,64",
    "STEPPER AXIS X,GP2,GP3,,,80,6000,500",
    "STEPPER AXIS Y,GP4,GP5,,1,80,6000,500",
    "STEPPER AXIS Z,GP6,GP7,,,400,3000,500",
    "STEPPER SPINDLE GP22",
    "STEPPER LIMITS Y,-50,50",
    "STEPPER POSITION HOME",
]


class HostBoard:
    """The host program with the far end of a pty as its console."""

    def __init__(self, folder, machine=""):
        self.trace = folder / "edges.csv"
        self._far, self._near = os.openpty()
        tty.setraw(self._near)
        self.device = os.ttyname(self._near)
        command = [HOST, "--virtual", "--trace", self.trace]
        if machine:
            (folder / "machine.txt").write_text(machine)
            command += ["--machine", folder / "machine.txt"]
        self.process = subprocess.Popen(command, stdin=self._far, stdout=self._far)

    def close(self):
        """Ends the program; the trace is complete then."""
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(timeout=20)
        os.close(self._far)
        os.close(self._near)

    def edges(self):
        return Edges.read(self.trace)


@pytest.fixture
def board(tmp_path):
    assert HOST.exists(), f"{HOST} is missing: run `make host` first"
    machine = HostBoard(tmp_path)
    yield machine
    if machine.process.poll() is None:
        machine.close()


@pytest.fixture
def setup_file(tmp_path):
    path = tmp_path / "machine.bas"
    path.write_text("\n".join(SETUP) + "\n")
    return path


def call(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


def end_of(lines):
    return target_steps(list(read_blocks(lines))[-1].target, (80, 80, 400, 1))[:2]


def test_the_example_is_streamed_and_ends_where_it_should(board, setup_file):
    result = call("stream", EXAMPLE, "--port", board.device, "--setup", setup_file)
    assert result.exit_code == 0, result.output
    assert "Done: 771 lines" in result.output
    assert "now at X0.000 Y0.000 Z3.000" in result.output
    board.close()
    traces = traces_of(board.edges(), PINS)
    assert tuple(trace.end_steps() for trace in traces) == end_of(read_lines(EXAMPLE))


def test_refused_line_stops_exactly_there(board, setup_file, tmp_path):
    part = tmp_path / "part.nc"
    lines = ["G90 G1 F1200"] + [f"X{n} Y{n / 2}" for n in range(1, 200)]
    part.write_text("\n".join(lines) + "\n")
    result = call("stream", part, "--port", board.device, "--setup", setup_file)
    assert result.exit_code == 1
    assert "part.nc:102: X101 Y50.5\nY position exceeds soft limits" in result.output
    with Board.open(board.device) as prompt:
        assert prompt.peek("ACTIVE") == 0
        assert prompt.peek("X") <= 100


def interrupted(board, setup, part, trace_bytes: int) -> str:
    """What `stream` says that gets a Ctrl-C when this much of the trace is there."""
    command = [sys.executable, "-m", "stepmite.cli", "stream", part, "--port", board.device]
    process = subprocess.Popen(
        [*command, "--setup", setup], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        deadline = time.monotonic() + 20
        while not board.trace.exists() or board.trace.stat().st_size < trace_bytes:
            assert process.poll() is None, process.communicate()
            assert time.monotonic() < deadline
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=20)
    finally:
        process.kill()
    assert process.returncode == 130, output + errors
    return output


def test_ctrl_c_brings_a_controlled_stop(board, setup_file, tmp_path):
    part = tmp_path / "part.nc"
    part.write_text("G91 G1 F600\n" + "X1\nX-1\n" * 2000)
    output = interrupted(board, setup_file, part, 20_000)
    assert "Stopped at X" in output
    with Board.open(board.device) as prompt:
        assert prompt.peek("ACTIVE") == 0
        stopped_at = prompt.peek("X")
    board.close()
    assert traces_of(board.edges(), PINS)[0].end_steps() == round(stopped_at * 80)


PAUSES = ["G21 G90 G1 X5 F6000", "M0", "X7", "T3 M6", "X9", "M30"]


def stream_pauses(board, setup_file, answer):
    """Stream PAUSES; `answer` is called with the streamer at each pause. Returns what was told."""
    told = []

    def tell(line):
        told.append(line)
        if "STEPPER RESUME" in line:
            answer(streamer)

    with Board.open(board.device, on_notice=tell) as prompt:
        run_setup(prompt, setup_file)
        streamer = Streamer(prompt, prepare("part.nc", PAUSES))
        try:
            streamer.run()
        finally:
            told.append(prompt.peek("X"))
    return told


def test_pauses_are_ended_from_here(board, setup_file):
    """M0 and a tool change are told and go on when the user says so."""
    told = stream_pauses(board, setup_file, lambda streamer: streamer.resume())
    assert sum("STEPPER RESUME" in str(line) for line in told) == 2
    assert any("Tool 3" in str(line) for line in told)
    assert told[-1] == 9


def test_a_pause_lasts_until_somebody_acts(board, setup_file):
    """Who cancels at M0 finds the machine where M0 stands."""
    with pytest.raises(Cancelled):
        stream_pauses(board, setup_file, lambda streamer: streamer.cancel())
    with Board.open(board.device) as prompt:
        assert prompt.peek("X") == 5


HOMES = ["G21 G90 G1 X5 F6000", "M0", "X7", "G28 X0", "X9", "M30"]


def test_homing_and_pauses_in_a_file(tmp_path):
    """Homing waits for what was sent, which a pause may hold up; the machine is armed by then."""
    switch = "axis X step=2 dir=3 at=800\nswitch pin=16 axis=X to=0\n"
    machine = HostBoard(tmp_path, switch)
    file = tmp_path / "machine.bas"
    file.write_text("\n".join([*SETUP, "STEPPER HWLIMITS GP16", "STEPPER GC G28"]))
    told = []

    def answer(notice):
        told.append(notice)
        if "STEPPER RESUME" in notice:
            streamer.resume()

    try:
        with Board.open(machine.device) as prompt:
            run_setup(prompt, file)
            prompt.on_notice = answer
            streamer = Streamer(prompt, prepare("part.nc", HOMES))
            streamer.run()
            assert sum("STEPPER RESUME" in line for line in told) == 1
            assert prompt.peek("X") == 9
    finally:
        machine.close()


def test_ctrl_c_while_the_setup_homes(tmp_path):
    """The axis brakes; nothing of the file has been sent."""
    machine = HostBoard(tmp_path, "axis X step=2 dir=3 at=800000\n")
    file, part = tmp_path / "machine.bas", tmp_path / "part.nc"
    lines = [*SETUP, "STEPPER HWLIMITS GP16", "STEPPER HOME X,,1,,,9999", "STEPPER GC G28"]
    file.write_text("\n".join(lines))
    part.write_text("G1 X1 F100\n")
    try:
        output = interrupted(machine, file, part, 10_000)
        assert "Stopped while the machine was set up" in output
        with Board.open(machine.device) as prompt:
            assert prompt.peek("ACTIVE") == 0
    finally:
        machine.close()


def test_the_machine_must_be_set_up(board, tmp_path):
    part = tmp_path / "part.nc"
    part.write_text("G1 X1 F100\n")
    result = call("stream", part, "--port", board.device)
    assert result.exit_code == 1
    assert "STEPPER INIT" in result.output


def test_running_program_is_reported_and_left_alone(board, tmp_path):
    with Board.open(board.device) as prompt:
        assert prompt.command("PRINT 1/4") == [" 0.25"]
        with pytest.raises(BoardError):
            prompt.command("NONSENSE 5")
        prompt._write(b"DO:PAUSE 10:LOOP\r")
    part = tmp_path / "part.nc"
    part.write_text("G1 X1 F100\n")
    result = call("stream", part, "--port", board.device)
    assert result.exit_code == 1
    assert "a program is running" in result.output


def test_half_a_typed_line_is_not_carried_out(board):
    with Board.open(board.device) as prompt:
        prompt._write(b"STEPPER INIT ,5")
        time.sleep(0.2)
    with Board.open(board.device) as prompt:
        assert prompt.peek("ACTIVE") == -1


def test_long_lines_are_recognised_in_the_echo(board):
    with Board.open(board.device) as prompt:
        text = 'PRINT "' + "x" * 240 + '"'
        assert prompt.command(text) == ["x" * 240]


def test_files_of_cam_programs_are_streamed(board):
    """Cycles that need more places than the queue has, offsets, pauses that somebody ends."""
    setup = [
        SETUP[0].replace("64", "16"),
        *SETUP[1:4],
        "STEPPER AXIS A,GP8,GP9,,,10,36000,2000",
        "STEPPER SPINDLE GP22,,20000,,,100,GP21",
        "STEPPER COOLANT GP20,GP19",
    ]
    with Board.open(board.device) as opened:
        for line in setup:
            opened.command(line)
        for name in ("fusion_drill", "rotary_wrap"):
            lines = read_lines(ROOT / "tests" / "gcode" / "files" / f"{name}.nc")
            opened.command("STEPPER POSITION HOME")
            streamer = Streamer(opened, prepare(name, lines))
            pauses = []

            def hear(notice, streamer=streamer, pauses=pauses):
                if "STEPPER RESUME" in notice:
                    pauses.append(notice)
                    streamer.resume()

            opened.on_notice = hear
            streamer.run()
            wanted = sum(block.kind == "pause" for block in read_blocks(lines))
            assert len(pauses) == wanted, pauses
            assert [round(opened.peek(axis) * 80) for axis in "XY"] == list(end_of(lines))
