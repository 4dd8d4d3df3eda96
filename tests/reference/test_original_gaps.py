"""What the PicoMite firmware lacks for somebody with a CNC machine (2.27 of its faults).

It is here, or the guide says that it is not.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import pytest
from typed import SET_UP, WAIT, typed


@dataclass(frozen=True)
class Feature:
    """Lines that use it and where the axes end by them, in mm."""

    lines: list[str]
    end: dict[str, float] = field(default_factory=dict)


def gc(*lines: str) -> list[str]:
    return [f"STEPPER GC {line}" for line in lines]


SWITCHES = "STEPPER HWLIMITS GP16,GP17,GP18,GP19"

THERE = {
    "feed hold": Feature(
        [*gc("G1 X1 F600"), "STEPPER HOLD", "PAUSE 500", "STEPPER RESUME", WAIT], {"X": 1}
    ),
    "cancel with deceleration": Feature([*gc("G1 X0.1 F60"), "STEPPER STOP"]),
    "jog": Feature(["STEPPER JOG X,5", WAIT, "STEPPER JOG X,-2,600", WAIT], {"X": 3}),
    "overrides": Feature(
        ["STEPPER OVERRIDE FEED,50", "STEPPER OVERRIDE RAPID,50", *gc("G0 X1"), WAIT], {"X": 1}
    ),
    "report while moving": Feature(
        [*gc("G1 X1 F600"), "STEPPER STATUS", "PRINT PEEK(STEPPER X)", WAIT], {"X": 1}
    ),
    "inch and mm": Feature([*gc("G20 G1 X1 F100", "G21 G91 X1"), WAIT], {"X": 26.4}),
    "planes": Feature([*gc("G18", "G19", "G17", "G2 X4 I2 F600"), WAIT], {"X": 4}),
    "modes of every header": Feature(gc("G17 G21 G40 G49 G54 G80 G90 G94")),
    "tool length": Feature([*gc("G43.1 Z2", "G0 Z0", "G49"), WAIT], {"Z": 2}),
    "machine coordinates": Feature([*gc("G92 X50", "G53 G0 X1"), WAIT], {"X": 1}),
    "work offsets": Feature(
        [*gc("G10 L2 P2 X5", "G10 L2 P9 Y3", "G55", "G0 X1", "G59.3", "G0 Y1", "G54"), WAIT],
        {"X": 6, "Y": 4},
    ),
    "G10 L20": Feature([*gc("G10 L20 P1 X10", "G0 X11"), WAIT], {"X": 1}),
    "predefined positions": Feature(
        [*gc("G0 X3", "G28.1", "G0 X5", "G30.1", "G0 X9", "G30"), WAIT, *gc("G30 P1"), WAIT],
        {"X": 3},
    ),
    "probing": Feature(
        ["STEPPER PROBE GP21", *gc("G38.3 Z-1 F300"), "PRINT PEEK(STEPPER PROBE OK)"], {"Z": -1}
    ),
    "G92.1 to G92.3": Feature(
        [*gc("G92 X5", "G92.2", "G0 X1", "G92.3", "G0 X7", "G92.1", "G0 Y1"), WAIT],
        {"X": 2, "Y": 1},
    ),
    "G90.1 and G91.1": Feature(
        [*gc("G0 X10", "G90.1", "G2 X20 Y0 I15 J0 F6000", "G91.1", "G2 X10 I-5"), WAIT], {"X": 10}
    ),
    "inverse time": Feature([*gc("G93 G1 X1 F60", "G94"), WAIT], {"X": 1}),
    "canned cycles": Feature(
        [
            *gc("G0 Z2", "G98 G81 X1 Y1 Z-1 R1 F600", "X2", "G80"),
            WAIT,
            *gc("G99 G83 X3 Z-1 R1 Q0.5"),
            WAIT,
            *gc("G73 X4 Z-1 R1 Q0.5"),
            WAIT,
            *gc("G82 X5 Z-1 R1 P10"),
            WAIT,
            *gc("G80", "G0 Y0"),
            WAIT,
        ],
        {"X": 5, "Y": 0, "Z": 1},
    ),
    "line numbers, %, block delete": Feature(
        [*gc("%", "N10 G0 X1 (comment) ; more", "/G0 X99"), "STEPPER HOLD", "STEPPER STATUS"]
    ),
    "stops of a program": Feature(
        [
            *gc("M0", "G0 X1"),
            "PAUSE 50",
            "PRINT PEEK(STEPPER X)",
            "STEPPER RESUME",
            WAIT,
            *gc("M1"),
            "PAUSE 50",
            "STEPPER RESUME",
            *gc("M2"),
            WAIT,
            *gc("M30"),
            WAIT,
        ],
        {"X": 1},
    ),
    "spindle speed": Feature(
        ["STEPPER SPINDLE GP14,,12000,0,1000,0,GP15", *gc("M4 S6000", "S3000", "M5"), WAIT]
    ),
    "spin-up": Feature(
        [
            "STEPPER SPINDLE GP14,,,,,200",
            "TIMER = 0",
            *gc("M3", "G0 X1"),
            WAIT,
            'IF TIMER < 200 THEN ERROR "no time to spin up"',
        ],
        {"X": 1},
    ),
    "stop of one axis": Feature(["STEPPER JOG X,+,600", "PAUSE 200", "STEPPER JOG STOP", WAIT]),
    "coolant": Feature(["STEPPER COOLANT GP19,GP20", *gc("M7", "M8", "M9"), WAIT]),
    "tools": Feature([*gc("T2", "M6", "G0 X1"), "PAUSE 100", "STEPPER RESUME", WAIT], {"X": 1}),
    "files": Feature(
        [
            'OPEN "a.nc" FOR OUTPUT AS #1',
            'PRINT #1, "G21 G90" + CHR$(10) + "G1 X1 F600"',
            "CLOSE #1",
            'STEPPER CHECK "a.nc"',
            'STEPPER FILE "a.nc"',
            WAIT,
            "PRINT PEEK(STEPPER LINE), PEEK(STEPPER PERCENT)",
        ],
        {"X": 1},
    ),
    "homing of each axis": Feature(
        [SWITCHES, "STEPPER HOME X,MAX,1200,60,2,50,100", "STEPPER HOME ORDER Z,XY"]
    ),
    "dwell in seconds": Feature(["STEPPER DIALECT NIST", *gc("G4 P0.1"), WAIT]),
    "one switch only": Feature(["STEPPER HWLIMITS 0,GP17"]),
    "events": Feature(["PRINT PEEK(STEPPER EVENT)"]),
    "settings kept over power-off": Feature(["OPTION AUTORUN OFF", "x = 1", WAIT, "VAR SAVE x"]),
}
"""What the original lacks and we have."""

NOT_THERE = [
    "Checksums",
    "Two motors for one axis",
    "Backlash",
    "CoreXY",
    "More than four axes",
    "Soft limits of A",
    "width and the polarity of step pulses",
    "Encoders",
    "Spindle override",
    "A time until drivers go off",
]
"""What the guide says is not there."""


@pytest.mark.parametrize("name", THERE)
def test_2_27_features_are_there(name: str, tmp_path: Path) -> None:
    """Each line is understood and the motors end where they should."""
    feature = THERE[name]
    session = typed(
        tmp_path,
        *SET_UP,
        "STEPPER POSITION HOME",
        "STEPPER RUN",
        WAIT,
        *feature.lines,
        "STEPPER STOP",
        "PAUSE 500",
    )
    assert session.errors() == []
    for axis, place in feature.end.items():
        assert session.end(axis) == place, axis


def test_2_27_what_is_not_there_is_told() -> None:
    """In the guide."""
    page = (Path(__file__).parents[2] / "docs/user-guide.md").read_text(encoding="utf-8")
    told = page.partition("## What is not there")[2]
    for feature in NOT_THERE:
        assert feature in told, feature
