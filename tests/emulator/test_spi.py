"""SPI on the emulated board: the controller's registers, words on the wire."""

import sys
from pathlib import Path

import pytest

from stepmite.emulator import Emulator

sys.path.insert(0, str(Path(__file__).parents[1] / "bas"))
from cases import Case, read_cases

CTRL_Z = "\x1a"
CLOCK_HZ = 125_000_000


def run(board: Emulator, source: str) -> str:
    """Type a program in, run it, return what was printed up to the next prompt."""
    board.send("AUTOSAVE\r" + source.replace("\n", "\r") + CTRL_Z)
    board.until("\n> ", 5000)
    board.send("RUN\r")
    return board.until("\n> ", 5000)


def on_the_wire() -> list[Case]:
    names = {
        "SPI words of all widths come back from a loopback plug",
        "SPI WRITE and READ",
        "an SPI transfer takes its time",
        "interrupts of the program go on with SPI",
    }
    return [case for case in read_cases() if case.name.removeprefix("spi: ") in names]


@pytest.mark.parametrize("case", on_the_wire(), ids=lambda case: case.name)
def test_the_wire_is_as_on_the_host(board: Emulator, case: Case) -> None:
    assert case.answer(run(board, case.source) + "\n") == case.expected()


def test_words_have_the_form_that_was_asked_for(board: Emulator) -> None:
    for mode, bits, hz in (
        (0, 8, 1_000_000),
        (1, 12, 400_000),
        (2, 16, 10_000),
        (3, 4, 62_500_000),
    ):
        source = f"""\
SETPIN GP8, GP11, GP10, SPI2
SPI2 OPEN {hz}, {mode}, {bits}
SPI2 WRITE 3, 1, 2, {2**bits - 1}
SPI2 CLOSE
"""
        run(board, source)
        words = board.spi_words(1)
        assert [word["word"] for word in words] == [1, 2, 2**bits - 1]
        assert {(word["mode"], word["bits"]) for word in words} == {(mode, bits)}
        assert 0.8 * hz <= words[0]["hz"] <= hz


def test_many_words_go_out_without_long_gaps(board: Emulator) -> None:
    program = """\
DIM a%(1999)
SETPIN GP4, GP3, GP2, SPI
SPI OPEN 250000, 0, 8
TIMER = 0
SPI WRITE 2000, a%()
PRINT "took"; TIMER
"""
    took_ms = float(run(board, program).split("took")[-1].split()[0])
    assert 2000 * 8 / 250 <= took_ms <= 2000 * 8 / 250 * 1.1
    assert len(board.spi_words(0)) == 2000
