"""Random keys in the editor: screen, cursor and stored text are those of a model in Python."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from editor_model import EditorModel
from hypothesis import given, settings
from hypothesis import strategies as st
from screen_terminal import ScreenTerminal

ROWS, COLUMNS = 12, 40
TEXT = (
    "' A program\nFOR i = 1 TO 10\n  PRINT i;\n\tIF i > 5 THEN\n"
    '    PRINT "Größe €"\n  ENDIF\nNEXT\n'
    f"' {'a long line of many words, ' * 4}\n"
) + "".join(f"x{n} = {n}\n" for n in range(12))
KEYS = {
    "left": "\x1b[D", "right": "\x1b[C", "up": "\x1b[A", "down": "\x1b[B", "page up": "\x1b[5~",
    "page down": "\x1b[6~", "home": "\x1b[H", "end": "\x1b[F", "text start": "\x1b[1;5H",
    "text end": "\x1b[1;5F", "word left": "\x1b[1;5D", "word right": "\x1b[1;5C",
    "shift right": "\x1b[1;2C", "shift up": "\x1b[1;2A", "shift down": "\x1b[1;2B",
    "shift end": "\x1b[1;2F", "enter": "\r", "backspace": "\x7f", "delete": "\x1b[3~",
    "delete line": "\x1b[18~", "tab": "\t", "back tab": "\x1b[Z", "insert": "\x1b[2~",
    "mark": "\x1bOS", "paste": "\x1b[15~", "undo": "\x1a",
}  # fmt: skip


@pytest.fixture(scope="module")
def terminal() -> Iterator[ScreenTerminal]:
    at = ScreenTerminal(ROWS, COLUMNS)
    at.type(f"OPTION DISPLAY {ROWS},{COLUMNS}\r")
    yield at
    at.close()


key = st.one_of(
    st.sampled_from(sorted(KEYS)), st.sampled_from(sorted(KEYS)), st.sampled_from('aZ 1"ü')
)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.lists(key, min_size=1, max_size=60))
def test_the_editor_does_what_the_model_does(terminal: ScreenTerminal, keys: list[str]) -> None:
    terminal.enter_program(TEXT)
    terminal.edit()
    terminal.key(KEYS["text start"])
    model = EditorModel(TEXT, ROWS - 2, COLUMNS - 1)
    model.last = "text start"
    model.step = 1
    try:
        for name in keys:
            if name in KEYS:
                terminal.key(KEYS[name])
                model.press(name)
            else:
                terminal.key(name)
                model.typed(name)
            rows, cursor = model.shown()
            assert terminal.rows()[: ROWS - 2] == rows
            assert terminal.cursor() == cursor
    finally:
        terminal.type("\x11", b"\r> ")  # Ctrl-Q
    stored = model.text
    assert terminal.listing() == stored + ("\n" if stored and not stored.endswith("\n") else "")
