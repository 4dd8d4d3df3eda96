"""Bad programs and full memory: the prompt stays usable."""

from __future__ import annotations

import re

import pytest
from test_prompt import CTRL_Z, answers, session


def test_a_list_ended_early_leaves_the_prompt_on_a_line_of_its_own():
    program = "".join(f"PRINT {line}\r" for line in range(60))
    shown = session(f"AUTOSAVE\r{program}{CTRL_Z}LIST\rqPRINT 7\r")
    assert shown.endswith("PRESS ANY KEY ...\r\n> PRINT 7\r\n 7\r\n> ")


def test_a_program_that_fills_the_memory_leaves_room_for_the_prompt():
    """Down to the last 16 bytes: what must be typed in need can still be typed."""
    sizes = [1 << shift for shift in range(13, 0, -1)] + [1] * 6
    fill = "".join(f"ON ERROR SKIP:DIM b{n}%({size})\r" for n, size in enumerate(sizes))
    rest = "ON ERROR ABORT:DIM last%(1)\r"
    typed = f"AUTOSAVE\r{fill}{rest}{CTRL_Z}RUN\rSTEPPER INIT\rSTEPPER ESTOP\r1+1\rNEW\r"
    got = answers(typed)
    assert "Error : Not enough memory" in got
    assert got[-1] == " 2"
    assert any(line.startswith("Emergency stop") for line in got)


def test_thousands_of_lines_of_texts_to_choose_from_use_up_no_memory():
    line = 'SELECT CASE "a":CASE "b":? 1:CASE "a":? 2:END SELECT\r'
    assert answers(line * 2000) == [" 2"] * 2000


def test_ctrl_c_ends_a_program_without_its_end_function():
    program = "ON ERROR IGNORE\rFUNCTION f(x)\rPRINT 1\r"
    assert answers(f"AUTOSAVE\r{program}{CTRL_Z}RUN\rPRINT 7\r")[-1] == " 7"


STILL_THERE = "RUN\rPRINT 6*7\rNEW\rAUTOSAVE\rPRINT 5\r" + CTRL_Z + "RUN\r"


@pytest.mark.parametrize(
    ("program", "error"),
    [
        ("".join(f'PRINT {i},"{"0" * 40}"\r' for i in range(3000)), "Not enough memory"),
        (("a=1:" * 60 + "\r") * 300, "Not enough memory for the code of the program"),
        (
            "".join(f"v{i}=1\r" for i in range(8000)),
            "Not enough memory for the code of the program",
        ),
        ("".join(f"SUB s{i}\rEND SUB\r" for i in range(4000)), "Not enough memory"),
        ("".join(f"label{i}: " for i in range(2000)) + "\r", "Line too long"),
        ("PRINT 1:" * 40 + "\r", "Line too long"),
    ],
)
def test_a_program_too_large_is_refused_and_the_prompt_goes_on(program: str, error: str):
    got = answers(f"AUTOSAVE\r{program}{CTRL_Z}{STILL_THERE}")
    assert any(error in line for line in got)
    assert " 42" in got
    assert got[-1] == " 5"


def test_a_line_of_255_characters_and_one_more():
    line = 'PRINT "' + "x" * 200 + '":' + "'" * 46
    assert len(line) == 255
    assert answers(f"AUTOSAVE\r{line}\r{CTRL_Z}RUN\r")[-1] == "x" * 200
    assert "Line too long" in session(f"AUTOSAVE\r{line}'\r{CTRL_Z}RUN\r")


def test_recursion_leaves_no_memory_in_use():
    """Errors deep inside give back what all the calls had."""
    program = """\
MEMORY
ON ERROR IGNORE
deep
MEMORY
SUB deep
  LOCAL a%(20), t$ = SPACE$(200)
  IF MM.ERRNO = 0 THEN deep
END SUB
"""
    shown = session(f"AUTOSAVE\r{program.replace(chr(10), chr(13))}{CTRL_Z}RUN\r")
    before, after = re.findall(r"free (\d+) of", shown)
    assert before == after


def test_many_blocks_without_an_end_are_told_as_such():
    program = "PRINT 1\r" + "DO\r" * 90
    got = answers(f"AUTOSAVE\r{program}{CTRL_Z}RUN\rPRINT 7\r")
    assert got[-4:] == [" 1", "[2] DO", "Error : Cannot find a matching LOOP", " 7"]
