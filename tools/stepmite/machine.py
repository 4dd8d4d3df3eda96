"""What the board says about its machine: limits for the time estimate, read off STEPPER STATUS."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

from stepmite.gcode import AXES, Position
from stepmite.plan import Machine

_NUMBER = r"([0-9.eE+-]+)"
_MOTION = re.compile(rf"([{AXES}]) motion: .*max {_NUMBER} \S+/min, {_NUMBER} \S+/s\^2")
_JUNCTION = re.compile(rf"Junction deviation: {_NUMBER} mm")


def machine_from_status(lines: Iterable[str], fallback: Machine | None = None) -> Machine:
    """Return the limits in a STEPPER STATUS report; what is not in it stays as in `fallback`."""
    machine = fallback or Machine()
    velocity = list(machine.max_velocity)
    acceleration = list(machine.max_acceleration)
    for line in lines:
        if match := _MOTION.match(line):
            index = AXES.index(match[1])
            velocity[index] = float(match[2]) / 60
            acceleration[index] = float(match[3])
        elif match := _JUNCTION.match(line):
            machine = replace(machine, junction_deviation_mm=float(match[1]))
    return replace(
        machine, max_velocity=_position(velocity), max_acceleration=_position(acceleration)
    )


def _position(values: list[float]) -> Position:
    return values[0], values[1], values[2], values[3]
