' A machine's day: a move and texts every five seconds, a file for ten of them, events all the time.
' TURNS is filled in.
OPTION EXPLICIT
DIM INTEGER turn%, seconds%, kicks%, lines%, turns% = TURNS
DIM x, y, s$, t$, marks$(9) LENGTH 50, started
STEPPER INIT ,64
STEPPER AXIS X,GP2,GP3,,,80,6000,500
STEPPER AXIS Y,GP4,GP5,,,80,6000,500
STEPPER POSITION HOME
STEPPER RUN
OPEN "log" FOR OUTPUT AS #1: PRINT #1, "begin": CLOSE #1
MEMORY
TIMER = 0
SETTICK 1000, second, 1
SETTICK 37, kick, 2
FOR turn% = 1 TO turns%
  x = (turn% * 7 MOD 11) / 8
  y = -(turn% * 3 MOD 5) / 4
  s$ = "G1 X" + STR$(x, 1, 4) + " Y" + STR$(y, 1, 4) + " F3000"
  STEPPER GS s$
  DO WHILE PEEK(STEPPER ACTIVE)
    PAUSE 10
  LOOP
  note s$, x
  EXECUTE "t$ = UCASE$(s$) + SPACE$(20)"
  DO WHILE TIMER < turn% * 5000
    PAUSE 50
  LOOP
NEXT
SETTICK 0, 0, 1
SETTICK 0, 0, 2
PRINT "seconds"; seconds%; " kicks"; kicks%; " lines"; lines%; " ms "; STR$(TIMER, 1, 3)
MEMORY
STEPPER STATUS
END

SUB second
  INC seconds%
END SUB

SUB kick
  LOCAL a$ = STR$(kicks%), b$
  INC kicks%
  b$ = LEFT$(a$ + STRING$(40, "-"), 20)
  IF kicks% MOD 10000 = 0 THEN PRINT b$
END SUB

' Keeps the last ten lines in a file.
SUB note(text$, at)
  LOCAL i, line$
  marks$(turn% MOD 10) = text$
  IF turn% MOD 10 <> 0 THEN EXIT SUB
  OPEN "log" FOR OUTPUT AS #1
  FOR i = 0 TO 9
    PRINT #1, marks$(i), at
  NEXT
  CLOSE #1
  OPEN "log" FOR INPUT AS #1
  DO WHILE NOT EOF(#1)
    LINE INPUT #1, line$
    INC lines%
  LOOP
  CLOSE #1
END SUB
