"""Ctrl-F and Ctrl-R on the emulated board: feed hold from any state of the prompt, by the edges."""

import pytest

from stepmite.emulator import Emulator

STEP, DIR = 2, 3
CTRL_C, CTRL_F, CTRL_R = "\x03", "\x06", "\x12"
SETUP = [
    "STEPPER INIT",
    f"STEPPER AXIS X,GP{STEP},GP{DIR},GP4,,80,6000,2000",
    "STEPPER POSITION HOME",
    "STEPPER RUN",
]
MOVE_STEPS = 60 * 80
FEED_MM_S, ACCELERATION = 50.0, 2000.0
# From the key at the PC to a standstill: braking, and what lies before it: a frame of USB, a BASIC
# statement, the motion that is computed ahead.
STOP_MS = 1000 * FEED_MM_S / ACCELERATION + 20
HELD = "Feed hold (Ctrl-R or STEPPER RESUME goes on)\r\n"

# What goes on at the prompt: what is typed, and what the screen shows then.
COMPUTES = "DO : a = SIN(a) : b$ = STR$(a) + CHR$(65) : LOOP\r"
PRINTS = 'DO:PRINT STRING$(70,"x"):LOOP\r'
SITUATIONS = {"idle": "", "typing": "PRINT 6*", "computing": COMPUTES, "printing": PRINTS}


def steps(board: Emulator) -> list[int]:
    """When X made steps, in ns."""
    return [t for t, gpio, level in board.edges([STEP]) if level]


@pytest.mark.parametrize("situation", SITUATIONS)
def test_hold_stands_and_resume_makes_every_step(board: Emulator, situation: str) -> None:
    for line in SETUP:
        assert "rror" not in board.command(line)
    board.output()
    board.clear_edges()
    board.send(f"STEPPER GC G1 X60 F{FEED_MM_S * 60:.0f}\r")
    board.send(SITUATIONS[situation])
    board.run_ms(300)
    pressed_ns = board.now_ns
    board.send(CTRL_F)
    board.run_ms(300)
    held = steps(board)
    assert 0.2 * MOVE_STEPS < len(held) < 0.8 * MOVE_STEPS
    assert held[-1] > pressed_ns + 1e6 * 500 * FEED_MM_S / ACCELERATION, "no ramp"
    assert held[-1] < pressed_ns + 1e6 * STOP_MS
    assert HELD in board.output()
    board.send(CTRL_R)
    board.run_ms(1500)
    assert "Resumed\r\n" in board.output()
    assert len(steps(board)) == MOVE_STEPS
    board.send(CTRL_C)
    board.run_ms(20)
    board.send("PRINT PEEK(STEPPER X)\r")
    board.expect(r"\n 60\r\n> $")


def test_a_line_being_typed_is_whole_behind_the_notices(board: Emulator) -> None:
    for line in [*SETUP, "STEPPER GC G1 X60 F600"]:
        board.command(line)
    board.send("PRINT 6*")
    board.run_ms(50)
    board.send(CTRL_F)
    board.run_ms(50)
    board.send("7")
    board.run_ms(50)
    board.send(CTRL_R)
    board.run_ms(50)
    assert board.command("").endswith("Resumed\r\n> PRINT 6*7\r\n 42\r")
