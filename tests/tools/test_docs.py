"""The guide names commands and options that exist."""

import re
from pathlib import Path

from typer.main import get_command

from stepmite.cli import app

GUIDE = (Path(__file__).parents[2] / "docs" / "pc-tools.md").read_text(encoding="utf-8")


def test_every_command_is_in_the_guide_and_exists():
    named = set(re.findall(r"`stepmite (\w+)", GUIDE))
    assert named == set(get_command(app).commands)


def test_every_option_in_the_guide_exists():
    known = {"--trace"}  # of the host program
    for command in get_command(app).commands.values():
        for parameter in command.params:
            known |= set(parameter.opts) | set(parameter.secondary_opts)
    assert set(re.findall(r"(--[a-z][a-z-]*)", GUIDE)) <= known
