"""The real firmware as a whole on the emulated board: its console, its sleep, its patience."""

import random

from stepmite.emulator import Emulator
from stepmite.trace import AxisPins, Edges, axis_trace

WFE = 2
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


def test_heap_of_the_c_library_stays_below_what_is_reserved(board: Emulator) -> None:
    """The firmware allocates nothing; newlib does for numbers that are long or far from 1."""
    for line in [
        "PRINT 1.7976931348623157e308, 1e-300",
        'N$="0."+STRING$(240,"7")',
        'PRINT VAL(N$+"e308"), VAL(N$+"e-300"), VAL(STRING$(250,"7"))',
        'PRINT FORMAT$(1e-300,"%128.120f"), FORMAT$(1e90,"%120.30f")',
    ]:
        assert "rror" not in board.command(line)
    # Without the up to 4 KB that align its first page, which another image would have elsewhere.
    assert 0 < board.peek("__malloc_max_sbrked_mem") <= 0x3000 - 4096


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
