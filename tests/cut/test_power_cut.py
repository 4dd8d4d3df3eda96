"""Power cuts at every flash write: there is the old or the new, never a mixture, nothing lost."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from power_cut import Cutter

ROOT = Path(__file__).parents[2]
PROGRAM = Path(os.environ.get("STEPMITE", ROOT / "build/host/stepmite"))
WRITES_LEAST = 100  # or the session is not what it is meant to be


def test_the_session_without_a_cut(tmp_path: Path) -> None:
    assert Cutter(PROGRAM, tmp_path).check_whole() is None


@pytest.mark.parametrize("how", ["torn", "after"])
def test_power_cut_at_every_write(how: str, tmp_path: Path) -> None:
    writes, fault = Cutter(PROGRAM, tmp_path).find_fault(how)
    assert fault is None
    assert writes > WRITES_LEAST


@pytest.mark.parametrize("planted", ["over_the_old", "removed_first", "left_halfway"])
def test_planted_faults_are_found(planted: str, tmp_path: Path) -> None:
    program = ROOT / f"build/host/tests/cut/stepmite_{planted}"
    cutter = Cutter(program, tmp_path)
    assert cutter.check_whole() is None
    assert cutter.find_fault("torn")[1] is not None
