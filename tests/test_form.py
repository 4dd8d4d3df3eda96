"""The sources have the common form: what `make format` would change is a fault."""

import subprocess
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def our_files(*patterns: str) -> list[str]:
    """Names of files in git, from the root."""
    command = ["git", "ls-files", *patterns]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return run.stdout.split()


def test_form():
    command = [ROOT / "tools" / "format", "--check"]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, "run `make format`\n" + run.stdout + run.stderr


def test_no_line_of_c_is_too_long():
    """clang-format leaves comments as they are."""
    listed = our_files("*.c", "*.h")
    assert len(listed) > 300
    long = [
        f"{name}:{number}"
        for name in listed
        for number, line in enumerate((ROOT / name).read_text(encoding="utf-8").splitlines(), 1)
        if len(line) > 100
    ]
    assert long == []


def test_no_two_test_files_have_one_name():
    """Pytest imports them by their names, so a whole run would not even begin."""
    names = Counter(Path(name).name for name in our_files("test_*.py", "*/test_*.py"))
    assert len(names) > 100
    assert [name for name, times in names.items() if times > 1] == []
