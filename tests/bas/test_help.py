"""HELP explains every word of the tables, and nothing it is asked for harms the prompt."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from test_prompt import answers

FIRMWARE = Path(__file__).parents[2] / "firmware/basic"
ROW = re.compile(r'^    \{"([^"]+)",(.*?)\},$', re.MULTILINE | re.DOTALL)


def rows(name: str) -> list[str]:
    """Each word of a table; functions without help are parts of a family such as MATH."""
    found = [
        word
        for word, rest in ROW.findall((FIRMWARE / name).read_text(encoding="utf-8"))
        if name == "statements.c" or not rest.rstrip().endswith("NULL")
    ]
    assert len(found) > 60
    return found


@pytest.mark.parametrize("table", ["statements.c", "functions.c"])
def test_help_of_each_word(table: str) -> None:
    words = rows(table)
    answer = answers("".join(f'PRINT "<"\rHELP {word}\r' for word in words))
    told = "\n".join(answer).split("<\n")[1:]
    assert len(told) == len(words)
    for word, text in zip(words, told, strict=True):
        assert "No help for" not in text, word
        assert word in text, (word, text)


def test_each_word_is_listed_once() -> None:
    """Whichever tables its rows are in."""
    heads = ("Commands of the machine:", "Statements:", "Functions:")
    for part in re.split("|".join(heads), "\n".join(answers("HELP\r")))[1:]:
        words = re.findall(r"[A-Z][A-Z0-9.$ ]+(?=,|\n|$)", part.split("HELP name")[0])
        assert len(words) > 3
        assert sorted(words) == sorted(set(words))
