"""The host program as its users and other tools see it: options, files, signals, pipes, terminal.

What the firmware does is tested elsewhere; here BASIC is only a means to make it do something.
Times are virtual except in the one test of real time, which has only a lower bound.
"""

from __future__ import annotations

import contextlib
import os
import select
import signal
import subprocess
import termios
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

STEPMITE = Path(__file__).parents[2] / "build" / "host" / "stepmite"
STORAGE_SIZE = 1280 * 1024
DEADLINE_S = 60.0  # wall time after which a test counts as hung

MACHINE = """\
STEPPER INIT 0.05,32,GP22
STEPPER AXIS X,GP2,GP3,,,80,6000,500
STEPPER POSITION HOME
STEPPER RUN
"""
MOVE = "STEPPER GC G1 X{} F3000\n"
WAIT = "DO\nPAUSE 10\nLOOP UNTIL PEEK(STEPPER ACTIVE)<>1\n"


def run(
    *arguments: str | Path, text: str | bytes = b"", code: int | None = 0
) -> subprocess.CompletedProcess[bytes]:
    """Run the program with `text` on its standard input and check its exit code."""
    data = text.encode() if isinstance(text, str) else text
    done = subprocess.run(
        [STEPMITE, *arguments], input=data, capture_output=True, timeout=DEADLINE_S, check=False
    )
    if code is not None:
        assert done.returncode == code, done
    return done


@contextlib.contextmanager
def started(*arguments: str | Path) -> Iterator[subprocess.Popen[bytes]]:
    """Start the program with pipes on all three; it does not outlive the block."""
    pipe = subprocess.PIPE
    with subprocess.Popen([STEPMITE, *arguments], stdin=pipe, stdout=pipe, stderr=pipe) as process:
        try:
            yield process
        finally:
            process.kill()


def read_until(file: int, what: bytes) -> bytes:
    """Read from a descriptor until `what` has come; returns all of it."""
    got = b""
    end = time.monotonic() + DEADLINE_S
    while what not in got:
        ready, _, _ = select.select([file], [], [], end - time.monotonic())
        assert ready, f"no {what!r} in {got!r}"
        block = os.read(file, 65536)
        assert block, f"end of output without {what!r} in {got!r}"
        got += block
    return got


def edges(path: Path) -> list[tuple[int, int, int]]:
    """Return the rows of an edge file: time in ns, gpio, level."""
    lines = path.read_text().splitlines()
    assert lines[0] == "time_ns,gpio,level"
    rows = [tuple(int(field) for field in line.split(",")) for line in lines[1:]]
    assert all(len(row) == 3 for row in rows)
    return rows


def program(folder: Path, text: str) -> Path:
    """Write a BASIC program."""
    path = folder / "program.bas"
    path.write_text(text)
    return path


# ---- Options -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--nonsense"], "nonsense"),
        (["--trace"], "trace"),
        (["--virtual", "--realtime"], "exclude each other"),
        (["a.bas", "b.bas"], "b.bas is one too many"),
        (["/nowhere.bas"], "/nowhere.bas: No such file"),
        (["/"], "/: Is a directory"),
        (["--trace", "/nowhere/t.csv"], "/nowhere/t.csv: No such file"),
        (["--inputs", "/nowhere.csv"], "/nowhere.csv: No such file"),
        (["--flash", "/nowhere/f.bin"], "/nowhere/f.bin: No such file"),
    ],
)
def test_wrong_usage_is_refused(arguments: list[str], message: str) -> None:
    """A message that names what is wrong, exit code 2, nothing on stdout."""
    done = run(*arguments, code=2)
    assert message in done.stderr.decode().splitlines()[0]
    assert done.stdout == b""


def test_help_and_version() -> None:
    """Both are printed and end the program."""
    help_text = run("--help").stdout.decode()
    for option in ("--trace", "--inputs", "--flash", "--virtual", "--realtime", "Ctrl-D"):
        assert option in help_text
    assert run("--version").stdout.startswith(b"stepmite ")


def test_bad_events_name_the_line(tmp_path: Path) -> None:
    """The message has file and line."""
    events = tmp_path / "events.csv"
    events.write_text("time_ns,gpio,level\n100,22,0\n100,22,2\n")
    done = run("--inputs", events, code=2)
    fault = "level must be 0 or 1, or a voltage, for instance 1.65V"
    assert done.stderr.decode() == f"stepmite: {events}:3: {fault}\n"


# ---- Programs and input --------------------------------------------------------------------------


def test_program_gives_the_exit_code(tmp_path: Path) -> None:
    """0, or 1 after a BASIC error."""
    assert b" 42" in run(program(tmp_path, "PRINT 6*7\n")).stdout
    assert b"Error" in run(program(tmp_path, "PRINT 1\nPRINT 1/0\nPRINT 2\n"), code=1).stdout


def test_end_of_input_ends_the_prompt() -> None:
    """Whatever the input is: empty, without a last line end, or closed."""
    run()
    assert b" 42" in run(text="PRINT 6*7\n").stdout
    closed = subprocess.run(
        ["sh", "-c", f"exec '{STEPMITE}' <&-"], capture_output=True, timeout=DEADLINE_S, check=False
    )
    assert closed.returncode == 0


def test_motion_ends_before_the_program_leaves(tmp_path: Path) -> None:
    """All 800 steps are in the trace although the input ends at once."""
    trace = tmp_path / "edges.csv"
    run("--trace", trace, text=MACHINE + MOVE.format(10))
    assert sum(1 for _, gpio, level in edges(trace) if gpio == 2 and level == 1) == 800


def test_virtual_time_jumps() -> None:
    """Three days of waiting pass in no time, and the clock shows them."""
    output = run(text="TIMER=0\nPAUSE 259200000\nPRINT TIMER\\1000\n").stdout
    assert b" 259200\r\n" in output


def test_same_input_same_edges(tmp_path: Path) -> None:
    """Virtual time does not depend on how fast the input comes."""
    script = (
        MACHINE + MOVE.format(3) + WAIT.replace("\n", ":")[:-1] + "\n" + MOVE.format(-2)
    ).encode()
    traces = [tmp_path / name for name in ("whole.csv", "bytes.csv")]
    run("--trace", traces[0], text=script)
    with started("--trace", traces[1]) as process:
        assert process.stdin
        for byte in script:
            process.stdin.write(bytes([byte]))
            process.stdin.flush()
        process.communicate(timeout=DEADLINE_S)
    assert [row for row in edges(traces[0]) if row[1] == 2]
    pulses = [[row[1:] for row in edges(trace)] for trace in traces]
    assert pulses[0] == pulses[1]


def test_peer_that_waits_for_answers() -> None:
    """A pipe that stays open is answered line by line."""
    with started() as process:
        assert process.stdin
        assert process.stdout
        read_until(process.stdout.fileno(), b"> ")
        for number in range(20):
            process.stdin.write(f"PRINT {number}*2\r".encode())
            process.stdin.flush()
            assert f"\r\n {number * 2}\r\n".encode() in read_until(
                process.stdout.fileno(), b"\r\n> "
            )
        process.stdin.close()
        assert process.wait(DEADLINE_S) == 0


def test_slow_reader_loses_nothing(tmp_path: Path) -> None:
    """A megabyte of output arrives whole, although nobody reads it at first."""
    source = program(tmp_path, 'FOR i=1 TO 16000\nPRINT i;STRING$(60,"x")\nNEXT\n')
    with started(source) as process:
        assert process.stdout
        time.sleep(0.2)
        lines = process.stdout.read().split(b"\r\n")
        assert process.wait(DEADLINE_S) == 0
    numbers = [int(line.rstrip(b"x")) for line in lines if line.endswith(b"x")]
    assert numbers == list(range(1, 16001))


# ---- Pins and storage ----------------------------------------------------------------------------


def test_input_event_stops_motion_in_the_same_tick(tmp_path: Path) -> None:
    """The E-STOP input goes low in the middle of a move; no step comes after it."""
    events = tmp_path / "events.csv"
    trace = tmp_path / "edges.csv"
    events.write_text("time_ns,gpio,level\n300000000,22,0\n")
    source = program(tmp_path, MACHINE + MOVE.format(50) + WAIT + "PAUSE 1000\n")
    run("--trace", trace, "--inputs", events, source, code=None)
    steps = [at for at, gpio, level in edges(trace) if gpio == 2 and level == 1]
    assert 100 < len(steps) < 4000
    assert 290_000_000 < steps[-1] <= 300_000_000


def test_edges_alternate_and_times_are_on_the_grid(tmp_path: Path) -> None:
    """Every row is a change, in order of time, on whole microseconds."""
    trace = tmp_path / "edges.csv"
    run("--trace", trace, text=MACHINE + MOVE.format(1) + MOVE.format(0))
    level_now: dict[int, int] = {}
    last_ns = 0
    for at, gpio, level in edges(trace):
        assert at >= last_ns
        assert level != level_now.get(gpio, 0)
        level_now[gpio] = level
        last_ns = at
    pulses = [at for at, gpio, _ in edges(trace) if gpio == 2]
    assert {(at - pulses[0]) % 10_000 for at in pulses} == {0}


def test_flash_image_is_kept(tmp_path: Path) -> None:
    """A program saved in one run is there in the next, and a damaged size is refused."""
    image = tmp_path / "flash.bin"
    run("--flash", image, text='AUTOSAVE\nPRINT "kept"\n\x1a')
    assert image.stat().st_size == STORAGE_SIZE
    assert b"\r\nkept\r\n" in run("--flash", image, text="RUN\n").stdout
    image.write_bytes(image.read_bytes()[:-1])
    assert b"1310720 bytes" in run("--flash", image, code=2).stderr


# ---- Signals -------------------------------------------------------------------------------------

ENDLESS = (
    MACHINE + "x=10\nDO\nIF PEEK(STEPPER BUFFER)>0 THEN STEPPER GCODE G1,X,x,F,3000:x=-x\nLOOP\n"
)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT])
def test_signal_ends_the_program_with_complete_files(tmp_path: Path, number: int) -> None:
    """The edge file has whole rows up to the end."""
    trace = tmp_path / "edges.csv"
    with started("--trace", trace, program(tmp_path, ENDLESS)) as process:
        while not trace.exists() or trace.stat().st_size < 200_000:
            assert process.poll() is None
            time.sleep(0.01)
        process.send_signal(number)
        assert process.wait(DEADLINE_S) == 128 + number
    assert trace.read_bytes().endswith(b"\n")
    assert len(edges(trace)) > 10_000


def test_interrupt_is_a_ctrl_c_and_two_end_the_program() -> None:
    """The first stops what runs, the second one soon after leaves."""
    with started() as process:
        assert process.stdin
        assert process.stdout
        process.stdin.write(b'PRINT "on":DO:PAUSE 1:LOOP\r')
        process.stdin.flush()
        read_until(process.stdout.fileno(), b"\r\non\r\n")
        process.send_signal(signal.SIGINT)
        read_until(process.stdout.fileno(), b"> ")
        process.stdin.write(b"PRINT 6*7\r")
        process.stdin.flush()
        read_until(process.stdout.fileno(), b" 42\r\n> ")
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGINT)
        assert process.wait(DEADLINE_S) == 130


def test_reader_that_leaves_ends_the_program_quietly() -> None:
    """As in `stepmite | head -1`: no message, no endless run."""
    with started() as process:
        assert process.stdin
        assert process.stdout
        assert process.stderr
        process.stdout.close()
        process.stdin.write(b"DO:PRINT 1:LOOP\r")
        process.stdin.close()
        assert process.wait(DEADLINE_S) == 1
        assert process.stderr.read() == b""


# ---- The terminal --------------------------------------------------------------------------------


class Terminal:
    """The program at a terminal of its own."""

    def __init__(self, *arguments: str) -> None:
        self.master, self.slave = os.openpty()
        self.before = termios.tcgetattr(self.slave)
        self.process = subprocess.Popen(
            [STEPMITE, *arguments],
            stdin=self.slave,
            stdout=self.slave,
            stderr=self.slave,
            start_new_session=True,
        )
        read_until(self.master, b"> ")

    def type(self, text: bytes, answer: bytes) -> bytes:
        """Type and wait for an answer."""
        os.write(self.master, text)
        return read_until(self.master, answer)

    def is_as_before(self) -> bool:
        """Return whether the terminal has the settings it had at first."""
        return termios.tcgetattr(self.slave) == self.before

    def close(self) -> None:
        """End the program if it still runs."""
        self.process.kill()
        self.process.wait()
        os.close(self.master)
        os.close(self.slave)


@pytest.fixture
def terminal() -> Iterator[Terminal]:
    """Provide the program at a terminal, in virtual time."""
    at = Terminal("--virtual")
    yield at
    at.close()


def test_terminal_is_raw_and_gets_its_settings_back(terminal: Terminal) -> None:
    """The line editor gets every key; Ctrl-D ends the input."""
    assert not termios.tcgetattr(terminal.slave)[3] & (termios.ECHO | termios.ICANON)
    terminal.type(b"PRINT 6*8\x7f7\r", b" 42\r\n> ")
    terminal.type(b'PRINT "on":DO:PAUSE 1:LOOP\r', b"\r\non\r\n")
    terminal.type(b"\x03", b"> ")
    assert terminal.process.poll() is None
    os.write(terminal.master, b"\x04")
    assert terminal.process.wait(DEADLINE_S) == 0
    assert terminal.is_as_before()


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGSEGV, signal.SIGABRT])
def test_terminal_gets_its_settings_back_after_a_signal(terminal: Terminal, number: int) -> None:
    """Whatever ends the program, the shell's terminal works again."""
    assert not terminal.is_as_before()
    terminal.process.send_signal(number)
    terminal.process.wait(DEADLINE_S)
    assert terminal.is_as_before()


def test_terminal_while_stopped(terminal: Terminal) -> None:
    """Stopped from outside the shell has its terminal; continued the program has it."""
    terminal.process.send_signal(signal.SIGTSTP)
    _, status = os.waitpid(terminal.process.pid, os.WUNTRACED)
    assert os.WIFSTOPPED(status)
    assert terminal.is_as_before()
    terminal.process.send_signal(signal.SIGCONT)
    terminal.type(b"PRINT 6*7\r", b" 42\r\n> ")
    assert not terminal.is_as_before()


def test_real_time_passes() -> None:
    """At a terminal the default is real time: a second of pause is no less, and not several."""
    at = Terminal()
    begin = time.monotonic()
    at.type(b'PAUSE 1000:PRINT "done"\r', b"\r\ndone\r\n")
    assert 1.0 <= time.monotonic() - begin < 4.0
    at.close()


def test_motion_in_real_time_is_the_same(tmp_path: Path) -> None:
    """The edges are those of virtual time, to the tick."""
    source = program(tmp_path, MACHINE + MOVE.format(5) + MOVE.format(4) + WAIT)
    pulses = []
    for mode in ("--virtual", "--realtime"):
        trace = tmp_path / f"{mode}.csv"
        run(mode, "--trace", trace, source)
        rows = edges(trace)
        begin = next(at for at, gpio, _ in rows if gpio == 2)
        pulses.append([(at - begin, gpio, level) for at, gpio, level in rows if at >= begin])
    assert len(pulses[0]) > 900
    assert pulses[0] == pulses[1]
