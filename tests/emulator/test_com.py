"""Serial ports of a program on the emulated board: bytes on the wire, both ways."""

from stepmite.emulator import Emulator


def obey(board: Emulator, *lines: str) -> None:
    for line in lines:
        answer = board.command(line).replace(line, "", 1).split()
        assert answer == [], (line, answer)


def test_both_ways(board: Emulator) -> None:
    obey(board, "SETPIN GP9, GP8, COM2", 'OPEN "COM2:38400" AS #1')
    board.uart_output(1)
    start_ns = board.now_ns
    obey(board, 'PRINT #1, "to the pendant"')
    board.run_ms(10)
    assert board.uart_output(1) == "to the pendant\r\n"
    assert board.now_ns > start_ns
    board.send_uart("jog X+\r", 1)
    board.run_ms(5)
    assert board.command("? LOC(#1)").split()[-1] == "7"
    board.command("LINE INPUT #1, a$")
    assert "jog X+" in board.command("? a$").replace("? a$", "", 1)
    every = "".join(chr(code) for code in range(256))
    program = 't%=0:FOR i=1 TO 256:t%=t%+i*ASC(INPUT$(1,#1)+CHR$(0)):NEXT:? "sum";t%'
    obey(board, "CLOSE #1", 'OPEN "COM2:38400,512" AS #1')
    board.send_uart(every, 1)
    board.run_ms(100)
    expected = sum((code + 1) * code for code in range(256))
    assert board.command(program).split()[-1] == str(expected)


def test_com1_borrows_the_uart_of_the_console(board: Emulator) -> None:
    obey(board, "SETPIN GP17, GP16, COM1")
    board.uart_output(0)
    obey(board, 'OPEN "COM1:115200" AS #1', 'PRINT #1, "mine"')
    board.run_ms(10)
    farewell, sent = board.uart_output(0).split("USB only\r\n")
    assert "GP0 and GP1 are taken" in farewell
    assert sent == "mine\r\n"
    board.send_uart("PRINT 1\r", 0)
    board.run_ms(5)
    assert "1\r\n" not in board.output()  # no command
    obey(board, "CLOSE #1")
    board.uart_output(0)
    board.send_uart("PRINT 6*7\r", 0)
    board.run_ms(20)
    assert "42" in board.uart_output(0)


def test_a_flood_calls_the_sub_and_loses_nothing(board: Emulator) -> None:
    program = """\
AUTOSAVE
SETPIN GP5, GP4, COM2
OPEN "COM2:9600,512,got,20" AS #1
DO
  a = a + 1
LOOP UNTIL n >= 1000
PRINT "received "; n; k > 10
SUB got
  k = k + 1
  n = n + LEN(INPUT$(255, #1))
END SUB
\x1a"""
    board.send(program.replace("\n", "\r"))
    board.until("\n> ", 3000)
    board.send("RUN\r")
    board.run_ms(30)
    board.send_uart("x" * 1000, 1)
    assert board.expect(r"received\s+(\d+)\s+(\d)", 3000)[1:] == ["1000", "1"]
