"""Settings kept over power-off, and how a board starts its program."""

from __future__ import annotations

import subprocess
from pathlib import Path
from tempfile import TemporaryFile

import pytest
from test_prompt import CTRL_C, PROGRAM, answers, session
from test_stored_programs import BUSY, MOVING, shown, stored


def test_options_are_kept_and_listed(tmp_path: Path) -> None:
    flash = ("--flash", str(tmp_path / "flash.bin"))
    typed = "OPTION DISPLAY 40,132\rOPTION autorun on\rOPTION TAB 4\rOPTION BREAK 1\r"
    assert answers(typed + "OPTION LIST\r", *flash) == answers("OPTION LIST\r", *flash)
    assert answers("OPTION AUTORUN OFF\rOPTION TAB 2\rOPTION LIST\rFILES\r", *flash)[:2] == [
        "OPTION DISPLAY 40, 132",
        "OPTION BREAK 1",
    ]
    assert answers("OPTION RESET\rOPTION LIST\r", *flash) == []
    assert answers("OPTION LIST\r", *flash) == []


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("OPTION BREAK 256", "key: 256 is invalid (valid is 0 to 255)"),
        ("OPTION TAB 5", "5 is invalid (valid is 2, 3, 4 or 8)"),
        ("OPTION DISPLAY 1", "lines: 1 is invalid (valid is 2 to 255)"),
        ("OPTION DISPLAY 24,10", "columns: 10 is invalid (valid is 20 to 255)"),
        ("OPTION AUTORUN 1", "Invalid syntax"),
        ("OPTION NONSENSE", "Unknown OPTION subcommand"),
    ],
)
def test_bad_options(line: str, error: str) -> None:
    assert answers(f"{line}\rOPTION LIST\r") == [f"Error : {error}"]


def test_options_are_not_changed_while_motion_is_under_way() -> None:
    assert shown(MOVING + "PRINT 0\rOPTION TAB 4\rOPTION LIST\rOPTION TAB 2\r") == [BUSY]


def test_a_break_key_of_ones_own(tmp_path: Path) -> None:
    flash = ("--flash", str(tmp_path / "flash.bin"))
    session(stored('DO:k$=INKEY$:LOOP UNTIL k$="x":PRINT "x"') + "OPTION BREAK 24\r", *flash)
    assert answers(f"RUN\r{CTRL_C}x", *flash) == ["x"]
    assert answers("RUN\r\x18PRINT 5\r", *flash) == [" 5"]


def start(typed: str, *options: str) -> str:
    """What the terminal shows in all; typed before the board is on, as a file is."""
    with TemporaryFile() as keys:
        keys.write(typed.encode())
        keys.seek(0)
        done = subprocess.run(
            [PROGRAM, "--virtual", *options], stdin=keys, capture_output=True, timeout=20
        )
    assert done.returncode == 0
    return done.stdout.decode().split("commands\r\n\r\n", 1)[1]


def test_autorun_and_startup(tmp_path: Path) -> None:
    flash = ("--flash", str(tmp_path / "flash.bin"))
    program = 'PRINT "main"\rSUB MM.STARTUP\rPRINT "startup"\rEND SUB'
    session(stored(program), *flash)
    assert start("", *flash) == "startup\r\n> "
    session("OPTION AUTORUN ON\r", *flash)
    assert start("PRINT 5\r", *flash) == "startup\r\nmain\r\n> PRINT 5\r\n 5\r\n> "
    assert start("NEW\r", *flash)
    assert start("", *flash) == "> "


def test_ctrl_c_first_keeps_the_program_from_starting(tmp_path: Path) -> None:
    flash = ("--flash", str(tmp_path / "flash.bin"))
    session(stored("DO:LOOP") + "OPTION AUTORUN ON\rOPTION BREAK 0\r", *flash)
    skipped = "MM.STARTUP and AUTORUN are skipped\r\n> PRINT 5\r\n 5\r\n> "
    assert start(f"{CTRL_C}PRINT 5\r", *flash).endswith(skipped)
    start(f"{CTRL_C}OPTION BREAK 3\r", *flash)
    assert start(f"{CTRL_C}PRINT 5\r", *flash) == skipped


def test_an_error_in_the_program_that_starts_leaves_the_prompt(tmp_path: Path) -> None:
    flash = ("--flash", str(tmp_path / "flash.bin"))
    session(stored("PRINT 1/0") + "OPTION AUTORUN ON\r", *flash)
    assert start("PRINT 5\r", *flash) == (
        "[1] PRINT 1/0\r\nError : Divide by zero\r\n> PRINT 5\r\n 5\r\n> "
    )


def test_a_damaged_option_costs_no_more_than_itself(tmp_path: Path) -> None:
    image = tmp_path / "flash.bin"
    session("OPTION TAB 4\rOPTION DISPLAY 30,100\r", "--flash", str(image))
    session('COPY ".options" TO "o"\r', "--flash", str(image))
    program = 'OPEN ".options" FOR OUTPUT AS #1:PRINT #1,"TAB=x";CHR$(10);"=5";CHR$(10);"JUNK"'
    session(f'{program}:PRINT #1,"BREAK=99999":CLOSE\r', "--flash", str(image))
    assert answers("OPTION LIST\rPRINT 5\r", "--flash", str(image))[-1] == " 5"
    assert answers("OPTION TAB 8\rOPTION LIST\r", "--flash", str(image))[0] == "OPTION TAB 8"


def test_format(tmp_path: Path) -> None:
    flash = ("--flash", str(tmp_path / "flash.bin"))
    session(stored("PRINT 11") + 'SAVE "x"\rOPTION TAB 4\rv=5:VAR SAVE v\r', *flash)
    assert answers('OPTION FORMAT "B:"\r', *flash) == ['Error : The drive is "A:"']
    typed = 'OPTION FORMAT "a:"\rOPTION LIST\rVAR RESTORE:?v\rRUN\rLOAD "x"\r'
    assert answers(typed, *flash) == [" 0", " 11", "Error : File not found: /x.bas"]
    assert answers('OPTION LIST\rSAVE "y"\rLOAD "y",R\r', *flash) == [" 11"]
    assert shown(MOVING + 'PRINT 0\rOPTION FORMAT "A:"\r') == [BUSY]
    assert (
        shown(stored('OPTION FORMAT "A:"') + "PRINT 0\rRUN\r")[-1] == "Error : Only at the prompt"
    )
