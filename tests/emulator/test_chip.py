"""The emulated chip against what the data sheets say, seen by a program that runs on it."""

import re

import numpy as np
import pytest

from stepmite.emulator import Emulator
from stepmite.ticks import latencies_ns
from stepmite.trace import Edges

TICK, HANDLER, MAIN, INPUT = 2, 3, 4, 16
CYCLE_NS = 8


def numbers(text: str) -> dict[str, list[int]]:
    """Lines of "name ... number ... number" as a table."""
    lines = [line for line in text.splitlines() if line.strip()]
    return {
        re.match(r"[a-z_ ]*[a-z_]", line)[0]: [int(n) for n in re.findall(r"-?\b\d+\b", line)]
        for line in lines
    }


def test_flags_of_carry_and_shift_instructions(check: Emulator) -> None:
    result = numbers(check.command("a"))
    assert result == {
        f"{name} tried": [512, 0] for name in ("adcs", "sbcs", "lsls", "lsrs", "asrs", "rors")
    }


def test_cycles_of_instructions(check: Emulator) -> None:
    result = numbers(check.command("c"))
    expected = {
        "nops": 4, "loads": 4, "stores": 4, "multiply": 1, "branch": 2, "not_taken": 1, "taken": 2,
        "loop": 299, "push_pop": 6, "call": 7, "call_stack": 13, "barriers": 6, "sio": 1,
    }  # fmt: skip
    assert {name: result[name][0] for name in expected} == expected


def test_hardware_alarms_fire_in_their_microsecond(check: Emulator) -> None:
    late = re.findall(r"alarm \d+ late (-?\d+) us", check.command("c"))
    assert len(late) == 3
    assert all(0 <= int(us) <= 2 for us in late), late


@pytest.mark.parametrize("busy", [0, 1])
def test_tick_is_exact(check: Emulator, busy: int) -> None:
    """Every tick is there, at its time, whether main sleeps or computes."""
    check.clear_edges()
    check.command(f"t{busy}")
    (run,) = check.tick_runs()
    assert (run.period_ns, run.count) == (10_000, 2000)
    rising = [time for time, _, level in check.edges([TICK]) if level == 1]
    late = np.array(rising) - run.first_ns - 10_000 * np.arange(2000)
    # Exception entry, two instructions and the store; asleep, or up to one long instruction later.
    assert late.min() >= 15 * CYCLE_NS
    assert late.max() <= 30 * CYCLE_NS


def test_tick_under_usb_load_stays_in_its_period(check: Emulator) -> None:
    check.clear_edges()
    check.command("t2")
    runs = check.tick_runs()
    edges = Edges.from_rows(check.edges([TICK]))
    assert int((edges.level == 1).sum()) >= 2000
    late = latencies_ns(edges, runs)
    assert late.max() < 4000


def test_tick_masked_stopped_and_cleared(check: Emulator) -> None:
    result = numbers(check.command("x"))
    assert result["masked"] == [0, 1]  # none came, one is pending
    stopped, later = result["stopped"]
    assert stopped == later == 5


def test_first_tick_comes_one_period_after_the_start(check: Emulator) -> None:
    check.clear_edges()
    check.command("x")
    (start, _, level), *_ = check.edges([MAIN])
    assert level == 1
    first = check.tick_runs()[0].first_ns
    assert 10_000 <= first - start <= 10_000 + 60 * CYCLE_NS


def test_software_pended_interrupt(check: Emulator) -> None:
    result = check.command("i")
    assert result.replace("\r", "").splitlines() == [
        "pended calls 1 pending 0",
        "ipsr 42",
        "disabled calls 1 pending 1",
        "cleared calls 1 pending 0",
        "enabled calls 2 pending 0",
        "masked calls 2 pending 1",
        "unmasked calls 3 pending 0",
        "twice calls 101 pending 0",
    ]


def test_sleep_and_wakeup(check: Emulator) -> None:
    result = numbers(check.command("w"))
    assert result["sev"][0] <= 1
    assert result["event left"] == [result["event left"][0], 1]
    assert result["event left"][0] <= 2  # the event of the first alarm was still there
    assert result["event waited"] == [pytest.approx(500, abs=2), 2]
    assert result["sevonpend masked"] == [pytest.approx(100, abs=2), 2]
    assert result["wfi masked"] == [pytest.approx(100, abs=2), 3]
    assert result["wfi pending"][0] <= 1
    assert result["alarms"] == [5]


def test_process_and_main_stack(check: Emulator) -> None:
    result = check.command("p").replace("\r", "").splitlines()
    assert result == [
        "thread process 1 control 2",
        "handler main 1 control 0 lr fffffffd",
        "from main lr fffffff9 main 1",
    ]


def test_exception_costs_and_nesting(check: Emulator) -> None:
    """The tick interrupts USB handlers; its cycles are not counted as theirs."""
    check.clear_profile()
    check.command("t2")
    profile = check.profile()
    assert profile["systick"].function == "on_tick"
    assert profile["systick"].least == profile["systick"].most
    assert profile["irq5"].calls > 50
    assert profile["irq5"].most < 3000  # 2.4 ticks: with them it would be more


def test_measured_function_excludes_exceptions(check: Emulator) -> None:
    """The same computation, alone and with a tick of 1,250 cycles' period around it."""
    check.measure("check_systick_stop")
    check.command("x")
    cycles = check.profile()["check_systick_stop"]
    assert cycles.calls == 1
    # 35 + 11 + 50 us of waiting and 5 ticks: about 19,000 cycles
    assert 15_000 < cycles.mean < 40_000


def test_uart_takes_its_time(check: Emulator) -> None:
    check.send("u\r")
    check.run_ms(3)
    check.send_uart("from outside")
    result = numbers(check.until("\n> "))
    text = check.uart_output()
    queued, sent = result["queued"]
    # 100 frames of 10 bits at 115200 Bd (divider 67 + 52/64) last 8681 us; 32 wait in the FIFO.
    assert sent == pytest.approx(8681, abs=10)
    assert queued == pytest.approx(8681 * 67 / 100, abs=90)
    assert text == "0123456789" * 10


def test_uart_receives(check: Emulator) -> None:
    check.send("u\r")
    check.run_ms(3)
    check.send_uart("from outside")
    assert "received from outside." in check.until("\n> ")


@pytest.mark.parametrize("halves", [2, 5, 25])
def test_pio_is_exact_to_the_cycle(check: Emulator, halves: int) -> None:
    """3 cycles high, 5 low; a fractional divider falls on the clock grid without drifting."""
    check.clear_edges()
    assert "words wrong 0" in check.command(f"o{halves}")
    edges = check.edges([HANDLER])
    assert [level for _, _, level in edges] == [(i + 1) % 2 for i in range(len(edges))]
    times = np.array([time for time, _, _ in edges])
    cycles = halves / 2
    assert len(times) == pytest.approx(2 * 200_000 / (8 * cycles * CYCLE_NS), abs=30)
    rising = (times[::2] - times[0]) / CYCLE_NS
    ideal = 8 * cycles * np.arange(len(rising))
    assert np.abs(rising - ideal).max() < 1
    high = (times[1::2] - times[::2][: len(times[1::2])]) / CYCLE_NS
    assert np.abs(high - 3 * cycles).max() < 1


def test_pio_shift_registers_fill_and_empty_themselves(check: Emulator) -> None:
    """A register that is empty takes a word at once, not when it is needed (data sheet 3.5.4)."""
    assert numbers(check.command("b")) == {
        "autopull": [2, 1, 1, 0, 0, 0, 0],
        "autopush": [0, 1, 1, 2, 2, 3, 3],
    }


def test_pio_answers_a_pin_from_outside(check: Emulator) -> None:
    """It is pulled low one to two cycles after the other one falls, for four, then let go of."""
    cycle_ns = 100 * CYCLE_NS
    check.set_pin(INPUT, 1)
    check.clear_edges()
    check.send("d\r")
    check.run_ms(1)
    falls = [check.now_ns + 100_000 + 12_345 * n for n in range(10)]
    for at in falls:
        check.set_pin(INPUT, 0, at_ns=at)
        check.set_pin(INPUT, 1, at_ns=at + 8_000)
    check.until("\n> ")
    edges = check.edges([HANDLER])
    assert [level for _, _, level in edges] == [0, 1] * 10
    lows, highs = [t for t, _, _ in edges[::2]], [t for t, _, _ in edges[1::2]]
    assert all(high - low == 4 * cycle_ns for low, high in zip(lows, highs, strict=True))
    late = [low - at for low, at in zip(lows, falls, strict=True)]
    assert all(cycle_ns <= ns <= 2 * cycle_ns for ns in late)
    assert max(late) - min(late) > cycle_ns / 2  # it waits for its own cycles


def test_pins_pull_and_readback(check: Emulator) -> None:
    assert "input 1 output 1" in check.command("g")
    check.set_pin(INPUT, 0)
    assert "input 0 output 1" in check.command("g")
    check.set_pin(INPUT, None)
    assert "input 1 output 1" in check.command("g")


def test_injection_at_an_exact_time(check: Emulator) -> None:
    at = check.now_ns + 1_234_567
    check.set_pin(INPUT, 1, at_ns=at - 500)
    check.set_pin(INPUT, 0, at_ns=at)
    check.run_ms(1.2)
    assert check.level(INPUT) == 0  # pulled down until then
    check.request("run", ms=(at - 250 - check.now_ns) / 1e6)
    assert check.level(INPUT) == 1
    check.run_ms(0.001)
    assert check.level(INPUT) == 0


def test_two_drivers_on_a_pin_are_a_fault(check: Emulator) -> None:
    check.set_pin(MAIN, 0)
    check.command("g")
    assert "GPIO4 is driven from both sides" in check.faults()[0].text
    check.clear_faults()


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        (0, "write to nothing (30000000)"),
        (1, "unaligned read (20000001)"),
        (2, "breakpoint 7"),
        (3, "undefined instruction de00"),
    ],
)
def test_planted_faults_are_caught(check: Emulator, kind: int, text: str) -> None:
    check.send(f"h{kind}\r")
    check.run_ms(5)
    first, *rest = check.faults()
    assert text in first.text
    assert "fault+0x" in first.text  # the function it happened in
    assert any("lock-up" in fault.text for fault in rest)  # the SDK's handler is a breakpoint
    assert check.status()["locked"]
    check.clear_faults()


def test_write_into_the_stack_guard_is_caught(check: Emulator) -> None:
    check.send("p1\r")
    check.run_ms(20)
    assert "beside" in check.output()
    assert "write into the stack guard" in check.faults()[0].text
    check.clear_faults()


def test_restart_keeps_scratch_and_enumerates_again(check: Emulator) -> None:
    check.send("r77\r")
    check.expect("emulator-check", 2000)
    check.until("> ")
    assert "scratch 0000004d watchdog 1" in check.command("r0")
    assert check.status()["resets"] == 1
