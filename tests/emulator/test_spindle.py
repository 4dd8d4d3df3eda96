"""The spindle's PWM on the board: registers, pulses, and its place in the motion."""

from itertools import pairwise

import numpy as np
import pytest

from stepmite.emulator import Emulator

PWM_BASE = 0x40050000
SLICE = PWM_BASE + 7 * 0x14  # of GP15, which is its output B
CTRL = 0x40014000 + 15 * 8 + 4
FUNCTION_PWM, FUNCTION_SIO = 4, 5
SPINDLE, STEP = 15, 2
TICK_NS = 10_000


def obey(board: Emulator, *lines: str) -> None:
    for line in lines:
        answer = board.command(line)
        assert "rror" not in answer, (line, answer)


def ready(board: Emulator, spindle: str) -> None:
    obey(
        board,
        "STEPPER INIT ,1024",
        "STEPPER AXIS X,GP2,GP3,,,80,6000,500",
        f"STEPPER SPINDLE GP15{spindle}",
        "STEPPER POSITION HOME",
        "STEPPER RUN",
    )


def level(board: Emulator) -> int:
    both = board.peek(SLICE + 12)
    assert both & 0xFFFF == both >> 16
    return both >> 16


def function(board: Emulator) -> int:
    return board.peek(CTRL) & 0x1F


@pytest.mark.parametrize("invert", [0, 1])
def test_duty(board: Emulator, invert: int) -> None:
    ready(board, f",{invert},10000,500,1000")
    assert board.level(SPINDLE) == invert
    assert board.peek(SLICE + 16) == 62_499
    for rpm, duty in ((2500, 0.25), (100, 0.05), (8000, 0.8)):
        obey(board, f"STEPPER GC M3 S{rpm}")
        board.run_ms(5)
        assert level(board) == round(duty * 62_500)
        assert function(board) == FUNCTION_PWM
        board.clear_edges()
        board.run_ms(10)
        edges = board.edges([SPINDLE])
        rises = [time for time, _, high in edges if high != invert]
        falls = [time for time, _, high in edges if high == invert and time > rises[0]]
        widths = np.array(falls[:8]) - np.array(rises[:8])
        assert np.allclose(widths, duty * 1e6, atol=20)
    obey(board, "STEPPER GC M5")
    board.run_ms(5)
    board.clear_edges()
    board.run_ms(5)
    assert (level(board), board.edges([SPINDLE]), board.level(SPINDLE)) == (0, [], invert)


@pytest.mark.parametrize("invert", [0, 1])
def test_emergency_stop_does_not_wait_for_the_period(board: Emulator, invert: int) -> None:
    ready(board, f",{invert},10000,,8")  # 125 ms
    obey(board, "STEPPER GC M3 S9900", "STEPPER GC G1 X100 F3000")
    board.run_ms(300)
    assert board.level(SPINDLE) != invert
    obey(board, "STEPPER ESTOP")
    assert (level(board), function(board), board.level(SPINDLE)) == (0, FUNCTION_SIO, invert)
    board.clear_edges()
    board.run_ms(300)
    assert board.edges([SPINDLE]) == []
    # Nor does the rest of the period come when the slice has the pin again.
    obey(board, "STEPPER POSITION HOME", "STEPPER RUN", "STEPPER GC M3 S9900")
    board.run_ms(20)
    obey(board, "STEPPER ESTOP", "STEPPER POSITION HOME", "STEPPER RUN")
    board.clear_edges()
    obey(board, "STEPPER GC M3 S0")
    board.run_ms(200)
    assert (function(board), board.edges([SPINDLE])) == (FUNCTION_PWM, [])
    obey(board, "STEPPER GC M3 S5000")
    board.run_ms(300)
    assert (level(board), function(board)) == (31_250, FUNCTION_PWM)


def test_close_gives_pin_and_slice_back(board: Emulator) -> None:
    ready(board, ",,10000")
    obey(board, "STEPPER GC M3 S5000")
    assert "STEPPER spindle" in board.command("SETPIN GP14,PWM")
    obey(board, "STEPPER CLOSE")
    assert board.peek(SLICE) & 1 == 0
    obey(board, "SETPIN GP14,PWM", "SETPIN GP15,PWM", "PWM 7,1000,50,50")


def test_power_of_each_move(board: Emulator) -> None:
    """At 100 kHz each period of the PWM is a tick: the duty changes where the move begins."""
    powers = [30, 80, 10, 60, 20, 90, 40, 70]
    ready(board, ",,100,0,100000")
    obey(board, "STEPPER GC M3 S50")
    obey(board, "STEPPER HOLD")
    for n, power in enumerate(powers, 1):
        obey(board, f"STEPPER GC G1 X{n / 2} F3000 S{power}")
    board.run_ms(20)
    board.clear_edges()
    obey(board, "STEPPER RESUME")
    board.run_ms(400)
    edges = board.edges([SPINDLE, STEP])
    steps = np.array([time for time, gpio, high in edges if gpio == STEP and high])
    pulses = np.array([time for time, gpio, _ in edges if gpio == SPINDLE])
    first = next(i for i, (_, gpio, high) in enumerate(edges) if gpio == SPINDLE and high)
    pulses = pulses[0 if edges[first][0] == pulses[0] else 1 :]
    rises, falls = pulses[::2], pulses[1::2]
    duties = (falls - rises[: len(falls)]) / TICK_NS * 100
    assert len(steps) == 40 * len(powers)
    for n, power in enumerate(powers[1:], 1):
        # The path is at the boundary in the middle between the steps on both sides of it.
        boundary = (steps[40 * n - 1] + steps[40 * n]) / 2
        change = np.nonzero(rises[: len(duties)] > boundary)[0][0]
        assert duties[change - 4] == pytest.approx(powers[n - 1], abs=1)
        assert duties[change + 4] == pytest.approx(power, abs=1)
    # It is one motion, faster and faster up to its middle.
    assert np.all(np.diff(np.diff(steps))[:150] < 2 * TICK_NS)


def burnt_s(edges: list[tuple[int, int, int]], begin_ns: float, end_ns: float) -> float:
    """Return how long the output was on between two times."""
    mine = [(time, high) for time, gpio, high in edges if gpio == SPINDLE]
    on = 0.0
    for (time, high), (later, _) in pairwise([*mine, (int(end_ns), 0)]):
        if high:
            on += max(0.0, min(later, end_ns) - max(time, begin_ns))
    return on * 1e-9


def test_a_laser_burns_by_the_way(board: Emulator) -> None:
    """M4: each line gets power * way / feed; nothing is burnt by G0, in a hold and after a stop."""
    ready(board, ",,100,0,20000")
    obey(board, "STEPPER LASER 1", "STEPPER GC M4 S80", "STEPPER HOLD")
    obey(board, "STEPPER GC G1 X10 F3000", "STEPPER GC G0 X20", "STEPPER GC G1 X22 F600 S50")
    board.clear_edges()
    obey(board, "STEPPER RESUME")
    board.run_ms(100)
    obey(board, "STEPPER HOLD")
    board.run_ms(300)
    held = len([1 for _, gpio, _ in board.edges() if gpio == SPINDLE])
    board.run_ms(100)
    assert len([1 for _, gpio, _ in board.edges() if gpio == SPINDLE]) == held
    assert (board.level(SPINDLE), level(board)) == (0, 0)
    obey(board, "STEPPER RESUME")
    board.run_ms(1500)
    edges = board.edges([SPINDLE, STEP])
    steps = [time for time, gpio, high in edges if gpio == STEP and high]
    assert len(steps) == 22 * 80
    first, second = steps[800] - 1000, steps[1599]
    end = edges[-1][0]
    assert burnt_s(edges, 0, first) == pytest.approx(0.8 * 10 / 50, abs=1e-3)
    assert burnt_s(edges, steps[810], steps[1590]) == 0.0
    assert burnt_s(edges, second, end) == pytest.approx(0.5 * 2 / 10, abs=1e-3)
    assert level(board) == 0
    obey(board, "STEPPER GC M3 S100", "STEPPER GC G1 X90 F3000")
    board.run_ms(400)
    assert level(board) > 0
    obey(board, "STEPPER STOP")
    board.run_ms(3)
    assert level(board) == 0
    assert board.command("? PEEK(STEPPER SPEED)").split()[-1] not in ("0", "0.0")
    board.run_ms(300)
    obey(board, "STEPPER GC G1 X0")
    board.run_ms(100)
    assert (board.level(SPINDLE), level(board)) == (0, 0)
