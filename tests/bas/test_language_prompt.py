"""The language at the prompt: what differs there from a program."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from test_prompt import CTRL_Z, PROGRAM, TIMEOUT_S, answers


def program(*lines: str) -> str:
    """Types a program in and runs it."""
    return "AUTOSAVE\r" + "".join(f"{line}\r" for line in lines) + CTRL_Z + "RUN\r"


@pytest.mark.parametrize(
    ("typed", "shown"),
    [
        ('EXECUTE "1+2"', [" 3"]),
        ('EXECUTE "a=5:? a"', [" 5"]),
        ('? EVAL("2^3")', [" 8"]),
        ('EXECUTE "FOR i=1 TO 3:? i;:NEXT"', [" 1 2 3"]),
        ('SELECT CASE "b":CASE "a" TO "c":? 1:END SELECT', [" 1"]),
        ("DIM a(2)=(3,1,2):SORT a():? a(0);a(1);a(2)", [" 1 2 3"]),
        ("? MATH(POWER 2,5)", [" 32"]),
        ("STATIC a", ["Error : Invalid here"]),
        ("LOCAL a", ["Error : Invalid here"]),
        ("SUB s", ["Error : Invalid here"]),
        ("GOTO 10", ["Error : Line number"]),
        ('EXECUTE "NEW":? 1', []),
        ('OPTION ESCAPE\r? "a\\x42"', ["aB"]),
        ("OPTION ANGLE DEGREES\r? SIN(30)", [" 0.5"]),
        ("_=5:? _+1", [" 6"]),
        ("MM.NOTHING", ["Error : Unknown command"]),
        ("? MM.NOTHING", ["Error : Unknown function MM.NOTHING"]),
    ],
)
def test_statements_at_the_prompt(typed: str, shown: list[str]) -> None:
    assert answers(typed + "\r") == shown


def test_a_word_that_is_no_variable_stays_unknown_after_it_was_used_as_an_argument() -> None:
    """A bare word in a command names a variable only if there is one."""
    lines = answers("STEPPER INIT\rSTEPPER ENABLE foo\rfoo\rfoo=5\rfoo\r")
    assert lines[-2:] == ["Error : Unknown command", " 5"]


def test_variables_of_a_program_are_there_after_it_and_its_subs_can_be_called() -> None:
    typed = program(
        "a=7:DIM b(2)=(1,2,3)", "SUB s", "LOCAL x=2:EXECUTE CHR$(63)+CHR$(120)", "END SUB"
    )
    after = "? a;b(2)\rs\rERASE b()\r? b(2)\rDIM b(9)\r? b(9)\r"
    assert answers(typed + after)[-4:] == [" 7 3", " 2", "Error : B is not declared", " 0"]


def test_lines_are_joined_in_programs_if_the_prompt_said_so() -> None:
    text = ("? 1 + _", "  2")
    assert answers(program(*text))[-1] == " 1"
    assert answers("OPTION CONTINUATION LINES ON\r" + program(*text))[-1] == " 3"
    assert "OPTION CONTINUATION LINES ON" in answers("OPTION CONTINUATION LINES ON\rOPTION LIST\r")


def test_a_program_says_itself_that_its_lines_are_not_joined() -> None:
    text = ("OPTION CONTINUATION LINES OFF", "_=4", "? 1 + _")
    assert answers("OPTION CONTINUATION LINES ON\r" + program(*text))[-1] == " 5"


def test_a_hundred_nested_blocks_and_not_one_more() -> None:
    """More than the twenty of each kind that are promised."""

    def nested(depth: int) -> list[str]:
        opening = [f"IF 1 THEN{' ' * (i % 2)}" for i in range(depth)]
        return [*opening, "PRINT 42", *["ENDIF"] * depth]

    assert answers(program(*nested(99)))[-1] == " 42"
    assert any("Too many nested blocks" in line for line in answers(program(*nested(120))))


def test_a_thousand_variables_of_one_program() -> None:
    lines = [f"v{i}={i}:n{i}%={i}" for i in range(500)]
    assert answers(program(*lines, "PRINT v499+n499%; v0; n7%"))[-1] == " 998 0 7"


def test_a_line_as_long_as_may_be() -> None:
    sums = "?" + "+".join(["1"] * 127)
    assert answers(program(sums + " "))[-1] == " 127"


def test_input_that_does_not_come_is_an_error() -> None:
    """Only where the terminal is a file: on a board INPUT waits."""
    assert answers("INPUT a\r")[-1] == "Error : End of input"


def test_a_damaged_program_is_ignored_with_a_word(tmp_path: Path) -> None:
    image = tmp_path / "flash.bin"
    answers(f"AUTOSAVE\rPRINT 11\r{CTRL_Z}", "--flash", str(image))
    flash = bytearray(image.read_bytes())
    flash[flash.index(b"PRINT 11")] ^= 1
    image.write_bytes(flash)
    typed = "PRINT 5\rRUN\r"
    done = subprocess.run(
        [PROGRAM, "--virtual", "--flash", str(image)],
        input=typed.encode(),
        capture_output=True,
        timeout=TIMEOUT_S,
        check=True,
    )
    output = done.stdout.decode("latin-1")
    assert "Error : The stored program is damaged and was ignored\r\n" in output
    assert output.endswith("\r\n 5\r\n> RUN\r\nError : No program\r\n> ")
