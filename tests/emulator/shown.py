"""What a line typed at the prompt of an emulated board prints."""

from stepmite.emulator import Emulator


def command(board: Emulator, line: str, timeout_ms: float = 10_000) -> str:
    """Return what the line printed, without its echo, blanks made one."""
    shown = board.command(line, timeout_ms=timeout_ms)
    return " ".join(shown.removeprefix(line).split())
