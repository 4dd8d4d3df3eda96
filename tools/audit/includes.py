#!/usr/bin/env python3
"""Checks who includes whom: the firmware's architecture as a table.

A folder's face is the header with the folder's name. Other folders include that face and nothing
else, and only in the direction the table allows; the rest of the rules is below. Run it with no
argument on the tree it is in.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from pathlib import Path

# Folder -> folders whose face it may include. Its own headers are always allowed.
ALLOWED: dict[str, list[str]] = {
    "firmware/base": [],
    "firmware/hal": ["firmware/base"],
    "firmware/files": ["firmware/base", "firmware/hal"],
    "firmware/basic": ["firmware/base", "firmware/hal", "firmware/files"],
    "firmware/io": ["firmware/base", "firmware/hal"],
    "stepper": ["firmware/base", "firmware/hal"],
    "tmc22xx": ["firmware/base", "firmware/hal"],
    "gcode": ["firmware/base", "firmware/files", "stepper"],
    "basic_cmds": [
        "firmware/base",
        "firmware/basic",
        "firmware/io",
        "stepper",
        "gcode",
        "tmc22xx",
    ],
    "firmware/port/host": ["firmware/base", "firmware/hal"],
    "firmware/port/rp2": ["firmware/base", "firmware/hal"],
    "firmware": [
        "firmware/base",
        "firmware/hal",
        "firmware/basic",
        "firmware/io",
        "stepper",
        "gcode",
        "tmc22xx",
        "basic_cmds",
    ],
}

# Second faces: headers that others may include because they have nothing to do with the first.
ALSO_FACES = {
    "firmware/hal/hal_i2c.h",
    "firmware/hal/hal_io.h",
    "firmware/hal/hal_serial.h",
    "firmware/hal/hal_spi.h",
    "firmware/hal/hal_wire.h",
    "firmware/hal/pins.h",
    "firmware/hal/slices.h",
    "firmware/io/io_bus.h",
    "firmware/io/io_serial.h",
    "firmware/basic/basic_device.h",
    "stepper/rules.h",
    "stepper/stepper_axes.h",
    "stepper/stepper_check.h",
    "stepper/stepper_estimate.h",
    "stepper/stepper_homing.h",
    "stepper/stepper_outputs.h",
    "stepper/stepper_safety.h",
    "gcode/gcode_job.h",
    "gcode/gcode_survey.h",
    "tmc22xx/tmc22xx_registers.h",
}

# Includes that lead out of the table: the inline half of hal.h, and what the build generates.
HAL_PORT = ("firmware/hal/hal.h", "hal_port.h")
GENERATED = {"version.h", "tmc_uart.pio.h"}

C_LIBRARY = set(
    """
    assert.h ctype.h errno.h float.h inttypes.h limits.h locale.h math.h setjmp.h signal.h stdarg.h
    stdbool.h stddef.h stdint.h stdio.h stdlib.h string.h time.h
    """.split()  # noqa: SIM905
)
LIBRARIES = {"firmware/files": {"lfs.h"}}
SDK = re.compile(r"^(pico|hardware|boot)/|^(tusb|pico)\.h$")

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
EXTERN = re.compile(r"^[ \t]*extern\b", re.MULTILINE)


def folder_of(path: str) -> str:
    """Return the part that a file belongs to: the longest row that fits, '' if none."""
    fitting = [folder for folder in ALLOWED if path.startswith(folder + "/")]
    return max(fitting, key=len, default="")


def face_of(folder: str) -> str:
    """Return the path of the folder's face."""
    return f"{folder}/{Path(folder).name}.h"


def resolve(root: Path, source: str, name: str) -> str | None:
    """Return the path that `#include "name"` in `source` means, None if it is not ours."""
    for base in (Path(source).parent, Path("firmware"), Path(".")):
        if (root / base / name).is_file():
            return (base / name).as_posix()
    return None


def check_include(root: Path, source: str, bracket: str, name: str) -> str | None:
    """Return what is wrong with one include line, or None."""
    folder = folder_of(source)
    if bracket == "<":
        if name in C_LIBRARY or folder == "firmware/port/host":
            return None
        return f"<{name}> is not the C library's"
    target = resolve(root, source, name)
    if target is None:
        if name in GENERATED and folder.startswith("firmware/port/"):
            return None
        if (source, name) == HAL_PORT or (SDK.search(name) and folder == "firmware/port/rp2"):
            return None
        if name in LIBRARIES.get(folder, ()):
            return None
        return f'"{name}" belongs to nobody who may be included here'
    other = folder_of(target)
    if other == folder:
        return None
    if other not in ALLOWED[folder]:
        return f'"{name}": {folder} may not include {other or "this"}'
    if target != face_of(other) and target not in ALSO_FACES:
        return f'"{name}" is not the face of {other} ({face_of(other)})'
    return None


def is_umbrella(path: str, code: str) -> bool:
    """Tell whether a header other than a face does nothing but include others."""
    if (
        not path.endswith(".h")
        or path == face_of(folder_of(path))
        or len(INCLUDE.findall(code)) < 2
    ):
        return False
    rest = re.sub(r"^\s*#.*$", "", code, flags=re.MULTILINE)
    return not rest.strip()


def check_file(root: Path, path: str) -> list[str]:
    """Return the faults of one file, each with its line number."""
    text = (root / path).read_text(encoding="utf-8")
    code = COMMENT.sub(lambda match: "\n" * match[0].count("\n"), text)
    faults = []
    for match in INCLUDE.finditer(code):
        wrong = check_include(root, path, match[1], match[2])
        if wrong is not None:
            faults.append(f"{path}:{code.count(chr(10), 0, match.start(2)) + 1}: {wrong}")
    if path.endswith(".c"):
        for match in EXTERN.finditer(code):
            line = code.count("\n", 0, match.end()) + 1
            faults.append(
                f"{path}:{line}: extern in a .c file; include the header that declares it"
            )
    if is_umbrella(path, code):
        faults.append(f"{path}:1: an umbrella header; include what is needed where it is needed")
    return faults


def audit(root: Path) -> tuple[int, list[str]]:
    """Return the number of files looked at and all faults."""
    tops = sorted({folder.split("/")[0] for folder in ALLOWED})
    paths = sorted(
        path.relative_to(root).as_posix() for top in tops for path in (root / top).rglob("*.[ch]")
    )
    return len(paths), [fault for path in paths for fault in check_file(root, path)]


# Files of a small tree, and what the audit has to say about each of them ('' for nothing).
PLANTED: dict[str, tuple[str, str]] = {
    "firmware/base/base.h": ('#include "base/err.h"\n#include <stdint.h>\n', ""),
    "firmware/base/err.h": ("int err;\n", ""),
    "firmware/hal/hal.h": ('#include "base/base.h"\n#include "hal_port.h"\nint h;\n', ""),
    "firmware/port/rp2/hal_port.h": ('#include "hardware/sync.h"\nint p;\n', ""),
    "firmware/port/host/pads.c": (
        '#include <poll.h>\n#include "hal/hal.h"\n#include "version.h"\n',
        "",
    ),
    "firmware/basic/basic.h": ('#include "base/base.h"\nint b;\n', ""),
    "stepper/stepper.h": ('// #include "gcode/gcode.h"\n#include "base/base.h"\nint s;\n', ""),
    "gcode/gcode.h": ('#include "stepper/stepper.h"\nint g;\n', ""),
    "stepper/upward.c": ('#include "gcode/gcode.h"\n', "stepper may not include gcode"),
    "stepper/sideways.c": ('#include "basic/basic.h"\n', "may not include firmware/basic"),
    "gcode/not_face.c": ('#include "base/err.h"\n', "not the face of firmware/base"),
    "firmware/files/flash.c": ('#include "lfs.h"\n', ""),
    "gcode/library.c": ('#include "lfs.h"\n', "belongs to nobody"),
    "gcode/skips.c": ('#include "hal/hal.h"\n', "may not include firmware/hal"),
    "stepper/sdk.c": ('#include "hardware/gpio.h"\n', "belongs to nobody"),
    "stepper/posix.c": ("#include <unistd.h>\n", "not the C library's"),
    "stepper/extern.c": ("// extern\nextern int x;\n", "extern in a .c file"),
    "gcode/all.h": ('#include "gcode/gcode.h"\n#include "stepper/stepper.h"\n', "umbrella"),
    "firmware/base/up.c": ('#include "hal/hal.h"\n', "may not include firmware/hal"),
}


def self_test() -> list[str]:
    """Plant one fault of every kind in a small tree; return what was not said or said wrongly."""
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        for path, (text, _) in PLANTED.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text, encoding="utf-8")
        failures = []
        for path, (_, expected) in PLANTED.items():
            faults = check_file(root, path)
            right = len(faults) == 1 and expected in faults[0] if expected else not faults
            if not right:
                failures.append(f"{path}: expected '{expected}', got {faults}")
        return failures


def main() -> int:
    """Run the audit or its self-test; the exit code tells whether all is well."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--self-test", action="store_true", help="show that planted faults are found"
    )
    arguments = parser.parse_args()
    if arguments.self_test:
        failures = self_test()
        print("\n".join(failures) or f"{len(PLANTED)} planted files judged rightly")
        return bool(failures)
    count, faults = audit(Path(__file__).resolve().parents[2])
    print("\n".join(faults) or f"{count} files keep the include rules")
    return bool(faults) or count == 0


if __name__ == "__main__":
    sys.exit(main())
