"""The real firmware at a terminal over USB: pastes at full speed, a port that is closed, EDIT."""

import pytest

from stepmite.emulator import Emulator

CTRL_C, CTRL_Q, CTRL_Z = "\x03", "\x11", "\x1a"


def test_a_paste_at_the_prompt_loses_nothing(board: Emulator) -> None:
    """All queued at once: the board takes the lines as it carries them out."""
    count = 300
    board.command("s% = 0")
    lines = "".join(f"s%=s%+{k}*{k}\r" for k in range(count))
    begin_ms = board.now_ns / 1e6
    board.send(lines + "PRINT s%; 42\r")
    board.until(" 42\r\n> ", 30_000)
    assert board.command("PRINT s%").split()[-1] == str(sum(k * k for k in range(count)))
    assert (board.now_ns / 1e6 - begin_ms) / count < 5  # ms a line, echo and carrying out


def test_a_paste_into_autosave_loses_nothing(board: Emulator) -> None:
    lines = [f"a = {k} ' {'x' * (k % 40)}" for k in range(1500)]
    board.send("AUTOSAVE\r" + "\r\n".join(lines) + "\r\n" + CTRL_Z)
    board.until("\n> ", 60_000)
    board.send("LIST ALL\r")
    listed = board.until("\n> ", 60_000).replace("\r", "").split("\n")
    assert listed[1:] == lines


def test_a_program_goes_on_while_no_terminal_is_there(board: Emulator) -> None:
    """It prints all the time; what nobody takes is dropped, and the program is not held up."""
    board.send('DO: n% = n% + 1: PRINT n%; " turns": PAUSE 10: LOOP\r')
    board.run_ms(100)
    board.host_open(False)
    board.output()
    board.run_ms(2000)
    board.host_open(True)
    board.run_ms(100)
    shown = board.output()
    first = int(shown[shown.index("\n") :].split()[0])
    assert 190 < first < 230
    board.send(CTRL_C)
    board.until("> ")
    assert board.command("PRINT 6*7").split()[-1] == "42"


def test_a_program_goes_on_while_the_cable_is_out(board: Emulator) -> None:
    """The board has power from elsewhere; it moves a pin all the time."""
    board.command("SETPIN GP15, DOUT")
    board.send("DO: n% = n% + 1: PIN(GP15) = n% AND 1: PRINT n%: PAUSE 10: LOOP\r")
    board.run_ms(100)
    board.unplug()
    board.run_ms(20)
    board.clear_edges()
    board.run_ms(2000)
    assert 170 < len(board.edges([15])) < 230
    board.plug()
    board.connect()
    board.output()
    board.run_ms(100)
    shown = board.output()
    assert 190 < int(shown[shown.index("\n") :].split()[0]) < 260
    board.send(CTRL_C)
    board.until("> ")
    assert board.command("PRINT 6*7").split()[-1] == "42"


def test_the_prompt_comes_back_with_the_cable(board: Emulator) -> None:
    for _ in range(3):
        board.unplug()
        board.run_ms(50)
        board.plug()
        board.connect()
        assert board.command("PRINT 6*7").split()[-1] == "42"


def test_a_terminal_that_comes_late_finds_the_prompt(board: Emulator) -> None:
    board.host_open(False)
    board.run_ms(50)
    board.output()
    board.host_open(True)
    board.run_ms(20)
    assert board.command("PRINT 1+1").split()[-1] == "2"


@pytest.fixture
def editor(board: Emulator) -> Emulator:
    board.send("AUTOSAVE\r" + "".join(f"PRINT {k} ' line\r" for k in range(200)) + CTRL_Z)
    board.until("\n> ", 20_000)
    board.send("EDIT\r")
    board.run_ms(400)
    board.output()
    return board


def test_a_key_in_the_editor_is_drawn_within_a_frame(editor: Emulator) -> None:
    """All cells are looked at for each key: that must stay below what a user sees."""
    for key in ["x", "\r", "\x1b[B", "\x1b[6~"]:
        begin_ms = editor.now_ns / 1e6
        editor.send(key)
        editor.until("\x1b[?25h", 500)
        assert editor.now_ns / 1e6 - begin_ms < 20, repr(key)


def test_edit_saves_what_was_typed(editor: Emulator) -> None:
    editor.send("\x1b[200~FOR i = 1 TO 3\n  PRINT i\nNEXT : END\n\x1b[201~" + CTRL_Q)
    editor.until("\r> ", 5000)
    editor.send("RUN\r")
    assert editor.until("\n> ").split()[1:4] == ["1", "2", "3"]


@pytest.mark.parametrize(("command", "end"), [("AUTOSAVE", CTRL_Z), ("EDIT", CTRL_Q)])
def test_a_paste_over_the_serial_port_loses_nothing(
    board: Emulator, command: str, end: str
) -> None:
    """At 115200 baud without flow control, as it comes out of a USB converter."""
    lines = [f"a = {k} ' {'x' * (k % 40)}" for k in range(200)]
    text = "\r".join(lines) + "\r"
    board.host_open(False)
    board.send_uart(command + "\r")
    board.run_ms(400)
    board.send_uart(text)
    board.run_ms(len(text) / 11.52 + 300)
    board.send_uart(end)
    board.run_ms(1000)
    board.uart_output()
    board.send_uart("LIST ALL\r")
    board.run_ms(len(text) / 10 + 500)
    assert board.uart_output().replace("\r", "").split("\n")[1:-1] == lines
