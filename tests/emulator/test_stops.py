"""Stops and disturbances on the emulated board: edges counted against what the machine says."""

import random
import re

from stepmite.emulator import Emulator
from stepmite.ticks import first_difference, snap_to_ticks, tick_train
from stepmite.trace import AxisPins, Edges, axis_trace

X = AxisPins("X", 2, 3, False, 80.0)
Y = AxisPins("Y", 5, 6, False, 80.0)
ESTOP = 15
TICK_NS = 10_000

SETUP = [
    f"STEPPER INIT ,64,GP{ESTOP}",
    "STEPPER AXIS X,GP2,GP3,GP4,,80,37500,20000",  # 50 kHz
    "STEPPER AXIS Y,GP5,GP6,GP7,,80,30000,20000",
]
ZIGZAG = [f"G0 X{40 * (i % 2)} Y{3 * i}" for i in range(40)]


def start(board: Emulator, lines: list[str]) -> list[int]:
    """Set up, at home, armed; then the lines go into the queue. Returns the counts at home."""
    for line in [*SETUP, "STEPPER POSITION HOME", "STEPPER RUN"]:
        assert "rror" not in board.command(line)
    home = counted(board, [0, 0])
    for line in lines:
        assert "rror" not in board.command(f"STEPPER GC {line}")
    return home


def counted(board: Emulator, home: list[int]) -> list[int]:
    """Steps from home, counted at the pins."""
    edges = Edges.from_rows(board.edges())
    ends = [axis_trace(edges, pins).end_steps() for pins in (X, Y)]
    return [end - begin for end, begin in zip(ends, home, strict=True)]


def reported(board: Emulator) -> list[int]:
    text = board.command("STEPPER STATUS")
    return [int(n) for n in re.findall(r"\((-?\d+) steps\)", text)]


def test_emergency_stop_at_any_moment_counts_every_step(board: Emulator) -> None:
    chance = random.Random(7)
    for _ in range(10):
        home = start(board, ZIGZAG)
        board.run_ms(chance.uniform(0, 300))
        board.command("STEPPER ESTOP")
        steps = counted(board, home)
        board.run_ms(20)
        assert counted(board, home) == steps, "a step after the stop"
        assert reported(board) == steps
        board.command("STEPPER CLOSE")


def test_estop_input_ends_motion_with_the_next_tick(board: Emulator) -> None:
    chance = random.Random(8)
    board.set_pin(ESTOP, 1)
    for _ in range(8):
        home = start(board, ZIGZAG)
        board.run_ms(chance.uniform(0, 300))
        pressed_ns = board.now_ns + chance.randrange(1_000_000)
        board.set_pin(ESTOP, 0, at_ns=pressed_ns)
        board.run_ms(20)
        rises = [t for t, gpio, level in board.edges() if level and gpio in (2, 5)]
        # The tick that is under way may have read its inputs already.
        assert max(rises) <= pressed_ns + 2_000, "a step after the tick that saw the input"
        assert [board.level(4), board.level(7)] == [1, 1], "drivers are off"
        assert "E-STOP" in board.command("")
        assert reported(board) == counted(board, home)
        assert "E-STOP active" in board.command("STEPPER RUN")
        board.set_pin(ESTOP, 1)
        board.command("STEPPER CLOSE")


def test_controlled_stop_by_ctrl_c_is_exact(board: Emulator) -> None:
    chance = random.Random(9)
    for _ in range(8):
        home = start(board, ZIGZAG)
        board.run_ms(chance.uniform(0, 300))
        board.send("\x03")
        board.run_ms(100)
        board.output()
        assert board.command("PRINT PEEK(STEPPER ACTIVE)").split()[-1] == "0"
        assert reported(board) == counted(board, home)
        board.command("STEPPER GC G0 X1 Y2")
        board.run_ms(300)
        assert reported(board) == counted(board, home) == [80, 160]
        board.command("STEPPER CLOSE")


BUSY = 'DO : a = a + 1.5 : b$ = STR$(a) + "x" : c$ = RIGHT$(c$ + MID$(b$, 2), 200) : LOOP\r'


def run_of(board: Emulator, disturb: list[str] | None) -> list:
    """The step train of the zigzag, queued first, with this going on at the prompt meanwhile."""
    for line in [*SETUP, "STEPPER POSITION HOME"]:
        board.command(line)
    for line in ZIGZAG[:20]:
        board.command(f"STEPPER GC {line}")
    board.clear_edges()
    first_run = len(board.tick_runs())
    board.send("STEPPER RUN\r")
    board.run_ms(2)
    for text in disturb or []:
        board.send(text)
        board.run_ms(60)
    board.run_ms(2500)
    edges = snap_to_ticks(Edges.from_rows(board.edges()), board.tick_runs()[first_run:])
    return tick_train(edges, (2, 3, 5, 6), (2, 5))


def test_nothing_at_the_prompt_disturbs_motion(uf2) -> None:
    """Errors, noise, a program without a pause, output that nobody reads: not one edge moves."""
    with Emulator(uf2) as quiet:
        quiet.connect()
        quiet.until("> ")
        expected = run_of(quiet, None)
        assert quiet.faults() == []
    assert len(expected) > 10_000
    with Emulator(uf2) as board:
        board.connect()
        board.until("> ")
        noise = "".join(chr(c) for c in range(4, 256) if c not in (6, 13, 18, 26))
        actual = run_of(
            board,
            [
                "STEPPER GC G1 X1 X2\r" * 20,
                "STEPPER INIT\rSTEPPER AXIS X,1\rSTEPPER POSITION HOME\r" * 5,
                "STEPPER CLEAR\r",  # refused: motion is active
                noise + "\x15\r",
                "z" * 3000 + "\r",
                'FOR i=1 TO 100000 : PRINT "a line that is longer than nothing"; i : NEXT\r',
                BUSY,
            ],
        )
        board.send("\x03")
        board.run_ms(100)
        board.output()
        assert "underruns: 0" in board.command("STEPPER STATUS")
        assert board.faults() == []
    assert first_difference(expected, actual) is None, first_difference(expected, actual)
