"""Damaged flash images: errors, never a crash, never a hang, and the prompt is alive."""

from __future__ import annotations

import os
from pathlib import Path
from random import Random

import pytest
from power_cut import BEFORE, BLOCK, FILES_START, run, store

ROOT = Path(__file__).parents[2]
HOST = Path(os.environ.get("STEPMITE", ROOT / "build/host/stepmite"))
ASAN = ROOT / "build/asan/stepmite"
USED_BLOCKS = 24  # of the file system; damage is likely to matter there
PROGRAM_PLACE = 128 * 1024

SESSION = (
    'LIST\nq\nOPTION LIST\nVAR RESTORE\nFILES\nLIST ALL "old"\nLIST ALL "f/r"\n'
    'RUN\nSAVE "new"\nOPTION TAB 3\nv=5:VAR SAVE v\n'
    'OPEN "log" FOR APPEND AS #1:PRINT #1,"x":CLOSE #1\nCOPY "old" TO "f/copy"\n'
    'RENAME "small" AS "f/small"\nKILL "old"\nMKDIR "g"\nFILES "f"\nVAR CLEAR\n'
    + store('PRINT "stored"\n')
    + "RUN\nNEW\nPRINT 99\n"
)


def damage(image: bytearray, random: Random) -> None:
    """Spoil an image in one of the ways flash goes bad, or a file that was mistaken for one."""

    def place() -> int:
        if random.random() < 0.2:
            return random.choice([0, PROGRAM_PLACE]) + random.randrange(600)
        return FILES_START + random.randrange(USED_BLOCKS * BLOCK)

    def block() -> int:
        return FILES_START + random.randrange(USED_BLOCKS) * BLOCK

    kind = random.randrange(7)
    if kind == 0:  # single bits
        for _ in range(random.randrange(1, 40)):
            image[place()] ^= 1 << random.randrange(8)
    elif kind == 1:  # bits that were lost from a block
        for at in range(start := block(), start + BLOCK):
            image[at] &= random.randrange(256)
    elif kind == 2:  # blocks of zeros, or erased
        for _ in range(random.randrange(1, 4)):
            start = block()
            image[start : start + BLOCK] = random.choice([b"\0", b"\xff"]) * BLOCK
    elif kind == 3:  # blocks that are copies of others: the file system goes in circles
        for _ in range(random.randrange(1, 6)):
            to, start = block(), block()
            image[to : to + BLOCK] = image[start : start + BLOCK]
    elif kind == 4:  # noise
        start = block()
        image[start : start + BLOCK] = random.randbytes(BLOCK)
    elif kind == 5:  # the end of a block is older than its start
        start = block() + random.randrange(BLOCK)
        end = start - start % BLOCK + BLOCK
        image[start:end] = b"\xff" * (end - start)
    else:
        image[:] = random.choice([bytes(len(image)), random.randbytes(len(image))])


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """An image with all kinds of things in it."""
    image = tmp_path_factory.mktemp("base") / "flash.bin"
    code, shown = run(HOST, image, "".join(step.typed for step in BEFORE))
    assert code == 0, shown
    return image.read_bytes()


@pytest.mark.parametrize(
    ("program", "seeds"), [(HOST, range(200)), (ASAN, range(200, 320))], ids=["host", "asan"]
)
def test_damaged_images(program: Path, seeds: range, base: bytes, tmp_path: Path) -> None:
    if not program.exists():
        pytest.skip("not built")
    image = tmp_path / "flash.bin"
    for seed in seeds:
        data = bytearray(base)
        damage(data, Random(seed))
        image.write_bytes(data)
        for _ in range(2):
            code, shown = run(program, image, SESSION)
            assert code == 0, f"seed {seed}: {shown[-2000:]}"
            assert shown.endswith("PRINT 99\r\n 99\r\n> "), f"seed {seed}: {shown[-300:]}"
