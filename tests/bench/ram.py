"""Who uses the RAM of an RP2040: the linker's map and names, and what the prompt says is left."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

from stepmite.emulator import PROJECT, Emulator

sys.path.insert(0, str(PROJECT / "tools" / "audit"))
import size

RAM_BYTES = 264 * 1024
INTERRUPT_STACK_BYTES = 4096
GUARD_BYTES = 2048  # of rp2_memory.c
PROMPT_RESERVE_BYTES = 4096  # MEMORY_PROMPT_RESERVE of firmware/basic/memory.h
GOAL_BYTES = 100 * 1024
FREE = re.compile(r"free (\d+) of (\d+) bytes")

WHAT = {
    "stepper": "the rest of the motion",
    "firmware/basic": "BASIC: the VM's frames, line editor, console",
    "firmware/port/rp2": "the port: UART rings, vectors",
    "pico-sdk": "pico-sdk: tables of the boot ROM's functions, alarms",
}


def ready(board: Emulator) -> int:
    """Set up the largest block ring there is; return the bytes left for program and variables."""
    assert "rror" not in board.command("STEPPER INIT ,1024")
    found = FREE.search(board.command("MEMORY"))
    assert found
    return int(found[1]) - PROMPT_RESERVE_BYTES


def symbols(elf: Path) -> dict[str, tuple[int, int]]:
    """Return address and size of the image's names; of two that are called the same the larger."""
    command = ["arm-none-eabi-nm", "-S", str(elf)]
    listing = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    found: dict[str, tuple[int, int]] = {}
    for address, length, name in re.findall(
        r"^([0-9a-f]{8}) (?:([0-9a-f]{8}) )?\w (\S+)$", listing, re.MULTILINE
    ):
        bytes_ = int(length or "0", 16)
        if name not in found or found[name][1] < bytes_:
            found[name] = (int(address, 16), bytes_)
    return found


def rows(uf2: Path, program_bytes: int) -> list[tuple[str, int]]:
    """Return what and how many bytes; all of the RAM is in one of the rows."""
    names = symbols(uf2.with_suffix(".elf"))
    _, ram = size.measure(uf2.with_suffix(".elf.map").read_text(encoding="utf-8"))
    # The map's rows for the interrupts' stack and the heap are the SDK's.
    ram["pico-sdk"] -= INTERRUPT_STACK_BYTES
    ring = names["blocks"][1]
    ram["stepper"] -= ring
    end, stack = names["rp2_variables_end"][0], names["rp2_main_stack"][0]
    main_stack = names["rp2_main_stack_top"][0] - stack
    arena = stack - end
    variables = [(WHAT.get(name, name), count) for name, count in ram.most_common() if count >= 100]
    listed = [
        ("program and variables of BASIC", program_bytes),
        ("BASIC's stack of values, and what frames its program", 0),
        ("kept free for the prompt", PROMPT_RESERVE_BYTES),
        ("the block ring, 1024 moves", ring),
        ("main's stack, of it 2048 bytes of guard", main_stack),
        ("the interrupts' stack", INTERRUPT_STACK_BYTES),
        *variables,
    ]
    listed[1] = (listed[1][0], arena - program_bytes - PROMPT_RESERVE_BYTES)
    listed.append(("small ones and gaps", RAM_BYTES - sum(count for _, count in listed)))
    return listed


def table(uf2: Path) -> str:
    """Return the rows as Markdown."""
    with Emulator(uf2) as board:
        board.connect()
        board.until("> ")
        program_bytes = ready(board)
    lines = ["| what | RAM, bytes |", "| --- | ---: |"]
    lines += [f"| {what} | {count:,} |" for what, count in rows(uf2, program_bytes)]
    lines.append(f"| total | {RAM_BYTES:,} |")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table(Path(sys.argv[1])))
