#!/usr/bin/env python3
"""Checks that nothing in the linked firmware can allocate.

There is no heap: what the linker leaves of the RAM belongs to BASIC. The C library allocates where
one does not expect it (printf and strtod with doubles), so any name of its allocator in the image
is a fault.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys

SYMBOL = re.compile(r"^[0-9a-f]{8} [tTwW] (\S+)$", re.MULTILINE)
ALLOCATES = re.compile(
    r"(__wrap_|_)*(malloc|calloc|realloc|free|sbrk|balloc|dtoa|strtod|strtold)(_r|_l)*"
    r"|_*[a-z]{0,4}printf(_r)?"
)
NAMES = {
    "_malloc_r": True,
    "__wrap_calloc": True,
    "_sbrk": True,
    "_dtoa_r": True,
    "_Balloc": True,
    "snprintf": True,
    "_svfprintf_r": True,
    "strtod_l": True,
    "memory_free": False,
    "basic_printf": False,
    "format_text": False,
    "console_write": False,
}


def audit(symbols: list[str]) -> list[str]:
    """Return the names that allocate."""
    return sorted({name for name in symbols if ALLOCATES.fullmatch(name.lower())})


def main() -> int:
    """Run the audit or its self-test; the exit code tells whether all is well."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("elf")
    parser.add_argument("--prefix", default="arm-none-eabi-", help="of the tools' names")
    arguments = parser.parse_args()
    expected = sorted(name for name, allocates in NAMES.items() if allocates)
    if audit(list(NAMES)) != expected:
        print(f"of the planted names these were found: {audit(list(NAMES))}")
        return 1
    command = [arguments.prefix + "nm", arguments.elf]
    listing = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    symbols = SYMBOL.findall(listing)
    found = audit(symbols)
    if found:
        print(f"{', '.join(found)}: use format_text() and num_parse() of firmware/base")
    elif "main" not in symbols:
        print("no main() in the image: its names were misread")
        return 1
    else:
        print(f"none of {len(symbols)} functions allocates")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
