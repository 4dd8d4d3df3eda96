"""Serial ports of a program on the host, where each wears a loopback plug."""

from __future__ import annotations

import subprocess
from pathlib import Path

STEPMITE = Path(__file__).parents[2] / "build" / "host" / "stepmite"


def run(folder: Path, program: str) -> list[str]:
    source = folder / "p.bas"
    source.write_text(program)
    done = subprocess.run(
        [STEPMITE, "--virtual", source],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    return done.stdout.split("\n\n", 1)[-1].splitlines()


def test_what_is_sent_comes_back_in_its_time(tmp_path: Path) -> None:
    program = """\
SETPIN GP5, GP4, COM2
OPEN "COM2:1200" AS #1
TIMER = 0
PRINT #1, "0123456789";
PRINT LOC(#1); TIMER < 2
DO : LOOP UNTIL LOC(#1) = 10
PRINT STR$(TIMER, 0, 0)
PRINT INPUT$(4, #1); " "; LOC(#1)
PRINT INPUT$(100, #1); LEN(INPUT$(1, #1)); EOF(#1)
"""
    printed = run(tmp_path, program)
    assert printed[0] == " 0 1"
    assert abs(int(printed[1]) - 10 * 10 * 1000 / 1200) <= 2
    assert printed[2:] == ["0123  6", "456789 0 1"]


def test_lines_and_all_bytes(tmp_path: Path) -> None:
    program = """\
SETPIN GP17, GP16, COM1
OPEN "COM1:115200,512" AS #2
PRINT #2, "first line" : PRINT #2, "second"; 2
LINE INPUT #2, a$ : LINE INPUT #2, b$
PRINT a$; "|"; b$
FOR i = 0 TO 255 : PRINT #2, CHR$(i); : NEXT
PAUSE 50
c$ = INPUT$(255, #2) : d$ = INPUT$(10, #2)
e$ = c$ + ""
t = 0
FOR i = 1 TO LEN(c$) : t = t + ASC(MID$(c$, i, 1)) : NEXT
PRINT t + ASC(RIGHT$(d$, 1)); LEN(c$) + LEN(d$) >= 256
"""
    printed = run(tmp_path, program)
    assert printed[0] == "first line|second 2"
    assert printed[1].split()[1] == "1"


def test_long_output_waits_for_the_wire(tmp_path: Path) -> None:
    program = """\
SETPIN GP5, GP4, COM2
OPEN "COM2:9600,512" AS #1
TIMER = 0
FOR i = 1 TO 4 : PRINT #1, STRING$(100, "x"); : NEXT
PRINT TIMER > 250
FLUSH #1
PRINT STR$(TIMER, 0, 0); LOC(#1)
"""
    printed = run(tmp_path, program)
    assert printed[0] == " 1"
    took, waiting = printed[1].split()
    assert abs(int(took) - 400 * 10 * 1000 / 9600) <= 3
    assert waiting == "400"


def test_a_sub_is_called_at_its_level(tmp_path: Path) -> None:
    program = """\
SETPIN GP5, GP4, COM2
OPEN "COM2:9600,256,got,5" AS #1
PRINT #1, "abcd"; : PAUSE 20 : PRINT "none yet"; n
PRINT #1, "e"; : PAUSE 20 : PRINT n; a$
CLOSE #1
PRINT LOC(#1)
SUB got
  n = n + 1
  a$ = INPUT$(20, #1)
END SUB
"""
    source = tmp_path / "p.bas"
    source.write_text(program.replace("PRINT LOC(#1)\n", ""))
    assert run(tmp_path, source.read_text()) == ["none yet 0", " 1abcde"]


def test_run_closes_the_port(tmp_path: Path) -> None:
    program = tmp_path / "p.txt"
    typed = (
        'SETPIN GP5, GP4, COM2 : OPEN "COM2:9600" AS #1\n'
        "NEW\n"
        'OPEN "COM2:9600" AS #1\n'
        "SETPIN GP4, DOUT : PRINT PIN(GP4)\n"
    )
    program.write_text(typed)
    done = subprocess.run(
        [STEPMITE, "--virtual"], input=typed, capture_output=True, text=True, timeout=60, check=True
    )
    assert "Error : COM2 has no pins (use SETPIN)" in done.stdout
    assert done.stdout.splitlines()[-1].endswith(" 0") or " 0" in done.stdout.splitlines()
