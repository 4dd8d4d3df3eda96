"""What the drivers' wire looks like on the emulated board, read by sigrok's UART decoder.

The frames are those that the PicoMite firmware sends for the same lines.
"""

import subprocess
from itertools import pairwise
from pathlib import Path

import pytest
from sigrok import Byte, decode, frames, write_vcd

from stepmite.emulator import PROJECT, Emulator
from stepmite.trace import Edges

HOST = PROJECT / "build" / "host" / "stepmite"
BAUDS = [9600, 19200, 115200, 250000, 500000]
TX = 16

GOLDEN = {
    "TMC22xx 16,2209,0,800,30,16": [
        "05 00 80 00 00 01 C0 F6",
        "05 00 90 00 08 19 07 15",
        "05 00 91 00 00 00 14 1F",
        "05 00 EC 14 03 01 53 69",
        "05 00 F0 CF 0D 0E 24 96",
    ],
    "TMC22xx 16,2208,0,600,50,32,0.15,0": [
        "05 00 80 00 00 01 C4 16",
        "05 00 90 00 08 19 0C 2B",
        "05 00 91 00 00 00 14 1F",
        "05 00 EC 13 03 01 53 0D",
        "05 00 F0 CF 0D 0E 24 96",
    ],
    "TMC22xx 16,2209,1,1000,25,16": [
        "05 01 80 00 00 01 C0 1A",
        "05 01 90 00 08 11 04 E0",
        "05 01 91 00 00 00 14 F3",
        "05 01 EC 14 01 01 53 03",
        "05 01 F0 CF 0D 0E 24 7A",
    ],
    "TMC22xx 16,2209,0,2000,100,256": [
        "05 00 80 00 00 01 C0 F6",
        "05 00 90 00 08 1F 1F A8",
        "05 00 91 00 00 00 14 1F",
        "05 00 EC 10 01 01 53 21",
        "05 00 F0 CF 0D 0E 24 96",
    ],
    "TMC22xx TCOOLTHRS 0,200": ["05 00 94 00 00 00 C8 4D"],
    "TMC22xx SGTHRS 0,120": ["05 00 C0 00 00 00 78 D7"],
    "TMC22xx SGTTHRS 0,120": ["05 00 C0 00 00 00 78 D7"],
    "TMC22xx TCOOLTHRS 0,0": ["05 00 94 00 00 00 00 34"],
}
INITIAL = "TMC22xx 16,2209,0,800,30,16"


def texts(groups: list[list[Byte]]) -> list[str]:
    return [" ".join(f"{byte.value:02X}" for byte in group) for group in groups]


def first_lines(line: str, baud: int) -> list[str]:
    """What has to be typed before a line, so that it is sent without an answer."""
    lines = ["TMC22xx VERIFY 0", "TMC22xx MONITOR 0", f"TMC22xx WIRE {TX},,{baud}"]
    needs_driver = not line.removeprefix("TMC22xx ")[0].isdigit()
    return [*lines, INITIAL] if needs_driver else lines


def accepted(board: Emulator, line: str) -> None:
    answer = board.command(line)
    assert "rror" not in answer, answer


def assert_bits(rows: list[tuple[int, int]], group: list[Byte], baud: int) -> None:
    """Every edge of a frame is where a bit begins, within 1 % of a bit from the first start bit."""
    bit_ns = 1e9 / baud
    begin = max(time for time, level in rows if level == 0 and time < group[0].start_ns)
    edges = [time for time, _ in rows if begin <= time <= group[-1].end_ns + bit_ns]
    assert len(edges) > 2 * len(group)
    for time in edges:
        bits = (time - begin) / bit_ns
        assert abs(bits - round(bits)) < 0.01, f"an edge {bits:.3f} bits behind the start"


def assert_gaps(rows: list[tuple[int, int]], groups: list[list[Byte]], baud: int) -> None:
    """200 us of idle line between two frames, and not much more."""
    for before, after in pairwise(groups):
        end = before[-1].end_ns + 1e9 / baud  # of the stop bit
        begin = max(time for time, level in rows if level == 0 and time < after[0].start_ns)
        assert 199_900 <= begin - end <= 245_000 + 2e9 / baud


def assert_sent(board: Emulator, wanted: list[str], baud: int, vcd: Path) -> None:
    """These frames and nothing else, each bit and each gap in its place."""
    board.write_vcd(vcd)
    groups = frames(decode(vcd, TX, baud), baud)
    assert texts(groups) == wanted
    rows = [(time, level) for time, _, level in board.edges([TX])]
    for group in groups:
        assert_bits(rows, group, baud)
    assert_gaps(rows, groups, baud)


@pytest.mark.parametrize("line", GOLDEN)
def test_frames_of_a_line(board: Emulator, tmp_path: Path, line: str) -> None:
    baud = 115200
    for first in first_lines(line, baud):
        accepted(board, first)
    before = board.edges([TX])
    if line.startswith("TMC22xx 16"):
        assert before == []  # no glitch when the pin was taken
        assert board.level(TX) == 1
    board.clear_edges()
    accepted(board, line)
    assert board.edges([TX])[0][2] == 0  # it was high
    assert_sent(board, GOLDEN[line], baud, tmp_path / "line.vcd")


@pytest.mark.parametrize("baud", BAUDS)
def test_frames_at_every_speed(board: Emulator, tmp_path: Path, baud: int) -> None:
    for line in [*first_lines(INITIAL, baud), INITIAL]:
        accepted(board, line)
    assert_sent(board, GOLDEN[INITIAL], baud, tmp_path / "speed.vcd")


# The examples of the reference, in their order: five frames and five, twice five, one each.
EXAMPLES = [
    "TMC22xx 16,2209,0,800,30,16",
    "TMC22xx 16,2208,0,600,50,32,0.15,0",
    "TMC22xx 16,2209,0,1000,25,16",
    "TMC22xx 16,2209,1,1000,25,16",
    "TMC22xx TCOOLTHRS 0,200",
    "TMC22xx SGTTHRS 0,120",
    "TMC22xx TCOOLTHRS 0,0",
]
# What stands nowhere else: the line for address 0 with 1000 mA.
AT_1000_MA = [
    "05 00 80 00 00 01 C0 F6",
    "05 00 90 00 08 11 04",
    "05 00 91 00 00 00 14 1F",
    "05 00 EC 14 01 01 53",
    "05 00 F0 CF 0D 0E 24 96",
]


def test_examples_one_after_the_other(board: Emulator, tmp_path: Path) -> None:
    """A line may come again and with another chip; two drivers share the pin."""
    accepted(board, "TMC22xx VERIFY 0")
    for line in EXAMPLES:
        accepted(board, line)
    vcd = tmp_path / "examples.vcd"
    board.write_vcd(vcd)
    found = texts(frames(decode(vcd, TX, 115200), 115200))
    expected = [frame for line in EXAMPLES for frame in GOLDEN.get(line, AT_1000_MA)]
    assert len(found) == len(expected)
    assert all(text.startswith(frame) for text, frame in zip(found, expected, strict=True))
    accepted(board, "TMC22xx CLOSE")
    board.set_pin(TX, 0)
    assert board.level(TX) == 0  # it is free again


@pytest.mark.parametrize("line", GOLDEN)
def test_the_host_sends_the_same(tmp_path: Path, line: str) -> None:
    trace = tmp_path / "host.csv"
    lines = [*first_lines(line, 115200), line]
    done = subprocess.run(
        [HOST, "--virtual", "--trace", trace],
        input="".join(text + "\r" for text in lines),
        text=True,
        check=True,
        capture_output=True,
        timeout=60,
    )
    assert "rror" not in done.stdout, done.stdout
    edges = Edges.read(trace).of(TX)
    rows = zip(edges.time_ns.tolist(), edges.gpio.tolist(), edges.level.tolist(), strict=True)
    vcd = tmp_path / "host.vcd"
    write_vcd(list(rows), TX, vcd)
    groups = frames(decode(vcd, TX, 115200), 115200)
    assert texts(groups)[-len(GOLDEN[line]) :] == GOLDEN[line]


def test_the_decoder_sees_a_wrong_bit(tmp_path: Path) -> None:
    """The check of the frames can fail: one edge at the wrong place."""
    bits = [bit for byte in (0x05, 0xC0) for bit in [0, *(byte >> i & 1 for i in range(8)), 1]]
    levels = [1, *bits]
    rows = [
        (1_000_000 + round(n * 1e9 / 115200), TX, bit)
        for n, bit in enumerate(bits)
        if bit != levels[n]
    ]
    vcd = tmp_path / "good.vcd"
    write_vcd(rows, TX, vcd)
    (group,) = frames(decode(vcd, TX, 115200), 115200)
    assert texts([group]) == ["05 C0"]
    assert_bits([(time, level) for time, _, level in rows], group, 115200)
    late = [(time + (100 if n == 3 else 0), level) for n, (time, _, level) in enumerate(rows)]
    with pytest.raises(AssertionError, match="bits behind"):
        assert_bits(late, group, 115200)
    write_vcd([*rows[:-3], (rows[-1][0] + 90_000, TX, 1)], TX, vcd)
    with pytest.raises(AssertionError, match="error"):
        decode(vcd, TX, 115200)
