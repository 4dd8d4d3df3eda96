"""Keys at the prompt, on the screen of a terminal emulator: Tab, words, function keys, UTF-8."""

from __future__ import annotations

import os

import pytest
from screen_terminal import ScreenTerminal

LEFT, HOME, WORD_LEFT, WORD_RIGHT = "\x1b[D", "\x1b[H", "\x1b[1;5D", "\x1b[1;5C"
PROGRAM = "SUB zdrill(n)\nPRINT n\nEND SUB\nFUNCTION depth()\ndepth = 3\nEND FUNCTION\n"


def press(at: ScreenTerminal, *keys: str) -> None:
    """Press keys, each when the program waits for it: what comes at once counts as a paste."""
    for key in keys:
        at.take_in()
        os.write(at.master, key.encode())
        at.wait_until_it_waits()


@pytest.mark.parametrize(
    ("start", "line"),
    [
        ("PRI", "> PRINT"),
        ("pri", "> print"),
        ("RAN", "> RANDOMIZE"),
        ("STEPPER JUN", "> STEPPER JUNCTION"),
        ("stepper jun", "> stepper junction"),
        ("a=5:STEPPER JUN", "> a=5:STEPPER JUNCTION"),
        ("IF a THEN STEPPER JUN", "> IF a THEN STEPPER JUNCTION"),
        ("HELP STEPPER JUN", "> HELP STEPPER JUNCTION"),
        ("PRINT UCA", "> PRINT UCASE$("),
        ("PRINT 2+PEE", "> PRINT 2+PEEK("),
        ("zdri", "> zdrill"),
        ("PRINT dep", "> PRINT depth("),
        ("PRINT zdri", "> PRINT zdri"),
        ("PRINT UCX", "> PRINT UCX"),
        ("PRINT LE", "> PRINT LE"),
    ],
)
def test_tab_completes(terminal: ScreenTerminal, start: str, line: str) -> None:
    terminal.enter_program(PROGRAM)
    press(terminal, start, "\t")
    assert terminal.shows(line)


def test_a_second_tab_lists_what_it_could_be(terminal: ScreenTerminal) -> None:
    press(terminal, "PRINT LE", "\t", "\t")
    terminal.until(b"> PRINT LE")
    terminal.take_in()
    rows = [row for row in terminal.rows() if row]
    assert rows[-3] == "> PRINT LE"
    assert rows[-2].split() == ["LEFT$(", "LEN("]
    assert rows[-1] == "> PRINT LE"
    press(terminal, 'FT$("ab",1)\r')
    assert terminal.shows(">")
    assert "a" in terminal.rows()


def test_tab_completes_names_of_files(terminal: ScreenTerminal) -> None:
    terminal.type('MKDIR "parts"\r')
    terminal.type('CHDIR "parts":OPEN "Gear.nc" FOR OUTPUT AS 1:CLOSE:CHDIR "/"\r')
    press(terminal, 'LIST "pa', "\t")
    assert terminal.shows('> LIST "parts/')
    press(terminal, "G", "\t")
    assert terminal.shows('> LIST "parts/Gear.nc')
    press(terminal, "\x15", 'LIST "parts/g', "\t")
    assert terminal.shows('> LIST "parts/g')  # capitals count


def test_a_tab_in_a_paste_is_a_blank(terminal: ScreenTerminal) -> None:
    terminal.type("PRINT\t1+\t2\r")
    assert "> PRINT 1+ 2" in terminal.rows()


def test_words_are_jumped_over_and_deleted(terminal: ScreenTerminal) -> None:
    press(terminal, "PRINT one, two", WORD_LEFT, "x")
    assert terminal.shows("> PRINT one, xtwo")
    press(terminal, WORD_LEFT, WORD_LEFT, "\x17")
    assert terminal.shows("> one, xtwo")
    press(terminal, WORD_RIGHT, "y")
    assert terminal.shows("> one, yxtwo")


def test_letters_beyond_ascii_are_one_place(terminal: ScreenTerminal) -> None:
    press(terminal, "'Größe", LEFT, LEFT, "\x7f", "ä")
    assert terminal.shows("> 'Gräße")
    assert terminal.cursor()[1] == 6
    press(terminal, HOME, "\x1b[3~", "ü", "ö")
    assert terminal.shows("> üöGräße")
    assert terminal.cursor()[1] == 4
    press(terminal, "\x1b[2~", "x", "y", "z")
    assert terminal.shows("> üöxyzße")


@pytest.mark.parametrize(
    ("key", "line"), [("\x1bOQ", "> RUN"), ("\x1b[13~", "> LIST"), ("\x1b[[A", "> FILES")]
)
def test_function_keys_are_lines(terminal: ScreenTerminal, key: str, line: str) -> None:
    terminal.enter_program("PRINT 7\n")
    terminal.type(key)
    assert line in terminal.rows()


def test_function_keys_have_texts_of_the_user(tmp_path) -> None:
    flash = ("--flash", str(tmp_path / "flash.bin"))
    at = ScreenTerminal(options=flash)
    at.type('OPTION F5 "PRINT 6*"\r')
    at.type('OPTION F2 "PRINT 5" + CHR$(13)\r')
    at.type('OPTION F12 "\'" + SPACE$(62) + "x"\r')
    assert at.type("OPTION F12 SPACE$(65)\r").endswith(b"Error : String too long\r\n> ")
    at.close()
    at = ScreenTerminal(options=flash)
    press(at, "\x1b[15~", "7\r")
    at.until(b" 42\r\n> ")
    assert b"\r\n 5\r\n" in at.type("\x1bOQ")
    listed = at.type("OPTION LIST\r")
    assert b'OPTION F5 "PRINT 6*"\r\nOPTION F2 "PRINT 5" + CHR$(13)\r\n' in listed
    at.type('OPTION F2 ""\r')
    assert at.type("\x1bOQ").startswith(b"RUN")
    at.type("OPTION RESET\r")
    assert b"F5" not in at.type("OPTION LIST\r").removeprefix(b"OPTION LIST")
    at.close()


def test_f4_edits_and_f10_takes_a_program(terminal: ScreenTerminal) -> None:
    terminal.type("\x1b[21~", b"\r\n")
    terminal.type("PRINT 8\r\x1bOP")
    terminal.key("\x1bOS")
    assert terminal.rows()[0] == "PRINT 8"
    terminal.type("\x1b", b"\r> ")


def test_unknown_sequences_and_bracketed_pastes_do_nothing_strange(terminal) -> None:
    noise = ["\x1b[99~", "\x1b[?1;2c", "\x1b[200~", "\x1bOx", "\x1b[12;34;56m", "\x1b[201~"]
    press(terminal, "PRINT ", *noise, "5")
    assert terminal.shows("> PRINT 5")


def test_a_program_can_have_its_own_prompt(terminal: ScreenTerminal) -> None:
    terminal.type("AUTOSAVE\r", b"\r\n")
    terminal.type('SUB MM.PROMPT\rn = n + 1\rPRINT "line"; n; ": ";\rEND SUB\r\x1a', b"line 1: ")
    terminal.type("PRINT 3\r", b"line 2: ")
    press(terminal, "PRINT 12", LEFT, "x")
    assert terminal.shows("line 2: PRINT 1x2")
    assert terminal.cursor()[1] == 16
    terminal.type("\x15NEW\r", b"\r\n> ")


def test_ctrl_c_gets_past_a_prompt_that_hangs(terminal: ScreenTerminal) -> None:
    terminal.type("AUTOSAVE\r", b"\r\n")
    terminal.type("SUB MM.PROMPT\rPRINT 7;\rDO:LOOP\rEND SUB\r\x1a", b" 7")
    terminal.type("\x03", b"> ")
    terminal.type("PRINT 3 + 3\r", b" 6\r\n 7")
    terminal.type("\x03", b"> ")
    terminal.type("NEW\r", b"\r\n> ")


@pytest.mark.parametrize(
    ("key", "code"),
    [("\x1b[A", 128), ("\x1bOD", 130), ("\x1b[3~", 127), ("\x1b[H", 134), ("\x1b[6~", 137),
     ("\x1bOP", 145), ("\x1b[24~", 156), ("\x1b[1;2R", 179), ("\x1b[Z", 159), ("\x1b", 27),
     ("x", 120), ("\r", 13), ("\n", 10)],
)  # fmt: skip
def test_inkey_tells_keys_without_a_character(terminal, key: str, code: int) -> None:
    terminal.type('DO: k$ = INKEY$: LOOP UNTIL k$ <> "": PRINT ASC(k$); LEN(INKEY$)\r', b"\r\n")
    assert terminal.type(key).startswith(f" {code} 0\r\n".encode())
