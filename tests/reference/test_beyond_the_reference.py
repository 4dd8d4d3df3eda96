"""What the PicoMite firmware has and its reference does not tell."""

from __future__ import annotations

from pathlib import Path

import pytest
from motion_checks import hardest_acceleration
from typed import ENABLE_X, ENABLE_Y, READY, SET_UP, SPINDLE, WAIT, Switch, program, typed

MOVE = "STEPPER GC G1 X50 F3000"


def test_recover_in_motion(tmp_path: Path) -> None:
    """A ramp to a standstill, spindle off, queue empty, disarmed; drivers and position stay."""
    session = typed(
        tmp_path,
        *SET_UP,
        f"STEPPER SPINDLE GP{SPINDLE}",
        "STEPPER POSITION HOME",
        "STEPPER RUN",
        "STEPPER GC M3",
        MOVE,
        "PAUSE 300",
        "STEPPER RECOVER",
        "STEPPER STATUS",
        "PRINT PEEK(STEPPER X); PEEK(STEPPER BUFFER)",
        "STEPPER GC G1 X60 F6000",
        "STEPPER RUN",
        WAIT,
    )
    assert session.errors() == []
    assert "Armed: NO" in session.answers[-5]
    assert "position known: YES" in session.answers[-5]
    place, free = session.numbers(-4)
    assert 5 < place < 30
    assert free == 64
    assert session.end("X") == 60
    assert session.level(SPINDLE) == 0
    assert session.level(ENABLE_X) == 0
    assert hardest_acceleration(session, "X") < 1.1 * 500 + 4 / 80 / 0.02**2


def test_recover_at_rest(tmp_path: Path) -> None:
    """Disarms, and the position stays."""
    session = typed(
        tmp_path,
        *READY,
        "STEPPER GC G1 X5 F6000",
        WAIT,
        "STEPPER RECOVER",
        "STEPPER GC G1 X6 F6000",
        "PAUSE 500",
        "PRINT PEEK(STEPPER X)",
        "STEPPER RUN",
        WAIT,
        "PRINT PEEK(STEPPER X)",
    )
    assert session.errors() == []
    assert session.number(-4) == 5
    assert session.number() == 6


def test_enable(tmp_path: Path) -> None:
    """One axis or all, on or off; on without a value."""
    session = typed(
        tmp_path,
        *SET_UP,
        "STEPPER ENABLE X",
        "STEPPER ENABLE ALL",
        "STEPPER ENABLE Y,0",
        "STEPPER ENABLE ALL,0",
    )
    assert session.errors() == []
    times = session.typed_ms[-4:]
    shown = [(session.level_at(ENABLE_X, ms), session.level_at(ENABLE_Y, ms)) for ms in times]
    assert shown == [(0, 1), (0, 0), (0, 1), (1, 1)]


def test_invert(tmp_path: Path) -> None:
    """As TUNE with dir_invert."""
    session = typed(tmp_path, *READY, "STEPPER INVERT X,1", "STEPPER GC G1 X1 F600", WAIT)
    assert session.errors() == []
    assert session.end("X") == -1


def test_arc(tmp_path: Path) -> None:
    """Shows and sets the tolerance of arcs."""
    session = typed(tmp_path, *SET_UP, "STEPPER ARC", "STEPPER ARC 0.1", "STEPPER STATUS")
    assert session.errors() == []
    assert "0.05" in session.answers[-3]
    assert "arc tolerance: 0.1 mm" in session.last


def test_buffer(tmp_path: Path) -> None:
    """Diagnostic lines of the queue."""
    session = typed(tmp_path, *SET_UP, "STEPPER POSITION HOME", MOVE, "STEPPER BUFFER")
    assert session.errors() == []
    assert "1" in session.last
    assert "64" in session.last


def test_reset(tmp_path: Path) -> None:
    """At rest: axes, spindle and switches are forgotten, their pins free; still initialised."""
    session = typed(
        tmp_path,
        *READY,
        MOVE,
        "STEPPER RESET",
        WAIT,
        "STEPPER RESET",
        "PRINT PEEK(STEPPER ACTIVE)",
        "SETPIN GP2,DIN",
        "SETPIN GP2,OFF",
        *SET_UP[1:],
    )
    assert len(session.errors()) == 1
    assert session.end("X") == 50
    assert session.number(-7) == 0
    assert hardest_acceleration(session, "X") < 1.1 * 500 + 4 / 80 / 0.02**2


def test_mm_code(tmp_path: Path) -> None:
    """Free slots, as PEEK(STEPPER BUFFER)."""
    session = typed(tmp_path, *SET_UP, "STEPPER POSITION HOME", MOVE, "PRINT MM.CODE")
    assert session.number() == 63


@pytest.mark.parametrize("form", ["STEPPER GC {}", 'STEPPER GS "{}"', "STEPPER GCODE {}"])
@pytest.mark.parametrize("code", ["G61", "G64"])
def test_path_modes(form: str, code: str, tmp_path: Path) -> None:
    """Exact and continuous."""
    session = typed(tmp_path, *READY, form.format(code), "STEPPER STATUS")
    assert session.errors() == []
    assert f"Path mode: {code}" in session.last


@pytest.mark.parametrize("arguments", ["0.1,64", "64,0.1", "64", ",64"])
def test_init_takes_its_first_two_in_either_order(arguments: str, tmp_path: Path) -> None:
    """What is a size is the size, what is a tolerance the tolerance."""
    session = typed(
        tmp_path, f"STEPPER INIT {arguments}", "PRINT PEEK(STEPPER BUFFER)", "STEPPER STATUS"
    )
    assert session.errors() == []
    assert session.number(-2) == 64
    tolerance = "0.1" if "0.1" in arguments else "0.05"
    assert f"arc tolerance: {tolerance} mm" in session.last


def test_g28_behind_a_limit_trip(tmp_path: Path) -> None:
    """The message says to home, and G28 does so with drivers that the trip has turned off."""
    session = typed(
        tmp_path,
        *SET_UP,
        "STEPPER HWLIMITS GP16",
        "STEPPER POSITION HOME",
        "STEPPER RUN",
        "STEPPER GC G1 X-20 F3000",
        "PAUSE 2000",
        "PRINT PEEK(STEPPER STATUS) AND 128",
        "STEPPER GC G28 X",
        "STEPPER RUN",
        "STEPPER GC G1 X5 F600",
        WAIT,
        "PRINT PEEK(STEPPER X); PEEK(STEPPER STATUS) AND 129",
        switches=[Switch(16, "X", -10)],
    )
    assert session.errors() == []
    assert session.number(-6) == 0
    assert session.numbers() == [5, 128]
    assert session.end("X") == pytest.approx(-10 + 3 + 5, abs=0.05)
    assert session.level(ENABLE_X) == 0


USERS_PROGRAM = """\
option explicit
dim integer shown
stepper init 32
stepper axis x,gp0,gp1,,,200,400,50,5
stepper axis y,gp2,gp3,gp4,1,200,400,50,5
stepper position home
stepper run
settick 100, show
stepper gc g90
stepper gc g0 x1 y1
stepper gcode g1, x, 2, f, 150
stepper gs "g1 y" + str$(0.5) + " f150"
do : pause 100 : loop until peek(stepper active) = 0
settick 0, 0
print str$(peek(stepper x),-4,4); " "; str$(peek(stepper y),-4,4)
end

sub show
  inc shown
  if peek(stepper x) < 0 then error "never"
end sub
"""


def test_a_program_as_users_write_it(tmp_path: Path) -> None:
    """Lower case, blank arguments, positions shown by a tick, slow axes."""
    session = program(tmp_path, USERS_PROGRAM)
    assert "Error" not in session.output
    assert session.answers[0].splitlines()[-1].split() == ["+2.0000", "+0.5000"]
