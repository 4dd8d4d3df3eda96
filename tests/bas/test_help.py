"""HELP explains every word of the tables, and nothing it is asked for harms the prompt."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from test_prompt import answers

FIRMWARE = Path(__file__).parents[2] / "firmware/basic"
ROW = re.compile(r'^    \{"([^"]+)",(.*?)\},$', re.MULTILINE | re.DOTALL)


def rows(name: str) -> dict[str, bool]:
    """Each word of a table, and whether it is a part of another one, without a help of its own."""
    found = {
        word: rest.rstrip().endswith("NULL")
        for word, rest in ROW.findall((FIRMWARE / name).read_text(encoding="utf-8"))
    }
    assert len(found) > 60
    return found


@pytest.mark.parametrize("table", ["statements.c", "functions.c"])
def test_help_of_each_word(table: str) -> None:
    words = rows(table)
    answer = answers("".join(f'PRINT "<"\rHELP {word}\r' for word in words))
    told = "\n".join(answer).split("<\n")[1:]
    assert len(told) == len(words)
    for (word, part), text in zip(words.items(), told, strict=True):
        assert text.startswith(f"Error : No help for {word}") == part, (word, text)
