"""VAR SAVE, VAR RESTORE and VAR CLEAR."""

from __future__ import annotations

from pathlib import Path

import pytest
from test_prompt import answers, session
from test_stored_programs import BUSY, MOVING, shown, stored

DAMAGED = "Error : The saved variables are damaged (VAR CLEAR forgets them)"


def test_values_come_back_after_power_off(tmp_path: Path) -> None:
    flash = ("--flash", str(tmp_path / "flash.bin"))
    session(
        'a=1.5:b%=-7:c$="text":DIM d(2)=(1,2,3):DIM e$(1,1) LENGTH 4=("a","b","c","dddd")\r'
        "VAR SAVE a,b%,c$,d(),e$()\r",
        *flash,
    )
    shows = "?a;b%;c$;d(0);d(2);e$(0,0);e$(1,1)\r"
    assert answers("VAR RESTORE\r" + shows, *flash) == [" 1.5-7text 1 3adddd"]
    declared = "OPTION EXPLICIT\rDIM FLOAT d(2)\rDIM b%\rDIM STRING e$(1,1) LENGTH 4\r"
    assert answers(declared + "VAR RESTORE\r" + shows, *flash) == [" 1.5-7text 1 3adddd"]


def test_a_program_restores_what_another_run_saved() -> None:
    program = "VAR RESTORE\rPRINT n%\rn%=n%+1\rVAR SAVE n%"
    assert shown(stored(program) + "PRINT 0\rRUN\rRUN\rRUN\r") == [" 0", " 1", " 2"]


def test_saving_adds_and_replaces() -> None:
    typed = "a=1:b=2:VAR SAVE a,b\ra=5:c=3:VAR SAVE a,c\ra=0:b=0:c=0:VAR RESTORE:?a;b;c\r"
    assert answers(typed) == [" 5 2 3"]
    assert answers(typed + "VAR CLEAR\ra=9:VAR RESTORE:?a\rFILES\r")[1] == " 9"


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("VAR SAVE nothing", "NOTHING is not declared"),
        ("CONST k=1:VAR SAVE k", "Cannot change a constant"),
        ("VAR SAVE", "Invalid syntax"),
        ("VAR SAVE 5", "Invalid syntax"),
        ("VAR KEEP a", "Invalid syntax"),
    ],
)
def test_what_cannot_be_saved(line: str, error: str) -> None:
    assert shown(f"a=1:VAR SAVE a\rPRINT 0\r{line}\ra=2:VAR RESTORE:?a\r") == [
        f"Error : {error}",
        " 1",
    ]


def test_locals_are_not_saved() -> None:
    for kind in ("LOCAL", "STATIC"):
        program = f"one\rSUB one\r{kind} x=5\rVAR SAVE x\rEND SUB"
        assert shown(stored(program) + "PRINT 0\rRUN\r")[-1] == "Error : Invalid here"


@pytest.mark.parametrize(
    "other",
    ["DIM a$", "DIM a%", "DIM a(3)", "DIM a(2,2)"],
)
def test_a_variable_of_another_shape_is_refused(other: str, tmp_path: Path) -> None:
    flash = ("--flash", str(tmp_path / "flash.bin"))
    session("DIM a(2)=(1,2,3):VAR SAVE a()\r", *flash)
    lines = answers(f"{other}\rVAR RESTORE\rPRINT 5\r", *flash)
    assert lines == ["Error : A Different type already declared", " 5"]


def test_refused_while_motion_is_under_way() -> None:
    lines = shown(MOVING + "PRINT 0\ra=5:VAR SAVE a\rVAR RESTORE\r?a\r")
    assert lines == [BUSY, " 5"]


def test_a_damaged_file_is_said_and_restores_nothing(tmp_path: Path) -> None:
    image = tmp_path / "flash.bin"
    flash = ("--flash", str(image))
    session('b=2:DIM a$(99) LENGTH 20:a$(50)="precious":VAR SAVE b,a$()\r', *flash)
    data = bytearray(image.read_bytes())
    data[data.index(b"precious")] ^= 0x10
    image.write_bytes(data)
    assert answers("b=7:VAR RESTORE\r?b\rVAR SAVE b\r", *flash) == [DAMAGED, " 7", DAMAGED]
    assert answers("VAR CLEAR\rb=8:VAR SAVE b\rb=0:VAR RESTORE:?b\r", *flash) == [" 8"]


def test_much_is_saved() -> None:
    typed = "DIM a(4000):a(4000)=1.25:VAR SAVE a()\ra(4000)=0:VAR RESTORE:?a(4000)\r"
    assert answers(typed) == [" 1.25"]
