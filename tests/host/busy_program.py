"""A BASIC program that does everything at once while motors move; see SUB and loop."""

BEGINS = "SETTICK 2, tick, 1"
"""In front of this line of BUSY motion may be started."""

BUSY = """\
OPTION EXPLICIT
DIM c%, k%, n%, s$, x, notes$(19) LENGTH 60, v(49)
SETTICK 2, tick, 1
SETTICK 7, texts, 2
ON KEY pressed
SETPIN GP20, DOUT
SETPIN GP21, DIN, PULLUP
SETPIN GP22, INTB, level
DO WHILE PEEK(STEPPER ACTIVE) = 1
  ON ERROR SKIP: x = 1 / (c% - c%)
  ON ERROR SKIP: OPEN "new" FOR OUTPUT AS #9
  ON ERROR SKIP: VAR SAVE c%
  ON ERROR SKIP: SAVE "x.bas"
  ON ERROR SKIP: OPTION TAB 4
  ON ERROR SKIP: STEPPER INIT
  ON ERROR SKIP: STEPPER GC G1 X1 X2
  ON ERROR SKIP: PIN(GP2) = 1
  EXECUTE "k% = k% + 1"
  s$ = EVAL("STR$(SIN(k%), 3, 5)")
  notes$(k% MOD 20) = s$ + SPACE$(10)
  v(k% MOD 50) = deep(12)
  IF k% MOD 10 = 0 THEN SORT v()
  PIN(GP20) = k% AND 1
  IF k% MOD 5 = 0 THEN PULSE GP20, 0.5
  PRINT k%; " "; s$; PEEK(STEPPER X), PIN(GP21)
  IF k% MOD 3 = 0 THEN PAUSE 1
LOOP
PRINT "busy"; k% > 10; c% > 100; n% > 30
END
SUB tick
  c% = c% + 1
  IF c% MOD 20 = 0 THEN PRINT "tick"; c%
END SUB
SUB texts
  LOCAL t$ = STRING$(200, "x"), i
  FOR i = 1 TO 5
    CAT t$, STR$(i)
  NEXT
  INC n%
  ON ERROR SKIP
  t$ = t$ + t$
END SUB
SUB pressed
  PRINT "key"
END SUB
SUB level
END SUB
FUNCTION deep(d)
  IF d > 0 THEN deep = deep(d - 1) + SQR(d) ELSE deep = RND
END FUNCTION
"""
DONE = "busy 1 1 1"
