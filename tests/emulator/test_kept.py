"""What is kept in the flash of the emulated board: programs, files, options, variables."""

from pathlib import Path

from test_firmware import MAIN_STACK_BYTES, stack_used
from test_restart import back_again

from stepmite.emulator import Emulator

CTRL_C, CTRL_Z = "\x03", "\x1a"
SLOW_MS = 10_000


def store(board: Emulator, *lines: str) -> None:
    board.send("AUTOSAVE\r")
    board.send("\r".join(lines) + "\r" + CTRL_Z)
    board.until("\n> ", SLOW_MS)


def line(board: Emulator, text: str) -> str:
    """The answer to a line, which must not be an error."""
    answer = board.command(text, timeout_ms=SLOW_MS).split("\n", 1)[-1].strip("\r\n")
    assert "rror" not in answer, answer
    return answer


def restart(board: Emulator) -> str:
    board.send("CPU RESTART\r")
    return back_again(board)


def test_programs_files_options_and_variables_survive_a_restart(board: Emulator) -> None:
    store(board, 'PRINT "first"')
    line(board, 'SAVE "first"')
    store(board, *(f"REM {'x' * 60} {i}" for i in range(150)), 'PRINT "second"')
    line(board, 'DIM a(50):a(50)=2.5:s$="text":VAR SAVE a(),s$')
    line(board, 'OPEN "log.txt" FOR OUTPUT AS #1:FOR i=1 TO 300:PRINT #1,"line";i:NEXT:CLOSE')
    line(board, "OPTION AUTORUN ON")
    greeting = restart(board)
    assert "rror" not in greeting
    assert greeting.endswith("\r\n\r\nsecond\r")
    line(board, "VAR RESTORE")
    assert line(board, "PRINT a(50);s$") == " 2.5text"
    line(board, 'n=0:OPEN "log.txt" FOR INPUT AS #1')
    assert (
        line(board, "DO:LINE INPUT #1,l$:n=n+1:LOOP UNTIL EOF(1):CLOSE:PRINT n;l$")
        == " 300line 300"
    )
    assert line(board, 'LOAD "first",R') == "first"
    board.send("CPU RESTART\r")
    board.connect(3000)
    board.expect("first\r\n", 3000)
    board.until("> ")
    assert stack_used(board) < 0.75 * MAIN_STACK_BYTES


def test_written_with_an_estop_input_watched_and_refused_in_motion(board: Emulator) -> None:
    line(board, "STEPPER INIT ,,GP15")
    board.set_pin(15, 1)
    for text in ["STEPPER AXIS X,GP2,GP3,,,80,6000,500", "STEPPER POSITION HOME", "STEPPER RUN"]:
        line(board, text)
    store(board, "PRINT 11")
    line(board, 'SAVE "first"')
    line(board, "STEPPER GC G1 X10 F3000")
    board.run_ms(50)
    assert "Error : The flash cannot be written" in board.command('SAVE "second"')
    board.run_ms(1000)
    line(board, 'SAVE "second"')
    board.set_pin(15, 0)
    board.run_ms(1)
    assert "E-STOP" in board.command("")
    line(board, 'SAVE "third"')
    assert line(board, 'RUN "second"') == " 11"


def test_ctrl_c_before_the_program_starts(uf2: Path) -> None:
    with Emulator(uf2) as board:
        board.connect()
        board.until("> ")
        store(board, "DO:LOOP")
        line(board, "OPTION AUTORUN ON")
        board.send("CPU RESTART\r")
        board.connect(3000)
        board.run_ms(200)
        board.send(CTRL_C)  # it runs, and can be stopped
        board.until("> ", 3000)
        board.command("OPTION BREAK 0")
        board.send("CPU RESTART\r")
        board.connect(3000)
        board.expect("Ctrl-C now", 3000)
        board.send(CTRL_C)
        board.until("are skipped\r\n> ", 3000)
        assert line(board, "PRINT 5") == " 5"
        assert board.faults() == []
