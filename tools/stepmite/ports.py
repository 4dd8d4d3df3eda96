"""Serial ports of this PC: finding boards, and a plain terminal."""

from __future__ import annotations

import serial
from rich.console import Console
from rich.table import Table
from serial.tools import list_ports, miniterm
from serial.tools.list_ports_common import ListPortInfo

RASPBERRY_PI_VID = 0x2E8A


def boards() -> list[ListPortInfo]:
    """Return the ports behind which a Raspberry Pi Pico answers."""
    return [info for info in list_ports.comports() if info.vid == RASPBERRY_PI_VID]


def show(console: Console) -> int:
    """Print all ports, boards first; return the exit code."""
    found = sorted(list_ports.comports(), key=lambda info: info.vid != RASPBERRY_PI_VID)
    if not found:
        console.print("No serial ports. Is the board plugged in, with a cable that carries data?")
        return 1
    table = Table("port", "device", "board")
    for info in found:
        table.add_row(
            info.device,
            info.description or "",
            "yes" if info.vid == RASPBERRY_PI_VID else "",
        )
    console.print(table)
    return 0


def terminal(device: str) -> int:
    """Connect this terminal with a port until Ctrl-]; return the exit code."""
    try:
        port = serial.Serial(device, 115200)
    except (serial.SerialException, OSError) as error:
        Console(stderr=True).print(f"Error: cannot open {device}: {error}", style="red")
        return 1
    term = miniterm.Miniterm(port, echo=False, eol="cr", filters=["direct"])
    term.set_rx_encoding("UTF-8")
    term.set_tx_encoding("UTF-8")
    print("Ctrl-] leaves")
    term.start()
    try:
        term.join(True)
    except KeyboardInterrupt:
        pass
    finally:
        term.stop()
        term.join()
        term.close()
    return 0
