"""Homing and probing as a program and a user at the prompt see them, on a simulated machine."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from test_host_port import Terminal, read_until
from test_simulated_machine import run

CTRL_C, CTRL_F, CTRL_R = b"\x03", b"\x06", b"\x12"

MACHINE = """\
axis X step=2 dir=3 at=4000 stops=-800:16800
axis Y step=4 dir=5 at=3000 stops=-800:16800
axis Z step=6 dir=7 at=-2000 stops=-16000:800
switch pin=10 axis=X to=0 bounce_us=900 hysteresis=6
switch pin=11 axis=Y to=0 bounce_us=900 hysteresis=6
switch pin=12 axis=Z from=0 bounce_us=900 hysteresis=6
"""
"""80 steps/mm; X and Y have a switch at their minimum, Z at its maximum."""

SET_UP = """\
STEPPER INIT
STEPPER AXIS X, GP2, GP3, , , 80
STEPPER AXIS Y, GP4, GP5, , , 80
STEPPER AXIS Z, GP6, GP7, , , 80
STEPPER HWLIMITS GP10, GP11, 0, 0, 0, GP12
STEPPER RUN
"""

STATE = """\
PRINT "at "; PEEK(STEPPER X); " "; PEEK(STEPPER Y); " "; PEEK(STEPPER Z); " ";
PRINT PEEK(STEPPER STATUS) >> 7
"""
"""Positions, and whether they are known."""


def program(folder: Path, text: str, machine: str = MACHINE) -> str:
    """Run the program behind the set-up; return what it printed behind that, blanks made one."""
    done = run(folder, machine, SET_UP + text)
    lines = done.stdout.split("Stepper armed\n", 1)[1].splitlines()
    return "".join(" ".join(line.split()) + "\n" for line in lines)


# ---- G28 ----


@pytest.mark.parametrize(
    ("line", "homed"),
    [
        ("STEPPER GC G28", "XYZ"),
        ("STEPPER GC G28 ' all of them", "XYZ"),
        ("STEPPER GC G28 X0", "X"),
        ("STEPPER GC G28 X", "X"),
        ("STEPPER GC G28 X1 Z1", "XZ"),
        ('STEPPER GS "G28 Y0"', "Y"),
        ("STEPPER GCODE G28, X, 0", "X"),
        ("STEPPER GCODE G28, X, 0, Y, 0", "XY"),
        ("STEPPER GC G28.2 Y0", "Y"),
    ],
)
def test_g28_homes_what_it_names_and_waits(tmp_path, line, homed):
    """The statement ends when homing has: X then stands 3 mm from its switch, at 0."""
    shown = program(tmp_path, f"{line}\nPRINT TIMER > 1000; PEEK(STEPPER ACTIVE)\n{STATE}")
    known = 1 if homed == "XYZ" else 0
    assert shown.splitlines()[-2:] == ["1 0", f"at 0 0 0 {known}"]


def test_moves_go_on_from_home(tmp_path):
    text = "STEPPER GC G28\nSTEPPER GC G1 X10 Y20 Z-5 F3000\n"
    text += f"DO : LOOP WHILE PEEK(STEPPER ACTIVE) = 1\n{STATE}"
    assert program(tmp_path, text) == "at 10 20 -5 1\n"


def test_the_offset_of_g92_stays(tmp_path):
    """Homing says where the machine stands; what is called zero is the user's."""
    text = f"STEPPER POSITION HOME\nSTEPPER GC G92 X5\nSTEPPER GC G28\n{STATE}"
    assert program(tmp_path, text) == "at 5 0 0 1\n"


def test_the_reference_recipe_without_switches(tmp_path):
    """Section 8.3 as it is printed, but for the driver's registers."""
    machine = "".join(
        f"axis {axis} step={2 + 2 * n} dir={3 + 2 * n} at={2000 + 700 * n} stops=-2:16000\n"
        f"stall pin={10 + n} axis={axis} to=0 rate=1500\n"
        for n, axis in enumerate("XYZ")
    )
    recipe = """\
STEPPER INIT
STEPPER AXIS X, GP2, GP3, , , 80
STEPPER AXIS Y, GP4, GP5, , , 80
STEPPER AXIS Z, GP6, GP7, , , 80
STEPPER HWLIMITS GP10, GP11, GP12, 0, 0, 0, 7  ' DIAG inputs, all active-high
STEPPER RUN

' Each home cycle:
STEPPER GC G28                            ' run the homing cycle
"""
    done = run(tmp_path, machine, recipe + STATE)
    assert done.returncode == 0
    assert " ".join(done.stdout.splitlines()[-1].split()) == "at 0 0 0 1"


# ---- Failures ----

BROKEN = MACHINE.replace("to=0 bounce_us=900", "to=0 never-closes", 1)
FAILED = "Homing X failed: the switch X_MIN never closed within 50 mm while approaching the switch"


def test_a_failure_is_the_statements_error(tmp_path):
    shown = program(tmp_path, "STEPPER HOME X, MIN, , , , 50\nSTEPPER GC G28\nPRINT 1\n", BROKEN)
    assert shown.splitlines()[-2:] == ["[8] STEPPER GC G28", f"Error : {FAILED}"]


def test_limits_are_watched_behind_a_failure_that_was_skipped(tmp_path):
    """The original forgot that it was no longer homing and drove through its switches."""
    text = f"""\
STEPPER HOME X, MIN, , , , 40
ON ERROR SKIP
STEPPER GC G28 X0
PRINT MM.ERRMSG$
STEPPER POSITION HOME
STEPPER GC G1 Y-60 F3000
DO : LOOP WHILE PEEK(STEPPER ACTIVE) = 1
PAUSE 10
{STATE}"""
    shown = program(tmp_path, text, BROKEN).splitlines()
    assert shown[0] == FAILED.replace("50 mm", "40 mm")
    assert "Limit switch trip: Y_MIN" in " ".join(shown)
    assert shown[-1].startswith("at 0 -37.5 0 0")


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("STEPPER GC G28 Y0", "Y has no home switch (use STEPPER HWLIMITS)"),
        ("STEPPER HOME X, , 0", "seek: 0 is invalid"),
        ("STEPPER HOME X, , , -1", "latch: -1 is invalid"),
        ("STEPPER HOME X, UP", "end: UP is invalid"),
        ("STEPPER HOME A", "axis: A is invalid"),
        ("STEPPER HOME ORDER Z, XZ", "An axis stands twice in the order of homing"),
        ('STEPPER HOME ORDER "Z,X,A"', "axes: 'A' is none that is homed (valid is X, Y and Z)"),
        ("STEPPER HOME RUN XQ", "axes: 'Q' is none that is homed (valid is X, Y and Z)"),
        ("STEPPER PROBE GP2", "Pin GP2 (pin 4) is in use by STEPPER X step"),
        ("STEPPER GC G38.2 X-1 F100", "Probe pin not configured (use STEPPER PROBE)"),
    ],
)
def test_what_is_wrong_is_named(tmp_path, line, said):
    text = "STEPPER HWLIMITS GP10, 0, 0\nSTEPPER POSITION HOME\nON ERROR SKIP\n"
    shown = program(tmp_path, f"{text}{line}\nPRINT MM.ERRMSG$\n{STATE}")
    assert said in shown
    assert shown.splitlines()[-1] == "at 0 0 0 1"  # and nothing moved


# ---- In the background ----


def test_a_program_goes_on_while_it_homes(tmp_path):
    text = """\
ON STEPPER EVENT happened
STEPPER HOME ORDER "ZX Y"
STEPPER HOME RUN
DO
  n = n + 1
LOOP WHILE PEEK(STEPPER ACTIVE) = 1
PAUSE 10
PRINT n > 100; homed
END
SUB happened
  LOCAL e = PEEK(STEPPER EVENT)
  IF e = 4 THEN homed = homed + 1
END SUB
"""
    assert program(tmp_path, text) == "1 1\n"


def test_a_failure_in_the_background_is_told_once(tmp_path):
    text = "STEPPER HOME X, MIN, , , , 50\nSTEPPER HOME RUN X\nPAUSE 9000\nPRINT 1\n"
    shown = program(tmp_path, text, BROKEN)
    assert shown.count(FAILED) == 1
    assert shown.endswith("\n1\n")


@pytest.mark.parametrize("stop", ["ESTOP", "RECOVER"])
def test_what_has_been_stopped_is_over_at_once(tmp_path, stop):
    """No pause is needed before the machine is armed again, or homed again."""
    text = f"STEPPER HOME RUN X:PAUSE 500:STEPPER {stop}:STEPPER RUN:STEPPER GC G28\n{STATE}"
    assert program(tmp_path, text).splitlines()[-1] == "at 0 0 0 1"


@pytest.mark.parametrize(
    ("order", "shown"),
    [
        ("Z,XY", "Z, XY"),
        ('"Z,XY"', "Z, XY"),
        ('"xy z"', "XYZ"),
        ("y", "Y"),
        ('"Z", "Y", "X"', "Z, Y, X"),
    ],
)
def test_the_order_may_be_written_in_several_ways(tmp_path, order, shown):
    printed = program(tmp_path, f"STEPPER HOME ORDER {order}\nSTEPPER STATUS\n")
    assert f"\nHome order: {shown}\n" in printed


def test_status_shows_how_axes_are_homed(tmp_path):
    text = """\
STEPPER HOME X, MIN, 1200, 0, 2.5, 80, -1
STEPPER PROBE GP13, 1
STEPPER HOME RUN Z
PAUSE 300
STEPPER STATUS
"""
    shown = program(tmp_path, text)
    assert "\nHoming Z: approaching the switch\n" in shown
    assert (
        "\nX home: MIN, seek 1200 mm/min, latch 0 mm/min, pull-off 2.5 mm, travel 80 mm, "
        "ends at -1 mm\n"
    ) in shown
    assert "\nZ home: MAX, seek 3000 mm/min, latch 300 mm/min, pull-off 3 mm, " in shown
    assert "\nProbe: GP13 (pin 17) active high\n" in shown


# ---- Keys ----


@pytest.fixture
def terminal(tmp_path):
    """Provide the program at a terminal beside the machine, with a very long way to the switch."""
    machine = MACHINE.replace("at=4000 stops=-800:16800", "at=900000000")
    (tmp_path / "machine.txt").write_text(machine)
    at = Terminal("--virtual", "--machine", str(tmp_path / "machine.txt"))
    for line in (*SET_UP.splitlines(), "STEPPER HOME X,MIN,60,,,100000", "STEPPER POSITION HOME"):
        at.type(line.encode() + b"\r", b"\r\n> ")
    yield at
    at.close()


def test_ctrl_c_ends_homing_at_once(terminal):
    os.write(terminal.master, b"STEPPER GC G28 X0\r")
    read_until(terminal.master, b"G28 X0\r\n")
    terminal.type(CTRL_C, b"motion stops, what was queued is dropped\r\n> ")
    terminal.type(b"DO:LOOP WHILE PEEK(STEPPER ACTIVE)=1\r", b"\r\n> ")
    shown = terminal.type(b"PRINT PEEK(STEPPER STATUS)>>7\r", b"\r\n> ")
    assert re.search(rb"\r\n 0\r", shown)  # X moved: unknown
    terminal.type(b"STEPPER POSITION HOME\r", b"\r\n> ")  # and free for what is next
    terminal.type(b"STEPPER GC G1 X1 F600\r", b"\r\n> ")


def test_feed_hold_waits_in_homing(terminal):
    os.write(terminal.master, b"STEPPER GC G28 X0\r")
    read_until(terminal.master, b"G28 X0\r\n")
    terminal.type(CTRL_F, b"Feed hold (Ctrl-R or STEPPER RESUME goes on)\r\n")
    terminal.type(CTRL_R, b"Resumed\r\n")
    terminal.type(CTRL_C, b"motion stops, what was queued is dropped\r\n> ")


# ---- Probing ----

PLATE = MACHINE + "switch pin=13 axis=Z to=-3001\n"


def test_a_plate_is_found_to_the_step(tmp_path):
    """Work coordinates, at the step at which it was touched; the machine stands a little below."""
    text = """\
STEPPER PROBE GP13
STEPPER GC G28
STEPPER GC G92 Z10
STEPPER GC G38.2 Z-90 F600
z = PEEK(STEPPER PROBE Z)
PRINT z; PEEK(STEPPER PROBE OK); PEEK(STEPPER PROBE CONTACT)
PRINT PEEK(STEPPER Z) < z; PEEK(STEPPER Z) > z - 0.2; PEEK(STEPPER PROBE X)
STEPPER GC G1 Z0
DO : LOOP WHILE PEEK(STEPPER ACTIVE) = 1
PRINT PEEK(STEPPER PROBE Z) = z; PEEK(STEPPER PROBE CONTACT)
"""
    # The switch closes at step 0, home is 3 mm below, the plate at -3001 steps.
    z = 10 + 3 - 3001 / 80
    assert program(tmp_path, text, PLATE).splitlines() == [f"{z:.4f} 1 1", "1 1 0", "1 0"]


def test_no_contact_is_an_error_or_not(tmp_path):
    text = """\
STEPPER PROBE GP13
STEPPER GC G28
STEPPER GC G38.3 Z-2 F600
PRINT PEEK(STEPPER PROBE OK); " "; PEEK(STEPPER PROBE Z)
STEPPER GC G38.2 Z-4 F600
"""
    shown = program(tmp_path, text, PLATE).splitlines()
    assert shown[0] == "0 -2"
    assert shown[-1] == "Error : Probing failed: no contact before the target"
