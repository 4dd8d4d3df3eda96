' Carries out a G-code file of the board's own disk A:. Make SUB machine that of your machine, bring the file
' there (stepmite put part.nc, or XMODEM RECEIVE "part.nc"), then: RUN "run_file.bas", "part.nc"
OPTION EXPLICIT
DIM name$ = MM.CMDLINE$
IF name$ = "" THEN INPUT "G-code file"; name$
machine
run_file name$
DO : PAUSE 10 : LOOP UNTIL PEEK(STEPPER ACTIVE) <> 1
PRINT "Done"
END

' RUN has closed the machine, as after power-up.
SUB machine
  STEPPER INIT ,256
  STEPPER AXIS X,GP2,GP3,GP4,,80,6000,500
  STEPPER AXIS Y,GP5,GP6,GP7,,80,6000,500
  STEPPER AXIS Z,GP8,GP9,GP10,,400,3000,500
  STEPPER SPINDLE GP22
  STEPPER POSITION HOME
  STEPPER RUN
END SUB

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
