"""`stepmite image`: what the PC puts into a flash image the firmware finds, and back."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest
from typer.testing import CliRunner

from stepmite.cli import app

PROGRAM = os.environ.get("STEPMITE", str(Path(__file__).parents[2] / "build/host/stepmite"))


def call(*words: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["image", *map(str, words)])
    return result.exit_code, result.output


def board(image: Path, typed: str) -> str:
    done = subprocess.run(
        [PROGRAM, "--virtual", "--flash", image], input=typed.encode(), capture_output=True
    )
    assert done.returncode == 0
    return done.stdout.decode()


def test_files_go_in_and_out(tmp_path: Path) -> None:
    image = tmp_path / "flash.bin"
    part = tmp_path / "part.nc"
    part.write_bytes(b"G0 X1\r\n" * 2000)
    (tmp_path / "p.bas").write_text('PRINT "from the PC"\n')
    assert call("put", image, part, "A:/parts/part.nc") == (0, "")
    assert call("put", image, tmp_path / "p.bas") == (0, "")
    shown = board(image, 'RUN "p"\nCOPY "parts/part.nc" TO "copy"\nSAVE "q"\nFILES "parts"\n')
    assert "\r\nfrom the PC\r\n" in shown
    assert "part.nc" in shown
    listed = "        20  /p.bas\n     14000  /parts/part.nc\n        20  /q.bas\n"
    assert call("ls", image) == (0, "     14000  /copy\n" + listed)
    assert call("get", image, "copy", tmp_path / "out") == (0, "")
    assert (tmp_path / "out").read_bytes() == part.read_bytes()


def test_a_program_longer_than_its_place_is_refused(tmp_path: Path) -> None:
    image = tmp_path / "flash.bin"
    big = tmp_path / "big.bas"
    big.write_text(("REM " + "x" * 200 + "\n") * 660)
    assert call("put", image, big) == (0, "")
    shown = board(image, 'AUTOSAVE\nPRINT 11\n\x1aLOAD "big"\nRUN\n')
    assert "Error : Program too long (more than 130816 bytes)\r\n> RUN\r\n 11\r\n" in shown


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (("ls", "{}/none"), "no such file"),
        (("ls", "{}/short"), "a flash image has 1310720 bytes, this file has 5"),
        (("get", "{}/good", "none"), "none: not in"),
        (("ls", "{}/zeros"), "are damaged"),
    ],
)
def test_what_is_wrong_is_said(words: tuple[str, ...], error: str, tmp_path: Path) -> None:
    (tmp_path / "short").write_bytes(b"short")
    (tmp_path / "zeros").write_bytes(bytes(1280 * 1024))
    (tmp_path / "x").write_bytes(b"x")
    call("put", tmp_path / "good", tmp_path / "x")
    code, output = call(*(word.format(tmp_path) for word in words))
    assert code == 1
    assert error in output.replace("\n", "")
