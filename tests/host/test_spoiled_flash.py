"""A flash whose contents were spoiled: whatever is in it, the prompt comes and works."""

from __future__ import annotations

import os
import random
import subprocess
from pathlib import Path

import pytest

BUILD = Path(__file__).parents[2] / "build"
STEPMITE = Path(os.environ.get("STEPMITE_HOST", BUILD / "host" / "stepmite"))
IMAGES = int(os.environ.get("SPOILED_IMAGES", "150"))
SECTOR, PAGE = 4096, 256
CTRL_C, CTRL_Z = "\x03", "\x1a"

FILL = f"""\
OPTION TAB 4
DIM kept% = 7
VAR SAVE kept%
AUTOSAVE
PRINT "the program"
{CTRL_Z}SAVE "one.bas"
MKDIR "folder"
OPEN "folder/data" FOR OUTPUT AS #1: FOR i=1 TO 400: PRINT #1, "line"; i: NEXT: CLOSE #1
OPEN "log" FOR APPEND AS #2: FOR i=1 TO 30: PRINT #2, "entry"; i: FLUSH #2: NEXT: CLOSE
COPY "one.bas" TO "folder/two.bas"
"""
LOOK = f"""\
{CTRL_C}LIST ALL
RUN
OPTION LIST
VAR RESTORE
FILES
FILES "folder/*"
LIST ALL "one.bas"
OPEN "folder/data" FOR INPUT AS #1: DO WHILE NOT EOF(#1): LINE INPUT #1, a$: LOOP: CLOSE
OPEN "log" FOR APPEND AS #2: PRINT #2, "more": CLOSE
KILL "one.bas"
OPEN "new" FOR OUTPUT AS #3: FOR i=1 TO 200: PRINT #3, "new"; i: NEXT: CLOSE
AUTOSAVE
PRINT 6*7
{CTRL_Z}RUN
"""


def session(image: Path, typed: str) -> str:
    done = subprocess.run(
        [STEPMITE, "--virtual", "--flash", image],
        input=typed.replace("\n", "\r").encode(),
        capture_output=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stdout[-1000:] + done.stderr[-1000:]
    return done.stdout.decode(errors="replace")


@pytest.fixture(scope="module")
def filled(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    image = tmp_path_factory.mktemp("flash") / "flash"
    assert "rror" not in session(image, FILL)
    return image.read_bytes()


def spoil(rng: random.Random, content: bytes) -> bytes:
    """A few of the things that happen to a flash, mostly where something is stored."""
    spoiled = bytearray(content)
    used = [at for at in range(0, len(content), PAGE) if content[at : at + PAGE] != b"\xff" * PAGE]
    for _ in range(rng.choice([1, 1, 2, 5, 30])):
        page = rng.choice(used) if rng.random() < 0.9 else rng.randrange(0, len(content), PAGE)
        at = page + rng.randrange(PAGE)
        match rng.randrange(7):
            case 0:
                spoiled[at] ^= 1 << rng.randrange(8)
            case 1:  # bits that lost their charge
                spoiled[page : page + PAGE] = bytes(
                    b | rng.getrandbits(8) for b in spoiled[page : page + PAGE]
                )
            case 2:
                spoiled[page : page + PAGE] = b"\xff" * PAGE
            case 3:
                spoiled[page : page + PAGE] = bytes(PAGE)
            case 4:
                spoiled[page : page + PAGE] = rng.randbytes(PAGE)
            case 5:
                sector = page // SECTOR * SECTOR
                spoiled[sector : sector + SECTOR] = b"\xff" * SECTOR
            case _:  # a sector of another place
                sector, other = (rng.choice(used) // SECTOR * SECTOR for _ in range(2))
                spoiled[sector : sector + SECTOR] = content[other : other + SECTOR]
    return bytes(spoiled)


def test_what_is_looked_at_is_there(filled: bytes, tmp_path: Path) -> None:
    image = tmp_path / "flash"
    image.write_bytes(filled)
    shown = session(image, LOOK)
    assert "rror" not in shown
    assert "the program" in shown
    assert "two.bas" in shown


@pytest.mark.parametrize("part", range(3))
def test_the_prompt_comes_and_works(filled: bytes, tmp_path: Path, part: int) -> None:
    rng = random.Random(part)
    image = tmp_path / "flash"
    for number in range(IMAGES // 3):
        image.write_bytes(spoil(rng, filled))
        shown = session(image, LOOK)
        assert shown.endswith("RUN\r\n 42\r\n> "), f"image {number}: {shown[-600:]}"


def test_random_bytes(tmp_path: Path, filled: bytes) -> None:
    image = tmp_path / "flash"
    for seed in range(3):
        image.write_bytes(random.Random(seed).randbytes(len(filled)))
        shown = session(image, LOOK)
        assert shown.endswith("RUN\r\n 42\r\n> "), shown[-600:]
