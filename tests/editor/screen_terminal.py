"""A real terminal emulator (pyte) at the host program: what a user would see on the screen."""

from __future__ import annotations

import fcntl
import os
import pty
import select
import subprocess
import termios
import time
from pathlib import Path

import pyte

PROGRAM = os.environ.get("STEPMITE", str(Path(__file__).parents[2] / "build/host/stepmite"))
TIMEOUT_S = 5
SCREENFUL = 100_000  # what came before has scrolled away
DRAWN = b"\x1b[?25h"  # the editor ends each drawing by showing the cursor


class ScreenTerminal:
    """The host program on a pseudo terminal, in virtual time, and the screen it draws."""

    def __init__(self, rows: int = 24, columns: int = 80, options: tuple[str, ...] = ()) -> None:
        self.screen = pyte.Screen(columns, rows)
        self.stream = pyte.ByteStream(self.screen)
        self.master, self.slave = pty.openpty()
        self.program = subprocess.Popen(
            [PROGRAM, "--virtual", *options],
            stdin=self.slave,
            stdout=self.slave,
            stderr=self.slave,
            close_fds=True,
        )
        self.until(b"> ")

    def until(self, end: bytes | tuple[bytes, ...]) -> bytes:
        """Take output in up to `end`, or one of several; what was seen."""
        seen = b""
        while not seen.endswith(end):
            ready, _, _ = select.select([self.master], [], [], TIMEOUT_S)
            assert ready, f"no {end!r} after {seen[-300:]!r}"
            seen += os.read(self.master, 65536)
        self.stream.feed(seen)
        return seen

    def type(self, text: str | bytes, end: bytes | tuple[bytes, ...] = b"\r\n> ") -> bytes:
        """Type, wait for what ends the answer; the answer."""
        data = text.encode() if isinstance(text, str) else text
        seen = b""
        while data:  # a terminal reads while it sends
            readable, writable, _ = select.select([self.master], [self.master], [], TIMEOUT_S)
            assert readable or writable, "the program takes nothing"
            if readable:
                seen += os.read(self.master, 65536)
            if writable:
                data = data[os.write(self.master, data[:1000]) :]
        self.stream.feed(seen[-SCREENFUL:])
        return (
            seen if end and seen.endswith(end) and not self.has_more() else seen + self.until(end)
        )

    def has_more(self) -> bool:
        """Tell whether the program says something within a moment."""
        return bool(select.select([self.master], [], [], 0.05)[0])

    def key(self, key: str | bytes) -> bytes:
        """Press a key of the editor; the drawing."""
        return self.type(key, DRAWN)

    def paste(self, text: str) -> None:
        """Paste into the editor and wait until all of it has arrived."""
        self.type(text + "\x1bOR", b"")
        shown = ""
        while "Find:" not in shown:
            self.until(DRAWN)
            shown = self.rows()[-1]
        self.key("\x1b")

    def let_time_pass(self) -> None:
        """Type nothing for so long that virtual time goes on, if there is something to do."""
        select.select([self.master], [], [], 0.1)

    def take_in(self) -> None:
        """Take in what the program has said so far."""
        while select.select([self.master], [], [], 0)[0]:
            self.stream.feed(os.read(self.master, 65536))

    def wait_until_it_waits(self) -> None:
        """Return once the program has taken all input and sleeps."""
        select.select([self.master], [], [], 0.3)  # most keys are answered by something
        end = time.monotonic() + TIMEOUT_S
        state = Path(f"/proc/{self.program.pid}/stat")
        while time.monotonic() < end:
            waiting = fcntl.ioctl(self.slave, termios.FIONREAD, b"\0" * 4)
            if waiting == b"\0" * 4 and state.read_text().rsplit(")", 1)[1].split()[0] == "S":
                return
            time.sleep(0.001)
        raise AssertionError("the program does not wait for input")

    def shows(self, row: str) -> bool:
        """Take in what the program says; tell whether the last row becomes this one in time."""
        while self.last_row() != row:
            if not select.select([self.master], [], [], TIMEOUT_S)[0]:
                return False
            self.stream.feed(os.read(self.master, 65536))
        return True

    def last_row(self) -> str:
        """Return the last row with something in it."""
        return [row for row in self.rows() if row][-1]

    def enter_program(self, text: str) -> None:
        """Store a program."""
        self.type("AUTOSAVE\r", b"\r\n")
        self.type(text.replace("\n", "\r") + "\x1a")

    def edit(self, statement: str = "EDIT") -> None:
        """Open the editor."""
        self.type(statement + "\r", DRAWN)

    def listing(self) -> str:
        """Return the stored program."""
        shown = self.type("LIST ALL\r").decode()
        return shown.removeprefix("LIST ALL\r\n").removesuffix("> ").replace("\r\n", "\n")

    def rows(self) -> list[str]:
        """Return the rows of the screen."""
        return [row.rstrip() for row in self.screen.display]

    def cursor(self) -> tuple[int, int]:
        """Row and column of the cursor, from 0."""
        return self.screen.cursor.y, self.screen.cursor.x

    def close(self) -> None:
        """End the program, which must still be alive."""
        assert self.program.poll() is None
        self.program.kill()
        self.program.wait()
        os.close(self.master)
        os.close(self.slave)
