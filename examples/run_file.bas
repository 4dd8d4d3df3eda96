' Carries out a G-code file of the board's own disk A:. Set the machine up first (machine.bas), bring the
' file there (stepmite put part.nc, or XMODEM RECEIVE "part.nc"), then: RUN "run_file.bas", "part.nc"
OPTION EXPLICIT
DIM name$ = MM.CMDLINE$
IF name$ = "" THEN INPUT "G-code file"; name$
STEPPER RUN
run_file name$
DO : PAUSE 10 : LOOP UNTIL PEEK(STEPPER ACTIVE) <> 1
PRINT "Done"
END

' Queues all lines of a file as fast as the queue takes them. A line that is refused ends the program, and
' with it the motion: a part with a line missing is no part.
SUB run_file(name$)
  LOCAL text$
  LOCAL INTEGER number
  OPEN name$ FOR INPUT AS #1
  DO WHILE NOT EOF(#1)
    LINE INPUT #1, text$
    INC number
    IF LEFT$(text$, 1) <> "%" THEN queue_line text$, number
  LOOP
  CLOSE #1
END SUB

' A line makes at most two entries (with a rounded corner), so it fits when two are free.
SUB queue_line(text$, number AS INTEGER)
  DO WHILE PEEK(STEPPER BUFFER) < 2 : PAUSE 1 : LOOP
  ON ERROR SKIP
  STEPPER GS text$
  IF MM.ERRNO <> 0 THEN
    PRINT "Line"; number; ": "; text$
    ERROR MM.ERRMSG$
  ENDIF
END SUB
