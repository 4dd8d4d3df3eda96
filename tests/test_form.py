"""The sources have the common form: what `make format` would change is a fault."""

import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def test_form():
    command = [ROOT / "tools" / "format", "--check"]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, "run `make format`\n" + run.stdout + run.stderr
