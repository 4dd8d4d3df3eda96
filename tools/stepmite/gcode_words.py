"""The text of a G-code line: comments, words, and which modal group each code belongs to."""

from __future__ import annotations

import re

_WORD = re.compile(r"([A-Z])([+-]?(?:\d+\.?\d*|\.\d+))")
_COMMENT = re.compile(r"\([^()]*\)")

MOTIONS = ("G0", "G1", "G2", "G3", "G38.2", "G38.3", "G38.4", "G38.5")
CYCLES = ("G73", "G81", "G82", "G83")
WORK_SYSTEMS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
OFFSETS = ("G10", "G92", "G92.1", "G92.2", "G92.3")
ONCE = ("G4", "G28", "G28.1", "G28.2", "G30", "G30.1", "G53", *OFFSETS)
"""Codes that act in their own line only."""

GROUPS: dict[str, tuple[str, ...]] = {
    "motion modes": MOTIONS + CYCLES,
    "ends of cycles": ("G80",),
    "planes": ("G17", "G18", "G19"),
    "units": ("G20", "G21"),
    "cutter compensations": ("G40",),
    "tool lengths": ("G43", "G43.1", "G49"),
    "work coordinate systems": WORK_SYSTEMS,
    "path modes": ("G61", "G61.1", "G64"),
    "distance modes": ("G90", "G91"),
    "centre modes": ("G90.1", "G91.1"),
    "feed modes": ("G93", "G94"),
    "retract modes": ("G98", "G99"),
    "codes of one line": ONCE,
    "ends": ("M0", "M1", "M2", "M30"),
    "spindle switches": ("M3", "M4", "M5"),
    "tool changes": ("M6",),
    "override switches": ("M48",),
    "coolant switches": ("M7", "M8", "M9"),
}
"""The modal groups: of each a line may have one code. G80 may stand beside
another motion mode, as in the first lines of many programs."""

GROUP_OF = {code: group for group, codes in GROUPS.items() for code in codes}


class GcodeError(Exception):
    """A line that cannot be read; `line_number` counts from 1."""

    def __init__(self, line_number: int, line: str, message: str) -> None:
        super().__init__(f"line {line_number}: {message}: {line.strip()}")
        self.line_number = line_number
        self.line = line.strip()
        self.message = message


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


def sort_words(words: list[tuple[str, float]]) -> tuple[dict[str, str], dict[str, float]]:
    """Return the codes of a line by modal group and its other words by letter.

    ValueError if two of one kind meet or a code is not known. N words count for nothing.
    """
    codes: dict[str, str] = {}
    values: dict[str, float] = {}
    for letter, value in words:
        if letter in "GM":
            code = f"{letter}{value:g}"
            group = GROUP_OF.get(code)
            if group is None:
                raise ValueError(f"{code} is not supported")
            if group in codes:
                raise ValueError(f"two {group} in one line")
            codes[group] = code
        elif letter not in "XYZAFIJKRPQLSTHN":
            raise ValueError(f"word {letter} is not supported")
        elif letter in values:
            raise ValueError(f"{letter} occurs twice")
        else:
            values[letter] = value
    values.pop("N", None)
    return codes, values
