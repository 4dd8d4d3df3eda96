"""Reads G-code on the PC: what a file asks for, without a board.

The firmware has the last word on what is valid. This reader serves the dry run, the progress bar,
the plots and the tests. It knows the codes of StepMite, and takes probing moves as if they met
nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from stepmite.arcs import Position
from stepmite.gcode_line import Line
from stepmite.gcode_state import AXES, Block, Offsets, PathMode, Series
from stepmite.gcode_words import GcodeError, parse_words, sort_words, strip_comments


@dataclass
class Reader:
    """Modal state while reading a program line by line."""

    position: Position = (0.0, 0.0, 0.0, 0.0)
    """Machine position, mm and degrees."""
    offsets: Offsets = field(default_factory=Offsets)
    absolute: bool = True
    motion: str | None = None
    feed_per_min: float | None = None
    """In mm and degrees; of G93 the number as it stands."""
    plane: str = "G17"
    path_mode: PathMode = field(default_factory=PathMode)
    arcs_turn_a: bool = True
    """False: an A word in a line with an arc is ignored (STEPPER ARC LEGACY 1)."""
    nist: bool = False
    """STEPPER DIALECT NIST."""
    skips: bool = False
    """Lines that begin with / are left out (STEPPER BLOCKDELETE 1)."""
    optional_stop: bool = False
    """M1 pauses (STEPPER OPTIONALSTOP 1)."""
    unit_mm: float = 1.0
    inverse_time: bool = False
    centres_from_start: bool = True
    returns_to_initial: bool = True
    """G98."""
    series: Series | None = None
    stored: dict[str, Position] = field(
        default_factory=lambda: {"G28": (0.0,) * 4, "G30": (0.0,) * 4}
    )
    spindle: str = "M5"
    speed_rpm: float = 0.0
    coolant: frozenset[str] = frozenset()
    ended: bool = False
    """M2 or M30 has been read."""

    def work_position(self) -> Position:
        """Return the position as the program counts it, mm and degrees."""
        pairs = zip(self.position, self.offsets.total(), strict=True)
        x, y, z, a = (place - offset for place, offset in pairs)
        return x, y, z, a

    def read(self, line_number: int, line: str) -> list[Block]:
        """Return the blocks that one line makes; GcodeError if it cannot be read."""
        try:
            code = strip_comments(line)
            if code.startswith("/"):
                code = "" if self.skips else code[1:]
            codes, values = sort_words(parse_words(code))
            return Line(self, line_number, codes, values).run()
        except ValueError as error:
            raise GcodeError(line_number, line, str(error)) from None


def read_lines(path: Path) -> list[str]:
    """Return the lines of a G-code file; bytes that are not UTF-8 become marks."""
    return path.read_text(encoding="utf-8", errors="replace").splitlines()


def read_blocks(lines: Iterable[str], reader: Reader | None = None) -> Iterator[Block]:
    """Yield the blocks of a whole program; GcodeError at the first line that cannot be read.

    A program ends with M2 or M30, and with the second line of % if it begins with one.
    """
    reader = reader or Reader()
    begun = False
    for line_number, line in enumerate(lines, start=1):
        if line.lstrip().startswith("%") and begun:
            return
        begun = begun or bool(line.strip())
        yield from reader.read(line_number, line)
        if reader.ended:
            return


def target_steps(target: Position, steps_per_unit: Position) -> tuple[int, int, int, int]:
    """Round a position to steps as the firmware does: once, from the absolute value."""
    steps = []
    for value, scale in zip(target, steps_per_unit, strict=True):
        exact = value * scale
        steps.append(int(abs(exact) + 0.5) * (1 if exact >= 0 else -1))
    return steps[0], steps[1], steps[2], steps[3]


__all__ = [
    "AXES",
    "Block",
    "GcodeError",
    "PathMode",
    "Position",
    "Reader",
    "parse_words",
    "read_blocks",
    "read_lines",
    "strip_comments",
    "target_steps",
]
