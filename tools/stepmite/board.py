"""A StepMite board at the other end of a serial port: send a BASIC line, get what it printed.

The conversation is the one a person has in a terminal: the firmware echoes the line, prints its
output and then the prompt `> `. An answer is complete when the prompt stands alone on the last
line.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from types import TracebackType
from typing import Protocol

import serial

from stepmite.screen import Screen

PROMPT = "> "
LINE_MAX = 255
"""Longest line the prompt takes, in characters."""

_KILL_LINE = b"\x15"
_BREAK = b"\x03"
_POLL_S = 0.05
QUIET_S = 0.1
"""A board that sends nothing for so long has said all it wanted to say."""


class BoardError(Exception):
    """The firmware refused a command; the text is its own message.

    `output` holds the lines that the command printed before the error.
    """

    def __init__(self, message: str, output: list[str] | None = None) -> None:
        super().__init__(message)
        self.output = output or []


class BoardGone(Exception):
    """The connection is broken: unplugged, switched off, or nobody answers."""


class Cancelled(Exception):
    """The user asked to stop while an answer was awaited."""


class Port(Protocol):
    """What Board needs of a serial port; pyserial's Serial has it."""

    def read(self, size: int = 1) -> bytes:
        """Return up to `size` bytes, b"" if none came within the port's time limit."""
        ...

    def write(self, data: bytes, /) -> int | None:
        """Send bytes."""
        ...

    @property
    def in_waiting(self) -> int:
        """Bytes that can be read at once."""
        ...

    def close(self) -> None:
        """Let go of the port."""
        ...


class Board:
    """The prompt of one board. Times are wall time: they only say when to give up."""

    def __init__(
        self,
        port: Port,
        on_notice: Callable[[str], None] | None = None,
        cancelled: Callable[[], bool] | None = None,
    ) -> None:
        self._port = port
        self._screen = Screen()
        self._echo = True
        self.on_notice = on_notice
        """Called with each line that the board printed without being asked."""
        self.cancelled = cancelled
        """Asked while waiting; Cancelled is raised when it says True."""

    @classmethod
    def open(
        cls,
        device: str,
        baud: int = 115200,
        on_notice: Callable[[str], None] | None = None,
        wake_timeout_s: float = 5.0,
    ) -> Board:
        """Open a serial port and wait for the prompt; BoardGone tells why it did not work."""
        try:
            port = serial.Serial(device, baud, timeout=_POLL_S, write_timeout=10.0)
        except (serial.SerialException, OSError, ValueError) as error:
            raise BoardGone(f"cannot open {device}: {_reason(error)}") from None
        board = cls(port, on_notice)
        try:
            board.wake(wake_timeout_s)
        except BaseException:
            board.close()
            raise
        return board

    def __enter__(self) -> Board:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        where: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Let go of the port; the machine goes on with what it does."""
        self._port.close()

    # ---- The conversation ---------------------------------------------------------------------

    def wake(self, timeout_s: float = 5.0) -> None:
        """Find the prompt, whatever was on the line before.

        Half a line that somebody typed is erased, not carried out. Raises BoardGone if no prompt
        comes: a program is running, or this is not a StepMite.
        """
        self._read_until_quiet()
        self._screen = Screen()
        self._write(_KILL_LINE + b"\r")
        deadline = time.monotonic() + timeout_s
        heard = False
        while not self._at_prompt():
            heard = self._receive() or heard
            if time.monotonic() > deadline:
                raise BoardGone(
                    "the board does not show its prompt: a program is running there"
                    " (Ctrl-C in a terminal ends it)"
                    if heard
                    else "the board does not answer: a program is running there or the port is not"
                    " a StepMite (Ctrl-C in a terminal ends a program)"
                )
        self._read_until_quiet()
        self._learn_echo(timeout_s)

    def _learn_echo(self, timeout_s: float) -> None:
        """Ask something with a known answer; shows whether the line comes back as an echo."""
        question, answer = "PRINT 7919*7907", "62615533"
        self._screen.forget()
        self._screen.clear_current()
        self._write(question.encode() + b"\r")
        deadline = time.monotonic() + timeout_s
        while not (self._at_prompt() and any(x.strip() == answer for x in self._screen.lines)):
            self._receive()
            if time.monotonic() > deadline:
                raise BoardGone("the port has a prompt, but it is not a StepMite's")
        self._echo = any(line.endswith(question) for line in self._screen.lines)
        self._screen.forget()

    def command(
        self,
        text: str,
        timeout_s: float = 15.0,
        on_line: Callable[[str], None] | None = None,
    ) -> list[str]:
        """Carry out one BASIC line and return what it printed.

        `on_line` gets each line of it as soon as it has come. Raises BoardError with the firmware's
        message if it was refused, BoardGone if no answer came.
        """
        if len(text) > LINE_MAX or not text.isascii() or not text.isprintable():
            raise ValueError(f"not a line for the prompt: {text!r}")
        self._flush_notices()
        # Without an echo the old prompt would pass for the new one.
        self._screen.clear_current()
        self._write(text.encode("ascii") + b"\r")
        output = self._answer(text, timeout_s, on_line)
        for number, line in enumerate(output):
            if line.startswith("Error : "):
                raise BoardError(line.removeprefix("Error : ").strip(), output[:number])
        return output

    def converse(
        self,
        text: str,
        work: Callable[[Port, bytes], bool],
        wait_for: bytes | None,
        timeout_s: float = 15.0,
    ) -> tuple[list[str], bool]:
        """Carry out a line that makes the port speak another protocol for a while.

        `work` gets the port and the byte that came first. It is called once the board sends one of
        `wait_for`, or, if that is None, is silent; not if the board shows its prompt instead.
        Returns what the board printed before and behind it, and what `work` returned.
        """
        self._flush_notices()
        self._screen.clear_current()
        self._write(text.encode("ascii") + b"\r")
        first = self._await_first(text, wait_for, timeout_s)
        done = False
        if first is not None:
            try:
                done = work(self._port, first)
            except (serial.SerialException, OSError) as error:
                raise BoardGone(f"the connection is broken: {_reason(error)}") from None
        deadline = time.monotonic() + timeout_s
        while not self._at_prompt():
            if self._receive():
                deadline = time.monotonic() + timeout_s
            elif time.monotonic() > deadline:
                raise BoardGone(f"no answer within {timeout_s:g} s to: {text}")
        output = [line for line in self._screen.lines if line]
        self._screen.forget()
        return output, done

    def _await_first(self, text: str, wait_for: bytes | None, timeout_s: float) -> bytes | None:
        """Return the first byte behind the echo that opens the other protocol.

        None: the board is at its prompt again. It reads byte by byte: what follows is not ours.
        """
        echo = self._echo
        deadline = time.monotonic() + timeout_s
        quiet = time.monotonic() + QUIET_S
        while time.monotonic() < deadline:
            if not echo and self._at_prompt():
                return None
            byte = self._port.read(1)
            if not echo and wait_for is None and not byte and time.monotonic() > quiet:
                return b""
            if not byte:
                continue
            quiet = time.monotonic() + QUIET_S
            opens = wait_for is not None and byte in wait_for and self._screen.current == ""
            if not echo and opens:
                return byte
            self._screen.feed(byte.decode("latin-1"))
            if echo and any(line.endswith(text) for line in self._screen.lines):
                echo = False
                self._screen.forget()
        raise BoardGone(f"no answer within {timeout_s:g} s to: {text}")

    def evaluate(self, expression: str) -> float:
        """Return the value of a numeric BASIC expression."""
        output = self.command(f"PRINT {expression}")
        for line in reversed(output):
            try:
                return float(line)
            except ValueError:
                self._notice(line)
        raise BoardError(f"no value for {expression}", output)

    def peek(self, name: str) -> float:
        """Return PEEK(STEPPER name): X, Y, Z, A, ACTIVE, STATUS or BUFFER."""
        return self.evaluate(f"PEEK(STEPPER {name})")

    def stop(self, timeout_s: float = 10.0) -> None:
        """Send Ctrl-C: the machine brakes to a controlled stop. Returns when it stands still."""
        self._write(_BREAK)
        cancelled, self.cancelled = self.cancelled, None
        try:
            self._read_until_quiet()
            deadline = time.monotonic() + timeout_s
            while not self._at_prompt():
                self._receive()
                if time.monotonic() > deadline:
                    raise BoardGone("no prompt after Ctrl-C")
            while self.peek("ACTIVE") > 0:
                if time.monotonic() > deadline:
                    raise BoardGone("the machine does not come to a stop")
                time.sleep(0.02)
        finally:
            self.cancelled = cancelled

    # ---- Underneath ---------------------------------------------------------------------------

    def _answer(
        self, text: str, timeout_s: float, on_line: Callable[[str], None] | None
    ) -> list[str]:
        """Collect the lines between the echo of `text` and the next prompt.

        Gives up after `timeout_s` of silence.
        """
        echo = self._echo
        output: list[str] = []
        deadline = time.monotonic() + timeout_s
        while True:
            for line in self._screen.lines:
                if not echo:
                    output.append(line)
                    if on_line is not None:
                        on_line(line)
                elif line.endswith(text):
                    echo = False
                elif line:
                    self._notice(line.removeprefix(PROMPT))
            self._screen.forget()
            if not echo and self._at_prompt():
                return output
            if self.cancelled is not None and self.cancelled():
                raise Cancelled
            if self._receive():
                deadline = time.monotonic() + timeout_s
            elif time.monotonic() > deadline:
                raise BoardGone(f"no answer within {timeout_s:g} s to: {text}")

    def _at_prompt(self) -> bool:
        return self._screen.current == PROMPT and self._waiting() == 0

    def _flush_notices(self) -> None:
        """Hand on what came since the last answer."""
        while self._waiting():
            self._receive()
        for line in self._screen.lines:
            self._notice(line.removeprefix(PROMPT))
        self._screen.forget()

    def _notice(self, line: str) -> None:
        if line.strip() and self.on_notice is not None:
            self.on_notice(line.strip())

    def _read_until_quiet(self, limit_s: float = 2.0) -> None:
        limit = time.monotonic() + limit_s
        quiet = time.monotonic() + QUIET_S
        while time.monotonic() < min(quiet, limit):
            if self._receive():
                quiet = time.monotonic() + QUIET_S

    def _waiting(self) -> int:
        try:
            return self._port.in_waiting
        except (serial.SerialException, OSError) as error:
            raise BoardGone(f"the connection is broken: {_reason(error)}") from None

    def _receive(self) -> bool:
        """Take what has come in, or wait shortly for it; tell whether there was anything."""
        waiting = self._waiting()
        try:
            data = self._port.read(max(1, waiting))
        except (serial.SerialException, OSError, TypeError) as error:
            raise BoardGone(f"the connection is broken: {_reason(error)}") from None
        self._screen.feed(data.decode("latin-1"))
        return bool(data)

    def _write(self, data: bytes) -> None:
        try:
            self._port.write(data)
        except (serial.SerialException, OSError) as error:
            raise BoardGone(f"the connection is broken: {_reason(error)}") from None


def _reason(error: Exception) -> str:
    """Return the operating system's words without pyserial's wrapping."""
    if isinstance(error, OSError) and error.errno:
        return os.strerror(error.errno)
    return str(error).strip() or type(error).__name__
