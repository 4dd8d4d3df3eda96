"""`stepmite put` and `get` against the real firmware, as the host build behind a pty."""

import os
import subprocess
import threading
import tty
from pathlib import Path
from random import Random

import pytest
from typer.testing import CliRunner

from stepmite.board import Board, BoardError
from stepmite.cli import app
from stepmite.transfer import TransferError, get, put

HOST = Path(__file__).parents[2] / "build" / "host" / "stepmite"


class Spoiler:
    """Carries bytes between two ptys and damages one of them now and then."""

    def __init__(self, every):
        self.every, self.count, self.spoiled = every, 0, 0
        self.inner, board_end = os.openpty()
        self.outer, self.near = os.openpty()
        for end in (board_end, self.near, self.inner, self.outer):
            tty.setraw(end)
        self.device = os.ttyname(self.near)
        self.board_end = board_end
        self.armed = False
        for source, target in ((self.inner, self.outer), (self.outer, self.inner)):
            threading.Thread(target=self._carry, args=(source, target), daemon=True).start()

    def _carry(self, source, target):
        while True:
            try:
                data = bytearray(os.read(source, 1024))
            except OSError:
                return
            for i in range(len(data)):
                self.count += 1
                if self.armed and len(data) > 100 and self.count % self.every == 0:
                    data[i] ^= 0x20
                    self.spoiled += 1
            os.write(target, data)


class HostBoard:
    """The host program with a pty as its console, in real time."""

    def __init__(self, every=1):
        self.line = Spoiler(every)
        self.device = self.line.device
        self.process = subprocess.Popen(
            [HOST, "--realtime"], stdin=self.line.board_end, stdout=self.line.board_end
        )

    def close(self):
        self.process.kill()
        self.process.wait()


@pytest.fixture
def board():
    boards = []

    def make(**options):
        boards.append(HostBoard(**options))
        return boards[-1]

    yield make
    for one in boards:
        one.close()


def call(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


def test_files_go_there_and_back(board, tmp_path):
    device = board().device
    for size in (0, 1, 128, 5000):
        source, back = tmp_path / "part.nc", tmp_path / "back.nc"
        source.write_bytes(Random(size).randbytes(max(size - 1, 0)) + b"x" * (size > 0))
        result = call("put", source, "--port", device)
        assert result.exit_code == 0, result.output
        assert f"part.nc: {size} bytes" in result.output
        result = call("get", "part.nc", back, "--port", device)
        assert result.exit_code == 0, result.output
        assert back.read_bytes() == source.read_bytes()


def test_a_file_of_the_board_that_ends_with_padding_comes_whole(board):
    with Board.open(board().device) as prompt:
        prompt.command('OPEN "f" FOR OUTPUT AS #1:PRINT #1,STRING$(200,26);:CLOSE')
        assert get(prompt, "f") == b"\x1a" * 200
        with pytest.raises(TransferError, match="1A hex"):
            put(prompt, b"text\x1a", "f")


def test_the_boards_own_message_is_told(board, tmp_path):
    device = board().device
    result = call("get", "none", tmp_path / "none", "--port", device)
    assert result.exit_code == 1
    assert "Error: File not found: /none" in result.output
    assert not (tmp_path / "none").exists()
    source = tmp_path / "a"
    source.write_text("text")
    result = call("put", source, "no/folder", "--port", device)
    assert result.exit_code == 1
    assert "Error: " in result.output
    with Board.open(device) as prompt:
        with pytest.raises(BoardError, match="Not a file name"):
            put(prompt, b"text", "C" * 100)
        assert prompt.command("PRINT 5") == [" 5"]
        with pytest.raises(ValueError, match="not a name"):
            put(prompt, b"text", 'a"b')


def test_a_line_that_damages_bytes_costs_time_only(board):
    one = board(every=1500)
    data = Random(1).randbytes(6000) + b"x"
    with Board.open(one.device) as prompt:
        one.line.armed = True
        put(prompt, data, "f")
        back = get(prompt, "f")
        one.line.armed = False
    assert one.line.spoiled > 4
    assert back == data
