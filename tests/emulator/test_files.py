"""Files on the emulated board: kept over a restart, carried over USB, read beside motion."""

from binascii import crc_hqx
from itertools import pairwise
from random import Random

import pytest

from stepmite.emulator import Emulator

SETUP = ["STEPPER INIT ,,GP22", "STEPPER AXIS X,GP2,GP3,,,80,6000,500", "STEPPER POSITION HOME"]
BUSY = "The flash cannot be written while motion is under way"
ACK, EOT, SUB = "\x06", "\x04", "\x1a"


def answer(board: Emulator, line: str, timeout_ms: float = 3000) -> list[str]:
    """The lines that a line prints."""
    return board.command(line, timeout_ms=timeout_ms).replace("\r", "").split("\n")[1:]


def block(number: int, data: bytes) -> str:
    """A block of XMODEM, of 128 or 1024 bytes."""
    size = 1024 if len(data) > 128 else 128
    data = data.ljust(size, SUB.encode())
    head = bytes([2 if size == 1024 else 1, number & 255, 255 - (number & 255)])
    return (head + data + crc_hqx(data, 0).to_bytes(2)).decode("latin-1")


def put(board: Emulator, name: str, data: bytes, size: int) -> None:
    """Send a file by XMODEM."""
    board.send(f'XMODEM RECEIVE "{name}"\r')
    board.until("\nC", 3000)
    for number, start in enumerate(range(0, len(data), size), start=1):
        board.send(block(number, data[start : start + size]))
        board.until(ACK, 3000)
    board.send(EOT)
    assert f"{len(data)} bytes received" in board.until("\n> ", 3000)


def get(board: Emulator, name: str) -> bytes:
    """Take a file by XMODEM."""
    board.send(f'XMODEM SEND "{name}"\r')
    board.until("\n", 3000)
    received = b""
    board.send("C")
    while True:
        board.run_ms(20)
        frame = board.output().encode("latin-1")
        if frame == EOT.encode():
            break
        assert len(frame) == 133
        assert frame[1] == (len(received) // 128 + 1) & 255
        assert crc_hqx(frame[3:131], 0) == int.from_bytes(frame[131:])
        received += frame[3:131]
        board.send(ACK)
    board.send(ACK)
    size = int(board.until(" bytes sent\r\n> ", 3000).split()[-1])
    return received[:size]


@pytest.mark.parametrize("orderly", [True, False])
def test_files_are_kept_over_a_restart(board: Emulator, orderly: bool) -> None:
    """What was closed or flushed is there; after a crash what was not has the old content."""
    board.command('MKDIR "d": OPEN "d/a" FOR OUTPUT AS #1: PRINT #1, "first": CLOSE #1')
    board.command('OPEN "b" FOR OUTPUT AS #1: PRINT #1, "flushed": FLUSH #1: PRINT #1, "not"')
    board.command('OPEN "d/a" FOR OUTPUT AS #2: PRINT #2, "second"')
    board.send("CPU RESTART\r" if orderly else "WATCHDOG 50: DO: LOOP\r")
    board.connect(3000)
    board.until("\n> ", 3000)
    assert answer(board, 'LIST "d/a"') == ["second" if orderly else "first"]
    assert answer(board, 'LIST "b"') == ["flushed", "not"][: 1 + orderly]


def test_xmodem_over_usb(board: Emulator) -> None:
    """Both ways and with both sizes of blocks."""
    for size in (128, 1024):
        data = Random(size).randbytes(3000) + b"x"
        put(board, "f.bin", data, size)
        assert get(board, "f.bin") == data


def test_a_new_program_over_usb_runs(board: Emulator) -> None:
    source = "\n".join([f"a = a + {n}" for n in range(50)] + ["PRINT a"]).encode()
    board.send("XMODEM RECEIVE\r")
    board.until("\nC", 3000)
    for number, start in enumerate(range(0, len(source), 128), start=1):
        board.send(block(number, source[start : start + 128]))
        board.until(ACK, 3000)
    board.send(EOT)
    board.until("\n> ", 3000)
    assert answer(board, "RUN") == [" 1225"]


def test_files_beside_motion(board: Emulator) -> None:
    """Reading goes on, writing is refused, no step is late; then all is as it was."""
    for line in SETUP:
        assert "rror" not in board.command(line)
    board.command(
        'OPEN "t" FOR OUTPUT AS #1: FOR i=1 TO 100: PRINT #1, i: NEXT: CLOSE', timeout_ms=9000
    )
    board.command('OPEN "t" FOR INPUT AS #1: OPEN "log" FOR OUTPUT AS #2: MKDIR "d"')
    board.command("STEPPER RUN")
    board.clear_edges()
    board.command("STEPPER GC G1 X40 F6000")
    board.run_ms(100)
    for line in ('RMDIR "d"', 'OPEN "u" FOR OUTPUT AS #3', 'XMODEM RECEIVE "u"', 'COPY "t" TO "u"'):
        assert answer(board, line) == [f"Error : {BUSY}"]
    reading = "s=0: DO WHILE NOT EOF(#1): INPUT #1, a: s=s+a: LOOP: PRINT s"
    assert answer(board, reading) == [" 5050"]
    board.command('PRINT #2, "small": CLOSE #2')
    assert answer(board, "PRINT PEEK(STEPPER ACTIVE)") == [" 1"]
    board.run_ms(900)
    steps = [time_ns for time_ns, _, level in board.edges([2]) if level == 1]
    assert len(steps) == 3200
    cruise = steps[1000:2000]
    gaps = {b - a for a, b in pairwise(cruise)}
    assert max(gaps) - min(gaps) < 25_000  # 8 kHz on ticks of 10 us
    assert answer(board, 'LIST "log"') == ["small"]
