"""Every program of docs/basic.md prints what the page says it prints, on the host program.

A `basic` block is a whole program; a `text` block behind it is all it prints. Blocks with prompts
are one session in their order; what stands between two prompts is the answer, without one any
answer will do that is no error.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from test_examples import ROOT, STEPMITE, Block, blocks, converse, failed, script

PAGE = "docs/basic.md"


def programs() -> list[tuple[Block, Block | None]]:
    """Return each program with the block of its output, if one follows."""
    page = blocks(PAGE)
    pairs = []
    for block, behind in zip(page, [*page[1:], None], strict=True):
        if block.language == "basic":
            shown = behind if behind is not None and behind.language == "text" else None
            pairs.append((block, shown))
    return pairs


def output(program: str, folder: Path) -> list[str]:
    """Run a program on a board with empty flash; return the lines it prints."""
    source = folder / "program.bas"
    source.write_text(program, encoding="utf-8")
    done = subprocess.run(
        [STEPMITE, "--virtual", source],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    # The banner ends with a blank line.
    _, _, printed = done.stdout.replace("\r", "").partition("\n\n")
    return [line.rstrip() for line in printed.expandtabs(8).splitlines()]


@pytest.mark.parametrize("pair", programs(), ids=lambda pair: pair[0].heading)
def test_a_program_prints_what_the_page_shows(
    pair: tuple[Block, Block | None], tmp_path: Path
) -> None:
    program, shown = pair
    printed = output("\n".join(program.lines) + "\n", tmp_path)
    if shown is not None:
        assert printed == shown.lines
    else:
        assert printed
        assert not any("Error :" in line for line in printed)


def test_the_sessions_answer_as_shown() -> None:
    typed = script(PAGE, programs=False)
    assert len(typed) >= 8
    for step, answer in zip(typed, converse([step.line for step in typed]), strict=True):
        if step.answer:
            assert [line.expandtabs(8).rstrip() for line in answer] == step.answer, step.line
        else:
            assert not failed(answer), (step.line, answer)


def test_a_planted_difference_is_seen(tmp_path: Path) -> None:
    assert output("PRINT 1\nPRINT 1/0\n", tmp_path)[-1] == "Error : Divide by zero"
    assert output("PRINT 2\n", tmp_path) == [" 2"]


def test_every_section_has_an_example() -> None:
    headings = [
        line[3:]
        for line in (ROOT / PAGE).read_text(encoding="utf-8").splitlines()
        if line.startswith("## ") and not line.startswith("## What is different")
    ]
    assert headings == list(dict.fromkeys(block.heading for block in blocks(PAGE)))
