"""Runs the cases of tests/bas/*.bas (see cases.py) through the host program."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest
from cases import FOLDER, MARK, Case, read_cases

PROGRAM = os.environ.get("STEPMITE", str(FOLDER.parents[1] / "build/host/stepmite"))
TIMEOUT_S = 20


def test_there_are_many_cases_with_names_of_their_own():
    names = [case.name for case in read_cases()]
    assert len(names) >= 650
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
    output = done.stdout.decode("latin-1")
    assert MARK in output, done.stderr.decode()
    expected = case.expected()
    assert case.answer(output) == expected
    assert done.returncode == (1 if expected and expected[-1].startswith("Error : ") else 0)
