"""The conversation with the prompt, also when it is disturbed."""

import pytest

from stepmite.board import Board, BoardError, BoardGone
from stepmite.screen import Screen


def test_command_returns_the_output_and_errors_carry_the_message(fake):
    with Board.open(fake().device) as board:
        assert board.command("PRINT 6*7") == [" 42"]
        with pytest.raises(BoardError, match=r"^Unknown command$") as caught:
            board.command("?5:NONSENSE:?6")
        assert caught.value.output == [" 5"]
        assert board.peek("BUFFER") == 32


def test_half_a_typed_line_is_erased_and_not_carried_out(fake):
    machine = fake(half_line="STEPPER ESTO")
    with Board.open(machine.device) as board:
        assert board.command("?1") == [" 1"]
    assert machine.executed == []


def test_prompt_without_echo(fake):
    with Board.open(fake(echo=False).device) as board:
        assert board.command("?1") == [" 1"]
        assert board.command("?2:?3") == [" 2", " 3"]


def test_notice_while_a_line_is_typed_is_passed_on(fake):
    notices = []
    machine = fake(notice_while_typing=True)
    with Board.open(machine.device, on_notice=notices.append) as board:
        notices.clear()
        assert board.command("PRINT 6*7") == [" 42"]
    assert notices == ["Limit switch X"]


def test_running_program_is_reported(fake):
    with pytest.raises(BoardGone, match="a program is running"):
        Board.open(fake(busy=True).device, wake_timeout_s=0.3)


def test_no_such_port():
    with pytest.raises(BoardGone, match="cannot open /dev/no-such-port: No such file"):
        Board.open("/dev/no-such-port")


def test_unplugged_cable_is_reported(fake):
    machine = fake()
    with Board.open(machine.device) as board:
        machine.unplug()
        with pytest.raises(BoardGone, match="connection is broken"):
            board.command("?1")


@pytest.mark.parametrize("line", ["a\nb", "ä", "x" * 256, "\x03"])
def test_what_is_no_line_is_never_sent(fake, line):
    with Board.open(fake().device) as board, pytest.raises(ValueError, match="not a line"):
        board.command(line)


def test_screen_understands_redrawing():
    screen = Screen()
    screen.feed("> STEP\r\x1b[KNotice\r\n> STEP")
    screen.feed("PER\x1b[")
    screen.feed("3D\x1b[K\x1b[1;31mxy\r\n")
    assert screen.lines == ["Notice", "> STEPxy"]
    assert screen.current == ""


def test_screen_survives_every_cut():
    text = "> ab\b \b\x1b[2Kc\r\x1b[0K> d\x1b[Ce\r\n\x1b]0;title\x07\r\n"
    whole = Screen()
    whole.feed(text)
    for cut in range(len(text)):
        parts = Screen()
        parts.feed(text[:cut])
        parts.feed(text[cut:])
        assert parts.lines == whole.lines
