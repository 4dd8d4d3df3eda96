"""Boards for the tests: the bench's own test program and the real firmware, in the emulator."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from stepmite.emulator import PROJECT, Emulator

BUILD = PROJECT / "build" / "pico"


def built(variable: str, default: Path) -> Path:
    """The UF2 named by an environment variable, or where the build puts it."""
    path = Path(os.environ.get(variable, default))
    assert path.exists(), f"{path} is missing: make firmware (with tests) builds it"
    return path


@pytest.fixture(scope="session")
def check_uf2() -> Path:
    return built("STEPMITE_CHECK_UF2", BUILD / "tests/emulator/firmware/emulator-check.uf2")


@pytest.fixture(scope="session")
def uf2() -> Path:
    return built("STEPMITE_UF2", BUILD / "stepmite-pico.uf2")


@pytest.fixture
def check(check_uf2: Path) -> Iterator[Emulator]:
    """The test program at its prompt; faults fail the test (clear_faults() those provoked)."""
    with Emulator(check_uf2) as board:
        board.connect()
        board.until("> ")
        yield board
        assert board.faults() == []


@pytest.fixture
def board(uf2: Path) -> Iterator[Emulator]:
    """The firmware at its prompt; faults fail the test."""
    with Emulator(uf2) as emulator:
        emulator.connect()
        emulator.until("> ")
        yield emulator
        assert emulator.faults() == []
