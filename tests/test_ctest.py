"""Runs every test of the C builds (unit tests, audits: what ctest knows), each as one test here."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PRESETS = ["host", "asan", "pico", "pico2"]


def registered(preset: str) -> list[str]:
    """Return the names ctest knows in this build; none if it is not there."""
    command = ["ctest", "--preset", preset, "--show-only=json-v1"]
    listing = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if listing.returncode != 0:
        return []
    return [test["name"] for test in json.loads(listing.stdout)["tests"]]


TESTS = [(preset, name) for preset in PRESETS for name in registered(preset)]


@pytest.mark.parametrize("preset", PRESETS)
def test_build_has_tests(preset: str) -> None:
    """A build without tests means that something went wrong before."""
    assert any(preset == of for of, _ in TESTS), f"run `make test`: build/{preset} has no tests"


@pytest.mark.parametrize(("preset", "name"), TESTS, ids=[f"{p}-{n}" for p, n in TESTS])
def test_ctest(preset: str, name: str) -> None:
    """One ctest entry passes."""
    command = ["ctest", "--preset", preset, "-R", f"^{re.escape(name)}$", "--no-tests=error"]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
