"""Host and board round alike: the condition for step trains that are the same edge for edge."""

import math
import re
import struct
from collections.abc import Callable, Iterator

from stepmite.emulator import Emulator

PAIRS = 20480
MASK64 = 2**64 - 1
FNV_PRIME, FNV_START = 0x100000001B3, 0xCBF29CE484222325


class Float32:
    """IEEE single: computed in double and rounded once more, which is exact for + - * / sqrt."""

    @staticmethod
    def value(bits: int) -> float:
        return struct.unpack("<f", struct.pack("<I", bits))[0]

    @staticmethod
    def bits(value: float) -> int:
        return struct.unpack("<I", struct.pack("<f", value))[0]


class Float64:
    @staticmethod
    def value(bits: int) -> float:
        return struct.unpack("<d", struct.pack("<Q", bits))[0]

    @staticmethod
    def bits(value: float) -> int:
        return struct.unpack("<Q", struct.pack("<d", value))[0]


def generator() -> Callable[[], int]:
    """The same xorshift64* as in the firmware."""
    state = 0x9E3779B97F4A7C15

    def step() -> int:
        nonlocal state
        state ^= state >> 12
        state = (state ^ state << 25) & MASK64
        state ^= state >> 27
        return state * 0x2545F4914F6CDD1D & MASK64

    return step


def results(kind: type, a: int, b: int) -> list[int]:
    x, y = kind.value(a), kind.value(b)
    values = (x + y, x - y, x * y, x / y, math.sqrt(abs(x)))
    return [kind.bits(value) for value in values]


def operand(step: Callable[[], int], kind: type) -> int:
    r = step()
    if kind is Float32:
        return r & 0x807FFFFF | (127 - 40 + (r >> 32) % 81) << 23
    exponent = 1023 - 200 + (step() >> 32) % 401
    return r & 0x800FFFFFFFFFFFFF | exponent << 52


def second(step: Callable[[], int], kind: type, a: int) -> int:
    if step() % 8 != 0:
        return operand(step, kind)
    near = a ^ (step() & 0xFF)
    return near if step() & 1 else near ^ (1 << (31 if kind is Float32 else 63))


def host_results(pairs: int) -> Iterator[tuple[str, int, int, list[int]]]:
    step = generator()
    for _ in range(pairs):
        for name, kind in (("f", Float32), ("d", Float64)):
            a = operand(step, kind)
            b = second(step, kind, a)
            yield name, a, b, results(kind, a, b)


def host_hashes(pairs: int) -> list[int]:
    """FNV-1a over all results, after every 64 pairs."""
    value, hashes = FNV_START, []
    for index, (_, _, _, bits) in enumerate(host_results(pairs)):
        for word in bits:
            for byte in word.to_bytes(8, "little"):
                value = (value ^ byte) * FNV_PRIME & MASK64
        if index % 128 == 127:
            hashes.append(value)
    return hashes


def test_every_result_is_correctly_rounded(check: Emulator) -> None:
    """+ - * / sqrt of 20,480 pairs each of float and double, bit for bit."""
    answer = check.command(f"f{PAIRS}", timeout_ms=60_000)
    board = [int(text, 16) for text in re.findall(r"h ([0-9a-f]{16})", answer)]
    host = host_hashes(PAIRS)
    assert len(board) == PAIRS // 64
    wrong = [index for index, (a, b) in enumerate(zip(host, board, strict=True)) if a != b]
    assert not wrong, f"first difference in pairs {64 * wrong[0]} to {64 * wrong[0] + 63}"


def test_operands_and_results_in_full(check: Emulator) -> None:
    """A few hundred pairs one by one: names the operation should the hashes ever differ."""
    answer = check.command("f-200", timeout_ms=20_000)
    rows = [line.split() for line in answer.splitlines() if line[:2] in ("f ", "d ")]
    board = [(name, *[int(word, 16) for word in words]) for name, *words in rows]
    host = [(name, a, b, *bits) for name, a, b, bits in host_results(200)]
    assert board == host
