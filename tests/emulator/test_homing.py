"""Homing and probing on the emulated board, with axes at its pins that press bouncing switches."""

from shown import command

from stepmite.emulator import Emulator

SETUP = [
    "STEPPER INIT",
    "STEPPER AXIS X,GP2,GP3,GP4,,80,6000,500",
    "STEPPER AXIS Y,GP5,GP6,GP7,,80,6000,500",
    "STEPPER HWLIMITS GP16,GP17",
    "STEPPER HOME X,MIN,3000,600,1",
    "STEPPER HOME Y,MIN,3000,600,1",
    "STEPPER PROBE GP18",
    "STEPPER RUN",
]


def start(board: Emulator) -> None:
    """Set up two axes with a switch at 0 each, and a plate that X touches at step -37 upside."""
    board.add_axis("X", 2, 3, at=700)
    board.add_axis("Y", 5, 6, at=450)
    board.add_switch("X", 16, end=0, bounces=6)
    board.add_switch("Y", 17, end=0, bounces=6)
    board.add_switch("X", 18, begin=1001)
    for line in SETUP:
        assert "rror" not in command(board, line)


def test_homing_and_probing_are_exact_on_the_board(board: Emulator) -> None:
    """The same step from several places, together and one by one; then a plate."""
    start(board)
    for order in ("X,Y", "XY"):
        assert command(board, f"STEPPER HOME ORDER {order}") == ""
        assert command(board, "STEPPER GC G28") == ""
        assert (board.axis("X"), board.axis("Y")) == (80, 80)
        assert command(board, 'PRINT PEEK(STEPPER X);" ";PEEK(STEPPER STATUS)>>7') == "0 1"
        command(board, "STEPPER GC G0 X7.3 Y4.1")
        board.run_ms(700)
    command(board, "STEPPER GC G38.2 X20 F900")
    assert float(command(board, "PRINT PEEK(STEPPER PROBE X)")) == (1001 - 80) / 80
    assert board.axis("X") - 80 == round(80 * float(command(board, "PRINT PEEK(STEPPER X)")))


def test_ctrl_c_ends_homing(board: Emulator) -> None:
    start(board)
    command(board, "STEPPER HOME X,MIN,600")
    board.send("STEPPER GC G28 X0\r")
    board.run_ms(300)
    board.send("\x03")
    assert "motion stops" in board.until("\n> ")
    board.run_ms(200)
    stands = board.axis("X")
    board.run_ms(200)
    assert board.axis("X") == stands > 80
    board.output()  # it may tell how homing ended
    assert command(board, "PRINT PEEK(STEPPER ACTIVE)") == "0"
    assert command(board, "STEPPER GC G28 X0") == ""
    assert board.axis("X") == 240
