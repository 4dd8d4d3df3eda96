"""`stepmite sgtune` against the host build of the firmware with simulated drivers, behind a pty."""

from pathlib import Path

import matplotlib.image
import pytest
from test_host_stream import HostBoard
from typer.testing import CliRunner

from stepmite import sgtune, sgtune_cmd
from stepmite.board import Board
from stepmite.cli import app
from stepmite.sgtune_cmd import line_to_type

ROOT = Path(__file__).parents[2]
MACHINE = (ROOT / "examples" / "sensorless.txt").read_text()
SETUP = [
    "TMC22xx GP5,2209,0,800,30,16",
    "STEPPER INIT",
    "STEPPER AXIS X,GP2,GP3,GP4,,80,6000,500",
    "STEPPER RUN",
    "TMC22xx AXIS 0,X",
]
ANSWER = [
    "something that was told before",
    "SGTUNE     ms     mm/min SG_RESULT lowest  CS",
    "           51     1590       101      0  25",
    "          103     3000       338    294  25",
    "At 3000 mm/min: SG_RESULT 356 lowest, 370 mean of 181 readings",
    "TMC22xx SGTHRS X,118",
    "TMC22xx STALL X,1800",
]


@pytest.fixture
def board(tmp_path):
    at = HostBoard(tmp_path, MACHINE)
    with Board.open(at.device) as prompt:
        for line in SETUP:
            prompt.command(line)
    yield at
    if at.process.poll() is None:
        at.close()


def call(*words):
    return CliRunner().invoke(app, ["sgtune", *(str(word) for word in words)])


def test_the_rows_and_the_proposal_are_read():
    tuning = sgtune.parse(ANSWER)
    assert [row.speed for row in tuning.rows] == [1590, 3000]
    assert tuning.rows[1] == sgtune.Row(103, 3000, 338, 294, 25)
    assert tuning.threshold == 236
    assert tuning.least_speed == 1800
    assert tuning.commands == ANSWER[-2:]
    assert tuning.says[0].startswith("At 3000")


def test_an_answer_without_a_proposal():
    tuning = sgtune.parse(ANSWER[:3])
    assert len(tuning.rows) == 1
    assert (tuning.threshold, tuning.least_speed, tuning.commands) == (None, None, [])


@pytest.mark.parametrize("line", ["", "1 2 3 4", "1 2 3 4 x", "1 2 3 4 5 6", "-1 2 3 4 5"])
def test_what_is_no_row(line):
    assert sgtune.row_of(line) is None


@pytest.mark.parametrize(
    ("options", "line"),
    [
        (("X", 3000.0, None, None), "TMC22xx SGTUNE X,3000"),
        (("X", 3000.5, -40.0, None), "TMC22xx SGTUNE X,3000.5,-40"),
        (("0", 100.0, None, "GP5"), "TMC22xx SGTUNE 0,100,,GP5"),
    ],
)
def test_the_line_to_type(options, line):
    assert line_to_type(*options) == line


def test_it_tunes_and_draws(board, tmp_path):
    picture = tmp_path / "sg.png"
    result = call("X", 3000, "--distance", 60, "--plot", picture, "--port", board.device)
    assert result.exit_code == 0, result.output
    assert "TMC22xx SGTHRS X,118" in result.output
    assert "TMC22xx STALL X,1800" in result.output
    assert result.output.count("█") > 200  # the rows, with a bar each
    image = matplotlib.image.imread(picture)
    assert image.shape[0] > 400
    dashes = (image[..., 0] > 0.7) & (image[..., 1] < 0.4) & (image[..., 2] < 0.4)
    assert dashes.sum() > 300  # the proposed threshold


def test_a_picture_without_a_proposal(tmp_path):
    """A jog that was too short; nothing is drawn that is not known."""
    picture = tmp_path / "sg.png"
    sgtune.draw(sgtune.parse(ANSWER[:4]), "short", picture)
    image = matplotlib.image.imread(picture)
    dashes = (image[..., 0] > 0.7) & (image[..., 1] < 0.4) & (image[..., 2] < 0.4)
    assert dashes.sum() == 0


def test_the_board_refuses(board):
    result = call("Y", 3000, "--port", board.device)
    assert result.exit_code == 1
    assert any(line.startswith("Error: ") for line in result.output.splitlines())
    assert "Y" in result.output


def test_rows_are_kept_when_there_is_no_proposal(board, tmp_path):
    picture = tmp_path / "sg.png"
    result = call("X", 6000, "--distance", 4, "--plot", picture, "--port", board.device)
    assert result.exit_code == 1
    assert "constant speed" in " ".join(result.output.split())
    assert "█" in result.output
    assert picture.exists()


def test_ctrl_c_stops_the_axis(board, monkeypatch):
    """Pressed at the third row: exit code 130; the axis has braked, the prompt is back."""
    rows = []

    def press(self, line):
        rows.append(line)
        if len(rows) == 4:
            raise KeyboardInterrupt

    monkeypatch.setattr(sgtune_cmd.Rows, "add", press)
    result = call("X", 60, "--distance", 100000, "--port", board.device)
    assert result.exit_code == 130
    assert "Stopped" in result.output
    with Board.open(board.device) as prompt:
        assert prompt.peek("ACTIVE") == 0
        assert 0 < prompt.peek("X") < 100000


def test_nobody_there(tmp_path):
    result = call("X", 3000, "--port", tmp_path / "nothing")
    assert result.exit_code == 1
    assert "Error: cannot open" in result.output.replace("\n", " ")
