"""docs/gcode.md names every code that the interpreter knows, and no other."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def known() -> set[str]:
    """The codes of the interpreter's table."""
    text = (ROOT / "gcode/gcode_codes.c").read_text(encoding="utf-8")
    found = set()
    for letter, table in re.findall(r"code_t (\w)_codes\[\] = \{(.*?)\n\};", text, re.DOTALL):
        for tenths in re.findall(r"^    \{(\d+), ", table, re.MULTILINE):
            found.add(f"{letter.upper()}{int(tenths) / 10:g}")
    return found


def test_the_page_names_all_codes() -> None:
    """In the table of groups."""
    page = (ROOT / "docs/gcode.md").read_text(encoding="utf-8")
    table = page.split("## Codes")[1].split("\n## ")[0]
    named = set(re.findall(r"`([GM]\d+(?:\.\d)?)`", table))
    assert len(known()) > 60
    assert named == known()
