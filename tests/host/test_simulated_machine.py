"""The simulated machine of the host port: what its file says happens, mistakes are told."""

import json
import subprocess
from pathlib import Path

import pytest

HOST_PROGRAM = Path(__file__).parents[2] / "build" / "host" / "stepmite"

JOG = """\
SETPIN GP10, DIN
STEPPER INIT
STEPPER AXIS X,GP2,GP3,,,80,6000,500
STEPPER RUN
PRINT PIN(GP10);
STEPPER JOG X, -5
DO WHILE PEEK(STEPPER ACTIVE) = 1 : LOOP
PRINT PIN(GP10);
STEPPER JOG X, 5
DO WHILE PEEK(STEPPER ACTIVE) = 1 : LOOP
PRINT PIN(GP10)
"""


def run(folder: Path, machine: str, program: str = JOG) -> subprocess.CompletedProcess:
    """Run the program beside the machine."""
    (folder / "machine.txt").write_text(machine)
    (folder / "program.bas").write_text(program)
    return subprocess.run(
        [HOST_PROGRAM, "--virtual", "--machine", folder / "machine.txt", folder / "program.bas"],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def test_an_axis_presses_its_switch(tmp_path):
    machine = "# one axis\naxis X step=GP2 dir=3\nswitch pin=GP10 axis=X to=-300\n"
    assert run(tmp_path, machine).stdout.split()[-3:] == ["1", "0", "1"]


def test_an_inverted_axis_with_a_switch_that_is_high(tmp_path):
    machine = "axis X step=2 dir=3 inverted at=-100\nswitch pin=10 axis=X from=100 to=350 high\n"
    assert run(tmp_path, machine).stdout.split()[-3:] == ["0", "1", "0"]


@pytest.mark.parametrize(
    ("machine", "said"),
    [
        ("axle X step=2 dir=3", "machine.txt:1: a line begins with axis, switch, stall, tmc"),
        ("\naxis X step=2", "machine.txt:2: an axis needs step= and dir=: 'X'"),
        ("axis X step=2 dir=31", "no such pin: 'dir=31'"),
        ("axis X step=2 dir=3 at=1x", "no whole number in 'at=1x'"),
        ("axis X step=2 dir=3 stops=5", "no whole number in 'stops=5'"),
        ("switch pin=2 axis=Y", "no axis before this line is called 'Y'"),
        ("axis X step=2 dir=3\nswitch axis=X", "machine.txt:2: a switch needs pin= and axis="),
        ("axis X step=2 dir=3\nswitch pin=4 axis=X bounce_us=-1", "out of range"),
        ("axis X step=2 dir=3\nstall pin=4 axis=X often", "unknown in the line of a switch"),
        ("tmc2209 address=0", "machine.txt:1: a driver needs tx="),
        ("tmc2209 tx=5 address=4", "address of a tmc2209: 0 to 3"),
        ("tmc2208 tx=5 address=1", "of a tmc2208: 0"),
        ("tmc2209 tx=5 axis=X", "no axis before this line is called 'X'"),
        ("axis X step=2 dir=3\ntmc2209 tx=5 axis=X\ntmc2209 tx=5 axis=X", "has a driver already"),
        ("tmc2209 tx=5 microsteps=12", "microsteps: 1, 2, 4"),
        ("tmc2209 tx=5 fault=lame", "no such fault: 'fault=lame'"),
        ("tmc2209 tx=5 fault=stall", "a stall has a place"),
        ("tmc2209 tx=5 fault=late:-1", "out of range: 'fault=late:-1'"),
        ("tmc2209 tx=5 fault=late@5-x", "no whole number in 'fault=late@5-x'"),
        ("tmc2209 tx=5 slow", "unknown in the line of a driver: 'slow'"),
        ("tmc2209 tx=5\n" * 9, "machine.txt:9: too many drivers"),
    ],
)
def test_mistakes_are_told_with_their_line(tmp_path, machine, said):
    done = run(tmp_path, machine)
    assert done.returncode == 2
    assert said in done.stderr


def test_a_report_has_drivers_and_axes(tmp_path):
    (tmp_path / "machine.txt").write_text(
        "axis X step=GP2 dir=GP3 at=5\ntmc2209 tx=5 address=1 axis=X fault=brown-out:0@1-2\n"
    )
    report = tmp_path / "report.jsonl"
    arguments = ["--virtual", "--machine", tmp_path / "machine.txt", "--machine-report", report]
    subprocess.run([HOST_PROGRAM, *arguments], input=b"", check=True, capture_output=True)
    rows = [json.loads(line) for line in report.read_text().splitlines()]
    assert len(rows) == 1
    assert rows[0]["axes"] == [{"name": "X", "position": 5, "pulses": 0}]
    assert rows[0]["drivers"][0]["microsteps"] == 32
    assert rows[0]["drivers"][0]["registers"]["CHOPCONF"] == 0x10000053


def test_a_missing_file_is_told(tmp_path):
    done = subprocess.run(
        [HOST_PROGRAM, "--machine", tmp_path / "none.txt"], capture_output=True, check=False
    )
    assert done.returncode == 2
    assert b"none.txt: No such file" in done.stderr
