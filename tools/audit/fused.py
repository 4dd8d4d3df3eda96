#!/usr/bin/env python3
"""Checks that the linked firmware has no fused multiply-add.

Host and board make the same step train because every float operation is rounded by itself. A fused
one rounds once for two operations and would change the last bit of a segment.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys

FUNCTION = re.compile(r"^[0-9a-f]{8} <([^>]+)>:$")
FUSED = re.compile(r"\t(vfn?m[as]\.\w+|vn?ml[as]\.f\w+|fn?m(?:add|sub)\b.*)\t?")
ARITHMETIC = re.compile(r"\tv(?:add|mul)\.f")

PLANTED = """
10000100 <sum>:
10000100:\tee70 7a27 \tvadd.f32\ts15, s0, s15
10000104:\tee67 7a20 \tvmul.f32\ts15, s14, s1
10000200 <fused>:
10000200:\teee6 7a27 \tvfma.f32\ts15, s12, s15
10000300 <chained>:
10000300:\tee47 7a20 \tvmls.f32\ts15, s14, s1
"""


def audit(listing: str) -> list[str]:
    """Return a line for each fused operation."""
    faults, name = [], ""
    for line in listing.splitlines():
        if header := FUNCTION.match(line):
            name = header[1]
        elif found := FUSED.search(line):
            faults.append(f"{name}: {found[1]}")
    return faults


def main() -> int:
    """Run the audit; the exit code tells whether all is well."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("elf")
    parser.add_argument("--fpu", action="store_true", help="the core has one: float code is there")
    parser.add_argument("--prefix", default="arm-none-eabi-", help="of the tools' names")
    arguments = parser.parse_args()
    if audit(PLANTED) != ["fused: vfma.f32", "chained: vmls.f32"]:
        print("the planted operations were not found")
        return 1
    command = [arguments.prefix + "objdump", "-d", arguments.elf]
    listing = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    faults = audit(listing)
    operations = len(ARITHMETIC.findall(listing))
    if arguments.fpu and operations == 0:
        faults.append("no float operation at all: the listing was misread")
    print("\n".join(faults) or f"{operations} float additions and multiplications, none fused")
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
