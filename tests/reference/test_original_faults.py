"""The faults that the PicoMite firmware was found to have: none of them is here.

A test for each, named after its number, drives the same commands with which that firmware fails.
Edges of the pins, reported positions and times are the judges.
"""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np
import pytest
from motion_checks import (
    duration_s,
    hardest_acceleration,
    places,
    slowest_between,
    speeds,
)
from typed import (
    ENABLE_X,
    ENABLE_Z,
    READY,
    SET_UP,
    WAIT,
    X_MAX,
    X_MIN,
    Event,
    Switch,
    error_of,
    program,
    typed,
)

SWITCHES = "STEPPER HWLIMITS GP16,GP17,GP18,GP19"

FEED = (
    'FOR i=1 TO {count} : DO WHILE PEEK(STEPPER BUFFER)=0 : PAUSE 1 : LOOP : STEPPER GS "{line}" '
    ": NEXT"
)
"""A line that queues a G-code line for each i, as fast as there is room."""


def feed(count: int, line: str) -> str:
    """`line` may hold {expression} where a number goes."""
    text = line.replace("{", '"+STR$(').replace("}", ',0,3)+"')
    return FEED.format(count=count, line=text)


# ---- 2.1 to 2.9: positions, corners, arcs --------------------------------------------------------


@pytest.mark.parametrize(
    ("lines", "steps"),
    [
        ([feed(1000, "G1 X{i/100} F600")], 800),
        ([feed(500, "G1 X{i/10} F3000")], 4000),
        ([feed(100, "G1 X{i*0.33} F3000")], 2640),
        (["STEPPER GC G91", feed(100, "G1 X0.1 F600")], 800),
    ],
    ids=["hundredths", "tenths", "thirds", "relative"],
)
def test_2_01_cumulative_loss_of_steps(lines: list[str], steps: int, tmp_path: Path) -> None:
    """The motor has made every step of the sum, and what is reported is where it stands."""
    session = typed(tmp_path, *READY, *lines, WAIT, "PRINT PEEK(STEPPER X)")
    assert session.errors() == []
    assert session.axis("X").end_steps() == steps
    assert session.number() == steps / 80


def test_2_01_there_and_back_ends_at_zero(tmp_path: Path) -> None:
    """Twenty passes of 0.37 mm segments."""
    there = feed(20, "G1 X{i*0.37} F3000")
    back = feed(20, "G1 X{(20-i)*0.37} F3000")
    session = typed(tmp_path, *READY, *[there, back] * 20, WAIT, "PRINT PEEK(STEPPER X)")
    assert session.errors() == []
    assert session.axis("X").end_steps() == 0
    assert np.abs(session.axis("X").steps()).max() == round(20 * 0.37 * 80)
    assert session.number() == 0


def test_2_02_g92_sign_error(tmp_path: Path) -> None:
    """At machine X50 `G92 X0` makes this place 0, and X10 is 10 mm further up."""
    lines = ["STEPPER GC G0 X50", WAIT, "STEPPER GC G92 X0", "PRINT PEEK(STEPPER X)"]
    session = typed(
        tmp_path, *READY, *lines, "STEPPER GC G1 X10 F6000", WAIT, "PRINT PEEK(STEPPER X)"
    )
    assert session.number(-4) == 0
    assert session.number() == 10
    assert session.end("X") == 60


def corner_speed(degrees: float, folder: Path) -> float:
    """Speed in mm/s at which two lines of 100 mm that bend by so much are joined."""
    x = 100 + 100 * math.cos(math.radians(degrees))
    y = 100 * math.sin(math.radians(degrees))
    lines = ["STEPPER GC G1 X100 F6000", f"STEPPER GC G1 X{x:.6f} Y{y:.6f}"]
    session = typed(folder, *SET_UP, "STEPPER POSITION HOME", *lines, "STEPPER RUN", WAIT)
    assert session.errors() == []
    axes = "XY" if len(session.axis("Y").step_ns) else "X"
    middle = duration_s(session, axes) / 2
    return slowest_between(session, axes, middle - 0.3, middle + 0.3)


def test_2_03_cornering_inverted(tmp_path: Path) -> None:
    """The sharper, the slower, and as fast as a deviation of 0.02 mm allows with 500 mm/s^2."""
    bends = [5, 10, 45, 90, 135, 170, 175, 180]
    measured = [corner_speed(bend, tmp_path) for bend in bends]
    for bend, speed in zip(bends, measured, strict=True):
        half = math.cos(math.radians(bend / 2))
        allowed = min(100.0, math.sqrt(500 * 0.02 * half / (1 - half)))
        assert 0.6 * allowed - 2 < speed < 1.05 * allowed + 2, (bend, speed, allowed)
    assert all(fast > slow - 1 for fast, slow in itertools.pairwise(measured))


def test_2_04_velocity_discontinuities_at_junctions(tmp_path: Path) -> None:
    """100, 100, 1 and 100 mm in one line: passed at full speed, without a jump."""
    lines = [f"STEPPER GC G1 X{x} F6000" for x in (100, 200, 201, 301)]
    session = typed(tmp_path, *SET_UP, "STEPPER POSITION HOME", *lines, "STEPPER RUN", WAIT)
    assert hardest_acceleration(session, "X") < 1.1 * 500 + 4 / 80 / 0.02**2
    assert slowest_between(session, "X", 0.3, duration_s(session) - 0.3) > 98
    gaps_ticks = np.diff(session.axis("X").step_ns) / 10_000
    fast = gaps_ticks[len(gaps_ticks) // 3 : len(gaps_ticks) * 2 // 3]
    assert fast.max() - fast.min() <= 1


def test_2_05_a_axis_excluded_from_junction_angle(tmp_path: Path) -> None:
    """X goes straight on, A turns round: it brakes for that."""
    lines = [
        "STEPPER AXIS A,GP11,GP12,GP13,,10,36000,2000",
        "STEPPER POSITION HOME",
        "STEPPER GC G1 X10 A90 F3000",
        "STEPPER GC G1 X20 A180",
        "STEPPER GC G1 X30 A0",
    ]
    session = typed(tmp_path, *SET_UP, *lines, "STEPPER RUN", WAIT)
    assert session.errors() == []
    assert session.end("A") == 0
    assert session.axis("A").steps().max() == 1800
    assert hardest_acceleration(session, "A") < 1.1 * 2000 + 4 / 10 / 0.02**2


@pytest.mark.parametrize(
    ("name", "ideal_s"), [("line", 2.1), ("circle of 360", 2.61), ("circle of 90", 2.61)]
)
def test_2_06_one_junction_look_ahead(name: str, ideal_s: float, tmp_path: Path) -> None:
    """Many short segments take as long as the curve they stand for."""
    if name == "line":
        code = [f"G1 X{n * 0.5:g} F3000" for n in range(1, 201)]
    else:
        count = int(name.split()[-1])
        angles = [2 * math.pi * n / count for n in range(1, count + 1)]
        code = [f"G1 X{20 * math.sin(t):.4f} Y{20 - 20 * math.cos(t):.4f} F3000" for t in angles]
    session = typed(
        tmp_path,
        "STEPPER INIT ,512",
        *SET_UP[1:],
        "STEPPER POSITION HOME",
        *[f"STEPPER GC {line}" for line in code],
        "STEPPER RUN",
        WAIT,
    )
    assert session.errors() == []
    assert duration_s(session, "X" if name == "line" else "XY") < 1.03 * ideal_s


def test_2_06_moves_fed_one_by_one_do_not_stop(tmp_path: Path) -> None:
    """A program that keeps the queue filled needs no longer than one that fills it first."""
    session = typed(tmp_path, *READY, feed(200, "G1 X{i/2} F3000"), WAIT)
    assert duration_s(session) < 1.03 * 2.1


def test_2_07_line_arc_line_always_stops(tmp_path: Path) -> None:
    """Tangential joints are passed at the feed."""
    lines = ["G1 X50 F1200", "G3 X70 Y20 J20", "G1 Y70"]
    session = typed(
        tmp_path,
        *SET_UP,
        "STEPPER POSITION HOME",
        *[f"STEPPER GC {line}" for line in lines],
        "STEPPER RUN",
        WAIT,
    )
    assert session.errors() == []
    assert (session.end("X"), session.end("Y")) == (70, 70)
    assert slowest_between(session, "XY", 0.2, duration_s(session, "XY") - 0.2) > 19


def test_2_08_arc_feed_error(tmp_path: Path) -> None:
    """A circle at F600 goes at 10 mm/s everywhere."""
    lines = ["STEPPER GC G2 I20 F600"]
    session = typed(tmp_path, *READY, *lines, WAIT)
    assert duration_s(session, "XY") == pytest.approx(2 * math.pi * 20 / 10, rel=0.005)
    time, speed = speeds(session, "XY")
    cruising = speed[(time > 0.5) & (time < time[-1] - 0.5)]
    # The estimate counts whole steps of two axes in 5 ms: 0.0125 mm are 2.5 mm/s.
    assert abs(cruising.mean() - 10) < 0.3
    eighths = np.array_split(cruising, 8)
    assert max(abs(part.mean() - 10) for part in eighths) < 0.5


@pytest.mark.parametrize("code", ["G2", "G3"])
def test_2_09_r_arcs_reversed(code: str, tmp_path: Path) -> None:
    """Positive R is the short way round, negative R the long one."""
    side = 1 if code == "G2" else -1
    for radius, height in ((10, 10 - math.sqrt(75)), (-10, 10 + math.sqrt(75))):
        session = typed(tmp_path, *READY, f"STEPPER GC {code} X10 R{radius} F1200", WAIT)
        points = places(session, "XY")
        assert (side * points[:, 1]).max() == pytest.approx(height, abs=0.02)
        assert session.end("X") == 10
        assert session.end("Y") == 0


# ---- 2.10 to 2.16: speeds, accelerations, the queue ----------------------------------------------


@pytest.mark.parametrize("speed", [7500, 9000, 12000])
def test_2_10_over_cap_axis_hangs(speed: int, tmp_path: Path) -> None:
    """400 steps/mm at 12000 mm/min would be 80 kHz: the move runs at 50 kHz and ends."""
    session = typed(
        tmp_path,
        "STEPPER INIT",
        f"STEPPER AXIS X,GP2,GP3,,,400,{speed},2000",
        "STEPPER POSITION HOME",
        "STEPPER RUN",
        f"STEPPER GC G1 X100 F{speed}",
        WAIT,
        "PRINT PEEK(STEPPER X)",
    )
    trace = session.axis("X")
    assert trace.end_steps() == 40_000
    assert session.number() == 100
    assert np.diff(trace.step_ns).min() == 20_000
    assert duration_s(session) == pytest.approx(100 / 125 + 125 / 2000, rel=0.01)


@pytest.mark.parametrize("steps_s2", [190, 50, 99, 101, 10])
def test_2_11_low_accelerations_hang_or_are_wrong(steps_s2: int, tmp_path: Path) -> None:
    """100 mm from rest to rest take 2 sqrt(way / acceleration), whatever that is."""
    session = typed(
        tmp_path,
        "STEPPER INIT",
        f"STEPPER AXIS X,GP2,GP3,,,10,60000,{steps_s2 / 10:g}",
        "STEPPER POSITION HOME",
        "STEPPER RUN",
        "TIMER = 0 : STEPPER GC G0 X100",
        "DO : LOOP WHILE PEEK(STEPPER ACTIVE) = 1 : PRINT TIMER / 1000",
    )
    assert session.axis("X").end_steps() == 1000
    assert session.number() == pytest.approx(2 * math.sqrt(100 / (steps_s2 / 10)), rel=0.005)


@pytest.mark.parametrize("feed_word", ["F0", "F-100", "F0.0", "F-0.001"])
def test_2_12_feed_of_zero_never_completes(feed_word: str, tmp_path: Path) -> None:
    """It is refused, and the line without it does what it should."""
    session = typed(
        tmp_path,
        *READY,
        f"STEPPER GC G1 X10 {feed_word}",
        f"STEPPER GCODE G1, X, 10, F, {feed_word[1:]}",
        "STEPPER GC G1 X10 F600",
        WAIT,
        "PRINT PEEK(STEPPER X); PEEK(STEPPER ACTIVE)",
    )
    assert [error.partition(":")[0] for error in session.errors()] == ["F", "F"]
    assert session.numbers() == [10, 0]


@pytest.mark.parametrize(("move", "way"), [("X50", 50.0), ("X50 Y50", 50 * math.sqrt(2))])
def test_2_13_s_curve_is_fictitious(move: str, way: float, tmp_path: Path) -> None:
    """A jerk of 1000 mm/s^3 is kept along the path, on a diagonal as well."""
    lines = ["STEPPER SCURVE 1", "STEPPER JERK 1000", f"TIMER = 0 : STEPPER GC G1 {move} F6000"]
    done = "DO : LOOP WHILE PEEK(STEPPER ACTIVE) = 1 : PRINT TIMER / 1000"
    session = typed(tmp_path, *READY, *lines, done)
    assert session.number() == pytest.approx(4 * (way / 2000) ** (1 / 3), rel=0.03)


def test_2_14_clear_forgets_the_position(tmp_path: Path) -> None:
    """At X50 CLEAR and G0 X60 make 10 mm more."""
    lines = ["STEPPER GC G0 X50", WAIT, "STEPPER CLEAR", "STEPPER GC G0 X60", WAIT]
    session = typed(tmp_path, *READY, *lines, "PRINT PEEK(STEPPER X)")
    assert session.errors() == []
    assert session.end("X") == 60
    assert session.number() == 60


def test_2_15_position_in_motion_parts_planner_and_machine(tmp_path: Path) -> None:
    """POSITION is refused on the way; G92 changes coordinates, no way."""
    lines = [
        "STEPPER GC G1 X50 F3000",
        "PAUSE 300 : STEPPER POSITION X,7",
        "STEPPER POSITION HOME",
        "STEPPER GC G92 X0",
        "PRINT PEEK(STEPPER X)",
        "STEPPER GC G1 X10",
        WAIT,
        "PRINT PEEK(STEPPER X)",
        "STEPPER POSITION HOME",
        "STEPPER GC G1 X5",
        WAIT,
        "PRINT PEEK(STEPPER X)",
    ]
    session = typed(tmp_path, *READY, *lines)
    assert len(session.errors()) == 2
    assert error_of(session.answers[-11])
    assert error_of(session.answers[-10])
    assert session.number(-8) < 0
    assert session.number(-5) == 10
    assert session.number() == 5
    assert session.end("X") == 65
    assert hardest_acceleration(session, "X") < 1.1 * 500 + 4 / 80 / 0.02**2


def test_2_16_refused_command_damages_state(tmp_path: Path) -> None:
    """Lines refused by the full queue and sent again: the same motion without a jump."""
    lines = [
        "STEPPER INIT ,16",
        *SET_UP[1:],
        "STEPPER POSITION HOME",
        "STEPPER RUN",
        "refused = 0 : ON ERROR IGNORE",
        'FOR i=1 TO 100 : DO : ON ERROR CLEAR : STEPPER GS "G1 X"+STR$(i)+" F6000" '
        ": e=MM.ERRNO : INC refused, e<>0 : LOOP WHILE e<>0 : NEXT",
        WAIT,
        "PRINT refused; PEEK(STEPPER X)",
    ]
    session = typed(tmp_path, *lines)
    refused, place = session.numbers()
    assert refused > 100
    assert place == 100
    assert session.axis("X").end_steps() == 8000
    assert hardest_acceleration(session, "X") < 1.1 * 500 + 4 / 80 / 0.02**2
    assert duration_s(session) == pytest.approx(100 / 100 + 100 / 500, rel=0.03)


# ---- 2.17, 2.18: homing --------------------------------------------------------------------------


def test_2_17_failed_homing_disables_the_limits(tmp_path: Path) -> None:
    """Homing that fails under ON ERROR SKIP: the switches still stop the machine behind it."""
    session = typed(
        tmp_path,
        *SET_UP,
        SWITCHES,
        "STEPPER HOME X,,,,,30",
        "STEPPER RUN",
        "ON ERROR SKIP : STEPPER GC G28 X : PRINT MM.ERRNO",
        "STEPPER POSITION HOME",
        "STEPPER RUN",
        "STEPPER GC G1 X100 F3000",
        "PAUSE 4000",
        "PRINT PEEK(STEPPER STATUS)",
        switches=[Switch(X_MIN, "X", -500), Switch(X_MAX, "X", 10, below=False)],
    )
    assert session.number(-6) != 0
    assert session.axis("X").steps().max() <= 10 * 80 + 4
    assert int(session.number()) & 0b1000_0010 == 0b0000_0010
    assert session.level(ENABLE_X) == 1


def test_2_18_homing_starts_at_speed_and_measures_once(tmp_path: Path) -> None:
    """Ramps within the limits, a fast and a slow approach, a pull-off that frees the switch."""
    session = typed(
        tmp_path,
        *SET_UP,
        "STEPPER HWLIMITS GP16",
        "STEPPER RUN",
        "STEPPER GC G28 X",
        "PRINT PEEK(STEPPER X); PEEK(STEPPER STATUS) AND 129",
        switches=[Switch(X_MIN, "X", -40)],
    )
    assert session.errors() == []
    assert session.numbers() == [0, 128]
    trace = session.axis("X")
    assert hardest_acceleration(session, "X") < 1.1 * 500 + 4 / 80 / 0.02**2
    turns = np.flatnonzero(np.diff(trace.direction))
    assert len(turns) == 3  # approach, back, approach, pull off
    fast = np.diff(trace.step_ns[: turns[0]]).min()
    slow = np.diff(trace.step_ns[turns[1] + 1 : turns[2]]).min()
    assert slow > 5 * fast
    assert trace.end_steps() / 80 == pytest.approx(-40 + 3, abs=0.2)


def test_2_18_homing_can_be_broken_off(tmp_path: Path) -> None:
    """Ctrl-C in the approach: it brakes, the prompt is there."""
    session = typed(
        tmp_path,
        *SET_UP,
        SWITCHES,
        "STEPPER RUN",
        "STEPPER HOME RUN X",
        "PAUSE 300 : STEPPER STOP",
        WAIT,
        "PRINT 6 * 7",
    )
    assert session.number() == 42
    assert 0 < len(session.axis("X").step_ns) < 40 * 80
    assert hardest_acceleration(session, "X") < 1.1 * 500 + 4 / 80 / 0.02**2


# ---- 2.19 to 2.26: errors, programs, timing, numbers ---------------------------------------------

LONG_MOVE = "STEPPER GC G1 X50 F3000"


@pytest.mark.parametrize(
    "mistake",
    ["STEPPER GC G1 X", "PRNT 1", "STEPPER GC G1 X1e9", "PRINT 1/0", "STEPPER AXIS X,GP5,GP5"],
)
def test_2_19_any_error_aborts_the_job(mistake: str, tmp_path: Path) -> None:
    """A mistake at the prompt leaves motion, drivers, spindle and position alone."""
    lines = ["STEPPER SPINDLE GP14", "STEPPER GC M3", LONG_MOVE, f"PAUSE 300 : {mistake}"]
    session = typed(
        tmp_path,
        *SET_UP,
        "STEPPER POSITION HOME",
        lines[0],
        "STEPPER RUN",
        *lines[1:],
        WAIT,
        "PRINT PEEK(STEPPER X); PEEK(STEPPER STATUS) AND 128",
    )
    assert len(session.errors()) == 1
    assert session.numbers() == [50, 128]
    assert session.end("X") == 50
    assert hardest_acceleration(session, "X") < 1.1 * 500 + 4 / 80 / 0.02**2
    assert session.level(4) == 0
    assert session.level(14) == 1


def test_2_19_skipped_error_and_end_do_not_abort(tmp_path: Path) -> None:
    """A program that skips an error and ends: its motion goes on to the end."""
    text = "\n".join(
        [*READY, LONG_MOVE, "ON ERROR SKIP", "STEPPER GC G1 X", "PRINT MM.ERRNO", "END"]
    )
    session = program(tmp_path, text + "\n")
    assert session.number() != 0
    assert session.end("X") == 50
    assert hardest_acceleration(session, "X") < 1.1 * 500 + 4 / 80 / 0.02**2


def test_2_19_ctrl_c_stops_the_motors(tmp_path: Path) -> None:
    """With a ramp, and the position stays known."""
    session = typed(
        tmp_path,
        *READY,
        "STEPPER GC G1 X500 F3000",
        "PAUSE 500",
        "\x03",
        WAIT,
        "PRINT PEEK(STEPPER X); PEEK(STEPPER STATUS) AND 128",
    )
    place, known = session.numbers()
    assert 20 < place < 40
    assert place == session.end("X")
    assert known == 128
    assert hardest_acceleration(session, "X") < 1.1 * 500 + 4 / 80 / 0.02**2


PROGRAM = """\
STEPPER INIT ,64,GP22
STEPPER AXIS X,GP2,GP3,GP4,,80,6000,500
STEPPER SPINDLE GP14
STEPPER POSITION HOME
STEPPER RUN
STEPPER GC M3
STEPPER GC G1 X20 F3000
PAUSE 200
"""


def test_2_20_second_run_of_a_program(tmp_path: Path) -> None:
    """Started again in the middle of its motion: a ramp to a standstill, then all from anew."""
    session = typed(
        tmp_path,
        f"AUTOSAVE\r{PROGRAM}\x1a",
        "RUN",
        "RUN",
        WAIT,
        "RUN",
        WAIT,
        "PRINT PEEK(STEPPER X)",
    )
    assert session.errors() == []
    assert session.number() == 20
    assert hardest_acceleration(session, "X") < 1.1 * 500 + 4 / 80 / 0.02**2
    assert 2 * 1600 < len(session.axis("X").step_ns) < 3 * 1600


@pytest.mark.parametrize(
    "line", ['SAVE "b.bas"', "VAR SAVE x", "OPTION AUTORUN ON", 'OPEN "f" FOR OUTPUT AS #1']
)
def test_2_21_flash_writes_stop_the_steps(line: str, tmp_path: Path) -> None:
    """Refused while an axis moves, done behind it; the motion is the same as without."""
    move = "STEPPER GC G1 X20 F3000"
    quiet = typed(tmp_path, *READY, "x = 1", move, "PAUSE 100", WAIT)
    session = typed(
        tmp_path,
        "AUTOSAVE\rPRINT 1\r\x1a",
        *READY,
        "x = 1",
        move,
        "PAUSE 100",
        f"{line}",
        WAIT,
        f"{line}",
    )
    assert len(session.errors()) == 1
    assert "while motion is under way" in session.errors()[0]
    assert error_of(session.last) == ""
    since = [s.axis("X").step_ns - s.axis("X").step_ns[0] for s in (quiet, session)]
    assert np.array_equal(since[0], since[1])


def test_2_22_timing_jitter(tmp_path: Path) -> None:
    """At any constant rate each step of each axis is within half a tick of its time."""
    for rate_khz in (7.0, 30.0, 45.0):
        feed_mm_min = rate_khz * 1000 / 400 * 60
        lines = [
            "STEPPER INIT",
            "STEPPER AXIS X,GP2,GP3,,,400,8000,5000",
            "STEPPER AXIS Y,GP5,GP6,,,400,8000,5000",
            "STEPPER POSITION HOME",
            "STEPPER RUN",
            f"STEPPER GC G1 X100 Y37 F{feed_mm_min * math.hypot(100, 37) / 100:.6f}",
            WAIT,
        ]
        session = typed(tmp_path, *lines)
        for name, ratio in (("X", 1.0), ("Y", 0.37)):
            step_ns = session.axis(name).step_ns
            middle = step_ns[len(step_ns) // 3 : len(step_ns) * 2 // 3]
            ideal_ns = 1e6 / (rate_khz * ratio)
            off = middle - middle[0] - ideal_ns * np.arange(len(middle))
            assert off.max() - off.min() <= 10_001, (rate_khz, name)


def test_2_23_noise_trips_and_drivers_drop(tmp_path: Path) -> None:
    """20 us of noise are ignored, 100 us trip; with KEEP a Z axis stays held."""
    lines = [
        SWITCHES,
        "STEPPER HWLIMITS KEEP 1",
        "STEPPER POSITION HOME",
        "STEPPER RUN",
        "STEPPER GC G1 Z20 F1200",
        "PAUSE 3000",
        "PRINT PEEK(STEPPER STATUS) AND 128",
    ]
    levels = [Event(0, X_MIN, 1), Event(300, X_MIN, 0), Event(300.018, X_MIN, 1)]
    session = typed(tmp_path, *SET_UP, *lines, events=levels)
    assert session.end("Z") == 20
    assert session.number() == 128
    levels += [Event(500, X_MIN, 0), Event(500.1, X_MIN, 1)]
    session = typed(tmp_path, *SET_UP, *lines, events=levels)
    assert 1 < session.end("Z") < 20
    assert session.axis("Z").step_ns[-1] <= 500.04e6
    assert session.number() == 0
    assert session.level(ENABLE_Z) == 0


def test_2_24_soft_limits_to_the_step(tmp_path: Path) -> None:
    """Not half a step beyond; a refusal leaves queue, position and motion alone."""
    session = typed(
        tmp_path,
        *READY,
        "STEPPER LIMITS X,0,10",
        "STEPPER GC G1 X5 F600",
        *[f"STEPPER GC G1 X{x}" for x in ("10.01", "10.0126", "-0.01", "11")],
        "STEPPER GC G2 I5",
        "STEPPER GC G1 X10",
        WAIT,
        "PRINT PEEK(STEPPER X)",
    )
    assert session.errors() == ["X position exceeds soft limits"] * 5
    assert session.number() == 10
    assert session.axis("X").steps().max() == 800


def test_2_25_float32_everywhere(tmp_path: Path) -> None:
    """Positions print without noise, and a far turned A loses nothing."""
    lines = ["STEPPER GC G1 X33.3 Y40.04 F6000", WAIT]
    session = typed(tmp_path, *READY, *lines, "PRINT PEEK(STEPPER X), PEEK(STEPPER Y)")
    assert session.last.split() == ["33.3", "40.04"]
    far = typed(
        tmp_path,
        *SET_UP,
        "STEPPER POSITION HOME",
        "STEPPER POSITION A, 10000000",
        "STEPPER RUN",
        "STEPPER GC G91 G1 A0.1 F3600",
        feed(99, "G1 A0.1"),
        WAIT,
        "PRINT PEEK(STEPPER A) - 10000000",
    )
    assert far.errors() == []
    assert far.axis("A").end_steps() == 100
    assert far.number() == 10


def test_2_26_memory_of_blocks_and_arcs(tmp_path: Path) -> None:
    """An arc takes one slot, and the queue takes nothing from programs."""
    session = typed(
        tmp_path,
        *SET_UP,
        "STEPPER POSITION HOME",
        "before = 0 : free = PEEK(STEPPER BUFFER) : before = MM.INFO(HEAP)",
        "STEPPER GC G2 I20 F600",
        "PRINT free - PEEK(STEPPER BUFFER)",
        *["STEPPER GC G2 I20 F600"] * 30,
        "PRINT before - MM.INFO(HEAP)",
    )
    assert session.errors() == []
    assert session.number(-32) == 1
    assert session.number() == 0
