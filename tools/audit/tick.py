#!/usr/bin/env python3
"""Checks in the linked firmware what the 100 kHz tick can reach, instruction by instruction.

From hal_on_tick on, over every call and jump: all code lies in RAM, nothing divides, nothing is
floating point, nothing calls through a pointer or reads a table from flash, nothing recurses; and
the stack it needs is counted.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field

RAM = range(0x20000000, 0x20090000)
EXCEPTION_FRAME_BYTES = (
    32  # what the core pushes by itself; Armv6-M, without a floating-point frame
)

# Helpers of the compiler that the tick must not need. (64-bit multiplication is short: allowed.)
FORBIDDEN_HELPER = re.compile(
    r"div|mod|__aeabi_[fd]|__aeabi_[a-z0-9]*2[fd]|float|double|sqrt|malloc|printf"
)
FORBIDDEN_INSTRUCTION = re.compile(r"^(udiv|sdiv|v[a-z0-9.]+|svc|bkpt|wfi|wfe|cpsid|cpsie)$")

FUNCTION = re.compile(r"^([0-9a-f]{8}) <([^>]+)>:$")
INSTRUCTION = re.compile(r"^\s*([0-9a-f]+):\t(?:[0-9a-f]{4} ?)+\s*\t([a-z0-9.]+)\s*(.*)$")
WORD = re.compile(r"^\s*([0-9a-f]+):\t[0-9a-f]{8}\s*\t\.word\t0x([0-9a-f]{8})")
TARGET = re.compile(r"^(?:r\d+, )?([0-9a-f]+) <([^>+]+)(\+0x[0-9a-f]+)?>")
BRANCH = re.compile(
    r"^(b|bl|blx|cbn?z|b(?:eq|ne|cs|cc|hs|lo|mi|pl|vs|vc|hi|ls|ge|lt|gt|le|al))(?:\.[nw])?$"
)


@dataclass
class Function:
    """One function of the disassembly."""

    name: str
    address: int
    callees: set[str] = field(default_factory=set)
    stack_bytes: int = 0
    faults: list[str] = field(default_factory=list)


def disassemble(objdump: str, elf: str) -> str:
    """Return objdump's listing of all code in the file, RAM functions (section .data) included."""
    command = [objdump, "-d", "--section=.text", "--section=.data", elf]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def flash_end_of(elf: str, nm: str) -> int:
    """Return the address behind the image in flash."""
    names = subprocess.run([nm, elf], check=True, capture_output=True, text=True).stdout
    found = re.search(r"^([0-9a-f]+) . __flash_binary_end$", names, re.MULTILINE)
    return int(found[1], 16) if found else 0x11000000


def stack_of(mnemonic: str, operands: str) -> int:
    """Return the bytes an instruction takes from the stack."""
    if mnemonic in ("push", "push.w", "stmdb", "stmdb.w") and (
        mnemonic.startswith("push") or operands.startswith("sp!")
    ):
        registers = operands[operands.index("{") + 1 : operands.index("}")]
        count = 0
        for part in registers.split(","):
            ends = [int(end) for end in re.findall(r"r(\d+)", part)]
            count += ends[1] - ends[0] + 1 if len(ends) == 2 else 1
        return 4 * count
    taken = re.match(r"^(?:sp, )?(?:sp, )?#(\d+)", operands)
    if mnemonic in ("sub", "subs", "sub.w", "subw") and operands.startswith("sp") and taken:
        return int(taken[1])
    return 0


def judge(function: Function, mnemonic: str, operands: str) -> None:
    """Add to the function what one instruction means for it."""
    function.stack_bytes += stack_of(mnemonic, operands)
    if FORBIDDEN_INSTRUCTION.match(mnemonic):
        function.faults.append(f"instruction {mnemonic} {operands}")
    through_register = mnemonic == "blx" and operands.startswith(("r", "ip", "lr"))
    jumps = mnemonic == "bx" and operands.split()[0] != "lr"
    writes_pc = re.match(r"^(pc,|pc$)", operands) and mnemonic.startswith(
        ("mov", "ldr", "add", "tb")
    )
    if through_register or jumps or writes_pc or mnemonic in ("tbb", "tbh"):
        function.faults.append(f"goes through a pointer: {mnemonic} {operands}")
    target = TARGET.match(operands) if BRANCH.match(mnemonic) else None
    is_loop = target and target[2] == function.name and not re.match(r"^blx?$", mnemonic)
    if target and not is_loop:
        function.callees.add(target[2])


@dataclass(frozen=True)
class Line:
    """A line of a listing that belongs to a function: a literal word, or an instruction."""

    word: int | None
    mnemonic: str = ""
    operands: str = ""


def lines_by_function(listing: str) -> Iterator[tuple[str, int, list[Line]]]:
    """Yield name, address and lines of each function of a listing."""
    name, address, lines = "", 0, list[Line]()
    for text in listing.splitlines():
        if header := FUNCTION.match(text):
            if name:
                yield name, address, lines
            name, address, lines = header[2], int(header[1], 16), []
        elif word := WORD.match(text):
            lines.append(Line(int(word[2], 16)))
        elif found := INSTRUCTION.match(text):
            operands = found[3].split("@")[0].split(";")[0].strip()
            lines.append(Line(None, found[2], operands))
    if name:
        yield name, address, lines


def parse(listing: str, flash_end: int) -> dict[str, Function]:
    """Return the functions of a listing by name."""
    functions: dict[str, Function] = {}
    for name, address, lines in lines_by_function(listing):
        function = functions[name] = Function(name, address)
        for line in lines:
            if line.word is None:
                judge(function, line.mnemonic, line.operands)
            elif 0x10000000 < line.word < flash_end:
                function.faults.append(f"uses flash at 0x{line.word:08x}")
    return functions


def audit(functions: dict[str, Function], root: str) -> tuple[list[str], list[str], int]:
    """Walk from `root`; return faults, functions reached, stack bytes of the deepest path."""
    faults: list[str] = []
    reached: list[str] = []

    def walk(name: str, path: tuple[str, ...]) -> int:
        where = " > ".join((*path, name))
        if name in path:
            faults.append(f"{where}: recursion")
            return 0
        function = functions.get(name)
        if function is None:
            faults.append(f"{where}: not in the listing")
            return 0
        if name not in reached:
            reached.append(name)
            if function.address not in RAM:
                faults.append(f"{where}: in flash (0x{function.address:08x})")
            if FORBIDDEN_HELPER.search(name):
                faults.append(f"{where}: a helper the tick must not need")
            faults.extend(f"{where}: {fault}" for fault in function.faults)
        below = (walk(callee, (*path, name)) for callee in sorted(function.callees))
        return function.stack_bytes + max(below, default=0)

    stack = walk(root, ())
    return faults, reached, stack


# Functions of tests/audit/tick_faults.c and what the audit has to say of each ('': nothing).
PLANTED = {
    "tick_clean": "",
    "tick_divides": "helper|sdiv|udiv",
    "tick_float": "helper",
    "tick_double": "helper",
    "tick_in_flash": "in flash",
    "tick_calls_flash": "in flash|uses flash",
    "tick_flash_table": "uses flash",
    "tick_pointer": "pointer",
    "tick_recursion": "recursion",
}


def self_test(functions: dict[str, Function]) -> list[str]:
    """Audit the planted functions; return those judged wrongly."""
    failures = []
    for root, expected in PLANTED.items():
        faults, _, stack = audit(functions, root)
        right = any(re.search(expected, fault) for fault in faults) if expected else not faults
        if not right:
            failures.append(f"{root}: expected '{expected}', got {faults}")
        if root == "tick_clean" and stack < 64:
            failures.append(f"tick_clean keeps 64 bytes on the stack, counted were {stack}")
    return failures


def main() -> int:
    """Run the audit or its self-test; the exit code tells whether all is well."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("elf")
    parser.add_argument(
        "--self-test", action="store_true", help="the file is tests/audit/tick_faults.c"
    )
    parser.add_argument("--prefix", default="arm-none-eabi-", help="of the tools' names")
    parser.add_argument("--root", default="hal_on_tick")
    parser.add_argument(
        "--max-stack", type=int, default=256, help="bytes, exception frame included"
    )
    arguments = parser.parse_args()
    flash_end = flash_end_of(arguments.elf, arguments.prefix + "nm")
    functions = parse(disassemble(arguments.prefix + "objdump", arguments.elf), flash_end)
    if arguments.self_test:
        failures = self_test(functions)
        print("\n".join(failures) or f"{len(PLANTED)} planted functions judged rightly")
        return bool(failures)
    faults, reached, stack = audit(functions, arguments.root)
    stack += EXCEPTION_FRAME_BYTES
    if stack > arguments.max_stack:
        faults.append(f"needs {stack} bytes of stack, allowed are {arguments.max_stack}")
    print(
        "\n".join(faults)
        or f"{', '.join(reached)}: in RAM, integers only, {stack} bytes of stack at most"
    )
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
