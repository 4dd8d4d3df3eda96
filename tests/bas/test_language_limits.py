"""Bad programs and full memory: the prompt stays usable."""

from __future__ import annotations

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
