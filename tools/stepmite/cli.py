"""The command line of the PC tools."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from stepmite import image_cmd

app = typer.Typer(
    help="Tools for the StepMite motion controller.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)

app.add_typer(image_cmd.app, name="image")

PortOption = Annotated[
    str | None,
    typer.Option("--port", help="Serial port; left out: the only StepMite that is plugged in."),
]


def _device(port: str | None) -> str:
    """Return the port to use; leaves with a message if it is not clear."""
    from stepmite.ports import boards

    if port is not None:
        return port
    found = [info.device for info in boards()]
    if len(found) == 1:
        return found[0]
    reason = f"several boards ({', '.join(found)})" if found else "no board found"
    Console(stderr=True).print(f"Error: {reason}: say which with --port", style="red")
    raise typer.Exit(2)


@app.command()
def stream(
    file: Annotated[Path, typer.Argument(exists=True, dir_okay=False, help="G-code file.")],
    port: PortOption = None,
    buffer_reserve: Annotated[
        int, typer.Option(min=0, help="Queue slots to leave free for other commands.")
    ] = 0,
    setup: Annotated[
        Path | None,
        typer.Option(exists=True, dir_okay=False, help="BASIC lines to send first, one by one."),
    ] = None,
    run: Annotated[
        bool, typer.Option(help="Arm the machine if it is not; without: only fill the queue.")
    ] = True,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Check the file, no board.")] = False,
    max_velocity: Annotated[float, typer.Option(min=1, help="Dry run: mm/min of each axis.")] = 6e3,
    acceleration: Annotated[float, typer.Option(min=1, help="Dry run: mm/s^2 of each axis.")] = 500,
) -> None:
    """Send a G-code file to the board and wait until it has been carried out.

    Ctrl-C brings the machine to a controlled stop. A line that the board refuses ends the job
    there.
    """
    from stepmite import stream_cmd
    from stepmite.plan import Machine

    if dry_run:
        machine = Machine((max_velocity / 60,) * 4, (acceleration,) * 4)
        raise typer.Exit(stream_cmd.dry_run(file, machine))
    raise typer.Exit(stream_cmd.run(file, _device(port), buffer_reserve, setup, run))


@app.command()
def put(
    file: Annotated[Path, typer.Argument(exists=True, dir_okay=False, help="File on this PC.")],
    name: Annotated[
        str | None, typer.Argument(help="Its name on the board; same if left out.")
    ] = None,
    port: PortOption = None,
) -> None:
    """Copy a file to the board's disk."""
    from stepmite import transfer_cmd

    raise typer.Exit(transfer_cmd.put(file, name or file.name, _device(port)))


@app.command()
def get(
    name: Annotated[str, typer.Argument(help="File on the board.")],
    file: Annotated[
        Path | None, typer.Argument(dir_okay=False, help="Where to; same name if left out.")
    ] = None,
    port: PortOption = None,
) -> None:
    """Copy a file from the board's disk."""
    from stepmite import transfer_cmd

    target = file or Path(name.replace("\\", "/").rsplit("/", 1)[-1].removeprefix("A:"))
    raise typer.Exit(transfer_cmd.get(name, target, _device(port)))


@app.command()
def ports() -> None:
    """List the serial ports; boards that may be a StepMite come first."""
    from stepmite.ports import show

    raise typer.Exit(show(Console()))


@app.command()
def console(port: PortOption = None) -> None:
    """Open the BASIC prompt of a board in this terminal; Ctrl-] leaves."""
    from stepmite.ports import terminal

    raise typer.Exit(terminal(_device(port)))


@app.command()
def plot(
    edges: Annotated[Path, typer.Argument(exists=True, dir_okay=False, help="EDGES.csv")],
    axis: Annotated[
        list[str], typer.Option(help="X=step,dir[,inv][,steps_per_unit]; once for each axis.")
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="Picture to write, PNG or SVG.")],
    gcode: Annotated[
        Path | None, typer.Option(exists=True, dir_okay=False, help="Draw the commanded path too.")
    ] = None,
) -> None:
    """Draw path, speed and acceleration from recorded step edges."""
    from stepmite import plot as plots
    from stepmite.gcode import GcodeError
    from stepmite.trace import TraceError

    try:
        plots.plot_file(edges, axis, output, gcode)
    except (TraceError, GcodeError, ValueError, OSError) as error:
        Console(stderr=True).print(f"Error: {error}", style="red", markup=False)
        raise typer.Exit(1) from None


@app.command()
def sgtune(
    driver: Annotated[str, typer.Argument(help="Axis of the driver, X for instance, or address.")],
    feed: Annotated[float, typer.Argument(min=0.001, help="Feed of the jog in mm/min.")],
    distance: Annotated[
        float | None, typer.Option(help="Way of the jog in mm; left out: one second's.")
    ] = None,
    tx_pin: Annotated[
        str | None, typer.Option(help="Wire of the driver, where an address is not enough.")
    ] = None,
    picture: Annotated[
        Path | None, typer.Option("--plot", dir_okay=False, help="Picture to write, PNG or SVG.")
    ] = None,
    port: PortOption = None,
) -> None:
    """Jog an axis with a TMC2209 and see what StallGuard reads, for sensorless homing."""
    from stepmite import sgtune_cmd

    line = sgtune_cmd.line_to_type(driver, feed, distance, tx_pin)
    raise typer.Exit(sgtune_cmd.run(_device(port), line, picture))


@app.command()
def emulate(
    uf2: Annotated[Path, typer.Argument(exists=True, dir_okay=False, help="Firmware to boot.")],
    pty: Annotated[Path | None, typer.Option(help="Link to make to the USB serial port.")] = None,
    trace: Annotated[Path | None, typer.Option(help="EDGES.csv to write.")] = None,
    inputs: Annotated[Path | None, typer.Option(help="EVENTS.csv to apply to pins.")] = None,
    flash: Annotated[Path | None, typer.Option(help="Flash image, kept across runs.")] = None,
    speed: Annotated[float, typer.Option(help="Virtual seconds per second, at most.")] = 1.0,
    report: Annotated[Path | None, typer.Option(help="JSON with profile and faults.")] = None,
) -> None:
    """Boot a UF2 in an emulated RP2040 and offer its serial port as a pty."""
    from stepmite.emulate_cmd import run as emulate_run

    raise typer.Exit(
        emulate_run(
            uf2, pty=pty, trace=trace, inputs=inputs, flash=flash, speed=speed, report=report
        )
    )


if __name__ == "__main__":
    app()
