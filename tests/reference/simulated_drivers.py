"""Driver chips beside the host program: the lines that describe them, and what becomes of them."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path

FULL_STEP = 256
"""Parts of a full step in which places of rotors count."""


@dataclass(frozen=True)
class Driver:
    """A driver chip, with its motor if it has an axis."""

    axis: str = ""
    address: int = 0
    tx: int = 26
    rx: int | None = None
    diag: int | None = None
    enable: int | None = None
    chip: int = 2209
    ends_mm: tuple[float, float] | None = None
    """Where the axis is held, counted from where it stands at power-up."""
    microsteps: int = 16
    """In which places of the axis count; those of the driver are in its registers."""
    load_ma: int = 80
    """A current that just overcomes the friction."""
    faults: tuple[str, ...] = ()
    """As "bad-crc:3@2000": three frames from 2 s on. Places are in steps."""
    more: str = ""
    """Other words of the line."""

    def row(self) -> str:
        words = [f"tmc{self.chip} tx=GP{self.tx} address={self.address}"]
        words.append(f"microsteps={self.microsteps} load_ma={self.load_ma}")
        words += [f"axis={self.axis}"] if self.axis else []
        for key in ("rx", "diag", "enable"):
            gpio = getattr(self, key)
            words += [f"{key}=GP{gpio}"] if gpio is not None else []
        return " ".join([*words, *(f"fault={fault}" for fault in self.faults), self.more])


@dataclass(frozen=True)
class Report:
    """What the host program tells of the drivers (--machine-report)."""

    events: list[dict] = field(default_factory=list)
    """What they took from the wire and what DIAG did: keys ms, driver, do ("write", "read",
    "diag"), register, address, value."""
    axes: list[dict] = field(default_factory=list)
    """name, position, pulses."""
    drivers: list[dict] = field(default_factory=list)
    """How they are at the end: rotor, slips, microsteps, current_ma, registers and so on."""

    @staticmethod
    def read(file: Path) -> Report:
        rows = [json.loads(line) for line in file.read_text().splitlines()]
        return Report(rows[:-1], rows[-1]["axes"], rows[-1]["drivers"])

    def register(self, name: str, driver: int = 0) -> int:
        """What a register holds at the end."""
        return self.drivers[driver]["registers"][name]

    def told(self, do: str, driver: int = 0, register: str | None = None) -> list[dict]:
        """What was written ("write"), asked ("read") or shown ("diag"), in order."""
        return [
            event
            for event in self.events
            if event["do"] == do
            and event["driver"] == driver
            and register in (None, event.get("register"))
        ]

    def full_steps(self, driver: int = 0) -> float:
        """Where the rotor of a driver stands, in full steps from where the axis began to count."""
        return self.drivers[driver]["rotor"] / FULL_STEP
