"""The pins of a BASIC program on the board: what comes out, what is counted, at what cost."""

from pathlib import Path

import numpy as np
import pytest

from stepmite.emulator import Emulator
from stepmite.ticks import first_difference, snap_to_ticks, tick_train
from stepmite.trace import Edges

SPEAK_MS = 5000


def ask(board: Emulator, line: str) -> float:
    """The number that a line prints."""
    return float(board.command(line).split()[-1])


def obey(board: Emulator, *lines: str) -> None:
    """Lines that print nothing."""
    for line in lines:
        answer = board.command(line).replace(line, "", 1).split()
        assert answer == [], (line, answer)


def write_events(path: Path, rows: list[str]) -> None:
    path.write_text("\n".join(["time_ns,gpio,level", *rows]) + "\n")


def square(board: Emulator, gpio: int, folder: Path, *, count: int, period_ns: int) -> None:
    """A square wave at a pin from now on; returns at its end."""
    start = int(board.now_ns) + 1000
    rows = [f"{start + i * period_ns // 2},{gpio},{1 - i % 2}" for i in range(2 * count)]
    path = folder / f"square{start}.csv"
    write_events(path, rows)
    board.inputs(path)
    board.run_ms((2000 + count * period_ns) / 1e6)


def test_outputs(board: Emulator) -> None:
    obey(board, "SETPIN GP2,DOUT", "SETPIN GP3,DOUT", "PIN(GP3)=1")
    assert [board.level(2), board.level(3)] == [0, 1]
    board.clear_edges()
    obey(board, "PORT(GP2,2)=1")
    assert sorted((gpio, level) for _, gpio, level in board.edges([2, 3])) == [(2, 1), (3, 0)]
    (a, _, _), (b, _, _) = board.edges([2, 3])
    assert abs(a - b) < 200  # ns: one instruction after the other
    obey(board, "SETPIN GP2,OFF")
    assert "not set up" in board.command("? PIN(GP2)")


@pytest.mark.parametrize("width_ms", [0.02, 0.5, 2.9, 3, 20])
def test_pulse_width(board: Emulator, width_ms: float) -> None:
    obey(board, "SETPIN GP2,DOUT")
    board.clear_edges()
    obey(board, f"PULSE GP2,{width_ms}")
    board.run_ms(30)
    (up_ns, _, up), (down_ns, _, down) = board.edges([2])
    assert (up, down) == (1, 0)
    # An interrupt of the console may come in between.
    assert -1000 < down_ns - up_ns - width_ms * 1e6 < 30_000


def test_several_pulses_end_while_a_program_computes(board: Emulator) -> None:
    obey(board, *(f"SETPIN GP{gpio},DOUT" for gpio in range(2, 10)))
    board.clear_edges()
    pulses = ":".join(f"PULSE GP{gpio},{gpio * 5}" for gpio in range(9, 1, -1))
    board.command(f"{pulses}:FOR i=1 TO 3000:NEXT")
    board.run_ms(60)
    edges = board.edges()
    for gpio in range(2, 10):
        up, down = (time for time, pin, _ in edges if pin == gpio)
        assert -1000 < down - up - gpio * 5e6 < 10_000


@pytest.mark.parametrize(("hz", "duty"), [(50, 7.5), (1000, 25), (20000, 50), (100000, 99)])
def test_pwm(board: Emulator, hz: int, duty: float) -> None:
    obey(board, "SETPIN GP6,PWM3A", f"PWM 3,{hz},{duty}")
    board.clear_edges()
    board.run_ms(12e3 / hz)
    edges = board.edges([6])
    rises = np.array([time for time, _, level in edges if level])
    falls = np.array([time for time, _, level in edges if not level])
    falls = falls[falls > rises[0]]
    count = min(len(rises), len(falls)) - 1
    assert count >= 9
    assert np.allclose(np.diff(rises), 1e9 / hz, rtol=2e-5, atol=10)
    assert np.allclose(falls[:count] - rises[:count], duty * 1e7 / hz, rtol=1e-4, atol=10)
    obey(board, "PWM 3,OFF")
    board.clear_edges()
    board.run_ms(12e3 / hz)
    assert board.edges([6]) == []
    assert board.level(6) == 0


def test_pwm_registers(board: Emulator) -> None:
    """What the emulator makes no edges of: both outputs, inversion, phase, a common start."""
    base = 0x40050000
    obey(board, "SETPIN GP4,PWM", "SETPIN GP5,PWM", "SETPIN GP0,PWM0A")
    obey(board, "PWM 2,1000,10,-20,1,1", "PWM 0,2000,50,,,1")
    csr, div, _, cc, top = (board.peek(base + 2 * 0x14 + 4 * i) for i in range(5))
    counts = top + 1
    assert 125e6 / (div / 16) / counts / 2 == pytest.approx(1000, rel=1e-5)
    assert cc & 0xFFFF == round(counts * 0.1)
    assert cc >> 16 == round(counts * 0.2)
    assert csr == 0b1010  # B inverted, phase correct, not running
    running = [board.peek(base + slice_ * 0x14) & 1 for slice_ in range(8)]
    assert running == [0] * 8
    board.command("PWM SYNC 0,,50")
    running = [board.peek(base + slice_ * 0x14) & 1 for slice_ in range(8)]
    assert running == [1, 0, 1, 0, 0, 0, 0, 0]


def test_servo(board: Emulator) -> None:
    obey(board, "SETPIN GP7,PWM3B", "SERVO 3,,100")
    board.clear_edges()
    board.run_ms(45)
    (up, _, _), (down, _, _) = board.edges([7])[-2:]
    assert abs(down - up - 2e6) < 2000


def test_analog(board: Emulator) -> None:
    board.set_analog(1, 2048)
    obey(board, "SETPIN GP27,AIN")
    assert ask(board, "? PIN(GP27)") == pytest.approx(2048 / 4095 * 3.3, rel=1e-8)
    obey(board, "SETPIN GP27,ARAW")
    assert ask(board, "? PIN(GP27)") == 2048
    board.set_analog(4, 876)
    assert ask(board, "? PIN(TEMP)") == pytest.approx(27 - (876 / 4095 * 3.3 - 0.706) / 0.001721)


def test_counting(board: Emulator, tmp_path: Path) -> None:
    """Up to 5 MHz, any pin, rising, falling and both."""
    board.set_pin(9, 0)
    for option, factor in ((1, 1), (2, 1), (3, 2), (4, 2)):
        obey(board, f"SETPIN GP9,CIN,{option}")
        assert ask(board, "? PIN(GP9)") == 0
        square(board, 9, tmp_path, count=777, period_ns=200)
        assert ask(board, "? PIN(GP9)") == 777 * factor
    obey(board, "PIN(GP9)=-10")
    square(board, 9, tmp_path, count=15, period_ns=10_000)
    assert ask(board, "? PIN(GP9)") == 20


def test_counting_starts_at_the_level_that_is_there(board: Emulator, tmp_path: Path) -> None:
    board.set_pin(9, 1)
    for option, expected in ((1, 4), (2, 5), (3, 9)):
        board.set_pin(9, 1)
        obey(board, f"SETPIN GP9,CIN,{option}")
        board.set_pin(9, 0)
        board.run_ms(1)
        square(board, 9, tmp_path, count=4, period_ns=1000)
        assert ask(board, "? PIN(GP9)") == expected


def test_frequency(board: Emulator, tmp_path: Path) -> None:
    board.set_pin(9, 0)
    obey(board, "SETPIN GP9,FIN,10")
    assert ask(board, "? PIN(GP9)") == 0
    square(board, 9, tmp_path, count=25_000, period_ns=2000)  # 50 ms
    assert abs(ask(board, "? PIN(GP9)") - 500_000) <= 200
    board.run_ms(25)
    assert ask(board, "? PIN(GP9)") == 0


@pytest.mark.parametrize(("period_ns", "periods"), [(1000, 1), (52_000, 10), (1_000_000, 3)])
def test_period(board: Emulator, tmp_path: Path, period_ns: int, periods: int) -> None:
    board.set_pin(9, 0)
    obey(board, f"SETPIN GP9,PIN,{periods}")
    assert ask(board, "? PIN(GP9)") == 0
    square(board, 9, tmp_path, count=3 * periods + 2, period_ns=period_ns)
    measured_ns = ask(board, "? PIN(GP9)") * 1e6
    assert abs(measured_ns - period_ns) <= 32 / periods + period_ns * 1e-8


PROGRAM = """\
AUTOSAVE
SETPIN GP9,INTB,changed
SETPIN GP10,FIN,100
DO
  a = a + 1
LOOP UNTIL INKEY$ = "q"
PRINT "changes "; n
SUB changed
  n = n + 1
END SUB
\x1a"""


def test_interrupts(board: Emulator) -> None:
    board.set_pin(9, 0)
    board.send(PROGRAM.replace("\n", "\r"))
    board.until("\n> ", SPEAK_MS)
    board.send("RUN\r")
    board.run_ms(20)
    for level in (1, 0, 1, 0, 1):
        board.set_pin(9, level)
        board.run_ms(5)
    board.send("q")
    assert board.expect(r"changes\s+(\d+)")[1] == "5"


ZIGZAG = [f"STEPPER GC G0 X{40 * (i % 2)} Y{3 * i}" for i in range(4)]


def train_of(uf2: Path, events: Path | None) -> tuple[list, float]:
    """Edges of a job by tick, and the latest of them (ns), while a program watches two pins."""
    with Emulator(uf2) as board:
        board.connect()
        board.until("> ")
        machine = [
            "STEPPER INIT ,64",
            "STEPPER AXIS X,GP2,GP3,GP4,,80,37500,20000",  # 50 kHz
            "STEPPER AXIS Y,GP5,GP6,GP7,,80,30000,20000",
            "STEPPER POSITION HOME",
            *ZIGZAG,
            "STEPPER RUN",
        ]
        board.set_pin(9, 0)
        board.set_pin(10, 0)
        program = PROGRAM.replace("DO\n", "\n".join([*machine, "DO\n"]))
        board.send(program.replace("\n", "\r"))
        board.until("\n> ", SPEAK_MS)
        board.clear_edges()
        first_run = len(board.tick_runs())
        if events is not None:
            start = int(board.now_ns) + 2_000_000
            rows = [f"{start + i * 400},{9 + i % 2},{i // 2 % 2}" for i in range(100_000)]
            write_events(events, rows)
            board.inputs(events)
        board.send("RUN\r")
        board.run_ms(450)
        underruns = board.command("q")
        assert "changes" in underruns + board.output()
        assert "underruns: 0" in board.command("STEPPER STATUS")
        assert board.faults() == []
        edges = Edges.from_rows(board.edges())
        snapped = snap_to_ticks(edges, board.tick_runs()[first_run:])
        steps = np.isin(edges.gpio, (2, 5)) & (edges.level == 1)
        late = (edges.time_ns - snapped.time_ns)[steps]
        return tick_train(snapped, (2, 3, 5, 6), (2, 5)), float(late.max())


def test_fast_inputs_do_not_disturb_motion(uf2: Path, tmp_path: Path) -> None:
    """Two inputs at 625 kHz, one of them an interrupt: not one edge moves, no tick is later."""
    quiet, quiet_late_ns = train_of(uf2, None)
    assert len(quiet) > 15_000
    busy, busy_late_ns = train_of(uf2, tmp_path / "events.csv")
    assert first_difference(quiet, busy) is None
    assert busy_late_ns <= max(quiet_late_ns, 4000)
