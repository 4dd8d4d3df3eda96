"""STEPPER CHECK says of random files what STEPPER FILE then does: the error, the way, the time."""

from __future__ import annotations

import random
import re
import subprocess
from pathlib import Path

import pytest
from cam_files import PROGRAM, SETUP, checked
from cam_oracle import judge_bounds, traces_of

from stepmite.image import Image
from stepmite.trace import Edges

STEPMITE = Path(__file__).parents[2] / "build" / "host" / "stepmite"
LONGEST_S = 30.0
LIMITS = [f"STEPPER LIMITS {axis},-50,60" for axis in "XYZ"]
HOMES_OR_PROBES = re.compile(r"G(?!\d)|G\s*0*28|G\s*38|O\d", re.IGNORECASE)


def lines_of(name: str) -> list[str]:
    """Return the lines of a table of G-code, without what is said about them."""
    table = (Path(__file__).parent / name).read_text(encoding="latin-1").splitlines()
    lines = [
        re.split(r"!!|->", line)[0].strip() for line in table if line[:1] not in ("", "#", "=")
    ]
    return [line for line in lines if line and not HOMES_OR_PROBES.search(line)]


RIGHT, WRONG = lines_of("meaning.txt"), lines_of("malformed.txt")


def word(rng: random.Random, letter: str, most: float) -> str:
    return f"{letter}{rng.uniform(-most, most):.{rng.randint(0, 4)}f}"


def motion(rng: random.Random) -> str:
    """A line of motion that is right in most states."""
    kind = rng.random()
    place = " ".join(word(rng, axis, 40) for axis in rng.sample("XYZ", rng.randint(1, 3)))
    if kind < 0.3:
        return f"G0 {place}"
    if kind < 0.7:
        return f"G1 {place} F{rng.randint(300, 12000)}"
    if kind < 0.85:
        return (
            f"G{rng.choice('23')} {word(rng, 'X', 20)} {word(rng, 'Y', 20)} R{rng.randint(5, 60)}"
        )
    code = rng.choice(["G81", "G82 P20", "G83 Q1.5", "G73 Q1"])
    return f"{rng.choice(['G98', 'G99'])} {code} {place.split()[0]} Z-3 R{rng.randint(-2, 5)}"


def random_file(rng: random.Random) -> list[str]:
    lines = ["G21 G90 G17 G94 G54 G64", "G1 F3000"]
    for _ in range(rng.randint(1, 20)):
        if rng.random() < 0.85:
            lines.append(motion(rng))
        else:
            lines.append(rng.choice(RIGHT if rng.random() < 0.98 else WRONG))
    return lines


def run(folder: Path, lines: list[str], source: str) -> tuple[str, Edges]:
    """Run a BASIC program beside a G-code file."""
    image, trace = Image(folder / "flash.bin"), folder / "edges.csv"
    image.write("part.nc", "\n".join(lines).encode("latin-1"))
    image.save()
    (folder / "job.bas").write_text(source)
    options = ["--flash", image.path, "--trace", trace, folder / "job.bas"]
    done = subprocess.run(
        [STEPMITE, "--virtual", *options], capture_output=True, timeout=60, check=False
    )
    return done.stdout.decode("latin-1").replace("\r", ""), Edges.read(trace)


def compare(folder: Path, lines: list[str]) -> bool:
    """Fail if CHECK and FILE say different things; tell whether the file had no error."""
    setup = "\n".join([*SETUP, *LIMITS])
    said, _ = run(folder, lines, f'{setup}\nON ERROR SKIP\nSTEPPER CHECK "part.nc"\n?MM.ERRMSG$')
    report = checked(said)
    if report.seconds > LONGEST_S:
        return False
    program = PROGRAM.format(setup=setup).replace('STEPPER CHECK "part.nc"\n', "")
    done, edges = run(folder, lines, program)
    error = re.search(r"^Line \d+: .*$", said, re.M)
    failed = re.search(r"^Line \d+: .*$", done, re.M)
    assert (error and error[0]) == (failed and failed[0])
    if error:
        return False
    assert "G-code file done" in done
    rounded = re.findall(r"G64 P([\d.]+)", " ".join(lines))
    judge_bounds(traces_of(edges), report.machine, max(map(float, rounded), default=0.0))
    taken = re.search(r"^Taken ([\d.]+)", done, re.M)
    assert taken
    slack = 0.01 * (2 + report.pauses)
    assert report.seconds == pytest.approx(float(taken[1]) / 1000, rel=0.01, abs=slack)
    return True


@pytest.mark.parametrize("seed", range(6))
def test_check_says_what_happens(tmp_path: Path, seed: int) -> None:
    rng = random.Random(seed)
    whole = 0
    for number in range(20):
        lines = random_file(rng)
        try:
            whole += compare(tmp_path, lines)
        except AssertionError as problem:
            raise AssertionError(f"file {number}:\n" + "\n".join(lines) + f"\n{problem}") from None
    assert whole >= 3  # or nothing has been compared
