"""Files of the board's disk, from the prompt and beside motion, in virtual time."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
STEPMITE = ROOT / "build" / "host" / "stepmite"
DEADLINE_S = 60.0  # wall time after which a test counts as hung
CTRL_C, CTRL_Z = "\x03", "\x1a"

MACHINE = [
    "STEPPER INIT ,64",
    "STEPPER AXIS X,GP2,GP3,,,80,6000,500",
    "STEPPER AXIS Y,GP4,GP5,,,80,6000,500",
    "STEPPER AXIS Z,GP6,GP7,,,400,3000,500",
    "STEPPER SPINDLE GP22",
    "STEPPER POSITION HOME",
]
MOVE = ["STEPPER RUN", "STEPPER GC G1 X20 F600"]  # two seconds
WAIT = "DO: PAUSE 10: LOOP UNTIL PEEK(STEPPER ACTIVE)=0"
BUSY = "Error : The flash cannot be written while motion is under way"


def session(*typed: str, options: tuple[str | Path, ...] = ()) -> str:
    """Return what the terminal shows from the first prompt on."""
    done = subprocess.run(
        [STEPMITE, "--virtual", *options],
        input="".join(f"{line}\r" for line in typed).encode("latin-1"),
        capture_output=True,
        timeout=DEADLINE_S,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    output = done.stdout.decode("latin-1")
    return output[output.index("> ") :]


def answers(*typed: str, options: tuple[str | Path, ...] = ()) -> list[str]:
    """Return the lines of output, without prompts and what was typed."""
    lines = session(*typed, options=options).split("\r\n")
    return [line for line in lines if line and not line.startswith(">")]


def written(name: str, lines: list[str]) -> list[str]:
    """Return what to type to make a file."""
    quoted = [f'PRINT #1, "{line}"' for line in lines]
    return [f'OPEN "{name}" FOR OUTPUT AS #1', *quoted, "CLOSE #1"]


# ---- Lists ---------------------------------------------------------------------------------------


def test_files_lists_folders_then_files_in_order() -> None:
    names = [f"{n * 7919 % 1000:03}.nc" for n in range(56)] + ["f1", "f10", "f100", "f2"]
    make = [f'OPEN "{name}" FOR OUTPUT AS #1:PRINT #1, "123":CLOSE' for name in names]
    shown = answers(*make, 'MKDIR "z"', 'MKDIR "b"', "OPTION DISPLAY 100", "FILES", 'FILES "00?.*"')
    end = shown.index("2 folders, 60 files, 1024000 bytes free")
    assert shown[:2] == ["     <DIR>  b", "     <DIR>  z"]
    assert shown[2:end] == [f"         5  {name}" for name in sorted(names)]
    few = [name for name in sorted(names) if name.startswith("00")]
    assert [line.split()[-1] for line in shown[end + 1 : -1]] == few
    assert re.match(rf"0 folders, {len(few)} files?, ", shown[-1])


def test_files_lists_all_in_a_small_memory() -> None:
    """In parts then, each in order."""
    make = 'FOR i=1 TO 200:OPEN "f"+STR$(i) FOR OUTPUT AS #1:CLOSE:NEXT'
    eat = 'ON ERROR SKIP 2000:FOR i=1 TO 700:EXECUTE "DIM a"+STR$(i)+"(20)":NEXT'
    program = f"{make}\r{eat}\rFILES\rPRINT MM.ERRMSG$"
    shown = answers("OPTION DISPLAY 255", f"AUTOSAVE\r{program}\r{CTRL_Z}RUN\r  ")
    listed = [line.split()[-1] for line in shown if line.startswith("         0  f")]
    assert sorted(listed) == sorted(f"f{n}" for n in range(1, 201))
    assert listed != sorted(listed)  # it was in parts


def test_a_long_list_stops_at_each_screen() -> None:
    """A key goes on, q ends."""
    make = 'FOR i=1 TO 30:OPEN "f"+STR$(i) FOR OUTPUT AS #1:CLOSE:NEXT'
    shown = session(make, "OPTION DISPLAY 10", "FILES").split("FILES\r\n")[1]
    assert shown.count("PRESS ANY KEY") == 1  # and then the input ends
    assert shown.count(" 0  f") == 9
    shown = session(make, "OPTION DISPLAY 10", "FILES\r  q?").split("FILES\r\n")[1]
    assert shown.count("PRESS ANY KEY") == 3
    assert shown.count(" 0  f") == 27


def test_list_of_a_file() -> None:
    make = written("a.txt", [f"line {n}" for n in range(40)])
    assert answers(*make, 'LIST ALL "a.txt"') == [f"line {n}" for n in range(40)]
    shown = session(*make, 'LIST "a.txt"\rq')
    assert shown.count("line ") == 40 + 23
    assert answers('LIST "none"') == ["Error : File not found: /none"]


def test_list_of_a_binary_file_does_not_upset_the_terminal() -> None:
    make = 'OPEN "b" FOR OUTPUT AS #1:FOR i=0 TO 255:PRINT #1,CHR$(i);:NEXT:CLOSE'
    shown = session(make, 'LIST "b"').split('LIST "b"\r\n')[1]
    assert all(c >= " " or c in "\r\n\t" for c in shown)


# ---- Programs and channels -----------------------------------------------------------------------


def test_channels_of_the_prompt_stay_until_a_program_runs() -> None:
    shown = answers(
        'OPEN "a" FOR OUTPUT AS #1',
        'PRINT #1, "kept"',
        f"AUTOSAVE\rPRINT 5\r{CTRL_Z}RUN",
        "PRINT #1, 2",
        'LIST "a"',
    )
    assert shown[-3:] == [" 5", "Error : File number is not open", "kept"]


@pytest.mark.parametrize("end", ["END", "PRINT 1/0", "INPUT a", "RUN", "NEW"])
def test_what_a_program_wrote_is_stored_however_it_ends(end: str) -> None:
    once = 'IF DIR$("b")<>"" THEN END\rOPEN "b" FOR OUTPUT AS #2' if end == "RUN" else ""
    program = f'{once}\rOPEN "a" FOR OUTPUT AS #1\rPRINT #1,"kept"\r'
    program += "" if end == "NEW" else f"{end}\r"
    keys = CTRL_C if end == "INPUT a" else ""
    after = "NEW" if end == "NEW" else ""
    shown = answers(f"AUTOSAVE\r{program}{CTRL_Z}RUN\r{keys}{after}", 'LIST "a"', "PRINT EOF(1)")
    assert shown[-2:] == ["kept", "Error : File number is not open"]


def test_ctrl_c_ends_a_copy_and_leaves_the_target() -> None:
    shown = answers(
        'OPEN "a" FOR OUTPUT AS #1: FOR i=1 TO 2000: PRINT #1, "a line": NEXT: CLOSE',
        *written("b", ["old"]),
        f'COPY "a" TO "b"{CTRL_C}',
        'COPY "a" TO "c"',
        'LIST "b"',
        'OPEN "c" FOR INPUT AS #1: PRINT LOF(1)',
    )
    assert shown[-1] == " 16000"


# ---- Beside motion -------------------------------------------------------------------------------


def test_while_motion_is_under_way_nothing_is_written_and_nothing_is_lost() -> None:
    """What was refused was not done; what was taken is there in the end."""
    shown = answers(
        *MACHINE,
        *written("old", ["old"]),
        'OPEN "log" FOR OUTPUT AS #2',
        *MOVE,
        *written("new", [])[:1],
        'KILL "old"',
        'RENAME "old" AS "new"',
        'COPY "old" TO "new"',
        'MKDIR "new"',
        'XMODEM RECEIVE "new"',
        'XMODEM RECEIVE "old"',
        "XMODEM RECEIVE",
        'LIST "old"',
        "FOR i=1 TO 100: ON ERROR SKIP: PRINT #2, i: NEXT",
        "CLOSE #2",
        "PRINT PEEK(STEPPER ACTIVE)",
        WAIT,
        "FILES",
        'LIST ALL "log"',
    )
    shown = shown[shown.index(BUSY) :]
    assert shown[:8] == [BUSY] * 8
    assert shown[8:10] == ["old", " 1"]
    names = [line.split()[-1] for line in shown[10:12]]
    assert names == ["log", "old"]
    log = [int(line) for line in shown[13:]]
    assert log == list(range(1, len(log) + 1))
    assert 20 <= len(log) < 100


def test_a_log_beside_motion_that_fits_an_array_is_written_afterwards() -> None:
    """The way the user guide shows."""
    program = """\
DIM x(100)
{}
STEPPER RUN
STEPPER GC G1 X20 F600
n = 0
DO WHILE PEEK(STEPPER ACTIVE) = 1 AND n < 100
x(n) = PEEK(STEPPER X)
INC n
PAUSE 100
LOOP
OPEN "log" FOR OUTPUT AS #1
FOR i = 0 TO n - 1 : PRINT #1, STR$(x(i), 1, 2) : NEXT
CLOSE #1
"""
    shown = answers(
        f"AUTOSAVE\r{program}".replace("{}", "\n".join(MACHINE)).replace("\n", "\r")
        + f"{CTRL_Z}RUN",
        'LIST "log"',
    )
    places = [float(line) for line in shown[-18:]]
    assert places == sorted(places)
    assert 0.9 < places[-1] - places[-2] < 1.1  # 10 mm/s


def test_what_is_open_when_a_program_ends_is_stored_once_motion_has_ended(tmp_path: Path) -> None:
    """Also if the program ends by an error, which stops the motion."""
    for end in ("END", "PRINT 1/0"):
        flash = tmp_path / f"{end[:3]}.bin"
        program = 'OPEN "log" FOR OUTPUT AS #1\r' + "".join(f"{line}\r" for line in MACHINE)
        program += "STEPPER RUN\rSTEPPER GC G1 X5 F600\r"
        program += f'PAUSE 100\rPRINT #1, "on the way"\r{end}\r'
        answers(f"AUTOSAVE\r{program}{CTRL_Z}RUN", WAIT, options=("--flash", flash))
        assert answers('LIST "log"', options=("--flash", flash)) == ["on the way"]


# ---- A full disk ---------------------------------------------------------------------------------


def test_a_full_disk_is_an_error_and_costs_no_other_file() -> None:
    shown = answers(
        *written("old", ["old"]),
        'OPEN "big" FOR OUTPUT AS #1',
        "a$ = STRING$(250, 65)",
        "n=0: DO: PRINT #1, a$: n=n+1: LOOP",
        "CLOSE",
        'LIST "old"',
        'OPEN "big" FOR INPUT AS #1: s = LOF(1): PRINT s / 252 >= n, s / 252 < n + 1',
        "m=0: DO WHILE m<n: LINE INPUT #1, b$: m=m+(b$=a$): LOOP: CLOSE #1: PRINT m=n",
        'KILL "big"',
        *written("new", ["new"]),
        'LIST "new"',
        "PRINT n > 3900",
    )
    full = "Error : Not enough space on A:"
    assert shown == [full, "old", " 1\t 1", " 1", "new", " 1"]


# ---- G-code from a file --------------------------------------------------------------------------


def run_file_example() -> str:
    """The example program, with the machine of these tests."""
    text = (ROOT / "examples" / "run_file.bas").read_text()
    before, _, rest = text.partition("SUB machine\n")
    _, _, after = rest.partition("  STEPPER RUN\n")
    return "\n".join([before + "SUB machine", *MACHINE, "STEPPER RUN", after])


def test_a_gcode_file_is_carried_out(tmp_path: Path) -> None:
    """The example program runs the name plate from A:, and the motors end where they should."""
    sys.path.insert(0, str(ROOT / "tests" / "tools"))
    from synthetic import PINS, traces_of

    from stepmite.gcode import read_blocks, read_lines, target_steps
    from stepmite.trace import Edges

    lines = (ROOT / "examples" / "nameplate.nc").read_text().splitlines()
    example = run_file_example()
    trace = tmp_path / "edges.csv"
    shown = answers(
        *written("part.nc", ["%", *lines]),
        f"AUTOSAVE\r{example}".replace("\n", "\r") + CTRL_Z + 'SAVE "run_file.bas"',
        'RUN "run_file.bas", "part.nc"',
        "STEPPER STATUS",
        options=("--trace", trace),
    )
    assert "Done" in shown
    assert "underruns: 0" in "\n".join(shown)
    blocks = list(read_blocks(read_lines(ROOT / "examples" / "nameplate.nc")))
    ends = tuple(one.end_steps() for one in traces_of(Edges.read(trace), PINS))
    assert ends == target_steps(blocks[-1].target, (80, 80, 400, 1))[: len(ends)]


def test_a_bad_line_of_a_gcode_file_is_named() -> None:
    example = run_file_example()
    shown = answers(
        *written("part.nc", ["G1 X1 F600", "X2", "X3 X4", "X5"]),
        f"AUTOSAVE\r{example}".replace("\n", "\r") + CTRL_Z + 'SAVE "run_file.bas"',
        'RUN "run_file.bas", "part.nc"',
    )
    assert shown[-1] == "Error : Line 3: X given twice"


def test_what_cannot_be_stored_at_a_programs_end_is_told() -> None:
    """The disk is so full that a small file does not fit any more."""
    program = """\
OPEN "big" FOR OUTPUT AS #1
ON ERROR IGNORE
DO WHILE MM.ERRNO = 0 : PRINT #1, STRING$(250, 65) : LOOP
CLOSE #1 : ON ERROR CLEAR : ON ERROR ABORT
FOR n = 1 TO 99
PRINT n
OPEN "t" + STR$(n) FOR OUTPUT AS #1 : PRINT #1, STRING$(100, 66)
{}
CLOSE #1
NEXT
"""
    full = "Error : Not enough space on A:"

    def run(line: str, *around: str) -> list[str]:
        source = f"AUTOSAVE\r{program.format(line)}".replace("\n", "\r")
        return answers(*around[:-1], f"{source}{CTRL_Z}RUN", *around[-1:])

    shown = run("")
    assert shown[-1] == full
    last = int(shown[-3])
    shown = run(f"IF n = {last} THEN END")
    assert shown[-2:] == [f" {last}", full]
    move = " : ".join([*MACHINE, "STEPPER RUN : STEPPER GC G1 X2 F600 : END"])
    shown = run(f"IF n = {last} THEN {move}", WAIT)  # closed only when that is done
    assert shown[-2:] == ["Stepper armed", full]
