"""The USB serial port in virtual time: nothing lost either way, however slow a side is."""

import hashlib

from stepmite.emulator import Emulator


def test_echo_of_a_burst(check: Emulator) -> None:
    """64 KB queued at once: the board takes them as it can, and answers every line."""
    lines = [f"{hashlib.sha256(str(i).encode()).hexdigest()}" for i in range(1000)]
    check.send("e\r" + "".join(line + "\r" for line in lines) + "\r")
    answer = check.until("\n> ", 20_000)
    assert answer.replace("\r", "").splitlines() == [f"echo {line}" for line in lines]


def test_host_that_does_not_read_stops_the_board_and_loses_nothing(check: Emulator) -> None:
    check.host_reading(False)
    check.send("l100\r")
    check.run_ms(300)
    assert check.output() == ""
    check.host_reading(True)
    lines = check.until("\n> ").replace("\r", "").splitlines()
    # The SDK gives up on a port that takes nothing for 500 ms; within that nothing is lost.
    assert [line.split()[1] for line in lines] == [str(i) for i in range(100)]


def test_closed_port_is_seen_by_the_board(check: Emulator) -> None:
    """Without DTR the SDK drops output at once instead of waiting for a reader."""
    check.send("l2000\r")
    check.run_ms(5)
    check.host_open(False)
    check.run_ms(200)
    check.output()
    check.host_open(True)
    check.run_ms(5)
    assert "line" not in check.output()
    assert "input 1" in check.command("g")


def test_idle_line_costs_the_board_next_to_nothing(check: Emulator) -> None:
    check.run_ms(50)
    check.clear_profile()
    check.run_ms(200)
    usb = check.profile().get("irq5")
    assert usb is None or usb.calls <= 2 * 200  # frames at most


def test_runs_are_identical(check: Emulator, check_uf2) -> None:
    def play(board: Emulator) -> tuple[str, list[tuple[int, int, int]], float]:
        text = board.command("t2") + board.command("g")
        return text, board.edges(), board.now_ns

    first = play(check)
    with Emulator(check_uf2) as again:
        again.connect()
        again.until("> ")
        assert play(again) == first
