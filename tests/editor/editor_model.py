"""What the editor should do, in Python: a text, a cursor, a window."""

from __future__ import annotations

from dataclasses import dataclass, field

TAB = 2


@dataclass
class EditorModel:
    """The text in the editor; each key is a method."""

    text: str
    window: int  # rows of text
    width: int  # columns used
    place: int = 0
    wanted: int = 0
    top: int = 0  # line
    anchor: int | None = None
    clipboard: str = ""
    overwrite: bool = False
    undo_stack: list[tuple[int, str, int]] = field(default_factory=list)
    step: int = 0
    last: str = "typed"

    # ---- Places --------------------------------------------------------------------------------

    def start_of(self, place: int) -> int:
        return self.text.rfind("\n", 0, place) + 1

    def end_of(self, place: int) -> int:
        end = self.text.find("\n", place)
        return len(self.text) if end < 0 else end

    def line_of(self, place: int) -> int:
        return self.text.count("\n", 0, place)

    def cells(self, start: int, end: int) -> str:
        shown = ""
        for c in self.text[start:end]:
            shown += " " * (TAB - len(shown) % TAB) if c == "\t" else c
        return shown

    def column_of(self, place: int) -> int:
        return len(self.cells(self.start_of(place), place))

    def place_of(self, start: int, column: int) -> int:
        place = start
        while place < self.end_of(start) and len(self.cells(start, place + 1)) <= column:
            place += 1
        return place

    def go(self, place: int) -> None:
        self.place = place
        self.wanted = self.column_of(place)

    def go_lines(self, lines: int) -> None:
        start = self.start_of(self.place)
        for _ in range(abs(lines)):
            if lines < 0 and start > 0:
                start = self.start_of(start - 1)
            elif lines > 0 and self.end_of(start) < len(self.text):
                start = self.end_of(start) + 1
        self.place = self.place_of(start, self.wanted)

    def marked(self) -> tuple[int, int]:
        if self.anchor is None:
            return self.place, self.place
        return min(self.anchor, self.place), max(self.anchor, self.place)

    # ---- Changes -------------------------------------------------------------------------------

    def remember(self, after_undo: int) -> None:
        if not self.undo_stack or self.undo_stack[-1][0] != self.step:
            self.undo_stack.append((self.step, self.text, after_undo))

    def insert(self, text: str) -> None:
        self.remember(self.place)
        self.top = min(self.top, self.line_of(self.place))
        self.text = self.text[: self.place] + text + self.text[self.place :]
        self.anchor = None
        self.go(self.place + len(text))

    def erase(self, start: int, count: int) -> None:
        if count == 0:
            return
        self.go(start)
        self.top = min(self.top, self.line_of(start))
        self.remember(start + count)
        self.text = self.text[:start] + self.text[start + count :]
        self.anchor = None

    def erase_marked(self) -> None:
        start, end = self.marked()
        self.erase(start, end - start)
        self.anchor = None

    def shift_lines(self, right: bool) -> None:
        marked = self.anchor is not None
        begin, end = self.marked()
        end = max(begin, end - 1) if end > begin else begin
        first, start = self.start_of(begin), self.start_of(end)
        lines = self.text.count("\n", first, end) + 1
        column, length = self.column_of(self.place), len(self.text)
        while True:
            if right:
                self.go(start)
                if start != self.end_of(start):
                    self.insert(" " * TAB)
            else:
                blanks = 0
                while blanks < TAB and self.text[start + blanks : start + blanks + 1] == " ":
                    blanks += 1
                if blanks == 0 and self.text[start : start + 1] == "\t":
                    blanks = 1
                self.erase(start, blanks)
            if start == first:
                break
            start = self.start_of(start - 1)
        self.go(first)
        if marked:
            self.anchor = first
            self.go_lines(lines)
        else:
            self.go(self.place_of(first, max(0, column - (length - len(self.text)))))

    # ---- Keys ----------------------------------------------------------------------------------

    def typed(self, c: str) -> None:
        if self.last != "typed":
            self.step += 1
        self.anchor = None
        if self.overwrite and self.place < self.end_of(self.place):
            self.erase(self.place, 1)
        self.insert(c)
        self.last = "typed"

    def press(self, name: str) -> None:
        """Press the key with this name."""
        plain = name.removeprefix("shift ")
        if plain != name and self.anchor is None:
            self.anchor = self.place
        if plain not in MOVES and plain not in KNOWS_MARK:
            self.anchor = None
        if plain not in ("backspace", "delete") or plain != self.last:
            self.step += 1
        getattr(self, "key_" + plain.replace(" ", "_"))()
        self.last = plain

    def key_left(self) -> None:
        if self.place > 0:
            self.go(self.place - 1)

    def key_right(self) -> None:
        if self.place < len(self.text):
            self.go(self.place + 1)

    def key_up(self) -> None:
        self.go_lines(-1)

    def key_down(self) -> None:
        self.go_lines(1)

    def key_page_up(self) -> None:
        self.go_lines(1 - self.window)

    def key_page_down(self) -> None:
        self.go_lines(self.window - 1)

    def key_home(self) -> None:
        start = self.start_of(self.place)
        self.go(0 if start == self.place and self.last == "home" else start)

    def key_end(self) -> None:
        end = self.end_of(self.place)
        self.go(len(self.text) if end == self.place and self.last == "end" else end)

    def key_text_start(self) -> None:
        self.go(0)

    def key_text_end(self) -> None:
        self.go(len(self.text))

    def is_word(self, place: int) -> bool:
        c = self.text[place]
        return c.isalnum() or c in "_.$" or ord(c) >= 128

    def key_word_left(self) -> None:
        place = self.place
        while place > 0 and not self.is_word(place - 1):
            place -= 1
        while place > 0 and self.is_word(place - 1):
            place -= 1
        self.go(place)

    def key_word_right(self) -> None:
        place = self.place
        while place < len(self.text) and self.is_word(place):
            place += 1
        while place < len(self.text) and not self.is_word(place):
            place += 1
        self.go(place)

    def key_enter(self) -> None:
        line = self.text[self.start_of(self.place) : self.place]
        self.insert("\n" + " " * (len(line) - len(line.lstrip(" "))))

    def key_backspace(self) -> None:
        if self.anchor is not None:
            self.erase_marked()
        elif self.place > 0:
            self.erase(self.place - 1, 1)

    def key_delete(self) -> None:
        if self.anchor is not None:
            self.erase_marked()
        elif self.place < len(self.text):
            self.erase(self.place, 1)

    def key_delete_line(self) -> None:
        start, end = self.start_of(self.place), self.end_of(self.place)
        self.erase(start, end - start + (end < len(self.text)))

    def key_tab(self) -> None:
        if self.anchor is not None:
            self.shift_lines(True)
        else:
            self.insert(" " * (TAB - self.column_of(self.place) % TAB))

    def key_back_tab(self) -> None:
        self.shift_lines(False)

    def key_insert(self) -> None:
        self.overwrite = not self.overwrite

    def key_mark(self) -> None:
        if self.anchor is None:
            self.anchor = self.place
        else:
            start, end = self.marked()
            self.clipboard = self.text[start:end]
            self.anchor = None

    def key_paste(self) -> None:
        if self.anchor is not None:
            start, end = self.marked()
            self.clipboard = self.text[start:end]
            self.erase_marked()
        elif self.clipboard:
            self.insert(self.clipboard)

    def key_undo(self) -> None:
        if self.undo_stack:
            step, text, place = self.undo_stack.pop()
            self.text = text
            self.step = step + 1
            self.anchor = None
            self.top = 0
            self.go(place)

    # ---- Screen --------------------------------------------------------------------------------

    def follow(self) -> None:
        """Move the window so that the cursor is in it."""
        line = self.line_of(self.place)
        if self.top <= line < self.top + self.window:
            return
        near = line + self.window > self.top and line < self.top + 2 * self.window
        above = self.window // 2
        if near:
            above = 0 if line < self.top else self.window - 1
        self.top = max(0, line - above)

    def shown(self) -> tuple[list[str], tuple[int, int]]:
        """Return the rows of the text and the cursor, as they should be on the screen."""
        self.follow()
        at = self.line_of(self.place)
        column, left = self.column_of(self.place), 0
        if column + 1 >= self.width:
            step = self.width // 2
            left = ((column + 2 - self.width) // step + 1) * step
        rows, start = [], 0
        for number, line in enumerate(self.text.split("\n")):
            cells = self.cells(start, start + len(line))
            start += len(line) + 1
            if self.top <= number < self.top + self.window:
                cut = left if number == at else 0
                row = cells[cut : cut + self.width]
                if cut and row:
                    row = "<" + row[1:]
                if len(cells) > cut + self.width:
                    row = row[:-1] + ">"
                rows.append(row.rstrip())
        rows += [""] * (self.window - len(rows))
        return rows, (at - self.top, column - left)


MOVES = {
    "left", "right", "up", "down", "page up", "page down", "home", "end", "text start", "text end",
    "word left", "word right",
}  # fmt: skip
KNOWS_MARK = {"backspace", "delete", "tab", "back tab", "insert", "mark", "paste"}
