"""A one-line terminal: turns what the prompt prints into plain lines of text.

The line editor redraws the line being typed with control sequences when a notice comes in between.
Only the current line has to be understood for that; colours and the like are skipped.
"""

from __future__ import annotations

import re

_SEQUENCE = re.compile(r"\x1b\[([0-9;?]*)([A-Za-z~])|\x1b[()][A-Z0-9]|\x1b[^\[()]")


class Screen:
    """Takes received text and keeps the finished lines and the line under the cursor."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        """Finished lines that nobody has taken yet, oldest first."""
        self._row: list[str] = []
        self._column = 0
        self._pending = ""

    @property
    def current(self) -> str:
        """The line under the cursor as it stands now."""
        return "".join(self._row)

    def forget(self) -> None:
        """Drop the finished lines."""
        self.lines.clear()

    def clear_current(self) -> None:
        """Drop the line under the cursor, as if the cursor stood on a fresh one."""
        self._row = []
        self._column = 0

    def feed(self, text: str) -> None:
        """Take received text; a control sequence may be cut anywhere."""
        text = self._pending + text
        self._pending = ""
        place = 0
        while place < len(text):
            char = text[place]
            if char == "\x1b":
                match = _SEQUENCE.match(text, place)
                if match is None:
                    if len(text) - place < 16:
                        self._pending = text[place:]
                        return
                    place += 1
                    continue
                self._control(match[1] or "", match[2] or "")
                place = match.end()
                continue
            self._put(char)
            place += 1

    def _put(self, char: str) -> None:
        if char == "\n":
            self.lines.append(self.current)
            self._row = []
            self._column = 0
        elif char == "\r":
            self._column = 0
        elif char == "\b":
            self._column = max(0, self._column - 1)
        elif char >= " ":
            self._row.extend(" " * (self._column - len(self._row)))
            self._row[self._column : self._column + 1] = [char]
            self._column += 1

    def _control(self, argument: str, letter: str) -> None:
        count = int(argument) if argument.isdigit() else 1
        if letter == "C":
            self._column += count
        elif letter == "D":
            self._column = max(0, self._column - count)
        elif letter == "G":
            self._column = count - 1
        elif letter == "P":
            del self._row[self._column : self._column + count]
        elif letter == "@":
            self._row[self._column : self._column] = [" "] * count
        elif letter in "KJ":
            self._erase(argument or "0")

    def _erase(self, what: str) -> None:
        if what == "0":
            del self._row[self._column :]
        elif what == "1":
            self._row[: self._column] = [" "] * min(self._column, len(self._row))
        else:
            self._row = []
