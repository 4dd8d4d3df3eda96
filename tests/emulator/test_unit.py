"""The bench's own unit tests, which are JavaScript: one pytest case for each file."""

import re
import subprocess
from pathlib import Path

import pytest

FILES = sorted((Path(__file__).parent / "unit").glob("*.test.mjs"))


@pytest.mark.parametrize("file", FILES, ids=[file.stem for file in FILES])
def test_node(file: Path) -> None:
    result = subprocess.run(["node", "--test", file], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout[-5000:]
    passed = re.search(r"^. pass (\d+)$", result.stdout, re.MULTILINE)
    assert passed
    assert int(passed[1]) > 0
