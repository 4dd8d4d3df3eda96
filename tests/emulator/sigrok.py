"""What sigrok's UART decoder, which knows nothing of us, makes of a recorded line."""

from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

NUMBERED = ["--protocol-decoder-samplenum"]


@dataclass(frozen=True)
class Byte:
    """A byte on the line, from its first data bit to its last one."""

    start_ns: int
    end_ns: int
    value: int


def decode(vcd: Path, gpio: int, baud: int) -> list[Byte]:
    """Return the bytes on the line of a pin, 8N1; AssertionError if the decoder has a complaint.

    The file's unit of time is a nanosecond.
    """
    decoder = f"uart:rx=GP{gpio}:baudrate={baud}:format=hex"
    rows = "uart=rx-data:rx-warnings:rx-break"
    answer = subprocess.run(
        ["sigrok-cli", "-I", "vcd", "-i", vcd, "-P", decoder, "-A", rows, *NUMBERED],
        text=True,
        capture_output=True,
        check=True,
        timeout=120,
    )
    assert answer.stderr == "", answer.stderr
    found = []
    for line in answer.stdout.splitlines():
        match = re.fullmatch(r"(\d+)-(\d+) uart-1: ([0-9A-F]{2})", line)
        assert match is not None, line  # "Frame error", "Break condition"
        found.append(Byte(int(match[1]), int(match[2]), int(match[3], 16)))
    return found


def frames(found: list[Byte], baud: int) -> list[list[Byte]]:
    """Cut the bytes where the line is idle for more than half a bit behind a stop bit."""
    groups: list[list[Byte]] = []
    for byte in found:
        pause = (byte.start_ns - groups[-1][-1].end_ns) * baud / 1e9 if groups else 0
        if not groups or pause > 2.5:  # a stop bit, a start bit
            groups.append([])
        groups[-1].append(byte)
    return groups


def write_vcd(rows: list[tuple[int, int, int]], gpio: int, path: Path) -> None:
    """Write the edges (time_ns, gpio, level) of one pin as a waveform file; it idles high."""
    lines = ["$timescale 1ns $end", f"$var wire 1 ! GP{gpio} $end", "$enddefinitions $end"]
    lines += ["#0", "1!"]
    for time_ns, pin, level in rows:
        if pin == gpio:
            lines += [f"#{time_ns}", f"{level}!"]
    lines.append(f"#{rows[-1][0] + 5_000_000}")
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
