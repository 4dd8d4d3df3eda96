"""Homing against ends of axes with motors that lag, slip and stall, and drivers that notice it.

Random starts, speeds, resolutions and loads: the home place is the same each time, and so far from
the end as the pull-off says, within two full steps; nothing slips on the way.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from pathlib import Path

import pytest
from simulated_drivers import Driver
from typed import DIR_X, DIR_Y, DIR_Z, STEP_X, STEP_Y, STEP_Z, WAIT, Session, typed

FULL_STEPS_MM = 5
"""A belt: 200 full steps in 40 mm."""
PULL_OFF_MM = 3
WIRE = 26
DIAG = {"X": 16, "Y": 17, "Z": 18}
PINS = {"X": (STEP_X, DIR_X), "Y": (STEP_Y, DIR_Y), "Z": (STEP_Z, DIR_Z)}
CLOCK_HZ = 12e6


@dataclass(frozen=True)
class Axis:
    """An axis that is homed to the end that holds it."""

    name: str
    microsteps: int
    seek: int
    """mm/min."""
    end_steps: int
    """Where it is held, counted from where it stands at power-up: any phase of the field."""
    places_mm: tuple[float, float]
    """Where it goes in between, from its home place."""
    load_ma: int

    def steps_mm(self) -> int:
        return FULL_STEPS_MM * self.microsteps

    def rows(self) -> list[str]:
        """Its lines in the description of the machine."""
        step, direction = PINS[self.name]
        address = "XYZ".index(self.name)
        driver = Driver(
            self.name, address, WIRE, diag=DIAG[self.name], load_ma=self.load_ma,
            microsteps=self.microsteps,
        )  # fmt: skip
        stops = f"stops={self.end_steps}:{self.end_steps + 1000 * self.steps_mm()}"
        return [f"axis {self.name} step=GP{step} dir=GP{direction} {stops}", driver.row()]

    def threshold(self) -> int:
        """TCOOLTHRS: the step time at 60 % of the fast approach."""
        return round(CLOCK_HZ / (0.6 * self.seek / 60 * FULL_STEPS_MM * 256))

    def set_up(self) -> list[str]:
        step, direction = PINS[self.name]
        driver = "XYZ".index(self.name)
        return [
            f"TMC22xx GP{WIRE},2209,{driver},800,30,{self.microsteps}",
            f"TMC22xx SGTHRS {driver},70",
            f"STEPPER AXIS {self.name},GP{step},GP{direction},,,{self.steps_mm()},{self.seek},800",
            f"STEPPER HOME {self.name},MIN,{self.seek},,{PULL_OFF_MM}",
        ]

    def arm(self, on: bool) -> str:
        return f"TMC22xx TCOOLTHRS {'XYZ'.index(self.name)},{self.threshold() if on else 0}"

    def full_steps(self, rotor: int) -> float:
        """From the end to a place of the rotor."""
        return rotor / 256 - self.end_steps / self.microsteps


def some_axes(seed: int) -> list[Axis]:
    chance = random.Random(seed)
    axes = []
    for name in "XYZ":
        microsteps = chance.choice([8, 16, 32, 64])
        steps_mm = FULL_STEPS_MM * microsteps
        fastest = min(6000, 60 * 45000 // steps_mm)  # what 100,000 ticks/s leave room for
        axes.append(
            Axis(
                name,
                microsteps,
                chance.randrange(1200, fastest),
                -chance.randrange(2 * steps_mm, 30 * steps_mm),
                (chance.uniform(1, 40), chance.uniform(1, 40)),
                chance.randrange(20, 250),
            )
        )
    return axes


def machine(axes: list[Axis]) -> list[str]:
    return [row for axis in axes for row in axis.rows()]


def set_up(axes: list[Axis], profile: int) -> list[str]:
    lines = ["STEPPER INIT", f"STEPPER SCURVE {profile}"]
    lines += [line for axis in axes for line in axis.set_up()]
    diag = ",".join(f"GP{DIAG[axis.name]}" for axis in axes)
    return [*lines, f"STEPPER HWLIMITS {diag},0,0,0,7", "STEPPER RUN"]


def home(axes: list[Axis]) -> list[str]:
    armed = [axis.arm(on=True) for axis in axes]
    return [*armed, "STEPPER GC G28", *(axis.arm(on=False) for axis in axes)]


def go(axes: list[Axis], index: int) -> list[str]:
    words = " ".join(f"{axis.name}{axis.places_mm[index]:.3f}" for axis in axes)
    return [f"STEPPER GC G0 {words}", WAIT]


def rotors_at_home(session: Session, axes: list[Axis]) -> dict[str, float]:
    """Full steps from the end, of the motors at the end of the session."""
    drivers = session.report.drivers
    return {
        axis.name: axis.full_steps(driver["rotor"])
        for axis, driver in zip(axes, drivers, strict=True)
    }


@pytest.mark.parametrize("profile", [0, 1])
@pytest.mark.parametrize("seed", range(17))
def test_the_home_place_is_the_same_from_anywhere(seed: int, profile: int, tmp_path: Path) -> None:
    axes = some_axes(seed)
    lines = set_up(axes, profile)
    found = []
    for times in (1, 2, 3):
        for index in range(times - 1):
            lines += [*home(axes), *go(axes, index)] if times - 2 == index else []
        session = typed(tmp_path, *lines, *home(axes), drivers=machine(axes))
        assert session.errors() == [], axes
        found.append(rotors_at_home(session, axes))
    for axis in axes:
        places = [places[axis.name] for places in found]
        assert max(places) - min(places) <= 2, axis
        assert places == pytest.approx([PULL_OFF_MM * FULL_STEPS_MM] * 3, abs=2), axis
    assert [driver["slips"] for driver in session.report.drivers] == [0, 0, 0]
