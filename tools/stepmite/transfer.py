"""Files between this PC and the disk of a board, by XMODEM over the prompt's own port."""

from __future__ import annotations

import io
import re
import time
from collections.abc import Callable

from xmodem import XMODEM

from stepmite.board import Board, BoardError, Port

BLOCK = 128
NAME_MAX = 127
_TRIES = 10
_ASK, _EOT, _ACK = b"C", b"\x04", b"\x06"

Progress = Callable[[int], None]
"""Called with the number of bytes that have gone or come so far."""


class TransferError(Exception):
    """The transfer did not come to its end, or not all has arrived."""


class _Line:
    """What the xmodem package needs of a serial port, with one byte put back in front.

    `asked`: what opens the conversation was sent already.
    """

    def __init__(self, port: Port, first: bytes = b"", asked: bool = False) -> None:
        self._port = port
        self._first = first
        self._asked = asked

    def read(self, size: int, timeout: float = 1) -> bytes | None:
        """Return up to `size` bytes; None if none came for `timeout` seconds."""
        got, self._first = self._first[:size], self._first[size:]
        deadline = time.monotonic() + timeout
        while len(got) < size and time.monotonic() < deadline:
            got += self._port.read(size - len(got))
        return got or None

    def write(self, data: bytes, timeout: float = 1) -> int | None:
        """Send bytes."""
        if self._asked and data == _ASK:
            self._asked = False
            return 1
        return self._port.write(bytes(data))


def _ask(line: _Line) -> bytes:
    """Ask the board to send, with a CRC; return its first byte, b"" if there is none."""
    for _ in range(_TRIES):
        line.write(_ASK)
        first = line.read(1, 3)
        if first is not None:
            return first
    return b""


def _quoted(name: str) -> str:
    if not name.isascii() or not name.isprintable() or '"' in name or len(name) > NAME_MAX:
        raise ValueError(f"not a name for a file of the board: {name}")
    return f'"{name}"'


def put(board: Board, data: bytes, name: str, progress: Progress | None = None) -> None:
    """Write a file of the board; what was there under this name is replaced when all has arrived.

    Raises BoardError with the firmware's message, TransferError if it was broken off. A file that
    ends with Ctrl-Z (1A hex) cannot be sent: XMODEM fills its last block with it.
    """
    if data.endswith(b"\x1a"):
        raise TransferError("the file ends with 1A hex, which XMODEM cannot carry")

    def count(total: int, sent: int, failed: int) -> None:
        if progress is not None:
            progress(min(sent * BLOCK, len(data)))

    def work(port: Port, first: bytes) -> bool:
        line = _Line(port, first)
        modem = XMODEM(line.read, line.write)
        return modem.send(io.BytesIO(data), retry=_TRIES, timeout=20, quiet=True, callback=count)

    output, whole = board.converse(f"XMODEM RECEIVE {_quoted(name)}", work, wait_for=b"C\x15")
    size = _bytes_told(output, "received")
    if not whole or size != len(data):
        raise TransferError("the transfer was broken off")


def get(board: Board, name: str, progress: Progress | None = None) -> bytes:
    """Read a file of the board; raises as put() does."""
    received = io.BytesIO()

    def count(total: int, good: int, failed: int, block: int) -> None:
        if progress is not None:
            progress(good * block)

    def work(port: Port, first: bytes) -> bool:
        first = _ask(_Line(port))
        if first == _EOT:  # an empty file, which the package does not understand
            port.write(_ACK)
            return True
        line = _Line(port, first, asked=True)
        modem = XMODEM(line.read, line.write)
        return modem.recv(received, retry=_TRIES, timeout=20, quiet=1, callback=count) is not None

    output, whole = board.converse(f"XMODEM SEND {_quoted(name)}", work, wait_for=None)
    size = _bytes_told(output, "sent")
    if not whole or size is None or size > len(received.getvalue()):
        raise TransferError("the transfer was broken off")
    return received.getvalue()[:size]


def _bytes_told(output: list[str], word: str) -> int | None:
    """Return the size that the firmware says has gone or come; raises its error if it told one."""
    for line in output:
        if line.startswith("Error : "):
            raise BoardError(line.removeprefix("Error : ").strip())
    for line in output:
        match = re.search(rf"(\d+) bytes {word}$", line.strip())
        if match:
            return int(match[1])
    return None
