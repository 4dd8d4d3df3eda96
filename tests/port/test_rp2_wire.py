"""Serial wires of the board's port in the emulator: this test plays the chip at the other end."""

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest

from stepmite.emulator import Emulator

BUILD = Path(__file__).resolve().parents[2] / "build" / "pico" / "tests" / "port"
BAUDS = [9600, 19200, 115200, 250000, 500000]
TX, RX = 5, 6
REQUEST = [0x05, 0x00, 0x06, 0x6F]
REPLY = [0x05, 0xFF, 0x06, 0x21, 0x55, 0xAA, 0x7F, 0x80]
LATEST_BITS = 128
CYCLE_NS = 8


@pytest.fixture
def board() -> Iterator[Emulator]:
    """A board at its start; nothing forbidden may happen in the test."""
    with Emulator(BUILD / "port-check.uf2", elf=BUILD / "port-check.elf") as emulator:
        emulator.connect()
        emulator.expect("port check\r\n")
        yield emulator
        assert emulator.faults() == []


class Wire:
    """A wire of the board, opened; `echo`: the receiving pin is another one."""

    def __init__(self, board: Emulator, *, echo: bool = False, baud: int = 115200) -> None:
        self.board = board
        self.baud = baud
        self.rx = RX if echo else TX
        self.pins = f"{TX} {self.rx} {baud}"
        self.ask("o")

    def bits_ns(self, bits: float) -> float:
        return bits * 1e9 / self.baud

    def post(self, command: str, *numbers: int) -> None:
        self.board.send(f"w{command} {self.pins} {' '.join(map(str, numbers))}".rstrip() + "\n")

    def result(self) -> tuple[str, list[int]]:
        state, *rest = self.board.expect(r"wire (.*)\r\n", 100)[1].split()
        return state, [int(number) for number in rest[1:]]

    def ask(self, command: str, *numbers: int) -> tuple[str, list[int]]:
        self.post(command, *numbers)
        return self.result()

    def edges(self) -> list[tuple[int, int]]:
        return [(time, level) for time, _, level in self.board.edges([TX])]

    def request(self) -> float:
        """Send a request that is to be answered; return when it ends. Time is just before that."""
        self.board.clear_edges()
        self.post("e", len(REPLY), *REQUEST)
        while not (edges := self.edges()):
            self.board.run_ms(0.02)
        end_ns = edges[0][0] + self.bits_ns(10 * len(REQUEST))
        assert self.board.now_ns < end_ns
        return end_ns

    def play(
        self, start_ns: float, data: list[int], *, clock: float = 1.0, no_stop: int | None = None
    ) -> None:
        """Drive the receiving pin as a chip whose clock is `clock` times too fast does."""
        bit_ns = self.bits_ns(1) / clock
        for n, byte in enumerate(data):
            stop = 0 if n == no_stop else 1
            for k, level in enumerate([0, *[byte >> i & 1 for i in range(8)], stop]):
                at_ns = round(start_ns + (10 * n + k) * bit_ns)
                self.board.set_pin(self.rx, level, at_ns=at_ns)
        self.board.set_pin(self.rx, None, at_ns=round(start_ns + 10 * len(data) * bit_ns))

    def answered(self, delay_bits: float, data: list[int] = REPLY, **how) -> tuple[str, list[int]]:
        """Have a request answered so many bits behind it."""
        self.play(self.request() + self.bits_ns(delay_bits), data, **how)
        return self.result()


@pytest.mark.parametrize("baud", BAUDS)
def test_bits_are_exact_and_the_line_idles_high(board: Emulator, baud: int) -> None:
    wire = Wire(board, baud=baud)
    board.run_ms(1)
    assert board.level(TX) == 1
    assert wire.edges() == []  # no glitch when it was opened
    wire.ask("e", 0, *[0x55] * 8)
    edges = wire.edges()
    assert [level for _, level in edges] == [0, 1] * 40
    assert board.level(TX) == 1
    for n, (time_ns, _) in enumerate(edges):
        ideal_ns = edges[0][0] + wire.bits_ns(n)
        # The divider is off by 1/512 of a cycle at worst, and edges fall on cycles of the chip.
        assert abs(time_ns - ideal_ns) <= 1e-4 * wire.bits_ns(n) + CYCLE_NS
    lengths = [b - a for (a, _), (b, _) in pairwise(edges)]
    assert all(abs(length / wire.bits_ns(1) - 1) < 0.01 for length in lengths)


@pytest.mark.parametrize("baud", BAUDS)
@pytest.mark.parametrize("echo", [False, True])
def test_replies_at_any_phase(board: Emulator, baud: int, echo: bool) -> None:
    wire = Wire(board, baud=baud, echo=echo)
    for eighth in range(8):
        assert wire.answered(8 + eighth / 8) == ("done", REPLY)


@pytest.mark.parametrize("clock", [0.965, 0.98, 1.02, 1.035])
def test_replies_of_a_clock_that_is_off(board: Emulator, clock: float) -> None:
    wire = Wire(board)
    for eighth in range(8):
        data = [0xFF, 0x00, 0xFE, 0x01, 0x7F, 0x80, 0x55, 0xAA]
        assert wire.answered(20 + eighth / 8, data, clock=clock) == ("done", data)


def test_earliest_latest_and_late_replies(board: Emulator) -> None:
    wire = Wire(board)
    for bits in (1, 8, LATEST_BITS):
        assert wire.answered(bits) == ("done", REPLY)
    assert wire.answered(LATEST_BITS + 40)[0] == "silent"
    board.run_ms(2)
    assert wire.answered(8) == ("done", REPLY)  # it has met nobody


def test_part_of_a_reply_and_a_missing_stop_bit(board: Emulator) -> None:
    wire = Wire(board)
    assert wire.answered(8, REPLY[:5])[0] == "silent"
    assert wire.answered(8, REPLY, no_stop=7)[0] == "garbled"
    assert wire.answered(8, [*REPLY[:3], *[0xFF] * 5], no_stop=3)[0] == "garbled"
    assert wire.answered(8) == ("done", REPLY)


def test_short_disturbances_are_no_start_bits(board: Emulator) -> None:
    wire = Wire(board)
    for n in range(8):
        end_ns = wire.request()
        for spike in range(3):
            begin_ns = round(end_ns + wire.bits_ns(2 + 1.37 * spike + n / 8))
            board.set_pin(TX, 0, at_ns=begin_ns)
            board.set_pin(TX, None, at_ns=round(begin_ns + wire.bits_ns(0.25)))
        wire.play(end_ns + wire.bits_ns(8), REPLY)
        assert wire.result() == ("done", REPLY)


def test_held_line_is_told_and_nothing_sent(board: Emulator) -> None:
    wire = Wire(board, echo=True)
    board.set_pin(RX, 0)
    board.clear_edges()
    assert wire.ask("e", 8, *REQUEST)[0] == "held"
    assert wire.edges() == []
    assert wire.ask("e", 0, *REQUEST)[0] == "done"  # nobody is expected to answer
    assert len(wire.edges()) > 0


def test_held_single_pin_is_let_go_of(board: Emulator) -> None:
    """Then no two drivers fight, as they do if something is sent all the same."""
    wire = Wire(board)
    assert wire.answered(8) == ("done", REPLY)
    board.set_pin(TX, 0)
    assert wire.ask("e", 8, *REQUEST)[0] == "held"
    assert board.faults() == []
    wire.ask("e", 0, *REQUEST)
    assert "GPIO5 is driven from both sides" in board.faults()[0].text
    board.set_pin(TX, None)
    board.clear_faults()


def test_busy_line_is_waited_for(board: Emulator) -> None:
    """Something left over is on the line: nothing is sent before it has been idle for 13 bits."""
    wire = Wire(board)
    assert wire.answered(8) == ("done", REPLY)
    board.clear_edges()
    begin_ns = board.now_ns
    for bit in range(60):
        board.set_pin(TX, bit & 1, at_ns=round(begin_ns + wire.bits_ns(bit)))
    board.set_pin(TX, None, at_ns=round(begin_ns + wire.bits_ns(60)))
    wire.post("e", 8, *REQUEST)
    board.run_ms(1)
    idle_bits = (wire.edges()[0][0] - begin_ns) / wire.bits_ns(1) - 59
    assert 13 < idle_bits < 17
    wire.result()


def test_an_early_answer_is_seen_as_a_fight(board: Emulator) -> None:
    """So that mistakes of the turnaround do not go unnoticed."""
    wire = Wire(board)
    wire.answered(-1)
    assert "GPIO5 is driven from both sides" in board.faults()[0].text
    board.clear_faults()


@pytest.mark.parametrize("after_us", [50, 100, 200, 300, 400, 600])
def test_given_up_anywhere(board: Emulator, after_us: int) -> None:
    wire = Wire(board)
    board.clear_edges()
    board.send(f"wa {after_us} {wire.pins} 8 {' '.join(map(str, REQUEST))}\n")
    board.expect("given up", 100)
    board.run_ms(1)
    assert board.level(TX) == 1
    assert wire.answered(8) == ("done", REPLY)


def test_closed_pins_are_as_after_reset(board: Emulator) -> None:
    wire = Wire(board, echo=True)
    wire.ask("c")
    for pin in (TX, RX):
        for level in (0, 1, 0):
            board.set_pin(pin, level)
            assert board.level(pin) == level  # nothing drives it
        assert board.peek(0x40014004 + 8 * pin) & 0x1F == 0x1F
        assert board.peek(0x4001C004 + 4 * pin) & 0x0C == 0  # no pull


def test_console_pins_come_back(board: Emulator) -> None:
    board.send("wo 0 1 115200\n")
    board.expect("wire done\r\n")
    assert board.uart_output().endswith("are taken: the console goes on over USB only\r\n")
    board.send("wc 0 1 115200\n")
    board.expect("wire done\r\n")
    board.send_uart("n")
    board.expect(r"Raspberry Pi Pico \S+\r\n")


def test_processor_is_free_meanwhile(board: Emulator) -> None:
    wire = Wire(board)
    board.measure("hal_wire_start", "hal_wire_poll")
    for _ in range(5):
        assert wire.answered(8) == ("done", REPLY)
    profile = board.profile()
    start, poll = profile["hal_wire_start"], profile["hal_wire_poll"]
    assert start.calls == 5
    assert poll.calls <= 5 * 4
    assert start.most < 2500
    assert poll.most < 1200
