"""A third of the cases of tests/bas on the emulated board: the same answers as on the host."""

import sys
import zlib
from pathlib import Path

import pytest

from stepmite.emulator import Emulator

sys.path.insert(0, str(Path(__file__).parents[1] / "bas"))
from cases import Case, read_cases

CTRL_C, CTRL_Z = "\x03", "\x1a"
SHARE = 3
# One prints the mark twice; AUTOSAVE refuses a line that a file may hold.
HOST_ONLY = {"errors: RUN inside a program starts it again", "errors: a line that is too long"}


def on_board() -> list[Case]:
    return [
        case
        for case in read_cases()
        if zlib.crc32(case.name.encode()) % SHARE == 0 and case.name not in HOST_ONLY
    ]


def run(board: Emulator, source: str) -> str:
    """Type a program in, run it, return what was printed up to the next prompt."""
    board.send("AUTOSAVE\r" + source.replace("\n", "\r") + CTRL_Z)
    board.until("\n> ", 5000)
    board.send("RUN\r")
    return board.until("\n> ", 5000)


def test_a_third_of_the_cases(board: Emulator) -> None:
    cases = on_board()
    assert len(cases) >= 70
    wrong = []
    for case in cases:
        board.command("STEPPER CLOSE")  # what another case has set up; an error if none has
        answer = case.answer(run(board, case.source) + "\n")
        if answer != case.expected():
            wrong.append((case.name, answer, case.expected()))
    assert wrong == []


DEEP = """\
PRINT f(%d)
FUNCTION f(n)
  IF n > 0 THEN f = 1 + ((((f(n - 1))))) ELSE f = 0
END FUNCTION
"""


@pytest.mark.parametrize(
    ("program", "answer"),
    [
        (DEEP % 50, [" 50"]),
        (DEEP % 100, [" 100"]),
        (DEEP % 5000, None),
        ("s\nSUB s\n  LOCAL t$ = SPACE$(255)\n  s\nEND SUB\n", None),
        ("s\nSUB s\n  LOCAL a(2000)\n  s\nEND SUB\n", None),
        ("DIM a$(500)\n", None),
        ("PRINT " + "(" * 32 + "1" + ")" * 32 + "\n", [" 1"]),
        ("PRINT " + "(" * 120 + "1" + ")" * 120 + "\n", None),
        ("PRINT " + "-" * 200 + "1\n", None),
        ("PRINT " + "ABS(" * 50 + "1" + ")" * 50 + "\n", None),
        ("a: GOSUB a\n", None),
        ("IF 1 THEN " * 24 + "PRINT 1\n", None),
    ],
)
def test_limits_are_errors_and_no_resets(
    board: Emulator, program: str, answer: list[str] | None
) -> None:
    resets = board.status()["resets"]
    lines = run(board, program).replace("\r", "").split("\n")[1:]
    if answer is None:
        assert lines[-1].startswith("Error : ") or lines == [" 1"]
    else:
        assert lines == answer
    assert board.command("PRINT 6*7").split() == ["PRINT", "6*7", "42"]
    assert board.status()["resets"] == resets
