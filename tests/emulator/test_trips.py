"""E-STOP and a limit switch at random times on the emulated board: 200 trips of four axes."""

import random
import re

from stepmite.emulator import Emulator

AXES = {"X": (2, 3), "Y": (4, 5), "Z": (6, 7), "A": (8, 9)}
ENABLE, SPINDLE, FLOOD, ESTOP, LIMIT = 10, 12, 13, 15, 20
TICK_NS = 10_000
# The tick that is under way when the pin changes may have read its inputs already.
UNDER_WAY_NS = 2_000
SCALE = 100

SETUP = [
    f"STEPPER INIT ,64,GP{ESTOP}",
    f"STEPPER AXIS X,GP2,GP3,GP{ENABLE},,{SCALE},24000,4000",
    f"STEPPER AXIS Y,GP4,GP5,,,{SCALE},24000,4000",
    f"STEPPER AXIS Z,GP6,GP7,,1,{SCALE},6000,2000",
    f"STEPPER AXIS A,GP8,GP9,,,{SCALE},24000,4000",
    f"STEPPER HWLIMITS 0,GP{LIMIT},0",
    f"STEPPER SPINDLE GP{SPINDLE}",
    f"STEPPER COOLANT GP{FLOOD}",
    "STEPPER SCURVE 1",
    "STEPPER JERK 100000",
]
PROGRAM = ["M3", "M8", "G0 X9 Y5 Z1 A20", "G3 X3 Y5 I-3 J0 F9000", "G1 X0 Y0 Z0 A-20 F12000"]


def command(board: Emulator, line: str) -> str:
    """Carry the line out, which must not fail."""
    answer = board.command(line)
    assert "rror" not in answer, answer
    return answer


def counted(board: Emulator, dirs: dict[str, int]) -> dict[str, int]:
    """Steps of the axes since the edges were cleared, when the direction pins were at `dirs`."""
    up = {name: dirs[name] != (name == "Z") for name in AXES}
    steps = dict.fromkeys(AXES, 0)
    by_pin = {pin: (name, kind) for name, pins in AXES.items() for kind, pin in enumerate(pins)}
    for _, gpio, level in board.edges(list(by_pin)):
        name, kind = by_pin[gpio]
        if kind == 1:
            up[name] = bool(level) != (name == "Z")
        elif level:
            steps[name] += 1 if up[name] else -1
    return steps


def reported(board: Emulator) -> dict[str, int]:
    """What STATUS says about each axis."""
    text = board.command("STEPPER STATUS", timeout_ms=5000)
    return {name: int(n) for name, n in re.findall(r"^([XYZA]): .*\((-?\d+) steps\)", text, re.M)}


def begin(board: Emulator) -> dict[str, int]:
    """Recover, stand at home, start the program. Returns the levels of the direction pins."""
    command(board, "STEPPER RECOVER")
    command(board, "STEPPER POSITION HOME")
    board.clear_edges()
    dirs = {name: board.level(pins[1]) for name, pins in AXES.items()}
    command(board, "STEPPER RUN")
    for line in PROGRAM:
        command(board, f"STEPPER GC {line}")
    return dirs


def trip(board: Emulator, chance: random.Random, limit: bool) -> None:
    """One trip and all that must hold behind it; the input is left pulled."""
    dirs = begin(board)
    board.run_ms(chance.uniform(0, 60))
    pulled_ns = board.now_ns + chance.randrange(200_000)
    board.set_pin(LIMIT if limit else ESTOP, 0, at_ns=pulled_ns)
    board.run_ms(1)
    rises = [t for t, gpio, level in board.edges([pins[0] for pins in AXES.values()]) if level]
    last_ns = pulled_ns + UNDER_WAY_NS + (2 * TICK_NS if limit else 0)
    assert max(rises, default=0) <= last_ns, "a step too late"
    assert board.level(ENABLE) == 1, "drivers are off"
    assert [board.level(SPINDLE), board.level(FLOOD)] == [0, 0], "spindle and coolant are off"
    steps = counted(board, dirs)
    board.run_ms(5)
    told = board.output()
    assert told.count("Limit switch trip: Y_MIN" if limit else "Hardware E-STOP trip") == 1
    assert "\n 1\r" in board.command("PRINT 1"), "the line behind the message is carried out"
    assert reported(board) == steps
    refused = board.command("STEPPER RUN")
    assert ("Limit switch Y_MIN alarm" if limit else "E-STOP active") in refused
    assert counted(board, dirs) == steps, "a step after the stop"


def test_two_hundred_trips_at_random_times(board: Emulator) -> None:
    chance = random.Random(11)
    for pin in (ESTOP, LIMIT):
        board.set_pin(pin, 1)
    for line in SETUP:
        command(board, line)
    for number in range(200):
        limit = number % 2 == 1
        trip(board, chance, limit)
        board.set_pin(LIMIT if limit else ESTOP, 1)
        assert "alarm" in board.command("STEPPER RUN")
    # The recovery is exact: the program as if nothing had been.
    dirs = begin(board)
    board.run_ms(1500)
    assert counted(board, dirs) == {"X": 0, "Y": 0, "Z": 0, "A": -20 * SCALE}
    assert reported(board) == {"X": 0, "Y": 0, "Z": 0, "A": -20 * SCALE}
    assert board.level(SPINDLE) == 1


def test_noise_does_not_trip_a_limit(board: Emulator) -> None:
    chance = random.Random(12)
    for pin in (ESTOP, LIMIT):
        board.set_pin(pin, 1)
    for line in SETUP:
        command(board, line)
    dirs = begin(board)
    for _ in range(300):
        start_ns = board.now_ns + chance.randrange(100_000)
        board.set_pin(LIMIT, 0, at_ns=start_ns)
        # Two samples at most.
        board.set_pin(LIMIT, 1, at_ns=start_ns + chance.randrange(1000, 19_500))
        board.run_ms(0.25)
    board.run_ms(1000)
    assert "Alarm: none" in board.command("STEPPER STATUS")
    assert counted(board, dirs) == {"X": 0, "Y": 0, "Z": 0, "A": -20 * SCALE}


def test_a_line_being_typed_is_whole_behind_the_messages(board: Emulator) -> None:
    """Both lines of a trip stand above it, and it is carried out as typed."""
    for pin in (ESTOP, LIMIT):
        board.set_pin(pin, 1)
    for line in SETUP:
        command(board, line)
    for limit in (True, False):
        begin(board)
        board.run_ms(20)
        board.output()
        board.send("PRINT 6*")
        board.run_ms(20)
        board.set_pin(LIMIT if limit else ESTOP, 0)
        board.run_ms(20)
        board.set_pin(LIMIT if limit else ESTOP, 1)
        told = board.output()
        assert told.count(" trip") == 1
        assert told.endswith("> PRINT 6*")
        board.send("7\r")
        board.expect(r"\n 42\r\n> $")
