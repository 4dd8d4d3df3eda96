"""G-code files of CAM programs from A: on the emulated board, judged as on the host."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from stepmite.emulator import PROJECT, Emulator
from stepmite.image import Image
from stepmite.trace import Edges

sys.path.insert(0, str(PROJECT / "tests" / "gcode"))
from cam_files import FILES, blocks_of, checked, program
from cam_oracle import judge_bounds, judge_motion, judge_outputs, traces_of


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_file_runs_on_the_board(uf2: Path, tmp_path: Path, file: Path) -> None:
    image = Image(tmp_path / "flash.bin")
    image.write("part.nc", file.read_bytes())
    image.save()
    with Emulator(uf2, storage=image.path) as board:
        board.connect()
        board.until("> ")
        board.send("AUTOSAVE\r" + program(file).replace("\n", "\r") + "\x1a")
        board.until("\n> ", 5000)
        output = board.command("RUN", timeout_ms=60_000).replace("\r", "")
        edges = Edges.from_rows(board.edges())
        assert board.faults() == []
    assert "Error" not in output, output
    assert "G-code file done" in output, output
    assert "underruns: 0" in output
    blocks, _ = blocks_of(file)
    traces = traces_of(edges)
    judge_bounds(traces, checked(output).machine)
    judge_motion(blocks, traces)
    judge_outputs(blocks, edges)
