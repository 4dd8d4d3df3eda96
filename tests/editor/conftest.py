"""The terminal of the editor's tests."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from screen_terminal import ScreenTerminal


@pytest.fixture
def terminal() -> Iterator[ScreenTerminal]:
    """A terminal of 24 rows and 80 columns at the prompt of a fresh board."""
    at = ScreenTerminal()
    yield at
    at.close()
