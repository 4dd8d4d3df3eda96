"""The board's port by itself, in the emulator: port_check.c does what a letter asks for."""

import re
from pathlib import Path

import pytest

from stepmite.emulator import Emulator

BUILD = Path(__file__).resolve().parents[2] / "build" / "pico" / "tests" / "port"
PULSE_GPIO = 2
UART_TX_GPIO = 0
WATCHDOG_MS = 8000


@pytest.fixture
def board():
    """A board that has just booted and whose USB port a terminal has open."""
    with Emulator(BUILD / "port-check.uf2", elf=BUILD / "port-check.elf") as emulator:
        emulator.connect()
        emulator.expect("port check\r\n")
        emulator.uart_output()
        yield emulator


@pytest.fixture
def clean_board(board):
    """The same; nothing forbidden may happen in the test."""
    yield board
    assert board.faults() == []


def ask(board: Emulator, letter: str, name: str) -> tuple[int, ...]:
    """Send a letter; return the three numbers of the line that begins with `name`."""
    board.send(letter)
    match = board.expect(rf"{name} (\d+) (\d+) (\d+)\r\n")
    return tuple(int(number) for number in match[1:])


def test_tick_count_and_stop(clean_board):
    assert ask(clean_board, "t", "tick") == (1000, 1000, 0)


def test_tick_period_and_start(clean_board):
    ask(clean_board, "t", "tick")
    runs = clean_board.tick_runs()
    assert [run.count for run in runs] == [1000, 1000]
    assert all(run.period_ns == 10_000 for run in runs)
    rising = [time for time, gpio, level in clean_board.edges([PULSE_GPIO]) if level]
    assert len(rising) == 2000
    for run, times in zip(runs, (rising[:1000], rising[1000:]), strict=True):
        late = [time - run.first_ns - n * run.period_ns for n, time in enumerate(times)]
        # The entry of the interrupt, and at worst what the SDK masks in its USB code.
        assert min(late) > 0
        assert max(late) < 2000


def test_governor_comes_at_once_and_as_one(clean_board):
    clean_board.send("g")
    assert [int(n) for n in clean_board.expect(r"governor (\d+) (\d+) (\d+)")[1:]] == [1, 0, 1]
    assert [int(n) for n in clean_board.expect(r"from tick (\d+) (\d+)")[1:]] == [0, 1]


def test_priorities_are_tick_then_the_rest_then_governor(clean_board):
    def priority(base: int, n: int) -> int:
        return clean_board.peek(base + n // 4 * 4) >> n % 4 * 8 & 0xFF

    timer3, usb, uart0, governor, usb_worker = 3, 5, 20, 26, 27
    enabled = clean_board.peek(0xE000E100)
    for irq in (timer3, usb, uart0, governor, usb_worker):
        assert enabled >> irq & 1, irq
    assert priority(0xE000ED20, 3) == 0  # SysTick
    for irq in range(32):
        if enabled >> irq & 1:
            assert priority(0xE000E400, irq) == (0xC0 if irq == governor else 0x80), irq


def test_idle_keeps_its_deadline(clean_board):
    took_us, returns, hundredths_late = ask(clean_board, "i", "idle")
    assert 5000 <= took_us < 5050
    assert returns < 20
    assert hundredths_late == 0


def test_tick_does_not_wake_main(clean_board):
    hundred_us, returns, _ = ask(clean_board, "j", "idle under tick")
    assert hundred_us in (99, 100)
    assert returns < 20


def test_storage_is_nor_flash_and_refused_while_the_tick_runs(clean_board):
    clean_board.send("s")
    assert clean_board.expect(r"storage (\d+) (\d+) (\d+)")[1:] == ["1", "255", str(0xF0 & 0x3C)]
    assert clean_board.expect(r"refused (\d+) (\d+)")[1:] == ["1", "0"]


def test_pins(clean_board):
    assert ask(clean_board, "p", "pins") == (1, 0, 1)


def test_long_output_arrives_complete(clean_board):
    clean_board.send("l")
    clean_board.run_ms(500)
    assert clean_board.output() == "".join(f"line {n} of a long output\r\n" for n in range(500))


def test_terminal_that_does_not_read_gets_all_later(clean_board):
    clean_board.host_reading(False)
    clean_board.send("l")
    clean_board.run_ms(100)
    clean_board.host_reading(True)
    clean_board.run_ms(500)
    assert clean_board.output().count("\n") == 500


def test_output_is_dropped_without_a_terminal(clean_board):
    clean_board.host_open(False)
    clean_board.run_ms(5)
    clean_board.output()
    clean_board.send_uart("l")
    clean_board.run_ms(1500)
    assert "line 499 of a long output\r\n" in clean_board.uart_output()
    clean_board.host_open(True)
    clean_board.run_ms(20)
    assert clean_board.output() == ""
    clean_board.send("n")
    clean_board.expect("Raspberry Pi Pico")


def test_greeting_goes_to_the_first_terminal_only(clean_board):
    clean_board.host_open(False)
    clean_board.run_ms(5)
    clean_board.host_open(True)
    clean_board.run_ms(50)
    assert clean_board.output() == ""


def test_rts_alone_loses_no_output(clean_board):
    """Windows raises DTR and RTS one after the other."""
    clean_board.send("l")
    clean_board.run_ms(1)
    for rts in (False, True, False, True):
        clean_board.host_open(True, rts=rts)
        clean_board.run_ms(2)
    clean_board.run_ms(500)
    assert clean_board.output() == "".join(f"line {n} of a long output\r\n" for n in range(500))


def test_terminal_without_dtr_is_there_once_it_sends(clean_board):
    clean_board.host_open(False, rts=True)
    clean_board.run_ms(5)
    clean_board.output()
    clean_board.send("l")
    clean_board.run_ms(500)
    assert clean_board.output() == "".join(f"line {n} of a long output\r\n" for n in range(500))


def test_terminal_without_dtr_that_left_holds_nothing_up(clean_board):
    clean_board.host_open(False)
    clean_board.run_ms(5)
    clean_board.host_reading(False)
    clean_board.send("l")
    clean_board.run_ms(4000)  # tries again after 2 s; then the terminal counts as gone
    assert "line 499 of a long output\r\n" in clean_board.uart_output()


def test_uart_says_where_input_was_lost(clean_board):
    """Busy with printing for a second, at most 2 KB of what comes meanwhile are kept."""
    clean_board.send_uart("l" + "." * 6000)
    clean_board.run_ms(2000)
    clean_board.send_uart("n")
    clean_board.run_ms(50)
    output = clean_board.uart_output()
    assert output.count("input is missing\r\n") == 1
    assert "Raspberry Pi Pico" in output


def test_uart_answers_and_leads(clean_board):
    clean_board.send_uart("l")
    clean_board.run_ms(1500)
    text = clean_board.uart_output()
    assert text == "".join(f"line {n} of a long output\r\n" for n in range(500))
    assert clean_board.output() != ""  # the terminal on USB sees it too


def test_uart_pins_belong_to_whoever_takes_them(clean_board):
    clean_board.send("u")
    clean_board.expect("uart pins taken\r\n")
    assert clean_board.level(UART_TX_GPIO) == 1
    assert clean_board.uart_output().endswith("are taken: the console goes on over USB only\r\n")
    clean_board.send_uart("n")
    clean_board.run_ms(10)
    assert clean_board.output() == ""
    clean_board.send("v")
    clean_board.expect("uart pins given back\r\n")
    clean_board.send_uart("n")
    clean_board.expect(r"Raspberry Pi Pico \S+\r\n")


def test_name_and_version(clean_board):
    clean_board.send("n")
    line = clean_board.expect(r"(Raspberry Pi Pico) (\S+)\r\n")
    assert re.fullmatch(r"[\w.-]+", line[2])


def test_exit_restarts_without_a_message(clean_board):
    clean_board.send("x")
    clean_board.run_ms(2000)
    assert clean_board.status()["resets"] == 1
    clean_board.connect()
    clean_board.run_ms(50)
    assert clean_board.output() == "port check\r\n"


def test_hung_main_loop_restarts(clean_board):
    clean_board.send("h")
    clean_board.run_ms(WATCHDOG_MS - 500)
    assert clean_board.status()["resets"] == 0
    clean_board.run_ms(1500)
    assert clean_board.status()["resets"] == 1
    clean_board.expect("Restarted after the main loop hung for 8 s\r\n", 2000)


def test_idle_main_loop_keeps_running(clean_board):
    clean_board.run_ms(3 * WATCHDOG_MS)
    assert clean_board.status()["resets"] == 0


def test_main_loop_that_takes_input_is_not_hung(clean_board):
    clean_board.send("c")
    clean_board.expect("still here", WATCHDOG_MS + 2000)
    assert clean_board.status()["resets"] == 0


def test_fault_restarts_and_says_where(board):
    board.send("f")
    line = board.expect(r"Restarted after a fault at PC=([0-9A-F]{8}) LR=[0-9A-F]{8}\r\n", 3000)
    assert int(line[1], 16) >> 28 in (1, 2)
    assert "Restarted after a fault" in board.uart_output()
    assert board.status()["resets"] == 1


def test_stack_overflow_restarts(board):
    board.send("o")
    board.run_ms(WATCHDOG_MS + 3000)
    assert board.status()["resets"] == 1
    assert "Restarted after" in board.output()
