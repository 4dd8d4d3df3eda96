"""EDIT on the screen of a terminal emulator: what each command does, and what it costs to draw."""

from __future__ import annotations

import pytest
from screen_terminal import DRAWN, ScreenTerminal

CTRL_C, CTRL_F, CTRL_R = "\x03", "\x06", "\x12"
ESC, ENTER, F1, F2, F3, F4, F5 = "\x1b", "\r", "\x1bOP", "\x1bOQ", "\x1bOR", "\x1bOS", "\x1b[15~"
F6, F8, F9 = "\x1b[17~", "\x1b[19~", "\x1b[20~"
UP, DOWN, RIGHT, LEFT = (f"\x1b[{letter}" for letter in "ABCD")
START, END = "\x1b[1;5H", "\x1b[1;5F"
LEFT_EDITOR = b"\x1b[H\r> "
PROGRAM = "".join(f"PRINT {n} ' line\n" for n in range(1, 61))
MACHINE = "STEPPER INIT:STEPPER AXIS X,GP2,GP3,,,80,6000,500:STEPPER POSITION HOME:STEPPER RUN\r"
MOVE = "STEPPER GC G1 X200000 F600\r"


@pytest.fixture
def editor(terminal: ScreenTerminal) -> ScreenTerminal:
    terminal.enter_program(PROGRAM)
    terminal.edit()
    terminal.key(START)
    return terminal


def keys(at: ScreenTerminal, *pressed: str) -> None:
    for key in pressed:
        at.key(key)


def status(at: ScreenTerminal) -> str:
    return at.rows()[22]


def message(at: ScreenTerminal) -> str:
    return at.rows()[23]


def test_the_screen_shows_program_place_and_keys(editor: ScreenTerminal) -> None:
    assert editor.rows()[:2] == ["PRINT 1 ' line", "PRINT 2 ' line"]
    assert editor.rows()[21] == "PRINT 22 ' line"
    assert status(editor).split()[:6] == ["Program", "INS", "Ln", "1", "of", "61"]
    assert message(editor).startswith("F1 Save  F2 Run  F3 Find  F4 Mark")
    assert editor.cursor() == (0, 0)


def test_escape_leaves_and_asks_only_if_something_changed(editor: ScreenTerminal) -> None:
    editor.type(ESC, LEFT_EDITOR)
    editor.edit()
    keys(editor, "x", ESC)
    assert message(editor).startswith("Leave without saving?")
    keys(editor, "n")
    assert editor.rows()[0] == "xPRINT 1 ' line"
    keys(editor, ESC)
    editor.type("y", LEFT_EDITOR)
    assert editor.listing() == PROGRAM


def test_f1_saves_and_f2_runs(editor: ScreenTerminal) -> None:
    keys(editor, *'PRINT "new":END', ENTER)
    assert b"new\r\n" in editor.type(F2)
    assert editor.listing() == 'PRINT "new":END\n' + PROGRAM
    editor.edit()
    keys(editor, START, "\x1b[3~")
    editor.type(F1, LEFT_EDITOR)
    assert editor.listing() == 'RINT "new":END\n' + PROGRAM


def test_it_opens_at_the_line_of_an_error_and_later_where_one_left(terminal) -> None:
    terminal.enter_program("a = 1\n" * 40 + "a = 1 / 0\n" + "b = 2\n" * 9)
    terminal.type("RUN\r")
    terminal.edit()
    assert status(terminal).split()[3] == "41"
    keys(terminal, DOWN, DOWN)
    terminal.type(F1, LEFT_EDITOR)
    terminal.edit()
    assert status(terminal).split()[3] == "43"


def test_find_goes_round(editor: ScreenTerminal) -> None:
    keys(editor, F3, *"print 5", ENTER)
    assert status(editor).split()[3] == "5"
    keys(editor, F3, F3)
    assert status(editor).split()[3] == "50"
    keys(editor, *["\x07"] * 9)
    assert status(editor).split()[3] == "59"
    assert not message(editor).startswith("From")
    editor.key("\x07")
    assert status(editor).split()[3] == "5"
    assert message(editor) == "From the start again"
    keys(editor, F3, *"no such text", ENTER)
    assert message(editor) == "Not found: no such text"
    assert status(editor).split()[3] == "5"


def test_replace_asks_at_each_place(editor: ScreenTerminal) -> None:
    keys(editor, F8, *"line", ENTER, *"row", ENTER)
    editor.type("y", DRAWN)
    editor.type("n", DRAWN)
    editor.type("a", DRAWN)
    while "Replaced" not in message(editor):
        editor.until(DRAWN)
    assert message(editor) == "Replaced 59 times"
    editor.type(F1, LEFT_EDITOR)
    assert editor.listing() == PROGRAM.replace("line", "row").replace("row", "line", 2).replace(
        "line", "row", 1
    )


def test_undo_takes_back_a_replacement_as_a_whole(editor: ScreenTerminal) -> None:
    keys(editor, F8, *"line", ENTER, *"row", ENTER)
    editor.type("a", DRAWN)
    while "Replaced" not in message(editor):
        editor.until(DRAWN)
    keys(editor, F6)
    editor.type(F1, LEFT_EDITOR)
    assert editor.listing() == PROGRAM


def test_blocks_are_moved(editor: ScreenTerminal) -> None:
    keys(editor, F4, DOWN, DOWN, F5, END, F5)
    editor.type(F1, LEFT_EDITOR)
    lines = PROGRAM.splitlines(keepends=True)
    assert editor.listing() == "".join(lines[2:] + lines[:2])


# ---- What moves ----------------------------------------------------------------------------------


def test_ctrl_c_never_loses_text_and_twice_it_stops_motion(terminal: ScreenTerminal) -> None:
    terminal.enter_program(PROGRAM)
    terminal.type(MACHINE)
    terminal.type(MOVE)
    terminal.edit()
    keys(terminal, "x", CTRL_C)
    assert message(terminal).startswith("ESC leaves. Ctrl-C again")
    assert terminal.rows()[0].startswith("xPRINT")
    terminal.key(CTRL_C)
    while "motion stops" not in message(terminal):
        terminal.until(DRAWN)
    assert terminal.rows()[0].startswith("xPRINT")
    keys(terminal, ESC)
    terminal.type("y", LEFT_EDITOR)
    assert b" 0\r\n" in terminal.type("PAUSE 2000:PRINT PEEK(STEPPER ACTIVE)\r")


def test_motion_is_held_and_goes_on_from_within_the_editor(terminal: ScreenTerminal) -> None:
    terminal.type(MACHINE)
    terminal.type(MOVE)
    terminal.edit()
    terminal.key(CTRL_F)
    while "Feed hold" not in message(terminal):
        terminal.until(DRAWN)
    keys(terminal, F9)
    terminal.key(CTRL_R)
    while "Resumed" not in message(terminal):
        terminal.until(DRAWN)
    terminal.type(ESC, LEFT_EDITOR)


def test_saving_while_motion_runs_is_refused_and_loses_nothing(terminal: ScreenTerminal) -> None:
    terminal.enter_program(PROGRAM)
    terminal.type(MACHINE)
    terminal.type(MOVE)
    terminal.edit()
    keys(terminal, "x", F1)
    assert message(terminal).startswith("Not saved: ")
    assert "motion is under way" in message(terminal)
    keys(terminal, F9)
    terminal.key(CTRL_C)
    while not terminal.type(F1, (DRAWN, LEFT_EDITOR)).endswith(LEFT_EDITOR):
        assert terminal.rows()[0].startswith("xPRINT")  # not at a standstill yet
        terminal.let_time_pass()
    assert terminal.listing() == "x" + PROGRAM


# ---- Pastes --------------------------------------------------------------------------------------


def test_a_paste_is_taken_as_it_is(terminal: ScreenTerminal) -> None:
    text = "".join(f"{'  ' * (n % 7)}PRINT {n}\n" for n in range(1000))
    terminal.edit()
    terminal.type(text.replace("\n", "\r") + "\x11", LEFT_EDITOR)
    assert terminal.listing() == text
    terminal.type("NEW\r")
    terminal.edit()
    terminal.type("\x1b[200~" + text + "\x1b[201~\x11", LEFT_EDITOR)
    assert terminal.listing() == text


def test_typed_lines_are_indented_like_the_one_before(terminal: ScreenTerminal) -> None:
    terminal.edit()
    keys(terminal, *"  a", ENTER, *"b", ENTER, *"c")
    assert terminal.rows()[:3] == ["  a", "  b", "  c"]


def test_a_paste_that_does_not_fit_loses_nothing_that_is_there(editor: ScreenTerminal) -> None:
    editor.key(END)
    for _ in range(40):
        editor.paste("\x1b[200~" + "' 23456789\n" * 900 + "\x1b[201~")
        if " 0 KB free" in status(editor):
            break
    keys(editor, *["x"] * 8)
    while "Not enough memory" not in message(editor):
        editor.paste("1234567")
        keys(editor, "x")
    editor.key(START)
    assert editor.rows()[:2] == ["PRINT 1 ' line", "PRINT 2 ' line"]
    keys(editor, "x")
    assert "Not enough memory" in message(editor)
    keys(editor, "\x1b[3~", "x")
    assert editor.rows()[0] == "xRINT 1 ' line"


# ---- Terminals -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("names", "sequences", "place"),
    [
        ("Home", ["\x1b[H", "\x1bOH", "\x1b[1~", "\x1b[7~", "\x15"], (10, 0)),
        ("End", ["\x1b[F", "\x1bOF", "\x1b[4~", "\x1b[8~", "\x0b"], (10, 15)),
        ("Up", ["\x1b[A", "\x1bOA", "\x05"], (9, 3)),
        ("Down", ["\x1b[B", "\x1bOB", "\x18"], (11, 3)),
        ("Left", ["\x1b[D", "\x1bOD", "\x13"], (10, 2)),
        ("Right", ["\x1b[C", "\x1bOC"], (10, 4)),
        ("Ctrl-Right", ["\x1b[1;5C", "\x1b[5;5C", "\x06"], (10, 6)),
        ("Ctrl-Home", ["\x1b[1;5H", "\x1b[1;5~", "\x1b[7^"], (0, 0)),
        ("unknown", ["\x1b[99~", "\x1b[1;2;3;4;5m", "\x1b[>0;136;0c", "\x1bO*", "\x00"], (10, 3)),
    ],
)
def test_keys_of_all_terminals(editor: ScreenTerminal, names, sequences, place) -> None:
    for sequence in sequences:
        keys(editor, START, *[DOWN] * 10, *[RIGHT] * 3)
        editor.key(sequence)
        assert editor.cursor() == place, (names, sequence)
    assert editor.rows()[10] == "PRINT 11 ' line"


@pytest.mark.parametrize("f1", ["\x1bOP", "\x1b[11~", "\x1b[[A", "\x11"])
def test_f1_of_all_terminals(editor: ScreenTerminal, f1: str) -> None:
    keys(editor, "x")
    editor.type(f1, LEFT_EDITOR)
    assert editor.listing() == "x" + PROGRAM


def test_a_terminal_that_tells_its_size_is_used_whole() -> None:
    at = ScreenTerminal(40, 132)
    at.enter_program(PROGRAM)
    at.type("EDIT\r\x1b[40;132R", DRAWN)
    assert at.rows()[37] == "PRINT 38 ' line"
    assert at.rows()[38].startswith(" Program")
    at.close()


def test_a_window_made_larger_and_smaller_is_redrawn(terminal: ScreenTerminal) -> None:
    terminal.enter_program(PROGRAM)
    terminal.edit()
    for rows, columns in [(50, 200), (10, 30), (30, 100), (24, 80), (60, 132)]:
        terminal.screen.resize(rows, columns)
        terminal.key("\x1b[21~")  # F10 asks
        terminal.key(f"\x1b[{rows};{columns}R")
        keys(terminal, START, "\x1b[F")
        assert terminal.rows()[0] == "PRINT 1 ' line"
        assert terminal.rows()[min(rows - 3, 59)] == f"PRINT {min(rows - 2, 60)} ' line"
        assert terminal.rows()[rows - 2].startswith(" Program")
        assert terminal.cursor() == (0, 14)
    keys(terminal, "x")
    terminal.type(F1, LEFT_EDITOR)
    assert terminal.listing() == PROGRAM.replace("line", "linex", 1)


def test_bytes_that_are_no_characters_are_shown_as_question_marks(terminal) -> None:
    terminal.type("AUTOSAVE\r", b"\r\n")
    terminal.type(b"' a\xffb \xe4\xb8\xad \xf0\x9f\x98\x80 \xc3\xa4\r\x1a")
    terminal.edit()
    assert terminal.rows()[0] == "' a?b ? ? ä"
    keys(terminal, "\x1b[F", LEFT, LEFT, "x")
    assert terminal.rows()[0] == "' a?b ? ?x ä"


def test_colours_and_tab_stops_are_options(terminal: ScreenTerminal) -> None:
    terminal.enter_program('IF a THEN PRINT "x", 12 \' why\n')
    terminal.type("OPTION COLOURCODE ON\rOPTION TAB 4\r", b"TAB 4\r\n> ")
    terminal.edit()
    row = terminal.screen.buffer[0]
    colours = {
        word: row[terminal.rows()[0].index(word)].fg for word in ["IF", "a", '"x', "12", "'"]
    }
    assert colours == {"IF": "cyan", "a": "default", '"x': "magenta", "12": "green", "'": "brown"}
    keys(terminal, START, "\t")
    assert terminal.rows()[0].startswith("    IF a")


# ---- What it costs -------------------------------------------------------------------------------


def test_a_key_costs_few_bytes(editor: ScreenTerminal) -> None:
    """At 115200 baud 100 bytes take 9 ms: drawing keeps up with a key held down."""
    keys(editor, *[DOWN] * 5, "\x1b[F", "x")
    typed = [len(editor.key(c)) for c in "abcdefghij" * 4]
    moved = [len(editor.key(key)) for key in [LEFT] * 9 + [UP] * 4 + [RIGHT] * 3 + [DOWN] * 9]
    keys(editor, *[DOWN] * 9)
    scrolled = [len(editor.key(DOWN)) for _ in range(20)]
    new_lines = [len(editor.key(ENTER)) for _ in range(10)]
    assert max(typed) <= 45
    assert max(moved) <= 45
    assert max(scrolled) <= 120
    assert max(new_lines) <= 160
    assert sum(typed + moved) / len(typed + moved) <= 36


# ---- Files ---------------------------------------------------------------------------------------


def test_a_file_is_edited(terminal: ScreenTerminal) -> None:
    terminal.enter_program("PRINT 1\n")
    terminal.edit('EDIT "part.nc"')
    assert status(terminal).startswith(" part.nc")
    keys(terminal, *"G1 X5", ENTER, *"G1 X6")
    terminal.type(F1, LEFT_EDITOR)
    assert terminal.type('LIST "part.nc"\r').endswith(b"G1 X5\r\nG1 X6\r\n> ")
    terminal.edit('EDIT "part.nc"')
    assert terminal.rows()[:2] == ["G1 X5", "G1 X6"]
    terminal.type(ESC, LEFT_EDITOR)
    assert terminal.listing() == "PRINT 1\n"
    terminal.edit('EDIT "no/such/folder"')
    keys(terminal, "x", F1)
    assert message(terminal).startswith("Not saved: ")
    assert terminal.rows()[0] == "x"


def test_a_file_that_cannot_be_is_refused_before_anything_is_drawn(
    terminal: ScreenTerminal,
) -> None:
    shown = terminal.type('EDIT "a?b"\rPRINT 1\r', b" 1\r\n> ")
    assert shown == b'EDIT "a?b"\r\nError : Not a file name: a?b.bas\r\n> PRINT 1\r\n 1\r\n> '


def test_f2_runs_a_file_as_the_program(terminal: ScreenTerminal) -> None:
    terminal.edit('EDIT "part.bas"')
    assert terminal.type("\x1b[200~PRINT 2*3\x1b[201~" + F2).endswith(b"\r 6\r\n> ")
    assert terminal.listing() == "PRINT 2*3\n"


def test_a_line_too_long_for_a_program_is_not_saved_but_not_lost(terminal) -> None:
    terminal.edit()
    terminal.key("\x1b[200~" + "PRINT 1\n" + "'" * 256 + "\x1b[201~")
    keys(terminal, START, F1)
    assert message(terminal).startswith("Not saved: this line has more than 255")
    assert status(terminal).split()[3] == "2"
    keys(terminal, "\x1b[3~")
    terminal.type(F1, LEFT_EDITOR)
    assert terminal.listing() == "PRINT 1\n" + "'" * 255 + "\n"
