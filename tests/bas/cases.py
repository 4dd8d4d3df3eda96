"""The cases of tests/bas/*.bas.

A file holds many cases, each opened by a line `'--- title`. Expectations stand on the lines:
`'>text` is the next line of output, exactly (a positive number prints with a leading blank);
`'! text` says that this line ends the program with this error.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

FOLDER = Path(__file__).parent
MARK = "@@@"  # printed by the case's first line; what comes before it is none of the case's


@dataclass
class Case:
    """One program and what it is to print."""

    name: str
    lines: list[str] = field(default_factory=list)

    @property
    def source(self) -> str:
        """The program, its first line the mark."""
        return "\n".join([f'PRINT "{MARK}"', *self.lines]) + "\n"

    def expected(self) -> list[str]:
        """The lines it is to print."""
        output = []
        error = []
        for number, line in enumerate(self.lines, start=2):
            for text in re.findall(r"'>(.*)$", line):
                output.append(text.rstrip())
            for text in re.findall(r"'! (.*)$", line):
                error = [f"[{number}] {line}".rstrip(), f"Error : {text}".rstrip()]
        return output + error

    def answer(self, output: str) -> list[str]:
        """The lines printed behind the mark."""
        text = output.replace("\r\n", "\n").split(MARK + "\n", 1)[1]
        return [line.rstrip() for line in text.splitlines()]


def read_cases() -> list[Case]:
    """All cases, in order."""
    cases = []
    for path in sorted(FOLDER.glob("*.bas")):
        for line in path.read_text().splitlines():
            if line.startswith("'---"):
                cases.append(Case(f"{path.stem}: {line[4:].strip()}"))
            else:
                cases[-1].lines.append(line)
    return cases
