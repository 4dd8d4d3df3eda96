"""The command `stepmite emulate`: plain pyserial at the other end, files complete at the end.

These run against the wall clock by nature, so they ask for order and completeness, never for times.
"""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import serial

from stepmite.ticks import read_tick_runs, snap_to_ticks, tick_train
from stepmite.trace import Edges

PATIENCE_S = 60
TICK, MAIN, INPUT = 2, 4, 16


def command(*arguments: str | Path) -> list[str]:
    return [sys.executable, "-m", "stepmite.cli", "emulate", *map(str, arguments)]


@contextmanager
def emulated(*arguments: str | Path, stop: int = signal.SIGTERM) -> Iterator[serial.Serial]:
    """The serial port of an emulator that is ended by a signal."""
    link = Path(arguments[arguments.index("--pty") + 1])
    process = subprocess.Popen(command(*arguments), stderr=subprocess.PIPE, text=True)
    try:
        deadline = time.monotonic() + PATIENCE_S
        while not link.is_symlink():
            assert process.poll() is None, process.stderr.read()
            assert time.monotonic() < deadline
            time.sleep(0.02)
        with serial.Serial(str(link), timeout=PATIENCE_S) as port:
            yield port
    finally:
        process.send_signal(stop)
        error = process.communicate(timeout=PATIENCE_S)[1]
    assert process.returncode == 0, error
    assert not link.is_symlink()


def ask(port: serial.Serial, line: str) -> str:
    port.write(line.encode() + b"\r")
    return port.read_until(b"\n> ").decode("latin-1")


def test_pyserial_and_files(check_uf2: Path, tmp_path: Path) -> None:
    link, trace, report = tmp_path / "port", tmp_path / "edges.csv", tmp_path / "report.json"
    arguments = (check_uf2, "--pty", link, "--trace", trace, "--report", report, "--speed", "0")
    with emulated(*arguments) as port:
        port.read_until(b"> ")
        assert "ticks 2000" in ask(port, "t0")
    content = json.loads(report.read_text())
    assert content["faults"] == []
    assert content["profile"]["systick"]["calls"] == 2000
    edges = snap_to_ticks(Edges.read(trace), read_tick_runs(report))
    train = tick_train(edges, [TICK], [TICK])
    assert [edge.tick for edge in train] == [n // 2 for n in range(4000)]
    assert [edge.level for edge in train] == [1, 0] * 2000


def test_burst_through_the_pty_loses_nothing(check_uf2: Path, tmp_path: Path) -> None:
    lines = [f"line {i} of a burst".ljust(60, ".") for i in range(200)]
    with emulated(check_uf2, "--pty", tmp_path / "port", "--speed", "0") as port:
        port.read_until(b"> ")
        port.write("\r".join(["e", *lines, "", ""]).encode())
        answer = port.read_until(b"\n> ").decode()
    assert answer.replace("\r", "").splitlines()[:-1] == [f"echo {line}" for line in lines]


def test_sigint_ends_it_in_order(check_uf2: Path, tmp_path: Path) -> None:
    trace = tmp_path / "edges.csv"
    arguments = (check_uf2, "--pty", tmp_path / "port", "--trace", trace)
    with emulated(*arguments, stop=signal.SIGINT) as port:
        port.read_until(b"> ")
        ask(port, "g")
    assert [(gpio, level) for _, gpio, level in rows(trace)] == [(MAIN, 1), (MAIN, 0)]


def rows(trace: Path) -> list[tuple[int, ...]]:
    header, *lines = trace.read_text().splitlines()
    assert header == "time_ns,gpio,level"
    return [tuple(int(word) for word in line.split(",")) for line in lines]


def with_input(text: str, *arguments: str | Path) -> subprocess.CompletedProcess:
    """Without --pty the standard streams are the console; end of input ends it at the prompt."""
    return subprocess.run(
        command(*arguments, "--speed", "0"),
        input=text,
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
    )


def test_standard_streams_are_the_console(check_uf2: Path) -> None:
    result = with_input("g\ng\n", check_uf2)
    assert result.returncode == 0
    assert result.stdout.count("input 1 output 1") == 2
    assert "USB serial port: /dev/pts/" in result.stderr


def test_inputs_are_applied(check_uf2: Path, tmp_path: Path) -> None:
    events = tmp_path / "events.csv"
    events.write_text(f"time_ns,gpio,level\n5000,{INPUT},1\n1000000,{INPUT},0\n")
    assert "input 0 output 1" in with_input("g\n", check_uf2, "--inputs", events).stdout


def test_bad_inputs_name_file_and_line(check_uf2: Path, tmp_path: Path) -> None:
    events = tmp_path / "events.csv"
    events.write_text("time_ns,gpio,level\n5000,16,1\n6000,30,1\n")
    result = with_input("", check_uf2, "--inputs", events)
    assert result.returncode == 1
    assert f"{events}:3: want time_ns,gpio,level" in result.stderr


def test_flash_is_kept(check_uf2: Path, tmp_path: Path) -> None:
    image = tmp_path / "flash.bin"
    assert "programmed a5" in with_input("s\n", check_uf2, "--flash", image).stdout
    assert os.path.getsize(image) == 1280 * 1024
    assert "holds 05 05" in with_input("s1\n", check_uf2, "--flash", image).stdout


def test_faults_are_reported_and_fail_it(check_uf2: Path) -> None:
    result = with_input("s2\n", check_uf2)
    assert result.returncode == 1
    assert "while it is busy" in result.stderr


def test_an_ordinary_file_in_the_links_place_is_not_replaced(
    check_uf2: Path, tmp_path: Path
) -> None:
    link = tmp_path / "port"
    link.write_text("mine")
    result = subprocess.run(
        command(check_uf2, "--pty", link), capture_output=True, text=True, timeout=PATIENCE_S
    )
    assert result.returncode == 1
    assert link.read_text() == "mine"
