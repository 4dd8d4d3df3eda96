"""An emulated Raspberry Pi Pico in virtual time, driven from Python.

The work is done by a Node process (tests/emulator/src/control.mjs), which this module talks to in
JSON lines. Virtual time moves only inside `connect`, `run_ms` and `expect`, so what happens is the
same in every run, however slow the machine is.
"""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

from stepmite.bootrom import BootromError, ensure_bootrom

PROJECT = Path(__file__).resolve().parents[2]
BENCH = PROJECT / "tests" / "emulator"
BOOTROM = PROJECT / "build" / "bootrom_b1.bin"


class EmulatorError(Exception):
    """The emulator cannot start, or something expected did not happen."""


@dataclass(frozen=True)
class Cycles:
    """CPU cycles of an exception handler or a function."""

    calls: int
    mean: float
    least: float
    most: float
    function: str = ""
    """Handlers: the function at the vector."""


@dataclass(frozen=True)
class TickRun:
    """A stretch of SysTick running: its ticks are due at first_ns + n * period_ns."""

    first_ns: float
    period_ns: float
    count: int
    """Ticks so far."""


@dataclass(frozen=True)
class Fault:
    """Something that must not happen on a board: wild access, breakpoint, flash read while busy."""

    time_ns: float
    text: str


class Emulator:
    """A board with a UF2 in its flash, just powered up.

    `elf` gives names to functions; without it the file beside the UF2 is taken if there is one.
    `storage` is a file with the firmware's storage area (the last 256 KB of the flash): read at
    start if it exists, written by save_storage(). All times are virtual.
    """

    def __init__(self, uf2: Path, *, elf: Path | None = None, storage: Path | None = None) -> None:
        self.now_ns = 0.0
        self.fault_count = 0
        self._process = _start_node()
        self.pid = self._process.pid
        beside = uf2.with_suffix(".elf")
        elf = elf or (beside if beside.exists() else None)
        try:
            self.request(
                "boot",
                uf2=str(uf2.resolve()),
                elf=str(elf.resolve()) if elf else None,
                bootrom=str(ensure_bootrom(BOOTROM)),
                storage=str(storage.resolve()) if storage else None,
            )
        except BootromError as error:
            self.close()
            raise EmulatorError(str(error)) from error
        except EmulatorError:
            self.close()
            raise

    def __enter__(self) -> Emulator:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    # ---- The wire --------------------------------------------------------------------------------

    def post(self, op: str, **arguments: Any) -> None:  # noqa: ANN401
        """Send a request without waiting for its answer (see `answer`)."""
        if self._process.stdin is None or self._process.poll() is not None:
            raise EmulatorError("the emulator process has ended")
        self._process.stdin.write(json.dumps({"op": op, **arguments}) + "\n")
        self._process.stdin.flush()

    def answer(self) -> dict[str, Any]:
        """Wait for the answer to a posted request."""
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line:
            raise EmulatorError("the emulator process has ended")
        reply: dict[str, Any] = json.loads(line)
        if not reply["ok"]:
            raise EmulatorError(reply["error"])
        self.now_ns = reply["now"]
        self.fault_count = reply["faults"]
        return reply

    def request(self, op: str, **arguments: Any) -> dict[str, Any]:  # noqa: ANN401
        """Send a request and return its answer."""
        self.post(op, **arguments)
        return self.answer()

    def close(self) -> None:
        """End the process; files that are being written are complete then."""
        if self._process.poll() is None and self._process.stdin is not None:
            try:
                self._process.stdin.write('{"op": "close"}\n')
                self._process.stdin.close()
                self._process.wait(timeout=20)
            except (OSError, subprocess.TimeoutExpired):
                self._process.kill()
                self._process.wait()
        if self._process.stdout is not None:
            self._process.stdout.close()

    # ---- Running ---------------------------------------------------------------------------------

    def connect(self, timeout_ms: float = 1000) -> None:
        """Run until the USB host has opened the board's serial port."""
        self.request("connect", timeout_ms=timeout_ms)

    def run_ms(self, ms: float) -> None:
        """Let time pass."""
        self.request("run", ms=ms)

    def send(self, text: str) -> None:
        """Queue text (latin-1) at the USB host; it travels while time passes."""
        self.request("send", text=text)

    def expect(self, pattern: str, timeout_ms: float = 1000) -> list[str]:
        """Run until the output matches the (JavaScript) pattern; return the match and its groups.

        Takes the output up to the end of the match away. EmulatorError after `timeout_ms`.
        """
        match: list[str] = self.request("expect", pattern=pattern, timeout_ms=timeout_ms)["match"]
        return match

    def until(self, suffix: str, timeout_ms: float = 2000) -> str:
        """Run until the output ends with `suffix`; take all of it, return what stood before."""
        return str(self.request("until", suffix=suffix, timeout_ms=timeout_ms)["text"])

    def command(self, line: str, prompt: str = "\n> ", timeout_ms: float = 2000) -> str:
        """Type a line at the prompt; return what was printed until the next prompt."""
        self.send(line + "\r")
        return self.until(prompt, timeout_ms)

    def output(self) -> str:
        """Take all output that has come over USB so far."""
        return str(self.request("output")["text"])

    def send_uart(self, text: str, index: int = 0) -> None:
        """Let the other side of a UART send text, at the UART's own speed."""
        self.request("send_uart", index=index, text=text)

    def spi_words(self, index: int) -> list[dict[str, int]]:
        """Take all words that an SPI has sent: word, and its form as mode, bits and hz."""
        return list(self.request("spi_words", index=index)["words"])

    def uart_output(self, index: int = 0) -> str:
        """Take all bytes that have left a UART so far."""
        return str(self.request("uart_output", index=index)["text"])

    def host_reading(self, on: bool) -> None:
        """Off: the USB host stops collecting what the board sends."""
        self.request("host_reading", on=on)

    def unplug(self) -> None:
        """Take the USB cable out; the board goes on, as with power from elsewhere."""
        self.request("unplug")

    def plug(self) -> None:
        """Put the cable in again. `connect` waits until the port is open."""
        self.request("plug")

    def host_open(self, opened: bool, *, rts: bool | None = None) -> None:
        """Set or clear DTR (and RTS: the same if not said), as a program does with the port."""
        self.request("host_open", dtr=opened, rts=opened if rts is None else rts)

    def host_baud(self, baud: int) -> None:
        """Set the line coding; 1200 asks many boards to restart into their boot loader."""
        self.request("line_coding", baud=baud)

    # ---- Pins ------------------------------------------------------------------------------------

    def set_pin(self, gpio: int, level: int | None, at_ns: float | None = None) -> None:
        """Connect a pin to 0 or 1, or let go of it (None), now or at a time."""
        self.request("set_pin", gpio=gpio, level=level, at_ns=at_ns)

    def set_analog(self, channel: int, reading: int) -> None:
        """Set what the converter reads until the next restart: channel 0 is GP26, 4 the sensor."""
        self.request("set_analog", channel=channel, reading=reading)

    def add_axis(self, name: str, step: int, direction: int, at: int = 0) -> None:
        """Move an axis by step and direction pins from now on; it stands at step `at`."""
        self.request("add_axis", name=name, step=step, dir=direction, at=at)

    def add_switch(
        self, name: str, pin: int, begin: int = -(2**31), end: int = 2**31, bounces: int = 0
    ) -> None:
        """Drive a pin low while the axis is between two steps (both included), else high."""
        self.request("add_switch", name=name, pin=pin, **{"from": begin}, to=end, bounces=bounces)

    def add_tmc2209(
        self,
        name: str,
        tx: int,
        *,
        rx: int | None = None,
        address: int = 0,
        axis: str | None = None,
        diag: int | None = None,
        stops: tuple[int | None, int | None] = (None, None),
        **options: Any,  # noqa: ANN401
    ) -> None:
        """Wire a TMC2209 to a pin (and a receiving one); `axis` gives it steps, `diag` is driven.

        `stops`: the steps of the axis between which the motor can move. Options, see
        tests/emulator/src/tmc2209.mjs: chip (2209, 2208), clock (1.02: 2 % fast), skew (of the bits
        of answers), load (0 to 1), microsteps (of the axis's steps), measured ("motor", "random").
        """
        low, high = stops
        self.request(
            "add_tmc",
            name=name,
            tx=tx,
            rx=rx,
            address=address,
            axis=axis,
            diag=diag,
            low=low,
            high=high,
            **options,
        )

    def tmc_fault(
        self,
        fault: str,
        driver: str | None = None,
        *,
        times: int | None = None,
        for_ms: float | None = None,
        at_ns: float | None = None,
        **options: float,
    ) -> None:
        """Let a driver (or the first one) have a fault: now, or at a time.

        Counted in exchanges (`times`) or milliseconds: silent, deaf, bad-crc, late (delay_ms),
        garbled. In milliseconds: unplugged, unpowered, over-temperature (celsius), short, open-load
        (bits of DRV_STATUS), stall (at: a step). At once: brown-out. Without an end it stays.
        """
        limits = {"times": times, "for_ms": for_ms}
        limits = {key: value for key, value in limits.items() if value is not None}
        self.request("tmc_fault", name=fault, driver=driver, at_ns=at_ns, **limits, **options)

    def tmc_heal(self, driver: str | None = None) -> None:
        """End the faults of a driver, or of all."""
        self.request("tmc_heal", driver=driver)

    def tmc(self, name: str) -> dict[str, int]:
        """Return every register of a driver by name, also those that only it itself can read."""
        registers: dict[str, int] = self.request("tmc", name=name)["registers"]
        return registers

    def tmc_motor(self, name: str) -> dict[str, float]:
        """Return field, rotor and lag of a driver's motor (1/256 full steps), and its slips."""
        motor: dict[str, float] = self.request("tmc", name=name)["motor"]
        return motor

    def tmc_log(self) -> list[dict[str, Any]]:
        """Take the log of the wires: each datagram that the board has sent, each fault that began.

        time_ns, tx, kind (read, write, fault), address, register, bytes, sent; what a driver adds:
        driver, value (that it answered with), ifcnt (behind a write), reply_ns, fault.
        """
        entries: list[dict[str, Any]] = self.request("tmc_log")["entries"]
        return entries

    def axis(self, name: str) -> int:
        """Return the step at which an axis stands."""
        return int(self.request("axis", name=name)["at"])

    def level(self, gpio: int) -> int:
        """Return the level of a pin now."""
        return int(self.request("level", gpio=gpio)["level"])

    def inputs(self, events: Path) -> None:
        """Apply the edges of an EVENTS.csv at their times."""
        self.request("inputs", file=str(events.resolve()))

    def edges(self, gpios: Iterable[int] | None = None) -> list[tuple[int, int, int]]:
        """Return (time_ns, gpio, level) of every edge of output pins so far."""
        wanted = None if gpios is None else list(gpios)
        rows = self.request("edges", gpios=wanted)["edges"]
        return [(int(time_ns), int(gpio), int(level)) for time_ns, gpio, level in rows]

    def clear_edges(self) -> None:
        """Forget the edges so far."""
        self.request("clear_edges")

    def trace(self, path: Path) -> None:
        """From now on write edges to an EDGES.csv instead of keeping them; complete at close()."""
        self.request("trace", file=str(path.resolve()))

    def write_vcd(self, path: Path) -> None:
        """Write the edges so far as a waveform file."""
        self.request("write_vcd", file=str(path.resolve()))

    def tick_runs(self) -> list[TickRun]:
        """Return the stretches in which SysTick ran, for putting edges on the grid of ticks."""
        return [TickRun(**run) for run in self.request("tick_runs")["runs"]]

    # ---- Measuring -------------------------------------------------------------------------------

    def measure(self, *functions: str) -> None:
        """Count the cycles of these functions from now on (see profile)."""
        self.request("measure", functions=list(functions))

    def profile(self) -> dict[str, Cycles]:
        """Return the cycles of all exception handlers ("systick", "irq5") and measured functions.

        Handlers count from their first instruction to their return, without what interrupted them;
        entry and exit (15 + 13 cycles) come on top. Functions count their callees, but no
        exceptions.
        """
        rows = self.request("profile")["profile"]
        return {
            name: Cycles(
                row["calls"], row["mean"], row["least"], row["most"], row.get("function", "")
            )
            for name, row in rows.items()
        }

    def clear_profile(self) -> None:
        """Start counting anew."""
        self.request("clear_profile")

    def keep_samples(self, *names: str) -> None:
        """Keep the cycles of every single call of these handlers or functions."""
        self.request("keep_samples", names=list(names))

    def samples(self, name: str) -> list[float]:
        """Return the cycles of every call since keep_samples."""
        cycles: list[float] = self.request("samples", name=name)["cycles"]
        return cycles

    def peek(self, symbol: str | int) -> int:
        """Return the 32-bit word at a symbol or an address."""
        key = "symbol" if isinstance(symbol, str) else "address"
        return int(self.request("peek", **{key: symbol})["value"])

    def status(self) -> dict[str, Any]:
        """Return where the chip is: connected, resets, sleeping, pc, where, locked."""
        return self.request("status")

    def faults(self) -> list[Fault]:
        """Return everything that happened and must not."""
        return [Fault(**fault) for fault in self.request("faults")["list"]]

    def clear_faults(self) -> None:
        """Forget the faults, for a test that provoked them."""
        self.request("clear_faults")

    def save_storage(self, path: Path | None = None) -> None:
        """Write the storage area to a file, or to the one given at start."""
        self.request("save_storage", file=str(path.resolve()) if path else None)


def _start_node() -> subprocess.Popen[str]:
    node = shutil.which("node")
    if node is None:
        raise EmulatorError("the emulator needs node: `make demo` installs it")
    if not (BENCH / "node_modules" / "rp2040js").is_dir():
        raise EmulatorError("the emulator needs its npm packages: `make demo` installs them")
    # A session of its own: Ctrl-C at the terminal is for us, who then ends it in order.
    return subprocess.Popen(
        [node, str(BENCH / "src" / "control.mjs")],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        start_new_session=True,
        close_fds=False,
    )
