"""Homing without switches on the emulated board: drivers at its pins, motors that slip."""

import pytest
from shown import command

from stepmite.emulator import Emulator

END = 0  # steps
FULL_STEP = 16
SETUP = [
    "TMC22xx GP21,2209,0,800,30,16",
    "TMC22xx GP21,2209,1,800,30,16",
    "STEPPER INIT",
    "STEPPER AXIS X,GP2,GP3,GP4,,80,6000,500",
    "STEPPER AXIS Y,GP5,GP6,GP7,,80,6000,500",
    "STEPPER HWLIMITS GP10,GP11,0,0,0,0,3",
    "STEPPER RUN",
    "TMC22xx AXIS 0,X",
    "TMC22xx AXIS 1,Y",
    "TMC22xx SGTHRS X,100",
    "TMC22xx SGTHRS Y,100",
]


def start(board: Emulator) -> None:
    board.add_axis("X", 2, 3, at=1500)
    board.add_axis("Y", 5, 6, at=1200)
    board.add_tmc2209("x", 21, address=0, axis="X", diag=10, stops=(END, None))
    board.add_tmc2209("y", 21, address=1, axis="Y", diag=11, stops=(END, None))
    for line in SETUP:
        assert "rror" not in command(board, line), line


def thresholds(board: Emulator) -> list[tuple[str, int]]:
    """Driver and value of what was written to TCOOLTHRS since the last look."""
    return [
        (entry["driver"], int.from_bytes(bytes(entry["bytes"][3:7]), "big"))
        for entry in board.tmc_log()
        if entry["kind"] == "write" and entry["register"] in ("TCOOLTHRS", 0x14)
    ]


def test_homing_arms_and_disarms(board: Emulator) -> None:
    """No arming lines; the axes end off their stops, disarmed."""
    start(board)
    board.tmc_log()
    assert command(board, "STEPPER GC G28") == ""
    assert command(board, 'PRINT PEEK(STEPPER X);" ";PEEK(STEPPER STATUS)>>7') == "0 1"
    written = thresholds(board)
    assert [(name, value > 0) for name, value in written] == [
        ("x", True),
        ("x", False),
        ("y", True),
        ("y", False),
    ]
    for name in "xy":
        assert board.tmc(name)["TCOOLTHRS"] == 0
        rotor = board.tmc_motor(name)["rotor"] / 256
        assert rotor == pytest.approx((END + 240) / FULL_STEP, abs=2)


def test_a_stall_in_a_normal_move_does_not_trip(board: Emulator) -> None:
    start(board)
    assert command(board, "STEPPER GC G28") == ""
    assert command(board, "STEPPER GC G1 X-5 F3000") == ""
    board.run_ms(600)
    assert board.tmc_motor("x")["slips"] > 0
    assert int(command(board, "PRINT PEEK(STEPPER STATUS)")) & 0xFF == 128


def test_a_driver_that_cannot_be_armed(board: Emulator) -> None:
    """Homing fails before its axis moves."""
    start(board)
    assert command(board, "TMC22xx MONITOR 0") == ""
    board.tmc_fault("silent", "x")
    at = board.axis("X")
    shown = command(board, "STEPPER GC G28 X0")
    assert "Homing X failed: No answer from address 0 on GP21" in shown
    assert board.axis("X") == at


def test_sgtune_while_the_board_moves(board: Emulator) -> None:
    """The readings of a jog on the chip, and a proposal."""
    start(board)
    shown = command(board, "TMC22xx SGTUNE X,1500,10")
    assert "Proposal: a stall is SG_RESULT" in shown
    assert "TMC22xx STALL X,900" in shown
