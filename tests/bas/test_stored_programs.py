"""Programs in the flash and in files: NEW, SAVE, LOAD, RUN file, and what a failure leaves."""

from __future__ import annotations

from pathlib import Path

import pytest
from test_prompt import CTRL_Z, answers, session

MACHINE = "STEPPER INIT\rSTEPPER AXIS X,GP2,GP3,,,100,6000,500\rSTEPPER POSITION X,0\rSTEPPER RUN\r"
MOVING = MACHINE + "STEPPER GC G1 X100 F600\r"  # 10 s
STOPS = "Motion stops for the new program, what was queued is dropped"
BUSY = "Error : The flash cannot be written while motion is under way"


def stored(program: str) -> str:
    """What to type to make a text the program."""
    return f"AUTOSAVE\r{program}\r{CTRL_Z}"


def shown(typed: str, *options: str) -> list[str]:
    """The answers to what is typed after the mark PRINT 0."""
    lines = answers(typed, *options)
    return lines[lines.index(" 0") + 1 :]


def test_save_and_load(tmp_path: Path) -> None:
    flash = ("--flash", str(tmp_path / "flash.bin"))
    session(
        stored("PRINT 11") + 'SAVE "first"\r' + stored("PRINT 22") + 'SAVE "B.TXT"\rNEW\r', *flash
    )
    assert answers("RUN\r", *flash) == ["Error : No program"]
    assert answers('LOAD "first.bas"\rRUN\rLIST\r', *flash) == [" 11", "PRINT 11"]
    assert answers('LOAD "A:/B.TXT",R\r', *flash) == [" 22"]
    assert answers("RUN\r", *flash) == [" 22"]
    assert answers('LOAD "b.txt"\rRUN\r', *flash) == ["Error : File not found: /b.txt", " 22"]


def test_a_program_runs_another_with_an_argument() -> None:
    typed = stored('PRINT "two"') + 'SAVE "two"\r' + stored('PRINT "one":RUN "two":PRINT "no"')
    assert shown(typed + "PRINT 0\rRUN\rRUN\r") == ["one", "two", "two"]


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ('LOAD "none"', "File not found: /none.bas"),
        ('RUN "none"', "File not found: /none.bas"),
        ('SAVE ""', "Not a file name: "),
        ('SAVE "no/such"', "File not found: /no/such.bas"),
        ('LOAD ""', "Not a file name: "),
        ("LOAD 5", "Expected a string"),
        ("SAVE 5", "Expected a string"),
        ('LOAD "x",S', "Invalid syntax"),
        ('RUN "x","' + "a" * 200 + '"', "String too long"),
    ],
)
def test_bad_names_change_nothing(line: str, error: str) -> None:
    typed = stored("PRINT 11") + f"PRINT 0\rv=7\r{line}\rPRINT v\rRUN\r"
    assert shown(typed) == [f"Error : {error}", " 7", " 11"]


def test_load_and_new_are_for_the_prompt() -> None:
    assert shown(stored('LOAD "x"') + "PRINT 0\rRUN\r")[-1] == "Error : Only at the prompt"
    assert shown('PRINT 0\rSAVE "x"\r') == ["Error : No program"]


def test_nothing_is_written_while_motion_is_under_way() -> None:
    typed = stored("PRINT 11") + 'SAVE "old"\r' + MOVING + "v=7\rPRINT 0\r"
    refused = f'SAVE "new"\rLOAD "old"\r{stored("PRINT 22")}PRINT v\rRUN\r'
    lines = shown(typed + refused)
    assert [line for line in lines if line == BUSY] == [BUSY] * 3
    assert lines[-3:] == [" 7", STOPS, " 11"]
    later = "PAUSE 12000\rPRINT 0\r" + 'SAVE "new"\r' + 'LOAD "new",R\r'
    assert shown(typed.replace("PRINT 0\r", "") + later) == [" 11"]


def test_an_estop_input_does_not_keep_programs_from_being_stored() -> None:
    machine = MACHINE.replace("INIT\r", "INIT ,,GP22\r")
    typed = machine + stored("PRINT 11") + 'SAVE "old"\rPRINT 0\rRUN\rPRINT PEEK(STEPPER ACTIVE)\r'
    assert shown(typed) == [" 11", "-1"]


def test_a_program_larger_than_the_memory_is_kept(tmp_path: Path) -> None:
    flash = ("--flash", str(tmp_path / "flash.bin"))
    line = "a%=1:" * 40 + "a%=1"
    text = "\r".join([line] * 400)
    lines = answers(stored(text) + "RUN\rPRINT 1\rMEMORY\r", *flash)
    assert lines[-5:-2] == ["Error : Not enough memory for the code of the program"] * 2 + [" 1"]
    assert lines[-2].startswith(f"Flash:  program {len(text) + 1} of 130816 bytes")
    assert answers('SAVE "big"\rRUN\r', *flash)[-1].endswith("code of the program")


def test_memory_tells_flash_code_and_variables() -> None:
    typed = stored("DIM a(100)\rPRINT 0") + "RUN\rMEMORY\r"
    flash, memory = shown(typed)
    assert flash == "Flash:  program 19 of 130816 bytes"
    assert memory.startswith("Memory: code ")
