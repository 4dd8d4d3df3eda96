"""XMODEM between the host program and other people's implementation of it: lrzsz, on a pty.

What faults do is tested in virtual time, in tests/unit/basic/test_xmodem.c.
"""

from __future__ import annotations

import binascii
import contextlib
import os
import select
import subprocess
import time
import tty
from collections.abc import Iterator
from pathlib import Path
from random import Random

import pytest

STEPMITE = Path(__file__).parents[2] / "build" / "host" / "stepmite"
DEADLINE_S = 30.0  # wall time after which a test counts as hung
SIZES = [1, 128, 129, 1024, 20000]


class Terminal:
    """The program at one end of a pty; this end types, or is lent to a transfer program."""

    def __init__(self, *arguments: str | Path) -> None:
        self.far, self.near = os.openpty()
        tty.setraw(self.near)
        self.process = subprocess.Popen(
            [STEPMITE, "--realtime", *arguments], stdin=self.far, stdout=self.far
        )
        self.read_until(b"> ")

    def read_until(self, what: bytes, before: bytes = b"") -> bytes:
        """Return what is shown up to and with `what`, behind what was shown before."""
        got = before
        end = time.monotonic() + DEADLINE_S
        while not got.endswith(what):
            ready, _, _ = select.select([self.near], [], [], max(0.0, end - time.monotonic()))
            assert ready, f"no {what!r} in {got!r}"
            got += os.read(self.near, 1)
        return got

    def type(self, line: str) -> str:
        """Carry out a line; returns its output."""
        os.write(self.near, line.encode() + b"\r")
        self.read_until(b"\r\n")
        return self.read_until(b"> ").decode()[:-2]

    def transfer(self, line: str, *command: str | Path) -> tuple[int, str]:
        """Start a transfer and run the program at the other side; its exit code and our output."""
        os.write(self.near, line.encode() + b"\r")
        self.read_until(b"\r\n")
        pipe = subprocess.PIPE
        with subprocess.Popen(
            command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, bufsize=0
        ) as peer:
            heard = self._relay(peer)
        return peer.returncode, self.read_until(b"> ", heard).decode("latin-1")

    def _relay(self, peer: subprocess.Popen[bytes]) -> bytes:
        """Carry bytes between both until the peer has ended; returns what it was sent."""
        assert peer.stdin is not None
        assert peer.stdout is not None
        end = time.monotonic() + DEADLINE_S
        heard = b""
        while True:
            assert time.monotonic() < end, "the transfer does not end"
            ready, _, _ = select.select([peer.stdout, self.near], [], [], 1.0)
            if peer.stdout in ready:
                data = os.read(peer.stdout.fileno(), 4096)
                if not data:
                    return heard
                os.write(self.near, data)
            if self.near in ready:
                data = os.read(self.near, 4096)
                heard += data
                with contextlib.suppress(BrokenPipeError):
                    os.write(peer.stdin.fileno(), data)

    def close(self) -> None:
        """End the program."""
        self.process.kill()
        self.process.wait()
        os.close(self.far)
        os.close(self.near)


@pytest.fixture
def terminal() -> Iterator[Terminal]:
    """Provide the program at a terminal, with an empty flash."""
    at = Terminal()
    yield at
    at.close()


def data_of(size: int) -> bytes:
    """Bytes of all kinds, the last one no padding."""
    return Random(size).randbytes(size - 1) + b"x"


@pytest.mark.parametrize("option", ["-X", "-k"])
def test_a_file_comes_and_goes(terminal: Terminal, tmp_path: Path, option: str) -> None:
    """Both ways, all sizes, blocks of 128 and of 1024 bytes."""
    for size in SIZES:
        source, target = tmp_path / "source", tmp_path / "target"
        source.write_bytes(data_of(size))
        code, shown = terminal.transfer('XMODEM RECEIVE "f.bin"', "sx", "-q", "-b", option, source)
        assert code == 0
        assert f"{size} bytes received\r\n> " in shown
        assert terminal.type('OPEN "f.bin" FOR INPUT AS #1:PRINT LOF(1):CLOSE') == f" {size}\r\n"
        code, shown = terminal.transfer('XMODEM SEND "f.bin"', "rx", "-q", "-b", "-c", target)
        assert code == 0
        assert f"{size} bytes sent\r\n> " in shown
        received = target.read_bytes()
        assert received[:size] == source.read_bytes()
        assert received[size:] == b"\x1a" * (-size % 128)


def test_with_a_checksum(terminal: Terminal, tmp_path: Path) -> None:
    """A receiver that knows no CRC."""
    source, target = tmp_path / "source", tmp_path / "target"
    source.write_bytes(data_of(3000))
    assert terminal.transfer('XMODEM RECEIVE "f"', "sx", "-q", "-b", source)[0] == 0
    assert terminal.transfer('XMODEM SEND "f"', "rx", "-q", "-b", target)[0] == 0
    assert target.read_bytes()[:3000] == source.read_bytes()


def test_a_program_comes_and_goes(terminal: Terminal, tmp_path: Path) -> None:
    """It is the program afterwards, and runs."""
    source, target = tmp_path / "source.bas", tmp_path / "target.bas"
    lines = [f"a = a + {n}" for n in range(200)] + ["PRINT a"]
    source.write_text("\r\n".join(lines) + "\r\n")
    code, shown = terminal.transfer("XMODEM RECEIVE", "sx", "-q", "-b", source)
    assert code == 0
    assert "bytes received" in shown
    assert terminal.type("RUN") == " 19900\r\n"
    assert terminal.transfer("XMODEM SEND", "rx", "-q", "-b", "-c", target)[0] == 0
    assert target.read_bytes().rstrip(b"\x1a").decode().splitlines() == lines


def test_a_transfer_that_is_cancelled_changes_nothing(terminal: Terminal, tmp_path: Path) -> None:
    """By the keys a user has: Ctrl-X twice, and Ctrl-C."""
    terminal.type('OPEN "f" FOR OUTPUT AS #1:PRINT #1,"old":CLOSE')
    for keys in (b"\x18\x18", b"\x03"):
        os.write(terminal.near, b'XMODEM RECEIVE "f"\r')
        terminal.read_until(b"\r\nC")
        os.write(terminal.near, keys)
        shown = terminal.read_until(b"> ")
        assert b"Error : Transfer failed: cancelled\r\n" in shown
    assert terminal.type('LIST "f"') == "old\r\n"
    assert terminal.type('? DIR$("*")') == "f\r\n"


@pytest.mark.parametrize("damage", [0, 1])
def test_a_new_file_of_a_cancelled_transfer_is_gone(terminal: Terminal, damage: int) -> None:
    """What has come of it, a good block or half a one, is no file."""
    os.write(terminal.near, b'XMODEM RECEIVE "new"\r')
    terminal.read_until(b"\r\nC")
    data = b"a" * 128
    check = (binascii.crc_hqx(data, 0) ^ damage).to_bytes(2)
    os.write(terminal.near, b"\x01\x01\xfe" + data + check)
    if not damage:
        terminal.read_until(b"\x06")
    os.write(terminal.near, b"\x18\x18")
    assert b"Error : Transfer failed: cancelled\r\n" in terminal.read_until(b"> ")
    assert terminal.type('? "["; DIR$("*"); "]"') == "[]\r\n"


def test_sending_what_is_not_there(terminal: Terminal) -> None:
    """The error comes at once, not after the wait for a receiver."""
    assert terminal.type('XMODEM SEND "none"') == "Error : File not found: /none\r\n"
    assert terminal.type("XMODEM SEND") == "Error : No program\r\n"
