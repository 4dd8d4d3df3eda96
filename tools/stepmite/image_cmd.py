"""The commands `stepmite image ls|get|put`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

app = typer.Typer(
    help="Look into a flash image (stepmite --flash, stepmite emulate --flash).",
    no_args_is_help=True,
)

ImagePath = Annotated[Path, typer.Argument(metavar="IMAGE", dir_okay=False, help="Flash image.")]


def _or_leave(work: Callable[[], None]) -> None:
    """Do the work; leaves with a message if the image is not as it should be."""
    from stepmite.image import ImageError

    try:
        work()
    except (ImageError, OSError) as error:
        Console(stderr=True).print(f"Error: {error}", style="red", markup=False)
        raise typer.Exit(1) from None


@app.command()
def ls(image: ImagePath) -> None:
    """List the files of A: with their sizes in bytes."""
    from stepmite.image import Image, ImageError

    def work() -> None:
        if not image.exists():
            raise ImageError(f"{image}: no such file")
        for path, size in Image(image).files():
            typer.echo(f"{size:10}  {path}")

    _or_leave(work)


@app.command()
def get(
    image: ImagePath,
    name: Annotated[str, typer.Argument(help="File on A:.")],
    output: Annotated[
        Path | None, typer.Argument(help="Where to write it; left out: the same name, here.")
    ] = None,
) -> None:
    """Copy a file out of an image."""
    from stepmite.image import Image

    def work() -> None:
        content = Image(image).read(name)
        (output or Path(Path(name).name)).write_bytes(content)

    _or_leave(work)


@app.command()
def put(
    image: ImagePath,
    file: Annotated[Path, typer.Argument(exists=True, dir_okay=False, help="What to copy.")],
    name: Annotated[
        str | None, typer.Argument(help="Its name on A:; left out: the same, in the root.")
    ] = None,
) -> None:
    """Copy a file into an image, which is made if it is missing."""
    from stepmite.image import Image

    def work() -> None:
        opened = Image(image)
        opened.write(name or file.name, file.read_bytes())
        opened.save()

    _or_leave(work)
