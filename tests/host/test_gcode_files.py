"""STEPPER FILE and STEPPER CHECK: what may happen to a file, and what is told."""

from __future__ import annotations

import re
import subprocess
from itertools import pairwise
from pathlib import Path

import pytest

from stepmite.image import Image

STEPMITE = Path(__file__).parents[2] / "build" / "host" / "stepmite"
CTRL_C, CTRL_F, CTRL_R = "\x03", "\x06", "\x12"
WAIT = "DO: PAUSE 5: LOOP WHILE PEEK(STEPPER ACTIVE) = 1"
RUNNING = "Error : A G-code file is running (STEPPER STOP ends it)"

SETUP = [
    "STEPPER INIT ,16,GP22",
    "STEPPER AXIS X,GP2,GP3,,,80,6000,500",
    "STEPPER AXIS Y,GP4,GP5,,,80,6000,500",
    "STEPPER AXIS Z,GP6,GP7,,,400,3000,500",
    "STEPPER SPINDLE GP10,,10000,,,500",
    "STEPPER POSITION HOME",
]
ARMED = [*SETUP, "STEPPER RUN"]
LONG = "G21 G90\nG1 F600\n" + "".join(f"X{n % 2} Y{n}\n" for n in range(100))


def session(
    folder: Path, files: dict[str, str | bytes], *typed: str, inputs: str = "", machine: str = ""
) -> str:
    """Return what the terminal shows when these lines are typed; `files` are on A:."""
    image = Image(folder / "flash.bin")
    for name, content in files.items():
        image.write(name, content.encode("latin-1") if isinstance(content, str) else content)
    image.save()
    options: list[str | Path] = ["--flash", image.path]
    for option, text in (("--inputs", inputs), ("--machine", machine)):
        if text:
            (folder / option[2:]).write_text(text)
            options += [option, folder / option[2:]]
    done = subprocess.run(
        [STEPMITE, "--virtual", *options],
        input="".join(f"{line}\r" for line in typed).encode("latin-1"),
        capture_output=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    output = done.stdout.decode("latin-1")
    return output[output.index("> ") :].replace("\r", "")


def answers(
    folder: Path, files: dict[str, str | bytes], *typed: str, inputs: str = "", machine: str = ""
) -> list[str]:
    """Return the lines of output, without prompts and what was typed."""
    shown = session(folder, files, *typed, inputs=inputs, machine=machine)
    return [line for line in shown.split("\n") if line and not line.startswith(">")]


def numbers(line: str) -> list[float]:
    """Return the numbers in a line."""
    return [float(number) for number in line.split()]


# ---- Reading -------------------------------------------------------------------------------------


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("last", [True, False])
def test_lines_may_end_in_any_way(tmp_path: Path, end: str, last: bool) -> None:
    """Also in the middle of what is read at once."""
    lines = ["G1 F6000", *(f"({'x' * (n % 260 % 251)}" for n in range(600)), "X2", "", "Y3"]
    text = end.join(lines) + (end if last else "")
    shown = answers(
        tmp_path,
        {"a.nc": text},
        *ARMED,
        'STEPPER FILE "a.nc"',
        WAIT,
        "PRINT PEEK(STEPPER LINE) PEEK(STEPPER PERCENT) PEEK(STEPPER X) PEEK(STEPPER Y)",
    )
    assert numbers(shown[-1]) == [len(lines), 100, 2, 3]


@pytest.mark.parametrize(
    ("text", "y"),
    [
        ("%\nG0 Y1\n%\nG0 Y2\n", 1),
        ("\n  \n % begin\nG0 Y1\n%", 1),
        ("(first)\n%\nG0 Y1\n", 0),
        ("G0 Y1\nM2\nG0 Y2\n", 1),
        ("G0 Y1\nM30\nnonsense\n", 1),
        ("G0 Y1", 1),
        ("", 0),
        ("\n\n\n", 0),
        ("%\n%\nG0 Y1", 0),
    ],
)
def test_where_a_program_begins_and_ends(tmp_path: Path, text: str, y: float) -> None:
    look = "PRINT PEEK(STEPPER Y)"
    shown = answers(tmp_path, {"a.nc": text}, *ARMED, 'STEPPER FILE "a.nc"', WAIT, look)
    assert shown[-2:] == ["G-code file done", f" {y}"]
    check = answers(tmp_path, {"a.nc": text}, *ARMED, 'STEPPER CHECK "a.nc"')
    assert "Lines: " in "".join(check)
    assert [line for line in check if line.startswith("Y:")] == (
        [f"Y: 0.000 to {y}.000 mm, machine 0.000 to {y}.000 mm"] if y else []
    )


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("X1 X2", "X given twice"),
        ("G5", "Unsupported code G5"),
        ("(" + "x" * 255, "Line too long (more than 255 characters)"),
        ("x" * 1000, "Line too long (more than 255 characters)"),
        ("X1\0", "Unexpected byte 0 in G-code"),
        ("O100 SUB", "O words are not supported - use BASIC (SUB, DO, IF)"),
        ("G81 X1 Z-1", "G81 needs R, from where the way down is at the feed"),
    ],
)
def test_a_refused_line_ends_the_file(tmp_path: Path, line: str, error: str) -> None:
    """What came before is carried out, what comes behind is not; the line is named."""
    text = f"G1 X5 F3000\nY5\n\n{line}\nY9\n"
    look = "PRINT PEEK(STEPPER X) PEEK(STEPPER Y)"
    shown = answers(tmp_path, {"a.nc": text}, *ARMED, 'STEPPER FILE "a.nc"', WAIT, look)
    assert shown[-3:] == [f"Line 4: {error}", "G-code file ended before line 4", " 5 5"]
    shown = answers(tmp_path, {"a.nc": text}, *ARMED, 'STEPPER CHECK "a.nc"')
    assert shown[-1] == f"Error : Line 4: {error}"
    assert "Y: 0.000 to 5.000 mm, machine 0.000 to 5.000 mm" in shown


@pytest.mark.parametrize("line", ["STEPPER GC G0 X3", 'STEPPER FILE "b.nc"', "STEPPER JOG X, 3"])
def test_what_comes_behind_recover_on_the_same_line(tmp_path: Path, line: str) -> None:
    """The file has ended by then, although nothing has looked at it since."""
    shown = answers(
        tmp_path,
        {"a.nc": LONG, "b.nc": "G0 X3\n"},
        *ARMED,
        "STEPPER GC G91",
        'STEPPER FILE "a.nc"',
        f"STEPPER RECOVER : STEPPER POSITION HOME : STEPPER RUN : {line}",
        WAIT,
        "PRINT PEEK(STEPPER X)",
    )
    assert not [text for text in shown if "Error" in text]
    assert shown[-1] == " 3"


@pytest.mark.parametrize("line", ["STEPPER GC G0 X3", 'STEPPER FILE "a.nc"', "STEPPER JOG X, 3"])
def test_what_comes_while_a_file_is_being_stopped(tmp_path: Path, line: str) -> None:
    """Nobody is told to stop what is stopping; the end is told when all stands."""
    shown = answers(
        tmp_path,
        {"a.nc": LONG.replace("F600", "F6000").replace("X1", "X9")},
        *ARMED,
        'STEPPER FILE "a.nc"',
        "PAUSE 150",
        f"STEPPER STOP : PRINT 1 : {line}",
        WAIT,
        "STEPPER GC G0 X3",
        WAIT,
        "PRINT PEEK(STEPPER X)",
    )
    stopping = shown.index("Error : Motion is being stopped")
    assert "G-code file stopped in line 4" in shown[stopping:]
    assert shown[-1] == " 3"


def test_a_file_that_is_stopped_at_once(tmp_path: Path) -> None:
    """None of its lines was reached: there is no line 0."""
    line = 'STEPPER FILE "a.nc" : STEPPER STOP'
    shown = answers(tmp_path, {"a.nc": LONG}, *ARMED, line, WAIT)
    assert shown[-1] == "G-code file stopped before its first line"


def test_what_is_not_ready_or_not_there(tmp_path: Path) -> None:
    files = {"a.nc": "G0 X1"}
    assert (
        answers(tmp_path, files, 'STEPPER FILE "a.nc"', 'STEPPER CHECK "a.nc"')
        == ["Error : Stepper not initialized (use STEPPER INIT)"] * 2
    )
    shown = answers(
        tmp_path,
        files,
        *SETUP,
        'STEPPER FILE "a.nc"',
        "STEPPER RUN",
        'STEPPER FILE "b.nc"',
        'STEPPER FILE ""',
        'STEPPER FILE STRING$(200, "a")',
        'STEPPER FILE "a" + CHR$(0)',
        "STEPPER FILE 5",
        "STEPPER FILE",
        'STEPPER CHECK "b.nc"',
        "STEPPER JOG X,5",
        'STEPPER FILE "a.nc"',
        "PRINT PEEK(STEPPER LINE) PEEK(STEPPER PERCENT)",
    )
    errors = [line for line in shown if line.startswith("Error")]
    assert errors[0] == "Error : Not armed (use STEPPER RUN)"
    assert errors[1] == "Error : File not found: /b.nc"
    assert errors[3].startswith("Error : Not a file name: aaaa")
    assert errors[7] == "Error : File not found: /b.nc"
    assert errors[8] == "Error : A jog is under way (use STEPPER JOG STOP)"
    assert len(errors) == 9
    assert shown[-1] == " 0 0"


# ---- While it runs -------------------------------------------------------------------------------


def test_only_the_file_moves_the_machine(tmp_path: Path) -> None:
    """And the file cannot be changed."""
    shown = answers(
        tmp_path,
        {"a.nc": LONG},
        *ARMED,
        'STEPPER FILE "a.nc"',
        "STEPPER GC G0 X9",
        'STEPPER GS "G90"',
        "STEPPER GCODE G0,X,1",
        "STEPPER JOG X,1",
        "STEPPER HOME RUN",
        'STEPPER FILE "a.nc"',
        'KILL "a.nc"',
        "PRINT PEEK(STEPPER ACTIVE)",
        "STEPPER STATUS",
        WAIT,
        "STEPPER GC G0 X9",
        WAIT,
        "PRINT PEEK(STEPPER X) PEEK(STEPPER Y)",
    )
    first = shown.index(RUNNING)
    assert shown[first : first + 8] == [RUNNING] * 6 + ["Error : File is open: /a.nc", " 1"]
    assert any(re.fullmatch(r"G-code file: line \d+, \d+ % done", line) for line in shown)
    assert shown[-2:] == ["G-code file done", " 9 99"]


def test_line_and_percent_rise_evenly(tmp_path: Path) -> None:
    """The line is that of the motors, not of the reading."""
    look = "PRINT PEEK(STEPPER LINE) PEEK(STEPPER PERCENT) PEEK(STEPPER Y)"
    program = f"FOR i = 1 TO 30: PAUSE 400: {look}: NEXT"
    shown = answers(tmp_path, {"a.nc": LONG}, *ARMED, 'STEPPER FILE "a.nc"', program)
    rows = [numbers(line) for line in shown if re.fullmatch(r"( [\d.]+){3}", line)]
    assert len(rows) == 30
    for (line, percent, y), (next_line, next_percent, _) in pairwise(rows):
        assert line <= next_line
        assert percent <= next_percent
        assert abs(line - 3 - y) <= 1
        assert abs(percent - line) <= 4


@pytest.mark.parametrize("how", ["STEPPER STOP", CTRL_C, "STEPPER ESTOP", "STEPPER CLOSE"])
def test_a_stop_ends_the_file(tmp_path: Path, how: str) -> None:
    """Then it can begin again."""
    again = [] if how != "STEPPER CLOSE" else ARMED
    again += ["STEPPER RUN"] if how == "STEPPER ESTOP" else []
    again += ["STEPPER POSITION HOME"]
    stop = f"PAUSE 9999\r{CTRL_C}" if how == CTRL_C else how
    shown = answers(
        tmp_path,
        {"a.nc": LONG, "b.nc": "G0 X7"},
        *ARMED,
        'STEPPER FILE "a.nc"',
        "PAUSE 2000",
        stop,
        "PAUSE 500",
        "PRINT PEEK(STEPPER ACTIVE) PEEK(STEPPER LINE)",
        *again,
        'STEPPER FILE "b.nc"',
        WAIT,
        "PRINT PEEK(STEPPER X)",
        'KILL "a.nc"',
    )
    stopped = [line for line in shown if line.startswith("G-code file stopped in line")]
    assert len(stopped) == 1
    active, line = numbers(shown[shown.index(stopped[0]) + 1])
    assert active == (-1 if how == "STEPPER CLOSE" else 0)
    assert 2 < line < 40
    assert shown[-2:] == ["G-code file done", " 7"]


def test_the_input_for_emergencies_ends_it(tmp_path: Path) -> None:
    shown = answers(
        tmp_path,
        {"a.nc": LONG},
        *ARMED,
        'STEPPER FILE "a.nc"',
        "PAUSE 3000",
        "PRINT PEEK(STEPPER ACTIVE)",
        inputs="2500000000,22,0\n",
    )
    assert any(line.startswith("G-code file stopped in line") for line in shown)
    assert shown[-1] == " 0"


def test_hold_resume_and_overrides(tmp_path: Path) -> None:
    """They act on the file as on all motion; it waits as long as it takes."""
    look = "PRINT PEEK(STEPPER LINE) PEEK(STEPPER SPEED)"
    shown = answers(
        tmp_path,
        {"a.nc": "G1 F600\n" + "".join(f"X{n}\n" for n in range(1, 50))},
        *ARMED,
        'STEPPER FILE "a.nc"',
        "PAUSE 1000: STEPPER HOLD: PAUSE 20000",
        look,
        "STEPPER OVERRIDE FEED,200: STEPPER RESUME: PAUSE 500",
        look,
        WAIT,
    )
    held = numbers(shown[-3])
    assert 5 < held[0] < 15
    assert held[1] == 0
    assert numbers(shown[-2])[1] == pytest.approx(1200, rel=0.01)
    assert shown[-1] == "G-code file done"


def test_a_program_goes_on_and_is_told(tmp_path: Path) -> None:
    """ON STEPPER EVENT knows the end of a file as 7."""
    program = (
        "\n".join(ARMED)
        + """
ON STEPPER EVENT happened
STEPPER FILE "a.nc"
DO
n = n + 1
LOOP UNTIL done
PRINT n > 1000; PEEK(STEPPER X)
SUB happened
DO
k = PEEK(STEPPER EVENT)
IF k = 7 THEN done = 1
LOOP WHILE k
END SUB
""".replace("\n", "\r")
    )
    shown = answers(tmp_path, {"a.nc": LONG}, f"AUTOSAVE\r{program}\x1aRUN")
    assert shown[-2:] == ["G-code file done", " 1 1"]


def test_the_end_of_a_program_lets_the_file_run(tmp_path: Path) -> None:
    program = "\r".join([*ARMED, 'STEPPER FILE "a.nc"', "PAUSE 500", ""])
    shown = answers(tmp_path, {"a.nc": LONG}, f"AUTOSAVE\r{program}\x1aRUN", WAIT)
    assert shown[-1] == "G-code file done"


def test_the_end_of_the_input_waits_for_the_file(tmp_path: Path) -> None:
    assert answers(tmp_path, {"a.nc": LONG}, *ARMED, 'STEPPER FILE "a.nc"')[-1] == (
        "G-code file done"
    )


def test_an_error_beside_it_keeps_its_text(tmp_path: Path) -> None:
    """Errors of the file and of statements come in the same moments."""
    bad = "G1 F6000\n" + "X1\nX0\n" * 20 + "Q1\n"
    program = "\r".join(
        [
            *ARMED,
            'STEPPER FILE "a.nc"',
            "DO",
            "ON ERROR SKIP",
            "x = 1 / 0",
            'IF MM.ERRMSG$ <> "Divide by zero" THEN PRINT "WRO" + "NG " + MM.ERRMSG$',
            "LOOP WHILE PEEK(STEPPER ACTIVE) = 1",
        ]
    )
    shown = answers(tmp_path, {"a.nc": bad}, f"AUTOSAVE\r{program}\r\x1aRUN")
    assert not any("WRONG" in line for line in shown)
    assert any(line.startswith("Line 42: ") for line in shown)


def test_a_file_that_homes(tmp_path: Path) -> None:
    """It waits for the end of homing; if that fails the file has failed."""
    switch = "switch pin=12 axis=X from=-100000 to=0\n"
    machine = "axis X step=2 dir=3 at=400\n" + switch
    lines = "G28 X0\nG1 X20 F3000\nG28 X0\nG0 X5\n"
    hw = "STEPPER HWLIMITS GP12,0,0"
    setup = [*SETUP[:-1], hw, "STEPPER RUN", 'STEPPER FILE "a.nc"', WAIT, "PRINT PEEK(STEPPER X)"]
    shown = answers(tmp_path, {"a.nc": lines}, *setup, machine=machine)
    assert shown[-2:] == ["G-code file done", " 5"]
    setup[-3:-3] = ["STEPPER HOME X,,,,,2"]
    far = machine.replace("at=400", "at=40000")
    shown = answers(tmp_path, {"a.nc": lines}, *setup, machine=far)
    failed = [line for line in shown if line.startswith("Line 1: ")]
    assert len(failed) == 1
    assert "G-code file ended before line 1" in shown


def test_a_pause_waits_for_the_user(tmp_path: Path) -> None:
    look = "PRINT PEEK(STEPPER LINE) PEEK(STEPPER X) PEEK(STEPPER ACTIVE)"
    shown = answers(
        tmp_path,
        {"a.nc": "G0 X1\nM0\nG0 X2\nM6 T3\nG0 X3\nM1\nG0 X4"},
        *ARMED,
        'STEPPER FILE "a.nc"',
        f"PAUSE 3000: {look}",
        f"STEPPER RESUME: PAUSE 3000: {look}",
        f"STEPPER RESUME: PAUSE 3000: {look}",
    )
    found = [numbers(line) for line in shown if re.fullmatch(r"( [\d.]+){3}", line)]
    assert found == [[2, 1, 1], [4, 2, 1], [7, 4, 0]]


# ---- STEPPER CHECK -------------------------------------------------------------------------------


def test_check_changes_nothing(tmp_path: Path) -> None:
    """Neither modes nor offsets, and it begins with those in force."""
    text = (
        "G20 G91 G18 G93 G99 G61\nG10 L2 P1 X1\nG55\nG92 X5\nT4 M6\nG43.1 Z3\nG94 G1 X1 F10\nM3 S9"
    )
    modes = "STEPPER STATUS"
    shown = session(
        tmp_path,
        {"a.nc": text, "b.nc": "X5 Y1"},
        *SETUP,
        "STEPPER GC G10 L2 P3 X100 Y-50 Z1",
        "STEPPER GC G56 G1 F1200 G90",
        modes,
        'STEPPER CHECK "a.nc"',
        modes,
        'STEPPER CHECK "b.nc"',
    )
    before, middle, after = shown.split("> STEPPER STATUS\n")[0:3]
    assert before
    assert middle.split("> STEPPER CHECK")[0] == after.split("> STEPPER CHECK")[0]
    assert "X: 0.000 to 25.400 mm" not in after
    assert "X: -100.000 to 5.000 mm, machine 0.000 to 105.000 mm" in after
    assert "Y: 1.000 to 50.000 mm, machine -49.000 to 0.000 mm" in after


def test_check_finds_what_leaves_the_limits(tmp_path: Path) -> None:
    """Lines and the true extent of arcs; the report is of the whole file."""
    limits = ["STEPPER LIMITS X,-1,10", "STEPPER LIMITS Y,-1,10"]
    arc = "G1 F600\nX10\nG3 X0 Y0 I-5 J0\nG2 X10 Y0 I5 J0\nG2 X0 Y0 I-5 J0\nG1 Y5\nX11"
    shown = answers(tmp_path, {"a.nc": arc}, *SETUP, *limits, 'STEPPER CHECK "a.nc"')
    assert shown[-1] == "Error : Line 5: Y position exceeds soft limits"
    assert "X: 0.000 to 11.000 mm, machine 0.000 to 11.000 mm" in shown
    assert "Y: -5.000 to 5.000 mm, machine -5.000 to 5.000 mm" in shown
    shown = answers(tmp_path, {"a.nc": arc}, *SETUP, limits[0], 'STEPPER CHECK "a.nc"')
    assert shown[-1] == "Error : Line 7: X position exceeds soft limits"
    inside = "\n".join(arc.split("\n")[:4])
    assert "Error" not in answers(tmp_path, {"a.nc": inside}, *SETUP, *limits, "")[-1]


def test_check_beside_a_running_file(tmp_path: Path) -> None:
    """The file runs on as if nothing was."""
    shown = answers(
        tmp_path,
        {"a.nc": LONG, "b.nc": "G0 X50\n" * 500},
        *ARMED,
        'STEPPER FILE "a.nc"',
        "PAUSE 500",
        'STEPPER CHECK "b.nc"',
        'STEPPER CHECK "a.nc"',
        WAIT,
        "PRINT PEEK(STEPPER X) PEEK(STEPPER Y)",
    )
    assert "Lines: 500, moves: 500, pauses: 0" in shown
    assert "Lines: 102, moves: 100, pauses: 0" in shown
    assert shown[-2:] == ["G-code file done", " 1 99"]


def test_check_ends_at_ctrl_c(tmp_path: Path) -> None:
    """A long file says nothing then, and is closed."""
    shown = answers(
        tmp_path,
        {"a.nc": "G1 X1 F100\nX0\n" * 5000},
        *SETUP,
        f'STEPPER CHECK "a.nc"{CTRL_C}',
        'KILL "a.nc"',
        "PRINT 5",
    )
    assert not any(line.startswith("Lines") for line in shown)
    assert shown[-1] == " 5"


def test_check_counts_what_takes_time(tmp_path: Path) -> None:
    """Dwells and spin-ups; a spindle that turns already needs none."""
    text = "M3 S1000\nG4 P250\nS2000\nM5\nM3\nM4\n".replace("M4\n", "")
    shown = answers(tmp_path, {"a.nc": text}, *SETUP, 'STEPPER CHECK "a.nc"')
    assert "Time: 0:00:01 (1.25 s)" in shown
    shown = answers(tmp_path, {"a.nc": "G4 P3725000"}, *SETUP, 'STEPPER CHECK "a.nc"')
    assert "Time: 1:02:05 (3725.00 s)" in shown


def test_check_sees_what_has_no_pin(tmp_path: Path) -> None:
    """As the machine would."""
    for line, error in (
        ("M4 S100", "no dir_pin"),
        ("M8", "oolant"),
        ("A5 G0", "A axis not configured (use STEPPER AXIS)"),
    ):
        shown = answers(tmp_path, {"a.nc": f"G90\n{line}"}, *SETUP, 'STEPPER CHECK "a.nc"')
        assert shown[-1].startswith("Error : Line 2: ")
        assert error in shown[-1]
