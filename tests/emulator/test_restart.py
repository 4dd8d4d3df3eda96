"""CPU RESTART, WATCHDOG and the boot loader on the emulated board."""

import pytest

from stepmite.emulator import Emulator

WATCHDOG_SCRATCH_7, ROM_END = 0x40058028, 0x4000
SETUP = ["STEPPER INIT", "STEPPER AXIS X,GP2,GP3,,,80,6000,500", "STEPPER POSITION HOME"]


def back_again(board: Emulator) -> str:
    """The greeting of a board that has restarted."""
    board.connect(3000)
    return board.until("\n> ", 3000)


def start_motion(board: Emulator) -> None:
    for line in [*SETUP, "STEPPER RUN", "STEPPER GC G1 X100 F3000"]:
        assert "rror" not in board.command(line)


def test_cpu_restart_is_a_fresh_start(board: Emulator) -> None:
    board.command("a = 5: WATCHDOG 100000")
    board.send('PRINT "bye": CPU RESTART\r')
    board.expect("bye\r\n")
    greeting = back_again(board)
    assert "StepMite" in greeting
    assert "Restarted" not in greeting
    assert board.peek(WATCHDOG_SCRATCH_7) == 0
    assert board.command("PRINT a; MM.WATCHDOG").endswith("\n 0 0\r")


def test_watchdog_restarts_and_says_so(board: Emulator) -> None:
    start_ns = board.now_ns
    board.send("WATCHDOG 200: DO: LOOP\r")
    greeting = back_again(board)
    assert "Restarted by WATCHDOG" in greeting
    assert 200e6 < board.now_ns - start_ns < 2000e6
    assert board.command("PRINT MM.WATCHDOG").endswith("\n 1\r")


def test_motors_are_let_go_by_the_watchdog(board: Emulator) -> None:
    start_motion(board)
    board.send("WATCHDOG 50: DO: LOOP\r")
    back_again(board)
    board.clear_edges()
    board.run_ms(50)
    assert board.edges([2, 3]) == []


@pytest.mark.parametrize("line", ["CPU RESTART", "CPU RESTART BOOTSEL", "UPDATE FIRMWARE"])
def test_refused_while_motors_turn(board: Emulator, line: str) -> None:
    start_motion(board)
    board.run_ms(100)
    assert "Error : Not possible while motion is active" in board.command(line)
    before = len(board.edges([2]))
    board.run_ms(100)
    assert len(board.edges([2])) > before + 100


@pytest.mark.parametrize("way", ["CPU RESTART BOOTSEL", "UPDATE FIRMWARE", "1200 baud"])
def test_boot_loader(board: Emulator, way: str) -> None:
    if way == "1200 baud":
        board.host_baud(1200)
    else:
        board.send(way + "\r")
    board.run_ms(200)
    # The chip restarts into its ROM, which finds in a scratch register where to go on. The emulator
    # starts the firmware instead, which leaves that register alone.
    assert board.status()["resets"] == 1
    assert 0 < board.peek(WATCHDOG_SCRATCH_7) < ROM_END


def test_1200_baud_are_nothing_while_motors_turn(board: Emulator) -> None:
    start_motion(board)
    board.run_ms(100)
    board.host_baud(1200)
    board.run_ms(100)
    assert " 1" in board.command("PRINT PEEK(STEPPER ACTIVE)")
