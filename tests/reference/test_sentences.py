"""sentences.toml is whole: each statement has tests, each test stands for a statement."""

from __future__ import annotations

import ast
import re
import tomllib
from pathlib import Path

HERE = Path(__file__).parent
SECTIONS = ["2.1", "2.2", "2.3", "2.4", "3.1", "3.2", "4", "5", "6", "7", "8"]


def statements() -> list[dict]:
    return tomllib.loads((HERE / "sentences.toml").read_text(encoding="utf-8"))["statement"]


def file_of(section: str) -> str:
    return f"test_section_{section.replace('.', '_')}.py"


def functions_of(path: Path) -> set[str]:
    """The names of the test functions of a file."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return {
        node.name
        for node in tree.body
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")
    }


def named(statement: dict) -> list[tuple[str, str]]:
    """File and function of each test of a statement."""
    found = []
    for test in statement["tests"]:
        file, _, name = test.rpartition("::")
        found.append((file or file_of(statement["section"]), name))
    return found


def test_every_statement_is_proven() -> None:
    """By tests that there are."""
    for statement in statements():
        assert statement["tests"], statement["id"]
        for file, name in named(statement):
            assert name in functions_of(HERE / file), (statement["id"], file, name)


def test_every_test_stands_for_a_statement() -> None:
    """So the list does not fall behind."""
    listed = {pair for statement in statements() for pair in named(statement)}
    for path in HERE.glob("test_section_*.py"):
        for name in functions_of(path):
            assert (path.name, name) in listed, (path.name, name)


def test_statements_are_whole_and_in_order() -> None:
    """All sections, ids of their own, and a sentence each."""
    found = statements()
    assert list(dict.fromkeys(statement["section"] for statement in found)) == SECTIONS
    names = [(statement["section"], statement["id"]) for statement in found]
    assert len(set(names)) == len(names)
    for statement in found:
        assert set(statement) <= {"section", "id", "says", "choice", "tests"}, statement["id"]
        assert re.fullmatch(r"[A-Z].*\.", statement["says"]), statement["id"]
        assert {file_of(section) for section in SECTIONS} <= {p.name for p in HERE.glob("*.py")}


def test_every_fault_has_its_test() -> None:
    """The 27 faults of the original, by number."""
    names = functions_of(HERE / "test_original_faults.py")
    names |= functions_of(HERE / "test_original_gaps.py")
    numbers = {int(found[1]) for name in names if (found := re.match(r"test_2_(\d\d)_", name))}
    assert numbers == set(range(1, 28))
