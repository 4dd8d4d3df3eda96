"""The sources have the common form: what `make format` would change is a fault."""

import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def test_form():
    command = [ROOT / "tools" / "format", "--check"]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, "run `make format`\n" + run.stdout + run.stderr


def test_no_line_of_c_is_too_long():
    """clang-format leaves comments as they are."""
    listed = subprocess.run(
        ["git", "ls-files", "*.c", "*.h"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.split()
    assert len(listed) > 300
    long = [
        f"{name}:{number}"
        for name in listed
        for number, line in enumerate((ROOT / name).read_text(encoding="utf-8").splitlines(), 1)
        if len(line) > 100
    ]
    assert long == []
