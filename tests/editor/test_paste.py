"""Pastes as fast as the host takes them, at the prompt and into AUTOSAVE; all line ends."""

from __future__ import annotations

import pytest

LINES = 10_000
ENDS = ["\r", "\n", "\r\n"]


@pytest.mark.parametrize("end", ENDS)
def test_ten_thousand_lines_at_the_prompt_are_all_carried_out(terminal, end) -> None:
    """PuTTY and TeraTerm send CR, a file LF, VS Code's serial monitor what it is told."""
    terminal.type("n% = 0 : s% = 0\r")
    pasted = "".join(f"n%=n%+1:s%=s%+{k}*n%{end}" for k in range(LINES))
    terminal.type(pasted + f"PRINT n%; s%; 42{end}", b" 42\r\n> ")
    expected = sum(k * (k + 1) for k in range(LINES))
    assert f" {LINES} {expected} 42" in terminal.rows()


@pytest.mark.parametrize("end", ENDS)
def test_ten_thousand_lines_into_autosave_are_all_there(terminal, end) -> None:
    lines = [f"a={k}" for k in range(LINES)]
    terminal.type("AUTOSAVE\r", b"\r\n")
    terminal.type(end.join(lines) + end + "\x1a")
    assert terminal.listing().split("\n")[:-1] == lines


def test_a_paste_larger_than_the_memory_leaves_the_old_program(terminal) -> None:
    terminal.enter_program("PRINT 1\n")
    terminal.type("AUTOSAVE\r", b"\r\n")
    shown = terminal.type("' a line to fill the memory with\r" * 20_000 + "\x1a", b"\r\n> ")
    assert shown.endswith(b"Error : Not enough memory\r\n> ")
    assert terminal.listing() == "PRINT 1\n"
    assert b"\r\n 1\r\n" in terminal.type("RUN\r")


def test_autosave_takes_the_memory_of_the_old_program_and_gives_it_back(terminal) -> None:
    terminal.enter_program("DIM a(8000)\nSUB five\nPRINT 5\nEND SUB\n")
    terminal.type("RUN\r")
    text = "' a line to fill the memory with\n" * 1200
    terminal.type("AUTOSAVE\r", b"\r\n")
    terminal.type(text.replace("\n", "\r") + "\x03")
    assert b"\r\n 5\r\n" in terminal.type("five\r")
    terminal.enter_program(text)
    assert terminal.listing() == text


def test_autosave_append(terminal) -> None:
    terminal.enter_program("PRINT 1\n")
    terminal.type("AUTOSAVE APPEND\r", b"\r\n")
    assert b"\r\n 1\r\n 2\r\n" in terminal.type("PRINT 2\r\x1bOQ")
    assert terminal.listing() == "PRINT 1\nPRINT 2\n"


def test_a_serial_monitor_that_sends_whole_lines(terminal) -> None:
    """VS Code's serial monitor: a line at once, ended by any line end, also within AUTOSAVE."""
    for end in ENDS:
        assert b"\r\n 5\r\n> " in terminal.type(f"PRINT 2+3{end}")
        terminal.type(f"AUTOSAVE{end}", b"\r\n")
        terminal.type(f"PRINT 7{end}", b"PRINT 7\r\n")
        terminal.type("\x1a")
        assert terminal.listing() == "PRINT 7\n"
