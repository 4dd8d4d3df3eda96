"""Flash images of the host program and the emulator: the files of A: in them."""

from __future__ import annotations

from pathlib import Path

from littlefs import LittleFS, LittleFSError, UserContext

IMAGE_SIZE = 1280 * 1024  # bytes
FILES_START = 256 * 1024  # behind the two places of the program
BLOCK = 4096  # bytes
WRITE = 128  # bytes written at once
NAME_MAX = 63


class ImageError(Exception):
    """What is wrong with the image or a name in it."""


class Image:
    """An image that is open; `save` writes changes back."""

    def __init__(self, path: Path) -> None:
        """Open an image; a file that is missing is an empty one."""
        self.path = path
        self.data = (
            bytearray(path.read_bytes()) if path.exists() else bytearray(b"\xff" * IMAGE_SIZE)
        )
        if len(self.data) != IMAGE_SIZE:
            raise ImageError(
                f"{path}: a flash image has {IMAGE_SIZE} bytes, this file has {len(self.data)}"
            )
        self.context = UserContext(buffer=self.data[FILES_START:])
        self.volume = LittleFS(
            self.context,
            mount=False,
            block_size=BLOCK,
            block_count=(IMAGE_SIZE - FILES_START) // BLOCK,
            read_size=16,
            prog_size=WRITE,
            cache_size=WRITE,
            lookahead_size=32,
            block_cycles=500,
            name_max=NAME_MAX,
        )
        if set(self.context.buffer[: 2 * BLOCK]) == {0xFF}:
            self.volume.format()
        try:
            self.volume.mount()
        except LittleFSError as error:
            raise ImageError(f"{path}: the files on A: are damaged ({error})") from None

    def save(self) -> None:
        """Write the image back as a whole."""
        self.data[FILES_START:] = self.context.buffer
        new = self.path.with_name(self.path.name + ".new")
        new.write_bytes(self.data)
        new.replace(self.path)

    def files(self) -> list[tuple[str, int]]:
        """Return path and size of every file of the user's, sorted."""
        found = []
        for folder, _, names in self.volume.walk("/"):
            for name in names:
                path = f"{folder.rstrip('/')}/{name}"
                if not name.startswith("."):
                    found.append((path, self.volume.stat(path).size))
        return sorted(found)

    def read(self, name: str) -> bytes:
        """Return what a file holds."""
        try:
            with self.volume.open(place_of(name), "rb") as file:
                return file.read()
        except FileNotFoundError:
            raise ImageError(f"{name}: not in {self.path}") from None
        except (LittleFSError, OSError) as error:
            raise ImageError(f"{name}: {error}") from None

    def write(self, name: str, content: bytes) -> None:
        """Make this the content of a file, with the folders it needs."""
        place = place_of(name)
        try:
            self.volume.makedirs(str(Path(place).parent), exist_ok=True)
            with self.volume.open(place, "wb") as file:
                file.write(content)
        except (LittleFSError, OSError) as error:
            raise ImageError(f"{name}: {error}") from None


def place_of(name: str) -> str:
    """Return a name as the board understands it, from the root."""
    if name[:2].upper() == "A:":
        name = name[2:]
    return "/" + name.lstrip("/")
