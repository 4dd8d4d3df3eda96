"""What stays in force between the lines of a G-code program."""

from __future__ import annotations

from dataclasses import dataclass, field

from stepmite.arcs import Arc, Position

AXES = "XYZA"
"""Axis letters in the order of every position tuple; X Y Z in mm, A in degrees."""

WORK_SYSTEMS = 9
TOOLS = 16


@dataclass(frozen=True)
class PathMode:
    """How corners are passed."""

    kind: str = "G64"
    """"G61" exact path, "G61.1" exact stop at each end, "G64" continuous."""
    tolerance_mm: float = 0.0
    """G64 P: how far a blend may leave the corner; 0: the path is exact, by junction deviation."""


@dataclass(frozen=True)
class Block:
    """One entry of the block ring."""

    kind: str
    """"move", "dwell", "spindle", "coolant", "pause" or "home"."""
    line_number: int
    target: Position
    """Machine position at the end of the block, mm and degrees."""
    feed_per_min: float | None = None
    """mm/min (deg/min where only A moves); None: as fast as the axes can (G0)."""
    dwell_s: float = 0.0
    spindle_on: bool = False
    clockwise: bool = True
    speed_rpm: float = 0.0
    """S, of a spindle that is on; a move carries it as well."""
    coolant: str = ""
    """What is on: "", "flood", "mist" or "flood mist"."""
    arc: Arc | None = None
    """The arc of G2 and G3; None: a straight line."""
    path_mode: PathMode = PathMode()
    """In force at the corner before the block."""


@dataclass
class Offsets:
    """What lies between machine and work coordinates, in mm and degrees.

    Machine = work + the system in force + the shift + the tool.
    """

    system: int = 0
    """The work coordinate system in force, 0 for G54."""
    systems: list[list[float]] = field(
        default_factory=lambda: [[0.0] * 4 for _ in range(WORK_SYSTEMS)]
    )
    shift: list[float] = field(default_factory=lambda: [0.0] * 4)
    """G92."""
    kept_shift: list[float] = field(default_factory=lambda: [0.0] * 4)
    """What G92.3 brings back."""
    tool_mm: float = 0.0
    tools: list[float] = field(default_factory=lambda: [0.0] * (TOOLS + 1))
    """Lengths of G43 H, by G10 L1."""

    def total(self) -> list[float]:
        """Return the sum for each axis."""
        sums = [a + b for a, b in zip(self.systems[self.system], self.shift, strict=True)]
        sums[2] += self.tool_mm
        return sums

    def place(self, axis: int, value: float, position: Position, shifts: bool) -> None:
        """Make `position` have the work coordinate `value`, by G92 or by the system in force."""
        other = self.total()[axis] - (self.shift if shifts else self.systems[self.system])[axis]
        (self.shift if shifts else self.systems[self.system])[axis] = position[axis] - other - value


@dataclass
class Series:
    """Lines of canned cycles that follow each other."""

    code: str
    initial: float
    """Machine coordinate of the drilling axis before the first one."""
    sticky: dict[str, float] = field(default_factory=dict)
    """R, the depth, Q and P as they were given last, in mm and as written."""
