"""Numbers on the board, from text and to text: what Python makes of them."""

import math
import random
import struct
from decimal import ROUND_HALF_UP, Context, Decimal

from test_language import run

from stepmite.emulator import Emulator

COUNT = 1200
PROGRAM = """\
DO
  READ t$
  IF t$ = "" THEN EXIT DO
  x = VAL(t$)
  PRINT STR$(x,0,-16);" ";FORMAT$(x,"%.9g");" ";
  IF ABS(x) < 1e12 THEN PRINT STR$(x,1,3) ELSE PRINT 0
LOOP
{data}DATA ""
"""


def typed(rng: random.Random) -> str:
    """A number as people type it, or any there is, the smallest included."""
    kind = rng.randrange(4)
    if kind == 0:
        return f"{rng.uniform(-2000, 2000):.{rng.randrange(6)}f}"
    if kind == 1:
        return repr(rng.randrange(1, 10**15) * 10.0 ** rng.randrange(-14, 3))
    bits = rng.getrandbits(64) if kind == 2 else rng.getrandbits(rng.randrange(1, 53))
    value = struct.unpack("<d", struct.pack("<Q", bits))[0]
    return repr(value) if math.isfinite(value) else "0.5"


def rounded(value: float, digits: int) -> Decimal:
    """Significant digits, ties away from zero."""
    return Context(prec=digits, rounding=ROUND_HALF_UP, Emin=-400, Emax=400).plus(Decimal(value))


def batches(texts: list[str], size: int) -> list[list[str]]:
    return [texts[start : start + size] for start in range(0, len(texts), size)]


def test_numbers_are_converted_exactly(board: Emulator) -> None:
    rng = random.Random(4)
    texts = [typed(rng) for _ in range(COUNT)]
    wrong = []
    for part in batches(texts, 300):
        data = "".join(
            "DATA " + ",".join(f'"{text}"' for text in line) + "\n" for line in batches(part, 8)
        )
        shown = run(board, PROGRAM.format(data=data)).replace("\r", "").split("\n")[1:]
        assert len(shown) == len(part)
        for text, line in zip(part, shown, strict=True):
            value = float(text)
            exponent, general, fixed = line.split()
            right = len(exponent.lstrip("-").split("e")[0]) == 18
            right &= Decimal(exponent) == rounded(value, 17)
            right &= Decimal(general) == rounded(value, 9)
            if abs(value) < 1e12:
                wanted = Decimal(value).quantize(Decimal("0.001"), ROUND_HALF_UP)
                right &= Decimal(fixed) == wanted
            if not right:
                wrong.append((text, line))
    assert wrong == []
