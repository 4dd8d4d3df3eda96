#!/usr/bin/env python3
"""Checks in the linked firmware what interrupts reach and how much stack they need at worst.

Interrupts nest: the governor, on top of it one of the SDK's handlers, on top of that the tick, and
a fault. They share the core's main stack. From each handler on, over every call, the bytes that a
function takes are added up from its instructions; calls through pointers have to be in the table
below. Nothing of it may allocate, print or recurse. Of the main loop's stack one
thing is checked: no function takes more at once than the guard below that stack is long, or it
could step over the guard without touching it.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from dataclasses import dataclass, field

from tick import disassemble, lines_by_function, stack_of

# What the core puts on the stack, with four bytes to align it: Armv6-M, and Armv8-M with room for
# the floating-point registers.
FRAME_BYTES = {"v6": 32 + 4, "v8": 104 + 4}
# A function of the boot ROM (float arithmetic, memcpy): not in the listing, none takes more.
ROM_BYTES = 128
# The same for doubles on the RP2350: hand-written, for its coprocessor, whose state they save by
# jumping into code that the listing takes for part of a neighbour.
DOUBLE_ARITHMETIC = re.compile(r"__wrap___aeabi_(d\w+|\w+2d)|__wrap_sqrt|double2\w+")

# From the lowest priority to the highest. Handlers of one row do not interrupt each other.
LEVELS = [
    ["governor_irq"],
    [
        "low_priority_worker_irq",
        "dcd_rp2040_irq",
        "usb_irq",
        "uart_irq",
        "on_edge",
        "irq_0",
        "irq_1",
        "hardware_alarm_irq_handler",
        "alarm_pool_irq_handler",
    ],
    ["hal_on_tick"],
    ["isr_hardfault"],
]

# Who may call through a pointer, and whom. Nobody: the boot ROM, or a hook that is never set.
POINTERS: dict[str, list[str]] = {
    r"alarm_pool_irq_handler": ["timer_task"],
    r"hardware_alarm_irq_handler": ["on_alarm", "call_handler"],
    r"call_handler": ["run_due"],
    r"tud_task_ext": ["cdcd_xfer_cb", "resetd_xfer_cb", "process_control_request"],
    r"process_control_request|process_get_descriptor|usbd_control_xfer_cb|configuration_reset": [
        "cdcd_control_xfer_cb",
        "resetd_control_xfer_cb",
        "cdcd_open",
        "resetd_open",
        "cdcd_reset",
        "resetd_reset",
    ],
    r"low_priority_worker_irq|dcd_event_handler": [],
    r"rom_[\w.]+": [],
    r"__wrap_(memset|memcpy|__aeabi_\w+|sqrtf)|__aeabi_\w+|f2fix|float2int(64)?|\w+_shim\w*": [],
    r"isr_hardfault": ["fault_at"],
}

FORBIDDEN = re.compile(r"alloc|sbrk|printf|dtoa|strtod|^(puts|abort)$")
TARGET = re.compile(r"(?:^|, )([0-9a-f]{8}) <([^>+]+)(\+0x[0-9a-f]+)?>")
CALL = re.compile(r"^(bl?|cbn?z|b(eq|ne|cs|cc|hs|lo|mi|pl|vs|vc|hi|ls|ge|lt|gt|le|al))(\.[nw])?$")
VENEER = re.compile(r"^__(\w+)_veneer$")


@dataclass
class Function:
    """One function of the disassembly."""

    name: str
    address: int
    callees: set[int] = field(default_factory=set)
    calls: bool = False
    through_pointer: bool = False
    stack_bytes: int = 0
    large_frame: bool = False
    literals: list[int] = field(default_factory=list)


def goes_through_pointer(mnemonic: str, operands: str) -> bool:
    """Tell whether an instruction jumps to an address in a register; jump tables do not count."""
    if mnemonic in ("blx", "bx"):
        return re.match(r"(r\d+|ip|sl|fp)\b", operands) is not None
    is_return = operands.startswith("pc, [sp]")
    return operands.startswith("pc,") and mnemonic.startswith("ldr") and not is_return


def taken_by(mnemonic: str, operands: str) -> int:
    """Return the bytes an instruction takes from the stack."""
    if before := re.search(r"\[sp, #-(\d+)\]!", operands):
        return int(before[1])
    if mnemonic == "vpush":
        return 8 * len(re.findall(r"[ds]\d+", operands)) * (8 if "-" in operands else 1)
    return stack_of(mnemonic, operands)


def parse(listing: str) -> dict[int, Function]:
    """Return the functions of a listing by address."""
    functions: dict[int, Function] = {}
    for name, address, lines in lines_by_function(listing):
        current = functions[address] = Function(name, address)
        for line in lines:
            if line.word is not None:
                current.literals.append(line.word)
                continue
            mnemonic, operands = line.mnemonic, line.operands
            current.stack_bytes += taken_by(mnemonic, operands)
            current.large_frame |= mnemonic == "add" and re.match(r"sp, r", operands) is not None
            current.through_pointer |= goes_through_pointer(mnemonic, operands)
            target = TARGET.search(operands) if CALL.match(mnemonic) else None
            if target and not (target[3] and target[2] == current.name):
                start = int(target[1], 16) - int(target[3] or "0", 16)
                current.callees.add(start)
                current.calls |= mnemonic == "bl"
    for function in functions.values():
        if function.large_frame:  # add sp, rN: the size is a negative number behind the code
            sizes = [2**32 - word for word in function.literals if word > 2**32 - 2**16]
            function.stack_bytes += max(sizes, default=0)
    return functions


class Walk:
    """The way from one handler on."""

    def __init__(self, functions: dict[int, Function]) -> None:
        self.functions = functions
        self.by_name = {function.name: function for function in functions.values()}
        self.faults: list[str] = []
        self.deepest: dict[int, int] = {}

    def callees(self, function: Function, where: str) -> tuple[list[Function], int]:
        """Return whom a function calls, and the bytes it needs beyond the listing."""
        callees = [self.functions[at] for at in function.callees if at in self.functions]
        if not function.through_pointer:
            return callees, 0
        if veneer := VENEER.match(function.name):
            names: list[str] | None = [veneer[1]]
        else:
            names = next(
                (to for who, to in POINTERS.items() if re.fullmatch(who, function.name)), None
            )
        if names is None:
            self.faults.append(f"{where}: calls through a pointer that is not in the table")
            return callees, 0
        found = [self.by_name[name] for name in names if name in self.by_name]
        return callees + found, 0 if found else ROM_BYTES

    def bytes_from(self, function: Function, path: tuple[str, ...] = ()) -> int:
        """Return the stack that a function needs with all it calls."""
        if function.name in path:
            cycle = path[path.index(function.name) :]
            if not any(self.by_name[name].calls for name in cycle):
                return 0  # jumps between labels of hand-written code: a loop
            self.faults.append(f"{' > '.join((*path, function.name))}: recursion")
            return 0
        if function.address in self.deepest:
            return self.deepest[function.address]
        if DOUBLE_ARITHMETIC.fullmatch(function.name):
            return ROM_BYTES
        where = " > ".join((*path, function.name))
        if FORBIDDEN.search(function.name):
            self.faults.append(f"{where}: not in an interrupt")
            return 0
        callees, below = self.callees(function, where)
        for callee in callees:
            below = max(below, self.bytes_from(callee, (*path, function.name)))
        self.deepest[function.address] = function.stack_bytes + below
        return self.deepest[function.address]


def audit(
    functions: dict[int, Function], stack_bytes: int, frame: int, levels: list[list[str]]
) -> tuple[list[str], str]:
    """Add up the worst nesting; return faults and a line that says what it is made of."""
    walk = Walk(functions)
    total, terms = 0, []
    for level in levels:
        present = [walk.by_name[name] for name in level if name in walk.by_name]
        if not present:
            walk.faults.append(f"none of {', '.join(level)} is in the image")
            continue
        need, name = max((walk.bytes_from(function), function.name) for function in present)
        total += need + frame
        terms.append(f"{name} {need}")
    if total > stack_bytes:
        walk.faults.append(f"interrupts need {total} bytes of stack, there are {stack_bytes}")
    return walk.faults, f"{' + '.join(terms)} + {len(terms)} frames of {frame}: {total} bytes"


# Functions of tests/audit/tick_faults.c and what the audit has to say of each ('': nothing).
PLANTED = {
    "tick_clean": "",
    "tick_pointer": "through a pointer",
    "tick_recursion": "recursion",
    "tick_allocates": "not in an interrupt",
}
PLANTED_STACK = range(64, 128)  # of tick_clean


def self_test(functions: dict[int, Function]) -> list[str]:
    """Walk over the planted functions; return what was judged wrongly."""
    failures = []
    for name, expected in PLANTED.items():
        walk = Walk(functions)
        need = walk.bytes_from(walk.by_name[name])
        right = any(expected in fault for fault in walk.faults) if expected else not walk.faults
        if not right:
            failures.append(f"{name}: expected '{expected}', got {walk.faults}")
        if name == "tick_clean" and need not in PLANTED_STACK:
            failures.append(f"{name}: {need} bytes of stack")
    if not any(
        "bytes of stack" in fault for fault in audit(functions, 64, 36, [["tick_clean"]])[0]
    ):
        failures.append("an overfull stack was not noticed")
    return failures


def symbols(nm: str, elf: str) -> dict[str, int]:
    """Return the addresses of the image's names."""
    lines = subprocess.run([nm, elf], check=True, capture_output=True, text=True).stdout
    return {name: int(at, 16) for at, name in re.findall(r"^([0-9a-f]{8}) \w (\S+)$", lines, re.M)}


def main() -> int:
    """Run the audit; the exit code tells whether all is well."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("elf")
    parser.add_argument(
        "--self-test", action="store_true", help="the file is tests/audit/tick_faults.c"
    )
    parser.add_argument("--prefix", default="arm-none-eabi-", help="of the tools' names")
    parser.add_argument("--core", choices=sorted(FRAME_BYTES), default="v6")
    parser.add_argument("--guard", type=int, default=0, help="bytes; 0: the core checks itself")
    arguments = parser.parse_args()
    functions = parse(disassemble(arguments.prefix + "objdump", arguments.elf))
    if arguments.self_test:
        failures = self_test(functions)
        print("\n".join(failures) or f"{len(PLANTED)} planted functions judged rightly")
        return bool(failures)
    names = symbols(arguments.prefix + "nm", arguments.elf)
    stack = names["__StackTop"] - names["__StackBottom"]
    faults, text = audit(functions, stack, FRAME_BYTES[arguments.core], LEVELS)
    largest = max(functions.values(), key=lambda function: function.stack_bytes)
    if arguments.guard and largest.stack_bytes > arguments.guard:
        faults.append(
            f"{largest.name} takes {largest.stack_bytes} bytes at once and could step over the"
            f" guard of {arguments.guard}"
        )
    print(
        "\n".join(faults)
        or f"{text} of {stack}; {largest.name} takes most at once: {largest.stack_bytes}"
    )
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
