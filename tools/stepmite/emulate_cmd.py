"""The command `stepmite emulate`: a board in an emulator, its USB serial port as a pty."""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import socket
import sys
import tempfile
import termios
import tty
from collections.abc import Iterator
from pathlib import Path

from stepmite.emulator import Emulator, EmulatorError

CONNECT_MS = 3000
QUIT_KEY = b"\x1d"  # Ctrl-]
CHUNK = 4096


def run(
    uf2: Path,
    *,
    pty: Path | None = None,
    trace: Path | None = None,
    inputs: Path | None = None,
    flash: Path | None = None,
    speed: float = 1.0,
    report: Path | None = None,
) -> int:
    """Boot `uf2` and serve its console until SIGINT or SIGTERM; return the exit code.

    `pty`: link to make to the serial port; without it the terminal is the console and Ctrl-] quits.
    `trace`, `inputs`: EDGES.csv to write, EVENTS.csv to apply. `flash`: the storage area, kept
    across runs. `speed`: virtual seconds per second at most, 0: as fast as it can. `report`: JSON
    with the virtual time, cycles of handlers, faults and tick runs at the end.
    """
    try:
        with Emulator(uf2, storage=flash) as board:
            if trace is not None:
                board.trace(trace)
            if inputs is not None:
                board.inputs(inputs)
            board.connect(CONNECT_MS)
            _serve(board, pty, speed)
            if flash is not None:
                board.save_storage(flash)
            if report is not None:
                _write_report(board, report)
            faults = board.faults()
    except (EmulatorError, OSError) as error:
        print(f"emulate: {error}", file=sys.stderr)
        return 1
    for fault in faults:
        print(f"emulate: fault at {fault.time_ns / 1e6:.3f} ms: {fault.text}", file=sys.stderr)
    return 1 if faults else 0


def _write_report(board: Emulator, path: Path) -> None:
    content = {
        "virtual_ms": board.now_ns / 1e6,
        "resets": board.status()["resets"],
        "profile": {name: vars(cycles) for name, cycles in board.profile().items()},
        "tick_runs": [vars(tick_run) for tick_run in board.tick_runs()],
        "faults": [vars(fault) for fault in board.faults()],
    }
    path.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")


def _serve(board: Emulator, link: Path | None, speed: float) -> None:
    """Carry bytes between the board and the pty or the terminal until told to stop."""
    master, slave = os.openpty()
    tty.setraw(slave)  # held open: a program that closes the port does not reset these settings
    os.set_blocking(master, False)
    name = os.ttyname(slave)
    try:
        with _stop_signals() as stop, _linked(name, link), _board_stream(board, speed) as stream:
            print(f"USB serial port: {link or name}", file=sys.stderr, flush=True)
            if link is not None:
                _Relay(stream, stop, inputs=[master], output=master, also=None).run()
            else:
                terminal = sys.stdin.fileno()
                with _raw_terminal(terminal):
                    output = sys.stdout.fileno()
                    _Relay(stream, stop, [terminal, master], output, also=master).run()
        board.answer()
    finally:
        os.close(master)
        os.close(slave)


class _Relay:
    """Moves bytes between a board and file descriptors, no faster than each side takes them."""

    def __init__(
        self, stream: socket.socket, stop: int, inputs: list[int], output: int, also: int | None
    ) -> None:
        self.stream = stream
        self.stop = stop
        self.inputs = inputs
        self.output = output
        self.also = also  # gets a copy of the output as far as it has room
        self.to_board = b""
        self.to_output = b""

    def run(self) -> None:
        """Return when a stop signal came, the board has ended, or Ctrl-] was typed."""
        while True:
            reading: list[int] = [self.stop]
            if not self.to_board:
                reading += self.inputs
            if not self.to_output:
                reading.append(self.stream.fileno())
            writing = [self.stream.fileno()] if self.to_board else []
            writing += [self.output] if self.to_output else []
            readable, writable, _ = select.select(reading, writing, [])
            if self.stop in readable or not self._read(readable):
                return
            self._write(writable)

    def _read(self, readable: list[int]) -> bool:
        for fd in [fd for fd in self.inputs if fd in readable]:
            data = os.read(fd, CHUNK)
            if not data or (fd != self.output and fd != self.also and data == QUIT_KEY):
                self._input_ended(fd)
            else:
                self.to_board += data
        if self.stream.fileno() in readable:
            self.to_output = self.stream.recv(CHUNK)
            if not self.to_output:
                return False
            if self.also is not None:
                with contextlib.suppress(BlockingIOError):
                    os.write(self.also, self.to_output)
        return True

    def _input_ended(self, fd: int) -> None:
        """No more input: the board finishes what it is doing and then ends."""
        self.inputs.remove(fd)
        self.stream.shutdown(socket.SHUT_WR)

    def _write(self, writable: list[int]) -> None:
        if self.to_board and self.stream.fileno() in writable:
            self.to_board = self.to_board[self.stream.send(self.to_board) :]
        if self.to_output and self.output in writable:
            self.to_output = self.to_output[os.write(self.output, self.to_output) :]


@contextlib.contextmanager
def _board_stream(board: Emulator, speed: float) -> Iterator[socket.socket]:
    """Let the board run with the wall clock, its serial port at the returned socket."""
    with tempfile.TemporaryDirectory(prefix="stepmite-") as folder, contextlib.ExitStack() as stack:
        listener = stack.enter_context(socket.socket(socket.AF_UNIX))
        listener.bind(f"{folder}/serial")
        listener.listen(1)
        listener.settimeout(10)
        board.post("serve", socket=f"{folder}/serial", speed=speed)
        stream, _ = listener.accept()
        with stream:
            yield stream


@contextlib.contextmanager
def _stop_signals() -> Iterator[int]:
    """Turn SIGINT and SIGTERM into a byte on the returned file descriptor."""
    read, write = os.pipe()
    os.set_blocking(write, False)
    before_fd = signal.set_wakeup_fd(write)
    before = {s: signal.signal(s, lambda *_: None) for s in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield read
    finally:
        signal.set_wakeup_fd(before_fd)
        for number, handler in before.items():
            signal.signal(number, handler)
        os.close(read)
        os.close(write)


@contextlib.contextmanager
def _linked(name: str, link: Path | None) -> Iterator[None]:
    """Make the link to the pty for as long as it lives; an old link is replaced, a file is not."""
    if link is None:
        yield
        return
    if link.is_symlink():
        link.unlink()
    link.symlink_to(name)
    try:
        yield
    finally:
        if link.is_symlink() and os.readlink(link) == name:
            link.unlink()


@contextlib.contextmanager
def _raw_terminal(fd: int) -> Iterator[None]:
    """Keys reach the board one by one and unchanged, Ctrl-C too; Ctrl-] quits."""
    if not os.isatty(fd):
        yield
        return
    print("Ctrl-] ends the emulator.", file=sys.stderr, flush=True)
    settings = termios.tcgetattr(fd)
    tty.setraw(fd)
    try:
        yield
    finally:
        termios.tcsetattr(fd, termios.TCSADRAIN, settings)
