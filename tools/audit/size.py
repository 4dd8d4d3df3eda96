#!/usr/bin/env python3
"""Prints what the firmware takes of flash and RAM, part by part, from the linker's map."""

from __future__ import annotations

import argparse
import re
import sys
from collections import Counter
from pathlib import Path

FLASH_START = 0x10000000
RAM_START = 0x20000000

# Where an object file comes from; the first pattern that fits names its row.
ORIGINS = [
    (re.compile(r"stepmite_port\.dir"), "firmware/port/rp2"),
    (re.compile(r"stepmite_main\.dir"), "firmware/main.c"),
    (re.compile(r"(\S+)/CMakeFiles/stepmite_\w+\.dir"), None),
    (re.compile(r"tinyusb"), "TinyUSB"),
    (re.compile(r"pico-sdk|pico_sdk|bs2_default"), "pico-sdk"),
    (re.compile(r"lib(c|m|g|gcc|nosys|stdc\+\+)\.a|crt\w*\.o"), "newlib, libgcc"),
]

# A section's line in the map; a long name stands on a line of its own before the numbers.
SECTION = re.compile(r"^ (\.?[\w.*]+)?\s+0x([0-9a-f]+)\s+0x([0-9a-f]+) (\S.*)$")
MEMORY = re.compile(r"^(FLASH|RAM|SCRATCH_[XY])\s+0x[0-9a-f]+\s+0x([0-9a-f]+)", re.MULTILINE)


def origin_of(path: str) -> str:
    """Return the row an object file belongs to."""
    for pattern, name in ORIGINS:
        if found := pattern.search(path):
            return name or found[1]
    return "other"


def measure(text: str) -> tuple[Counter[str], Counter[str]]:
    """Return bytes of flash and of RAM by origin; data with a start value count in both."""
    flash: Counter[str] = Counter()
    ram: Counter[str] = Counter()
    in_data = False
    for line in text[text.index("Linker script and memory map") :].splitlines():
        if line.startswith("."):
            in_data = line.startswith((".data", ".scratch"))
        found = SECTION.match(line)
        if not found or found[4].startswith("load address"):
            continue
        address, size, origin = int(found[2], 16), int(found[3], 16), origin_of(found[4])
        if address >= RAM_START:
            ram[origin] += size
        if FLASH_START <= address < RAM_START or (address >= RAM_START and in_data):
            flash[origin] += size
    return flash, ram


def table(text: str, storage_bytes: int) -> str:
    """Return the table as Markdown."""
    flash, ram = measure(text)
    sizes = {name: int(length, 16) for name, length in MEMORY.findall(text)}
    rows = ["| part | flash, bytes | RAM, bytes |", "| --- | ---: | ---: |"]
    for name, _ in (flash + ram).most_common():
        rows.append(f"| {name} | {flash[name]:,} | {ram[name]:,} |")
    rows.append(f"| total | {flash.total():,} | {ram.total():,} |")
    # The stack of the interrupts lies in one of the two banks behind the main memory.
    ram_bytes = sum(length for name, length in sizes.items() if name != "FLASH")
    rows.append(f"| available | {sizes['FLASH'] - storage_bytes:,} | {ram_bytes:,} |")
    return "\n".join(rows)


def main() -> int:
    """Print the table; fail if nothing of ours is in it: the map was misread."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("map", type=Path, help="for instance build/pico/stepmite-pico.elf.map")
    parser.add_argument(
        "--storage", type=int, default=1280 * 1024, help="bytes of flash kept for the user"
    )
    arguments = parser.parse_args()
    text = arguments.map.read_text(encoding="utf-8")
    print(table(text, arguments.storage))
    flash, ram = measure(text)
    return not (flash["firmware/port/rp2"] > 1000 and ram["firmware/port/rp2"] > 1000)


if __name__ == "__main__":
    sys.exit(main())
