' Homes three axes without switches: TMC2209 drivers on one wire (GP5), their DIAG outputs in the place of the switches.
' docs/tmc22xx.md says how to wire it and how to find the numbers in SUB drivers for your machine.
' Without a board: build/host/stepmite --machine examples/sensorless.txt examples/sensorless.bas
OPTION EXPLICIT
drivers
machine
STEPPER GC G28          ' arms StallGuard for each approach by itself
PRINT "Home, and the load of X at 50 mm/s:"
STEPPER GC G1 X60 F3000
DO WHILE PEEK(STEPPER ACTIVE) = 1
  PAUSE 250
  PRINT "X"; PEEK(STEPPER X); " SG_RESULT"; PEEK(TMC X, SG); " current scale"; PEEK(TMC X, CS)
LOOP
END

SUB drivers
  LOCAL n
  FOR n = 0 TO 2
    TMC22xx GP5, 2209, n, 800, 30, 16
    TMC22xx AXIS n, MID$("XYZ", n + 1, 1)
    TMC22xx SGTHRS n, 118       ' proposed by TMC22xx SGTUNE
  NEXT
END SUB

SUB machine
  STEPPER INIT ,256
  STEPPER AXIS X,GP2,GP3,GP4,,80,6000,500
  STEPPER AXIS Y,GP6,GP7,GP8,,80,6000,500
  STEPPER AXIS Z,GP14,GP15,GP13,,400,3000,200
  STEPPER HWLIMITS GP10,GP11,GP12,0,0,0,7
  STEPPER RUN
END SUB
