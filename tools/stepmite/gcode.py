"""Reads G-code on the PC: what a file asks for, without a board.

The firmware has the last word on what is valid. This reader serves the dry run, the progress bar,
the plots and the tests, and knows the words of StepMite: G0 G1 G2 G3 G4 G17 G18 G19 G61 G61.1 G64
G90 G91 G92 M3 M5 X Y Z A F I J K R P.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from stepmite.arcs import PLANES, Arc, Position, read_arc

AXES = "XYZA"
"""Axis letters in the order of every position tuple; X Y Z in mm, A in degrees."""

_WORD = re.compile(r"([A-Z])([+-]?(?:\d+\.?\d*|\.\d+))")
_COMMENT = re.compile(r"\([^()]*\)")


class GcodeError(Exception):
    """A line that cannot be read; `line_number` counts from 1."""

    def __init__(self, line_number: int, line: str, message: str) -> None:
        super().__init__(f"line {line_number}: {message}: {line.strip()}")
        self.line_number = line_number
        self.line = line.strip()
        self.message = message


@dataclass(frozen=True)
class PathMode:
    """How corners are passed."""

    kind: str = "G64"
    """"G61" exact path, "G61.1" exact stop at each end, "G64" continuous."""
    tolerance_mm: float = 0.0
    """G64 P: how far a blend may leave the corner; 0: the path is exact, by junction deviation."""


@dataclass(frozen=True)
class Block:
    """One entry of the block ring: a move, a dwell or a spindle switch."""

    kind: str
    """"move", "dwell" or "spindle"."""
    line_number: int
    target: Position
    """Machine position at the end of the block, mm and degrees."""
    feed_per_min: float | None = None
    """mm/min (deg/min where only A moves); None: as fast as the axes can (G0)."""
    dwell_s: float = 0.0
    spindle_on: bool = False
    arc: Arc | None = None
    """The arc of G2 and G3; None: a straight line."""
    path_mode: PathMode = PathMode()
    """In force at the corner before the block."""


def strip_comments(line: str) -> str:
    """Return the words of a line without comments, blanks and the tape mark %; "" if none are left.

    A parenthesis that does not close is left alone, so that the firmware can refuse it.
    """
    code = _COMMENT.sub("", line)
    cut = code.find(";")
    if cut >= 0 and "(" not in code[:cut]:
        code = code[:cut]
    code = "".join(code.split())
    return "" if code.startswith("%") else code


def parse_words(code: str) -> list[tuple[str, float]]:
    """Split `code` (free of comments) into letters and values; ValueError tells what is no word."""
    words = []
    place = 0
    text = code.upper()
    while place < len(text):
        match = _WORD.match(text, place)
        if match is None:
            raise ValueError(f"not a word at '{text[place : place + 12]}'")
        words.append((match[1], float(match[2])))
        place = match.end()
    return words


@dataclass
class Reader:
    """Modal state while reading a program line by line."""

    position: Position = (0.0, 0.0, 0.0, 0.0)
    """Machine position, mm and degrees."""
    offset: list[float] = field(default_factory=lambda: [0.0] * 4)
    """Machine position minus work position, set by G92."""
    absolute: bool = True
    motion: str | None = None
    feed_per_min: float | None = None
    plane: str = "G17"
    path_mode: PathMode = field(default_factory=PathMode)
    arcs_turn_a: bool = True
    """False: an A word in a line with an arc is ignored (STEPPER ARC LEGACY 1)."""

    def work_position(self) -> Position:
        """Return the position as the program counts it, mm and degrees."""
        x, y, z, a = (p - o for p, o in zip(self.position, self.offset, strict=True))
        return x, y, z, a

    def read(self, line_number: int, line: str) -> list[Block]:
        """Return the blocks that one line makes; GcodeError if it cannot be read."""
        try:
            return self._execute(line_number, parse_words(strip_comments(line)))
        except ValueError as error:
            raise GcodeError(line_number, line, str(error)) from None

    def _execute(self, line_number: int, words: list[tuple[str, float]]) -> list[Block]:
        values: dict[str, float] = {}
        codes: list[str] = []
        for letter, value in words:
            if letter in "GM":
                codes.append(f"{letter}{value:g}")
            elif letter not in "XYZAFIJKRP":
                raise ValueError(f"word {letter} is not supported")
            elif letter in values:
                raise ValueError(f"{letter} occurs twice")
            else:
                values[letter] = value
        return self._run(line_number, codes, values)

    def _run(self, line_number: int, codes: list[str], values: dict[str, float]) -> list[Block]:
        blocks: list[Block] = []
        if "F" in values:
            if values["F"] <= 0:
                raise ValueError("F must be above 0")
            self.feed_per_min = values["F"]
        once = None
        for code in codes:
            if code in ("G4", "G92"):
                once = code
            elif code in ("M3", "M5"):
                on = code == "M3"
                blocks.append(Block("spindle", line_number, self.position, spindle_on=on))
            else:
                self._set_mode(code, values)
        axes = {letter: values[letter] for letter in AXES if letter in values}
        if once == "G4":
            if "P" not in values:
                raise ValueError("G4 without P")
            blocks.append(Block("dwell", line_number, self.position, dwell_s=values["P"] / 1000))
        elif once == "G92":
            if not axes:
                raise ValueError("G92 without an axis")
            self._shift(axes)
        elif axes or (self.motion in ("G2", "G3") and any(word in values for word in "IJKR")):
            if blocks:
                raise ValueError("a move and M3 or M5 need a line each")
            blocks.append(self._move(line_number, axes, values))
        elif any(word in values for word in "IJKR"):
            raise ValueError("I J K R without an arc")
        return blocks

    def _set_mode(self, code: str, values: dict[str, float]) -> None:
        if code in ("G0", "G1", "G2", "G3"):
            self.motion = code
        elif code in ("G90", "G91"):
            self.absolute = code == "G90"
        elif code in PLANES:
            self.plane = code
        elif code in ("G61", "G61.1"):
            self.path_mode = PathMode(code)
        elif code == "G64":
            if values.get("P", 0.0) < 0:
                raise ValueError("P must not be below 0")
            self.path_mode = PathMode(code, values.get("P", 0.0))
        else:
            raise ValueError(f"{code} is not supported")

    def _shift(self, axes: dict[str, float]) -> None:
        for index, letter in enumerate(AXES):
            if letter in axes:
                self.offset[index] = self.position[index] - axes[letter]

    def _move(self, line_number: int, axes: dict[str, float], values: dict[str, float]) -> Block:
        if self.motion is None:
            raise ValueError("a position without a motion mode, G0 to G3")
        if self.motion != "G0" and self.feed_per_min is None:
            raise ValueError(f"{self.motion} before any F")
        curved = self.motion in ("G2", "G3")
        if curved and not self.arcs_turn_a:
            axes = {letter: value for letter, value in axes.items() if letter != "A"}
        elif not curved and any(word in values for word in "IJKR"):
            raise ValueError("I J K R without an arc")
        start, target = self.position, list(self.position)
        for index, letter in enumerate(AXES):
            if letter in axes:
                base = self.offset[index] if self.absolute else self.position[index]
                target[index] = base + axes[letter]
        end = target[0], target[1], target[2], target[3]
        arc = None
        if curved:
            arc = read_arc(self.motion == "G2", PLANES[self.plane], start, end, values)
        self.position = end
        feed = None if self.motion == "G0" else self.feed_per_min
        return Block("move", line_number, end, feed, arc=arc, path_mode=self.path_mode)


def read_lines(path: Path) -> list[str]:
    """Return the lines of a G-code file; bytes that are not UTF-8 become marks."""
    return path.read_text(encoding="utf-8", errors="replace").splitlines()


def read_blocks(lines: Iterable[str], reader: Reader | None = None) -> Iterator[Block]:
    """Yield the blocks of a whole program; GcodeError at the first line that cannot be read."""
    reader = reader or Reader()
    for line_number, line in enumerate(lines, start=1):
        yield from reader.read(line_number, line)


def target_steps(target: Position, steps_per_unit: Position) -> tuple[int, int, int, int]:
    """Round a position to steps as the firmware does: once, from the absolute value."""
    steps = []
    for value, scale in zip(target, steps_per_unit, strict=True):
        exact = value * scale
        steps.append(int(abs(exact) + 0.5) * (1 if exact >= 0 else -1))
    return steps[0], steps[1], steps[2], steps[3]
