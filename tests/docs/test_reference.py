"""The command reference is what the firmware's tables say."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/host/tools/reference/stepmite_reference"
REGISTERS_PROGRAM = ROOT / "build/host/tools/reference/stepmite_register_page"


def test_reference_page_is_current() -> None:
    """docs/reference.md was made from the rows as they are; if not: `make reference`."""
    made = subprocess.run([PROGRAM], capture_output=True, text=True, check=True).stdout
    assert (ROOT / "docs/reference.md").read_text() == made


def test_registers_page_is_current() -> None:
    """docs/tmc22xx-registers.md was made from the table as it is; if not: `make reference`."""
    made = subprocess.run([REGISTERS_PROGRAM], capture_output=True, text=True, check=True).stdout
    assert (ROOT / "docs/tmc22xx-registers.md").read_text() == made


@pytest.mark.parametrize("page", ["reference.md", "tmc22xx-registers.md"])
def test_every_row_is_complete(page: str) -> None:
    """No row of the page has an empty place, and all have as many as the head."""
    head = ""
    for line in (ROOT / "docs" / page).read_text().replace("\\|", "/").splitlines():
        if line.startswith("|"):
            head = head or line
            assert all(cell.strip() for cell in line.strip("|").split("|")), line
            assert line.count("|") == head.count("|"), line
        else:
            head = ""


def test_the_table_of_what_is_refused_names_every_command() -> None:
    """A new command comes with its rule."""
    page = (ROOT / "docs/reference.md").read_text()
    names = re.findall(r"^## STEPPER (.*)$", page, re.MULTILINE)
    table = page.partition("## What is refused when")[2].partition("Of several reasons")[0]
    rows = " ; ".join(line.split("|")[1] for line in table.splitlines() if line.startswith("| "))
    named = {word.strip() for word in re.split(r"[,:;]", rows)}
    named |= {word.split(" ")[0] for word in named if " axis" in word or " that" in word}
    assert len(names) > 40
    assert [name for name in names if name not in named] == ["STATUS"]


def test_there_is_room_for_all_rows() -> None:
    """Rows beyond ROWS_MAX (functions: FUNCTIONS_MAX) would not be found by the language."""
    headings = [
        line for line in (ROOT / "docs/reference.md").read_text().splitlines() if line[:3] == "## "
    ]
    commands = [line for line in headings if "(" not in line]
    assert 80 < len(commands) < 255
    assert 10 < len(headings) - len(commands) < 64
