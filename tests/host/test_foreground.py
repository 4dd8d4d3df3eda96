"""Whatever the foreground does, motion that is queued goes on: not one edge comes at another time.

The job fills the queue and is started; then the prompt gets work of all bad kinds. On this port a
statement takes 20 us of virtual time and time stands still for a host that does not read, so these
tests show that nothing the foreground calls touches the motion; that the interrupts come through is
shown on the emulated board (tests/emulator/test_stops.py) and by tests/preempt.
"""

from __future__ import annotations

import os
import re
import subprocess
import time
from pathlib import Path

import pytest
from busy_program import BEGINS, BUSY, DONE

STEPMITE = Path(__file__).parents[2] / "build" / "host" / "stepmite"
DEADLINE_S = 120.0  # wall time after which a test counts as hung
STEP_AND_DIR = range(2, 10)

SETUP = [
    "STEPPER INIT ,512",
    "STEPPER AXIS X,GP2,GP3,,,400,6000,2000",
    "STEPPER AXIS Y,GP4,GP5,,,400,6000,2000",
    "STEPPER AXIS Z,GP6,GP7,,,400,6000,2000",
    "STEPPER AXIS A,GP8,GP9,,,100,20000,5000",
    "STEPPER SCURVE 1",
    "STEPPER JERK 50000",
    "STEPPER POSITION HOME",
    'OPEN "text" FOR OUTPUT AS #1: FOR i=1 TO 500: PRINT #1, "line"; i: NEXT: CLOSE #1',
    'OPEN "log" FOR OUTPUT AS #2: OPEN "text" FOR INPUT AS #3: MKDIR "folder"',
]
JOB = [
    "G1 X40 F6000",
    "Y30 A90",
    *[f"X{40 - i / 10:.1f} Y{30 + i % 2 / 10:.1f} Z{i / 50:.2f}" for i in range(1, 200)],
    "G2 X0.1 Y10.1 I-10 J-10 F3000",
    *[f"G1 X{i % 2 * 5} Y{10 - i / 4:.2f} F5000" for i in range(1, 40)],
    "G0 X0 Y0 Z0 A0",
]
WAIT = "DO WHILE PEEK(STEPPER ACTIVE)=1: PAUSE 100: LOOP"

LOOP = 'DO WHILE PEEK(STEPPER ACTIVE)=1: a=a+1.5: b$=STR$(a)+"x": LOOP'
CHURN = (
    'DO WHILE PEEK(STEPPER ACTIVE)=1: s$="": FOR i=1 TO 60: s$=s$+CHR$(65+i MOD 26): NEXT: '
    "t$=MID$(s$,5,40)+LEFT$(s$,9): u=INSTR(t$,RIGHT$(s$,3)): LOOP"
)
LONG_TEXT = 'FOR i=1 TO 20000: PRINT "a line that is longer than nothing"; i: NEXT'
ERRORS = [
    "STEPPER GC G1 X1 X2",
    "STEPPER INIT",
    "STEPPER AXIS X,1",
    "STEPPER POSITION HOME",
    "STEPPER POSITION X,5",
    "STEPPER CLEAR",
    "STEPPER JOG X,1",
    "STEPPER OVERRIDE FEED,1000",
    "PRINT 1/0",
    'a$="x"+1',
    ") = (",
    "z" * 3000,
    "".join(chr(c) for c in range(33, 127)),
]
FILES = [
    'OPEN "more" FOR OUTPUT AS #4',
    'FOR i=1 TO 500: ON ERROR SKIP: PRINT #2, "position"; PEEK(STEPPER X): NEXT',
    "SEEK #3, 1: DO WHILE NOT EOF(#3): LINE INPUT #3, a$: LOOP",
    "FILES",
    'COPY "text" TO "copy"',
    'KILL "text"',
    'RENAME "text" AS "copy"',
    'MKDIR "another"',
    'a$=DIR$("*"): a$=DIR$()',
    'CHDIR "folder": CHDIR ".."',
    'XMODEM RECEIVE "copy"',
    "CLOSE #2",
    'LIST ALL "text"',
]
FOREGROUNDS = {
    "loop": [LOOP],
    "string churn": [CHURN],
    "errors": ERRORS * 40,
    "questions": ["STEPPER STATUS", "PRINT PEEK(STEPPER X)", "HELP STEPPER"] * 60,
    "files": FILES * 10,
    "long text": [LONG_TEXT],
    "a busy program": ["RUN"],
    "all": [*ERRORS * 5, LONG_TEXT.replace("20000", "2000"), *ERRORS, CHURN],
}


def lines(foreground: list[str]) -> bytes:
    queued = [f'STEPPER GS "{line}"' for line in JOB]
    if foreground == ["RUN"]:  # RUN stops motion, so the program starts it itself
        machine = [line for line in SETUP if line.startswith("STEPPER")]
        start = [*machine, *queued, "STEPPER RUN", BEGINS]
        program = BUSY.replace(BEGINS, "\n".join(start)).splitlines()
        typed = ["AUTOSAVE", *program, "\x1a", *foreground, WAIT, "STEPPER STATUS", ""]
        return "\r".join(typed).encode()
    typed = [*SETUP, *queued, "STEPPER RUN", *foreground, WAIT, "STEPPER STATUS", ""]
    return "\r".join(typed).encode()


def edges(trace: Path) -> list[tuple[int, ...]]:
    """The rows of the step and direction pins, times from the first step."""
    rows = [tuple(map(int, row.split(","))) for row in trace.read_text().splitlines()[1:]]
    rows = [row for row in rows if row[1] in STEP_AND_DIR]
    first_ns = next(row[0] for row in rows if row[1] % 2 == 0 and row[2] == 1)
    return [(time_ns - first_ns, *rest) for time_ns, *rest in rows if time_ns >= first_ns]


def check_status(output: str) -> None:
    assert "underruns: 0" in output
    assert f"executed: {len(JOB)}," in output
    assert re.findall(r"\((-?\d+) steps\)", output)[-4:] == ["0", "0", "0", "0"]


def run(folder: Path, foreground: list[str]) -> list[tuple[int, ...]]:
    trace = folder / "edges.csv"
    done = subprocess.run(
        [STEPMITE, "--virtual", "--trace", trace],
        input=lines(foreground),
        capture_output=True,
        timeout=DEADLINE_S,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    if "RUN" in foreground:
        assert f"\n{DONE}\r\n".encode() in done.stdout
    check_status(done.stdout[-3000:].decode())
    return edges(trace)


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> list[tuple[int, ...]]:
    rows = run(tmp_path_factory.mktemp("idle"), [])
    assert len(rows) > 50_000
    return rows


def first_difference(a: list[tuple[int, ...]], b: list[tuple[int, ...]]) -> str | None:
    for i, (left, right) in enumerate(zip(a, b, strict=False)):
        if left != right:
            return f"edge {i}: {left} instead of {right}"
    return None if len(a) == len(b) else f"{len(a)} edges instead of {len(b)}"


@pytest.mark.parametrize("name", FOREGROUNDS)
def test_not_one_edge_moves(name: str, undisturbed: list[tuple[int, ...]], tmp_path: Path) -> None:
    assert first_difference(run(tmp_path, FOREGROUNDS[name]), undisturbed) is None


def test_a_host_that_does_not_read(undisturbed: list[tuple[int, ...]], tmp_path: Path) -> None:
    """The output stays where it is until the pipe is full and the program has to wait for us."""
    trace, typed = tmp_path / "edges.csv", tmp_path / "typed"
    typed.write_bytes(lines([LONG_TEXT]))
    with typed.open() as stdin:
        process = subprocess.Popen(
            [STEPMITE, "--virtual", "--trace", trace], stdin=stdin, stdout=subprocess.PIPE
        )
    assert process.stdout is not None
    with process, process.stdout:
        read = process.stdout.fileno()
        end = time.monotonic() + DEADLINE_S
        output = b""
        while block := os.read(read, 4096):
            time.sleep(0.0005)  # slower than it writes
            output = (output + block)[-3000:]
            assert time.monotonic() < end
    assert process.returncode == 0
    check_status(output.decode())
    assert first_difference(edges(trace), undisturbed) is None


def test_a_planted_disturbance_is_seen(undisturbed: list[tuple[int, ...]], tmp_path: Path) -> None:
    slower = run(tmp_path, ["STEPPER OVERRIDE FEED,99", "STEPPER OVERRIDE FEED,100"])
    assert first_difference(slower, undisturbed) is not None
