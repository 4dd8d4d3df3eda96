"""The real firmware as a whole on the emulated board: its console, its sleep, its patience."""

import random

from stepmite.emulator import Emulator
from stepmite.trace import AxisPins, Edges, axis_trace

WFE = 2
MAIN_STACK_TOP, MAIN_STACK_BYTES, GUARD_BYTES = 0x20041000, 16 * 1024, 2048
X = AxisPins("X", 2, 3, False, 80.0)
SETUP = ["STEPPER INIT", "STEPPER AXIS X,GP2,GP3,,,80,6000,500", "STEPPER POSITION HOME"]


def set_up(board: Emulator) -> None:
    for line in [*SETUP, "STEPPER RUN"]:
        assert "rror" not in board.command(line)


def steps(board: Emulator) -> int:
    return axis_trace(Edges.from_rows(board.edges()), X).end_steps()


def test_idle_board_sleeps_without_a_tick(board: Emulator) -> None:
    set_up(board)
    board.command("STEPPER GC G1 X1 F3000")
    board.run_ms(1000)
    before = board.tick_runs()
    board.clear_profile()
    board.run_ms(500)
    assert board.tick_runs() == before
    assert "systick" not in board.profile()
    assert board.status()["sleeping"] == WFE
    busy = sum(cycles.calls * (cycles.mean + 28) for cycles in board.profile().values())
    assert busy < 0.01 * 500 * 125_000


def stack_used(board: Emulator) -> int:
    """Bytes of main's stack (rp2_memory.ld) that were written at some time; RAM starts as zeros."""
    bottom = MAIN_STACK_TOP - MAIN_STACK_BYTES
    for start in range(bottom, MAIN_STACK_TOP, 64):
        if any(board.peek(at) for at in range(start, start + 64, 4)):
            return MAIN_STACK_TOP - start
    return 0


def test_main_stack_keeps_a_third_free_at_worst(board: Emulator) -> None:
    """Expressions as deep as they may be, compiled by EVAL in a SUB, and the longest numbers."""
    board.command("SUB")  # the console's part of it
    assert 500 < stack_used(board) < 3000
    deep = "1=2+3*4^(" * 17 + "1" + ")" * 17
    for line in [
        "PRINT 1.7976931348623157e308, 1e-300",
        'N$="0."+STRING$(240,"7")',
        'PRINT VAL(N$+"e308"), VAL(N$+"e-300"), VAL(STRING$(250,"7"))',
        'PRINT FORMAT$(1e-300,"%128.120f"), FORMAT$(1e90,"%120.30f")',
        "PRINT " + "MAX(1=2+3*4^" * 13 + "1" + ",1)" * 13,
        "IF 1 THEN " * 17 + "PRINT " + "1=2+4*(" * 9 + "1" + ")" * 9,
    ]:
        assert "rror" not in board.command(line)
    assert "Expression too complex" in board.command(f'PRINT EVAL("{deep}")')
    used = stack_used(board)
    assert 3000 < used < (MAIN_STACK_BYTES - GUARD_BYTES) * 2 // 3


def test_host_that_does_not_read_does_not_stop_motion(board: Emulator) -> None:
    """Output waits for the host, and nothing of it is lost; the motors do not wait."""
    set_up(board)
    board.command("STEPPER GC G1 X20 F3000")
    board.host_reading(False)
    board.send('FOR i=1 TO 300: PRINT "line";i;" of a text that fills every buffer": NEXT\r')
    board.run_ms(2000)
    assert steps(board) == 1600
    board.host_reading(True)
    lines = [line for line in board.until("\n> ", 5000).splitlines() if line.startswith("line")]
    assert [int(line.split()[1]) for line in lines] == list(range(1, 301))


def test_uart_is_the_same_console(board: Emulator) -> None:
    board.uart_output()
    board.send_uart("PRINT 6*7\r")
    board.run_ms(30)
    assert "PRINT 6*7\r\n 42\r\n> " in board.uart_output()
    assert " 42\r\n> " in board.output()


def test_noise_and_endless_lines_lose_nothing(board: Emulator) -> None:
    set_up(board)
    chance = random.Random(3)
    # Ctrl-C (3) is no noise: it stops the machine.
    noise = "".join(chr(chance.choice([b for b in range(256) if b != 3])) for _ in range(3000))
    board.send(noise + "\r")
    board.run_ms(300)
    board.send("\x15\r" + "X" * 10_000 + "\r")
    board.run_ms(500)
    board.output()
    board.send("\r")
    board.run_ms(50)
    board.output()
    assert board.command("PRINT 6*7").split() == ["PRINT", "6*7", "42"]
    board.command("STEPPER GC G1 X1 F3000")
    board.run_ms(500)
    assert steps(board) == 80
