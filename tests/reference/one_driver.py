"""A simulated driver of the X axis on GP21, and what was written to it."""

from __future__ import annotations

from pathlib import Path

from typed import Session, typed
from wire_frames import writes

TX = 21
AXIS_X = "axis X step=GP2 dir=GP3"
ONE = [AXIS_X, "tmc2209 tx=GP21 address=0 axis=X"]
BARE = ["tmc2209 tx=GP21 address=0"]
SET_UP = "TMC22xx GP21, 2209, 0, 800, 30, 16"
TIE = "TMC22xx AXIS 0, X"
IHOLD_IRUN, TPWMTHRS, TCOOLTHRS, SGTHRS, COOLCONF = 0x10, 0x13, 0x14, 0x40, 0x42


def driven(folder: Path, *lines: str, drivers: list[str] | tuple = ONE, **more: list) -> Session:
    """Type the lines with a simulated driver of the X axis on GP21."""
    return typed(folder, *lines, drivers=drivers, **more)


def last_write(session: Session, register: int) -> int:
    """The value written to a register last."""
    return [value for _, reg, value in writes(session.edges, TX) if reg == register][-1]
