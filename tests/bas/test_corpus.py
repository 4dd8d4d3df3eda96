"""The corpus is complete: each statement, function, operator and error of the language is in it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from cases import FOLDER, read_cases

ROOT = FOLDER.parents[1]
ROW = re.compile(r'^    \{"([A-Z][A-Z0-9.$(]*)",', re.MULTILINE)
OPERATOR = re.compile(r"\{(?:'(.+?)'|LEXER_PAIR\('(.)', '(.)'\)|0), (?:NULL|\"(\w+)\"), \d, OP_")
# What needs a terminal, a board or damaged flash is shown by tests of its own.
ELSEWHERE = ("tests/**/*.py", "tests/unit/**/*.c", "tests/cut/*.c", "examples/*.bas")

NOT_SHOWN = {"The flash could not be written"}  # of a worn-out chip, which nothing here simulates


def sources(pattern: str) -> str:
    """All text of the files that match."""
    return "\n".join(path.read_text(encoding="utf-8") for path in sorted(ROOT.glob(pattern)))


def rows(name: str) -> list[str]:
    """Names of the rows of a table of the firmware."""
    return ROW.findall((ROOT / "firmware/basic" / name).read_text(encoding="utf-8"))


def corpus() -> str:
    """What the cases type, without what they expect."""
    lines = [line for case in read_cases() for line in case.lines]
    return "\n".join(re.sub(r"'[>!].*$", "", line) for line in lines).upper()


def has_word(text: str, word: str) -> bool:
    """True if the word stands in the text; MATH(SUM may have blanks behind its parenthesis."""
    pattern = re.escape(word).replace(r"\(", r"\(\s*")
    end = "" if word.endswith("$") else r"(?![\w.$%])"
    return re.search(rf"(?<![\w.]){pattern}{end}", text) is not None


@pytest.mark.parametrize("table", ["statements.c", "functions.c"])
def test_each_word_of_the_language_is_used(table: str) -> None:
    names = rows(table)
    assert len(names) > 60
    text = corpus() + "".join(sources(pattern) for pattern in ELSEWHERE).upper()
    assert [name for name in names if not has_word(text, name)] == []


def test_each_operator_is_used() -> None:
    table = (ROOT / "firmware/basic/expressions.c").read_text(encoding="utf-8")
    operators = ["".join(part) for part in OPERATOR.findall(table)]
    assert len(operators) == 20
    text = corpus()
    missing = [op for op in operators if op.replace("\\\\", "\\") not in text]
    assert missing == []


def test_each_error_of_the_language_is_met() -> None:
    table = (ROOT / "firmware/base/err.def").read_text(encoding="utf-8")
    language = table[table.index("// Language") : table.index("// Pins")]
    texts = re.findall(r'^ERR\(\w+,\s*"(.+)"\)', language, re.MULTILINE)
    assert len(texts) > 60
    expected = "\n".join(line for case in read_cases() for line in case.lines)
    expected += "".join(sources(pattern) for pattern in ELSEWHERE)
    missing = []
    for text in texts:
        pattern = re.escape(text.replace("\\\\", "\\")).replace("%", ".+")
        if text not in NOT_SHOWN and re.search(pattern, expected) is None:
            missing.append(text)
    assert missing == []


def test_the_check_finds_what_is_missing() -> None:
    assert not has_word("PRINT MIDDLE", "MID")
    assert not has_word("FORMAT$(1)", "FOR")
    assert has_word("X = MATH( SUM A())", "MATH(SUM")
    assert has_word("A$=CHR$(65)", "CHR$")
    assert Path(ROOT / "firmware/basic/statements.c").exists()
