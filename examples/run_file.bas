' Carries out a G-code file of the board's own disk A:. Make SUB machine that of your machine, bring the file
' there (stepmite put part.nc, or XMODEM RECEIVE "part.nc"), then: RUN "run_file.bas", "part.nc"
OPTION EXPLICIT
DIM name$ = MM.CMDLINE$
IF name$ = "" THEN INPUT "G-code file"; name$
machine
STEPPER CHECK name$     ' an error in the file ends the program before anything moves
STEPPER FILE name$
DO
  PAUSE 500
  PRINT "Line"; PEEK(STEPPER LINE); ","; PEEK(STEPPER PERCENT); " %"
LOOP WHILE PEEK(STEPPER ACTIVE) = 1
IF PEEK(STEPPER PERCENT) = 100 THEN PRINT "Done" ELSE PRINT "Not done"
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
