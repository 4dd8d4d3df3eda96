"""The prompt as a terminal sees it: echo, editing keys, errors, programs typed in, bad input."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path
from random import Random

import pytest

PROGRAM = os.environ.get("STEPMITE", str(Path(__file__).parents[2] / "build/host/stepmite"))
TIMEOUT_S = 20
CTRL_C, CTRL_U, CTRL_Z, BACKSPACE = "\x03", "\x15", "\x1a", "\x7f"
UP, DOWN, RIGHT, LEFT = (f"\x1b[{letter}" for letter in "ABCD")
HOME, INSERT, DELETE, END = (f"\x1b[{number}~" for number in "1234")


def session(typed: str | bytes, *options: str) -> str:
    """What the terminal shows from the first prompt on."""
    data = typed if isinstance(typed, bytes) else typed.encode("latin-1")
    done = subprocess.run(
        [PROGRAM, "--virtual", *options],
        input=data,
        capture_output=True,
        timeout=TIMEOUT_S,
        check=False,
    )
    assert done.returncode == 0, done.stderr.decode()
    output = done.stdout.decode("latin-1")
    return output[output.index("> ") :]


def answers(typed: str | bytes, *options: str) -> list[str]:
    """The output lines alone, without prompts and what was typed."""
    lines = session(typed, *options).split("\r\n")
    return [line for line in lines if not line.startswith("> ") and line != ">" and line != ""]


def test_a_line_gives_echo_output_and_the_next_prompt():
    assert session("PRINT 5\r") == "> PRINT 5\r\n 5\r\n> "


def test_an_error_is_one_line():
    assert session("PRINT 1/0\r") == "> PRINT 1/0\r\nError : Divide by zero\r\n> "


def test_output_without_a_line_end_gets_one_before_the_prompt():
    assert session('PRINT "a";\r') == '> PRINT "a";\r\na\r\n> '


@pytest.mark.parametrize("end", ["\r", "\n", "\r\n"])
def test_each_line_end_counts_once(end):
    assert answers(f"PRINT 1{end}PRINT 2{end}") == [" 1", " 2"]


def test_the_last_line_needs_no_end():
    assert answers("PRINT 1\rPRINT 2") == [" 1", " 2"]


def test_an_empty_line_does_nothing():
    assert session("\r\r") == "> \r\n> \r\n> "


@pytest.mark.parametrize(
    ("typed", "answer"),
    [
        ("1+2", " 3"),
        ('"a" + "b"', "ab"),
        ("-2^2", " 4"),
        ("SQR(16)", " 4"),
        ("(1+2)*3", " 9"),
        ("7 MOD 4", " 3"),
        ("NOT 0", " 1"),
        ("MATH(POWER 2, 10)", " 1024"),
        ("TIMER * 0", " 0"),
    ],
)
def test_an_expression_prints_its_value(typed, answer):
    assert answers(typed + "\r") == [answer]


def test_variables_stay_between_lines():
    assert answers('a=5\rb$="x"\ra\rPRINT a;b$\r') == [" 5", " 5x"]


def test_a_line_number_at_the_prompt_is_ignored():
    assert answers("10 PRINT 7\r") == [" 7"]


def test_a_loop_in_one_line():
    assert answers("FOR i=1 TO 3:PRINT i;:NEXT\r") == [" 1 2 3"]


def test_unknown_words():
    assert answers("foo\rfoo 1\rPRINT 1 +\r") == [
        "Error : Unknown command",
        "Error : Unknown command",
        "Error : Invalid syntax",
    ]


@pytest.mark.parametrize(
    ("typed", "answer"),
    [
        ("PRINT 15" + LEFT + LEFT + DELETE, " 5"),
        ("RINT 1" + HOME + "P", " 1"),
        ("PRINT 1" + HOME + END + "2", " 12"),
        ("PRINT 129\x7f\b" + "0", " 10"),
        ("PRINT 12" + LEFT + INSERT + "3", " 13"),
        ("PRINT 12" + LEFT + LEFT + RIGHT + "3", " 132"),
        ("rubbish" + CTRL_U + "PRINT 3", " 3"),
        ("rubbish" + CTRL_C + "PRINT 4", " 4"),
    ],
)
def test_editing_keys(typed, answer):
    assert answers(typed + "\r")[-1] == answer


def test_history_goes_up_and_down():
    typed = "PRINT 1\rPRINT 2\r" + UP + UP + "\r" + UP + UP + UP + DOWN + "\r"
    outputs = [line for line in session(typed).split("\r\n") if line.startswith(" ")]
    assert outputs == [" 1", " 2", " 1", " 2"]


def test_the_same_line_twice_is_one_in_the_history():
    typed = "PRINT 1\rPRINT 2\rPRINT 2\r" + UP + UP + "\r"
    assert session(typed).split("\r\n")[-2] == " 1"


def test_a_line_too_long_is_refused_as_a_whole():
    assert answers("PRINT " + "1" * 10000 + "\rPRINT 2\r") == [
        line for line in answers("PRINT " + "1" * 10000 + "\rPRINT 2\r") if "1111" in line
    ] + ["Error : Line too long (more than 255 characters)", " 2"]


def test_a_line_of_the_full_length():
    line = 'PRINT "' + "x" * 247 + '"'
    assert len(line) == 255
    assert "x" * 247 in answers(line + "\r")


def test_binary_noise_is_harmless():
    noise = bytes(b for b in range(256) if b not in (3, 10, 13, 26)) * 3
    shown = session(noise + b"\x15\rPRINT 1\r\x00\xff\xfe\x1b[[[~\x15\rPRINT 2\r")
    assert "\r\n 1\r\n" in shown
    assert "\r\n 2\r\n" in shown


def test_help():
    overview = "\n".join(answers("HELP\r"))
    assert "PRINT" in overview
    assert "MID$" in overview
    assert answers("HELP for\r")[0].startswith("FOR name = first TO last")
    assert answers("HELP nothing\r") == ["Error : No help for nothing"]
    assert answers("HELP next\r") == answers("HELP FOR\r")
    assert answers("HELP return\r") == answers("HELP GOSUB\r")
    product, *language = answers("HELP ON\r")  # a command of the machine begins with this word
    assert product.strip() == "ON STEPPER EVENT"
    assert answers("HELP on key\r") == language
    assert answers("HELP line input\r") == answers("HELP LINE\r")
    assert answers("HELP x\r") == ["Error : No help for x"]
    assert answers("HELP PORT\r")[0] == "PORT(start, bits [, start, bits] ...)"
    assert answers("HELP PIN\r")[0] == "PIN(pin)"


def enter(program: str) -> str:
    return "AUTOSAVE\r" + program.replace("\n", "\r") + CTRL_Z


def test_a_program_typed_in_runs_and_lists():
    program = 'PRINT "one"\nPRINT "two"\n'
    shown = answers(enter(program) + "RUN\rLIST\r")
    assert shown == ['PRINT "one"', 'PRINT "two"', "one", "two", 'PRINT "one"', 'PRINT "two"']


def test_ctrl_c_leaves_autosave_and_keeps_the_old_program():
    typed = enter("PRINT 1\n") + "AUTOSAVE\rPRINT 2\r" + CTRL_C + "RUN\r"
    assert answers(typed)[-1] == " 1"


def test_a_sub_of_the_program_is_a_command_at_the_prompt():
    typed = enter("SUB hi(n)\nPRINT n*2\nEND SUB\n") + "hi 21\r"
    assert answers(typed)[-1] == " 42"


def test_an_error_in_the_program_shows_line_and_text():
    typed = enter("PRINT 1\nPRINT 1/0 ' bad\n") + "RUN\r"
    assert answers(typed)[-3:] == [" 1", "[2] PRINT 1/0 ' bad", "Error : Divide by zero"]


def test_variables_of_the_program_can_be_looked_at_afterwards():
    assert answers(enter("a=7\n") + "RUN\rPRINT a\r")[-1] == " 7"


def test_new_deletes_the_program():
    assert answers(enter("PRINT 1\n") + "NEW\rRUN\rLIST\r")[-1] == "Error : No program"


def test_the_program_survives_power_off(tmp_path):
    image = str(tmp_path / "flash.bin")
    session(enter("PRINT 11\n"), "--flash", image)
    assert answers("RUN\r", "--flash", image) == [" 11"]
    session(enter("PRINT 22\n"), "--flash", image)
    assert answers("RUN\r", "--flash", image) == [" 22"]
    session("NEW\r", "--flash", image)
    assert answers("RUN\r", "--flash", image) == ["Error : No program"]


def test_a_damaged_image_is_reported_and_the_older_program_is_there(tmp_path):
    image = tmp_path / "flash.bin"
    session(enter("PRINT 11\n"), "--flash", str(image))
    session(enter("PRINT 22\n"), "--flash", str(image))
    data = bytearray(image.read_bytes())
    data[data.index(b"PRINT 22")] ^= 1
    image.write_bytes(data)
    done = subprocess.run(
        [PROGRAM, "--virtual", "--flash", str(image)],
        input=b"RUN\r",
        capture_output=True,
        timeout=TIMEOUT_S,
        check=True,
    )
    assert (
        b"Error : The program stored last is damaged or incomplete; this is the one before"
        in done.stdout
    )
    assert b"\r\n 11\r\n" in done.stdout


def test_input():
    typed = 'INPUT "size"; a, b$\r12.5, big one\rPRINT a; b$\r'
    assert session(typed).endswith("size? 12.5, big one\r\n> PRINT a; b$\r\n 12.5big one\r\n> ")


def test_line_input():
    assert answers('LINE INPUT "? ", a$\ra, "b"\rPRINT a$\r')[-1] == 'a, "b"'


def test_inkey_takes_what_was_typed_ahead():
    assert answers("k$=INKEY$\rxPRINT k$\r")[-1] == "x"


def test_ctrl_c_stops_a_pause():
    assert answers("PAUSE 10000\r" + CTRL_C + "\rPRINT 5\r")[-1] == " 5"


def test_a_long_paste_waits_while_a_statement_runs():
    lines = "".join(f"a{n}={n}\r" for n in range(400))
    assert answers("PAUSE 1000\r" + lines + "PRINT a399\r")[-1] == " 399"


def test_a_script_waits_however_long_a_statement_takes():
    """A pipe has nothing to lose by waiting: there is no Ctrl-C behind the lines."""
    lines = "".join(f"a%=a%+{i}\r" for i in range(1000))
    assert answers("PAUSE 60000\r" + lines + "PRINT a%\r") == [" 499500"]


def test_a_routine_behind_a_colon_is_refused_where_it_stands():
    program = (
        "AUTOSAVE\rPRINT 1:SUB x\rEND SUB\rFUNCTION f():f=1:END FUNCTION:FUNCTION g()\r" + CTRL_Z
    )
    out = answers(program + "\rRUN\rx\r? g()\rPRINT 5\r")
    assert "Error : Invalid here" in out
    assert out[-1] == " 5"


def test_data_at_the_prompt_is_refused():
    out = answers("DATA 1\rREAD a\rDATA 2\rPRINT 5\r")
    assert out == ["Error : Invalid here", "Error : No DATA to read", "Error : Invalid here", " 5"]


def test_bounds_far_beyond_memory():
    typed = "DIM INTEGER a(3,9223372036854775807)\rDIM b(131068)\rDIM c(99999,99999)\rPRINT 5\r"
    assert answers(typed) == ["Error : Dimensions"] * 3 + [" 5"]


def test_output_is_seen_while_a_program_computes():
    """A program that never pauses does not keep what it printed to itself."""
    with subprocess.Popen(
        [PROGRAM, "--virtual"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0
    ) as program:
        program.stdin.write(b'a$="be": PRINT a$; "gun": DO: LOOP\r')
        seen = b""
        while b"begun" not in seen:  # the test's time limit ends a wait in vain
            seen += program.stdout.read(100)
        program.kill()


def test_ctrl_c_says_that_it_stops_the_machine():
    """With nothing to stop it says nothing."""
    setup = "STEPPER INIT\rSTEPPER AXIS X,2,3\rSTEPPER POSITION HOME\r"
    moving = setup + "STEPPER RUN\rSTEPPER GC G1 X100 F1200\rPAUSE 100\r"
    said = "Ctrl-C: motion stops, what was queued is dropped"
    shown = answers(moving + CTRL_C + "PAUSE 500\rPRINT PEEK(STEPPER X) < 9\r" + CTRL_C)
    assert shown[-2:] == [said, " 1"]
    assert said not in answers(setup + CTRL_C)


WIDTH = 80


def screen(shown: str, width: int = WIDTH) -> list[str]:
    """The rows of a terminal that was sent `shown`; the next letter wraps a full row."""
    rows, row, column = [[]], 0, 0
    for part in re.findall(r"\x1b\[(?:\d*)[A-Z]|.", shown, re.DOTALL):
        count = int(re.sub(r"\D", "", part[1:]) or 1) if len(part) > 1 else 1
        if part in "\r\n\b":
            row += part == "\n"
            column = {"\r": 0, "\b": min(column, width - 1) - 1}.get(part, column)
        elif len(part) > 1 and part[-1] == "J":
            assert column < width, "erases the last character of a full row"
            rows[row:] = [rows[row][:column]]
        elif len(part) > 1:
            row -= count if part[-1] == "A" else 0
            column = min(column, width - 1) + {"A": 0, "C": count, "D": -count}[part[-1]]
            assert row >= 0
            assert 0 <= column < width
        else:
            row, column = (row + 1, 0) if column == width else (row, column)
            rows += [[] for _ in range(row + 1 - len(rows))]
            rows[row] += " " * (column - len(rows[row]))
            rows[row][column : column + 1] = part
            column += 1
        rows += [[] for _ in range(row + 1 - len(rows))]
    return ["".join(row).rstrip() for row in rows]


def edited(keys: list[str]) -> str:
    """The line that keys make."""
    line, cursor = "", 0
    for key in keys:
        if key == LEFT:
            cursor = max(cursor - 1, 0)
        elif key == RIGHT:
            cursor = min(cursor + 1, len(line))
        elif key in (HOME, END):
            cursor = 0 if key == HOME else len(line)
        elif key == DELETE:
            line = line[:cursor] + line[cursor + 1 :]
        elif key == BACKSPACE:
            line = line[: max(cursor - 1, 0)] + line[cursor:]
            cursor = max(cursor - 1, 0)
        elif key == CTRL_U:
            line, cursor = "", 0
        else:
            line = line[:cursor] + key + line[cursor:]
            cursor += 1
    return line


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("width", [WIDTH, 40])
def test_a_line_of_several_rows_is_shown_as_it_is(seed, width):
    random = Random(seed)
    near = [20, width - 4, width - 3, width - 2, 2 * width - 4, 2 * width - 3]
    keys = ["'"] + ["abcdefgh"[i % 8] for i in range(random.choice(near))]
    for _ in range(30):
        key = random.choice([LEFT, RIGHT, HOME, END, DELETE, BACKSPACE, "z", CTRL_U, UP])
        if key in (CTRL_U, UP):  # a whole line goes, or comes back from the history
            keys += [CTRL_U] + ["'"] + ["y"] * random.choice([5, width - 3, width - 2, 100])
        else:
            keys += [key] * random.choice([1, 1, 2, width - 1, width] if key != "z" else [1, 2])
    line = "> " + edited(keys)
    rows = [line[i : i + width].rstrip() for i in range(0, len(line), width)]
    shown = session(f"OPTION DISPLAY 24,{width}\r" + "".join(keys) + "\r")
    shown = screen(shown.split("\r\n", 1)[1], width)
    assert shown[: len(rows)] == rows
    assert shown[len(rows)].startswith((">", "Error"))


def test_the_size_of_the_terminal():
    """HELP keeps to the columns, LIST stops after the lines; nonsense is refused."""
    overview = answers("OPTION DISPLAY 24,40\rHELP\r")
    assert max(len(line) for line in overview) < 60  # sentences do not wrap
    assert max(len(line) for line in overview if line.startswith("  ")) <= 40
    listed = session(enter("PRINT 1\n" * 9) + "OPTION DISPLAY 5\rLIST\rq")
    assert listed.count("PRINT 1\r\n") == 9 + 4
    assert "PRINT 1\r\nPRESS ANY KEY" in listed
    assert answers("OPTION DISPLAY 1\rOPTION DISPLAY 24,10\rOPTION DISPLAY 24,256\r") == [
        "Error : lines: 1 is invalid (valid is 2 to 255)",
        "Error : columns: 10 is invalid (valid is 20 to 255)",
        "Error : columns: 256 is invalid (valid is 20 to 255)",
    ]


def test_a_long_line_of_the_history_gives_way_to_a_short_one():
    first, second = "'" + "x" * 200, "' short"
    shown = screen(session(f"{second}\r{first}\r{UP}{UP}\r"))
    assert shown[-2:] == ["> " + second, ">"]
    assert len(shown) == 1 + 3 + 1 + 1


def test_list_takes_lines_and_words():
    program = "".join(f"a={n}\n" for n in range(1, 31))
    shown = session(enter(program) + "LIST 3-5\rLIST 29-\rLIST -2\rLIST 7\rLIST ALL 20-21\r")
    listed = [line for line in shown.split("\r\n")[32:] if line.startswith("a=")]
    assert listed == [f"a={n}" for n in [3, 4, 5, 29, 30, 1, 2, 7, 20, 21]]
    assert "PRINT" in session("LIST COMMANDS\r")
    assert "MID$" in session("LIST FUNCTIONS\r")
    assert "MID$" not in session("LIST COMMANDS\r")


def test_list_pins_tells_who_has_each() -> None:
    set_up = "STEPPER INIT\rSTEPPER AXIS X,GP2,GP3\rSETPIN GP16,DOUT\r"
    listed = answers(set_up + "LIST ALL PINS\r")[1:]
    assert listed[0] == "GP0 (pin 1)    Unused"
    assert listed[2] == "GP2 (pin 4)    STEPPER X step"
    assert listed[16] == "GP16 (pin 21)  SETPIN DOUT"
    assert [line.split()[0] for line in listed[22:]] == ["GP22", "GP25", "GP26", "GP27", "GP28"]
    assert answers("LIST PINS\rq")[-1].startswith("PRESS ANY KEY")
