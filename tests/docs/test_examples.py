"""What the pages tell a reader to type does what they say: run on the host program, as printed.

Blocks with prompts ("> ") and `basic` blocks of a page are typed into one session in their order.
What stands between two prompts is the answer; without one any answer will do that is no error.
Blocks below the heading "Into the board" are programs: pasted behind AUTOSAVE and started twice.
"""

from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
STEPMITE = ROOT / "build/host/stepmite"
PC_TOOLS = ROOT / ".venv/bin/stepmite"
PAGES = [
    "README.md",
    "docs/user-guide.md",
    "docs/programs.md",
    "docs/pc-tools.md",
    "docs/testing.md",
    "docs/basic.md",
    "docs/gcode.md",
    "docs/tmc22xx.md",
]
TYPED: dict[str, list[str]] = {
    "README.md": [],
    "docs/user-guide.md": [],
    "docs/programs.md": [],
    "docs/tmc22xx.md": ["--machine", str(ROOT / "examples/sensorless.txt")],
}
"""Pages whose blocks are typed, and the options of the host program there."""
CTRL_Z = "\x1a"
PROGRAMS = (
    "Into the board",
    "Larger programs",
    "Events",
    "Drivers in a program",
)  # headings of blocks that are typed as one program
GUIDE = "docs/user-guide.md"
# A reader of the guide waits for the end of what the block before has begun.
PATIENCE = "FOR patience = 1 TO 600 : PAUSE 100 * (PEEK(STEPPER ACTIVE) = 1) : NEXT"
WAIT = "DO : PAUSE 5 : LOOP UNTIL PEEK(STEPPER ACTIVE) <= 0"


@dataclass
class Block:
    """A fenced block: its language, the heading above it and its lines."""

    language: str
    heading: str
    lines: list[str] = field(default_factory=list)


def blocks(page: str) -> list[Block]:
    """Return the fenced blocks of a page."""
    found: list[Block] = []
    heading, inside = "", False
    for line in (ROOT / page).read_text(encoding="utf-8").splitlines():
        if line.startswith("```"):
            inside = not inside
            if inside:
                found.append(Block(line[3:], heading))
        elif inside:
            found[-1].lines.append(line)
        elif line.startswith("#"):
            heading = line.lstrip("# ")
    return found


@dataclass
class Typed:
    """A line to type and the answer that is printed below it, if one is."""

    line: str
    answer: list[str] = field(default_factory=list)


def script(page: str, *, programs: bool = True) -> list[Typed]:
    """Return what a page says to type, in order; without its `basic` blocks if asked for."""
    typed: list[Typed] = []
    for block in blocks(page):
        if block.language == "basic" and not programs:
            continue
        if block.language == "basic" and page == GUIDE:
            typed.append(Typed(PATIENCE))
        if block.language == "basic" and block.heading in PROGRAMS:
            typed.append(Typed(WAIT))
            typed.append(Typed("AUTOSAVE\n" + "\n".join(block.lines) + "\n" + CTRL_Z))
            typed += [Typed("RUN"), Typed("RUN")]
        elif block.language == "basic":
            typed += [Typed(line) for line in block.lines]
        elif block.lines and block.lines[0].startswith("> "):
            for line in block.lines:
                if line.startswith("> "):
                    typed.append(Typed(line[2:]))
                else:
                    typed[-1].answer.append(line)
    return typed


def converse(lines: list[str], *options: str) -> list[list[str]]:
    """Type lines at the prompt of the host program; return the answer to each."""
    text = "".join(f'{line}\nPRINT "<{i}>"\n' for i, line in enumerate(lines))
    shown = subprocess.run(
        [STEPMITE, "--virtual", *options],
        input=text,
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    ).stdout.replace("\r", "")
    answers = []
    for i, line in enumerate(lines):
        before, mark, shown = shown.partition(f'> PRINT "<{i}>"\n<{i}>\n')
        assert mark, f"no prompt after {line!r}"
        echo = f"> {line}\n"
        answers.append(before[before.find(echo) + len(echo) :].splitlines())
    return answers


def failed(answer: list[str]) -> bool:
    """Say whether an answer is an error of BASIC."""
    return any("Error :" in line for line in answer)


@pytest.mark.parametrize("page", TYPED)
def test_what_a_page_says_to_type_works(page: str) -> None:
    """Each answer that is printed in the page is the real one, and nothing else is refused."""
    typed = script(page)
    assert len(typed) >= 5
    answers = converse([step.line for step in typed], *TYPED[page])
    for step, answer in zip(typed, answers, strict=True):
        if step.answer:
            assert answer == step.answer, step.line
        else:
            assert not failed(answer), (step.line, answer)


def test_what_the_text_about_drivers_says_works() -> None:
    """Each `TMC22xx ...` in the running text of that page, after all that is typed there.

    Programs are left out: RUN releases the drivers.
    """
    page = "docs/tmc22xx.md"
    text = re.sub(r"```.*?```", "", (ROOT / page).read_text(encoding="utf-8"), flags=re.DOTALL)
    lines = re.findall(r"`(TMC22xx \w+ [^`]*)`", text)
    assert len(lines) > 12
    typed = [step.line for step in script(page)]
    before = [line for line in typed if line != "RUN" and not line.startswith("AUTOSAVE")]
    answers = converse([*before, *lines], *TYPED[page])[len(before) :]
    for line, answer in zip(lines, answers, strict=True):
        assert not failed(answer), (line, answer)


def test_the_check_finds_a_planted_fault() -> None:
    """A refused line is seen as one, an answer is taken from the right place."""
    answers = converse(["PRINT 3 * 4", "STEPPER RUN", "PRINT 1"])
    assert answers[0] == [" 12"]
    assert answers[2] == [" 1"]
    assert [failed(answer) for answer in answers] == [False, True, False]


def test_the_first_move_ends_at_its_target() -> None:
    """The five lines at the top of README move X by 10 mm."""
    lines = next(block.lines for block in blocks("README.md") if block.language == "basic")
    assert converse([*lines, WAIT, "PRINT PEEK(STEPPER X)"])[-1] == [" 10"]


SWITCHES = """\
axis X step=GP2 dir=GP3
axis Y step=GP5 dir=GP6
axis Z step=GP8 dir=GP9
switch pin=GP16 axis=X to=-80
switch pin=GP17 axis=Y to=-80
switch pin=GP18 axis=Z to=-4000
"""
"""The axes of examples/machine.bas with a switch below each."""

TO_TRY_CODES_WITH = [
    "STEPPER SPINDLE GP14,0,12000,0,1000,0,GP15",
    "STEPPER COOLANT GP20,GP21",
    "STEPPER HWLIMITS GP16,GP17,GP18",
    "STEPPER PROBE GP19",
    "STEPPER RUN",
    "STEPPER GC F600",
]
WITH_WORDS = {
    "G38.2": "G38.3 Z-1",  # without a probe to touch the others are errors
    "G38.5": "G38.3 Z-2",
    "G73": "G73 Z-1 R1 Q1",
    "G81": "G81 Z-1 R1",
    "G82": "G82 Z-1 R1 P10",
    "G83": "G83 Z-1 R1 Q1",
}
"""What codes are tried with that mean nothing alone."""


def test_the_g_codes_of_the_guide_are_understood(tmp_path: Path) -> None:
    """Each code in the table of the user guide is accepted; those of a row in their order."""
    text = (ROOT / "docs/user-guide.md").read_text(encoding="utf-8")
    table = text.split("## G-code")[1].split("##")[0]
    rows = [
        re.findall(r"`(.*?)`", cell)
        for cell in re.findall(r"^\| (`[GMT]\d.*?) \|", table, re.MULTILINE)
    ]
    assert {"G0", "G1", "G4 P500", "G92 X0", "M3", "M5"} <= {code for row in rows for code in row}
    machine = (ROOT / "examples/machine.bas").read_text(encoding="utf-8").splitlines()
    setup = [line for line in machine if not re.match("STEPPER (SPINDLE|RUN)", line)]
    world = tmp_path / "machine.txt"
    world.write_text(SWITCHES)
    for row in rows:
        lines = [
            *setup,
            *TO_TRY_CODES_WITH,
            *(f"STEPPER GC {WITH_WORDS.get(code, code)}" for code in row),
        ]
        answers = converse([*lines, "STEPPER STOP"], "--machine", str(world))
        for line, answer in zip(lines, answers, strict=False):
            assert not failed(answer), (line, answer)


def test_machine_bas_can_be_sent_twice() -> None:
    """The example set-up works on a fresh board and on one that is set up; pc-tools.md shows it."""
    machine = (ROOT / "examples/machine.bas").read_text(encoding="utf-8").splitlines()
    for line, answer in zip(machine * 2, converse(machine * 2), strict=True):
        assert not failed(answer), (line, answer)
    shown = "".join(f"    {line}\n" for line in machine)
    assert shown in (ROOT / "docs/pc-tools.md").read_text(encoding="utf-8")


def test_the_example_of_homing_without_switches() -> None:
    """It homes, and shows the load until X stands at 60 mm."""
    world = TYPED["docs/tmc22xx.md"]
    source = ROOT / "examples/sensorless.bas"
    shown = subprocess.run(
        [STEPMITE, "--virtual", *world, source],
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    ).stdout.replace("\r", "")
    rows = re.findall(r"^X ([\d.]+) SG_RESULT (\d+) current scale 25$", shown, re.MULTILINE)
    assert len(rows) >= 5
    assert rows[-1][0] == "60"
    assert all(250 < int(load) < 450 for _, load in rows)


@cache
def known_commands() -> set[str]:
    """Return the names of all command rows, from the reference made of them."""
    text = (ROOT / "docs/reference.md").read_text(encoding="utf-8")
    return set(re.findall(r"^## (?:ON )?((?:STEPPER|TMC22XX) \w+)", text, re.MULTILINE))


@pytest.mark.parametrize("page", PAGES)
def test_commands_named_in_the_text_exist(page: str) -> None:
    """Each `STEPPER ...` and `TMC22xx ...` in running text is a command."""
    text = (ROOT / page).read_text(encoding="utf-8")
    named = re.findall(r"(?<!PEEK\()STEPPER [A-Z]{2,}", re.sub(r"`STEPPER\s+", "`STEPPER ", text))
    named += [f"TMC22XX {word}" for word in re.findall(r"TMC22xx ([A-Z]{3,})", text)]
    assert {name for name in named if not name.endswith("COMMANDS")} <= known_commands()


@cache
def help_of(command: str) -> str:
    """Return what a PC tool says about its options."""
    result = subprocess.run(
        [PC_TOOLS, command, "--help"],
        capture_output=True,
        text=True,
        check=True,
        env={"COLUMNS": "200", "TERM": "dumb"},
    )
    return result.stdout


@pytest.mark.parametrize("page", PAGES)
def test_targets_and_tools_named_in_the_text_exist(page: str) -> None:
    """`make X` is a target; `stepmite X --option` is a PC tool that has the option."""
    text = (ROOT / page).read_text(encoding="utf-8")
    code = re.findall(r"`([^`\n]+)`", text)
    code += [line for block in blocks(page) for line in block.lines]
    code += re.findall(r"^    (\S.*)$", text, re.MULTILINE)
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for line in code:
        if match := re.match(r"make (\w+)", line):
            assert re.search(rf"^{match[1]}:", makefile, re.MULTILINE), line
        if match := re.match(r"(?:\.venv/bin/)?stepmite (\w+)\b(?!\.)(.*)", line):
            options = help_of(match[1])
            for option in re.findall(r"(?<!\S)(--?[a-z][\w-]*)", match[2].split(" #")[0]):
                assert re.search(rf"(?<!\S){option}\b", options), line
