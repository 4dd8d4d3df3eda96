"""Frames on a wire to driver chips, taken from the edges of the pin that sends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stepmite.trace import Edges


@dataclass(frozen=True)
class Frame:
    """Bytes that were sent without a gap."""

    start_ns: int
    """The edge of the first start bit."""
    end_ns: int
    """The end of the last stop bit."""
    data: bytes

    @property
    def text(self) -> str:
        """As in a table: "05 00 80"."""
        return self.data.hex(" ").upper()

    @property
    def is_write(self) -> bool:
        return len(self.data) == 8 and self.data[2] & 0x80 != 0

    @property
    def write(self) -> tuple[int, int, int]:
        """Address of the driver, register, value."""
        return self.data[1], self.data[2] & 0x7F, int.from_bytes(self.data[3:7], "big")


def crc(data: bytes) -> int:
    """Of a datagram: polynomial 0x07, the bits of each byte from the lowest on."""
    value = 0
    for byte in data:
        for bit in range(8):
            value = (value << 1 ^ (0x07 if (value >> 7 ^ byte >> bit) & 1 else 0)) & 0xFF
    return value


def frames(edges: Edges, gpio: int, baud: float = 115200) -> list[Frame]:
    """All frames of a wire whose idle line is high: 8 bits, low bit first, one stop bit."""
    mine, bit_ns = edges.of(gpio), 1e9 / baud

    def level_at(time_ns: float) -> int:
        at = int(np.searchsorted(mine.time_ns, time_ns, side="right"))
        return int(mine.level[at - 1]) if at > 0 else 1

    found: list[Frame] = []
    free_ns = -1.0
    for time_ns, level in zip(mine.time_ns, mine.level, strict=True):
        if level != 0 or time_ns < free_ns:
            continue
        assert level_at(time_ns + 0.5 * bit_ns) == 0, "a glitch"
        bits = [level_at(time_ns + (1.5 + i) * bit_ns) for i in range(9)]
        assert bits[8] == 1, "no stop bit"
        byte = sum(bit << i for i, bit in enumerate(bits[:8]))
        end_ns = time_ns + 10 * bit_ns
        free_ns = end_ns - 0.5 * bit_ns
        last = found[-1] if found else None
        if last is not None and time_ns - last.end_ns < 0.5 * bit_ns:
            found[-1] = Frame(last.start_ns, round(end_ns), last.data + bytes([byte]))
        else:
            found.append(Frame(int(time_ns), round(end_ns), bytes([byte])))
    return found


def writes(edges: Edges, gpio: int, baud: float = 115200) -> list[tuple[int, int, int]]:
    """What was written, in order: address of the driver, register, value."""
    sent = frames(edges, gpio, baud)
    assert all(frame.data[-1] == crc(frame.data[:-1]) for frame in sent)
    return [frame.write for frame in sent if frame.is_write]
