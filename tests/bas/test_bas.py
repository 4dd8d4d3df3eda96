"""Runs the cases of tests/bas/*.bas through the host program.

A file holds many cases, each opened by a line `'--- title`. Expectations stand on the lines:
`'>text` is the next line of output, exactly (a positive number prints with a leading blank);
`'! text` says that this line ends the program with this error.
"""

from __future__ import annotations

import os
import re
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent
PROGRAM = os.environ.get("STEPMITE", str(FOLDER.parents[1] / "build/host/stepmite"))
MARK = "@@@"  # printed by the case's first line; what comes before it is the banner
TIMEOUT_S = 20


@dataclass
class Case:
    """One program and what it is to print."""

    name: str
    lines: list[str] = field(default_factory=list)

    @property
    def source(self) -> str:
        return "\n".join([f'PRINT "{MARK}"', *self.lines]) + "\n"

    def expected(self) -> list[str]:
        output = []
        error = []
        for number, line in enumerate(self.lines, start=2):
            for text in re.findall(r"'>(.*)$", line):
                output.append(text.rstrip())
            for text in re.findall(r"'! (.*)$", line):
                error = [f"[{number}] {line}".rstrip(), f"Error : {text}".rstrip()]
        return output + error


def read_cases() -> list[Case]:
    cases = []
    for path in sorted(FOLDER.glob("*.bas")):
        for line in path.read_text().splitlines():
            if line.startswith("'---"):
                cases.append(Case(f"{path.stem}: {line[4:].strip()}"))
            else:
                cases[-1].lines.append(line)
    return cases


def test_there_are_many_cases_with_names_of_their_own():
    names = [case.name for case in read_cases()]
    assert len(names) >= 150
    assert len(names) == len(set(names))


@pytest.mark.parametrize("case", read_cases(), ids=lambda case: case.name)
def test_case(case: Case, tmp_path: Path):
    source = tmp_path / "case.bas"
    source.write_text(case.source)
    done = subprocess.run(
        [PROGRAM, "--virtual", str(source)],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        timeout=TIMEOUT_S,
        check=False,
    )
    output = done.stdout.decode("latin-1").replace("\r\n", "\n")
    assert MARK in output, done.stderr.decode()
    printed = [line.rstrip() for line in output.split(MARK + "\n", 1)[1].splitlines()]
    expected = case.expected()
    assert printed == expected
    assert done.returncode == (1 if expected and expected[-1].startswith("Error : ") else 0)
