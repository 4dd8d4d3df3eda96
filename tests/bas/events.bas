'--- SETTICK calls a SUB while PAUSE waits
SETTICK 10, tick
PAUSE 35
SETTICK 0, 0
PAUSE 30
PRINT n '> 3
SUB tick
  n = n + 1
END SUB
'--- four clocks, each with its SUB
SETTICK 10, a
SETTICK 15, b, 2
SETTICK 20, c, 3
SETTICK 25, d, 4
PAUSE 62
PRINT n; m; o; p '> 6 4 3 2
SUB a: n = n + 1: END SUB
SUB b: m = m + 1: END SUB
SUB c: o = o + 1: END SUB
SUB d: p = p + 1: END SUB
'--- a SUB in a string, and in a string variable
s$ = "tick"
SETTICK 10, s$
PAUSE 12
SETTICK 10, "TI" + "CK"
PAUSE 12
PRINT n '> 2
SUB tick: n = n + 1: END SUB
'--- SETTICK PAUSE holds the clock, RESUME lets it go on
SETTICK 20, tick
PAUSE 25
SETTICK PAUSE, tick
PAUSE 100
PRINT n '> 1
SETTICK RESUME, tick
PAUSE 10
PRINT n '> 1
PAUSE 10
PRINT n '> 2
SUB tick: n = n + 1: END SUB
'--- SETTICK PAUSE by number
SETTICK 10, tick, 3
SETTICK PAUSE, , 3
PAUSE 25
PRINT n '> 0
SUB tick: n = n + 1: END SUB
'--- a computing loop is interrupted as well
SETTICK 1, tick
DO: LOOP UNTIL n >= 5
PRINT n '> 5
SUB tick: n = n + 1: END SUB
'--- the SUB of an event has locals, calls others, leaves early
SETTICK 10, tick
PAUSE 25
PRINT n '> 20
SUB tick
  LOCAL k, t$
  k = 1: t$ = "x"
  add 10 * k
  EXIT SUB
  add 1000
END SUB
SUB add v
  n = n + v
END SUB
'--- what the statement was doing goes on behind the SUB
DIM t$
SETTICK 1, tick
FOR i = 1 TO 50
  t$ = LEFT$(t$ + CHR$(65 + i MOD 26), 20)
NEXT
PRINT t$ '>BCDEFGHIJKLMNOPQRSTU
SUB tick
  LOCAL u$
  u$ = STRING$(100, "-")
END SUB
'--- an error in the SUB of an event ends the program
SETTICK 10, tick
PAUSE 50
PRINT "never"
SUB tick
  PRINT 1 / 0 '! Divide by zero
END SUB
'--- ON ERROR SKIP is not used up by the SUB of an event, and its errors stay its own
SETTICK 10, tick
ON ERROR SKIP 2
PAUSE 15
a = SQR(-1)
PRINT MM.ERRMSG$ '>Negative argument
SUB tick
  ON ERROR SKIP
  a = 1 / 0
END SUB
'--- ON ERROR IGNORE holds for the SUB of an event
ON ERROR IGNORE
SETTICK 10, tick
PAUSE 15
PRINT n '> 1
SUB tick
  a = 1 / 0
  n = 1
END SUB
'--- ON ERROR IGNORE in the SUB of an event does not last
SETTICK 10, tick
PAUSE 15
PRINT 1 / 0 '! Divide by zero
SUB tick
  ON ERROR IGNORE
END SUB
'--- END in the SUB of an event ends the program
SETTICK 10, tick
DO: LOOP
SUB tick
  PRINT "end" '>end
  END
END SUB
'--- a program that never ends a statement longer than its events still goes on
SETTICK 1, tick
FOR i = 1 TO 5: NEXT
PRINT i '> 6
SUB tick: PAUSE 3: END SUB
'--- SETTICK: no such SUB
SETTICK 10, nobody '! Unknown user subroutine
'--- SETTICK: a SUB with parameters
SETTICK 10, tick '! TICK: the SUB must have no parameters
SUB tick x
END SUB
'--- SETTICK: a FUNCTION
SETTICK 10, tick '! Unknown user subroutine
FUNCTION tick()
END FUNCTION
'--- SETTICK: number out of range
SETTICK 10, tick, 5 '! number: 5 is invalid (valid is 1 to 4)
SUB tick: END SUB
'--- SETTICK: period out of range
SETTICK -1, tick '! period: -1 is invalid (valid is 0, 0.1 to 2147483647 milliseconds)
SUB tick: END SUB
'--- SETTICK: no SUB
SETTICK 10 '! Invalid syntax
'--- SETTICK: a number instead of a SUB
SETTICK 10, 7 '! sub: expected the name of a SUB
'--- ON KEY: a code out of range
ON KEY 256, k '! code: 256 is invalid (valid is 1 to 255)
SUB k: END SUB
'--- ON KEY 0 and ON KEY code, 0 are allowed at any time
ON KEY 0
ON KEY 65, 0
PRINT "fine" '>fine
'--- MM.END is called at the end of the program
x = 5
PRINT "main" '>main
SUB MM.END
  PRINT "end"; x '>end 5
END SUB
'--- MM.END is called by END
PRINT "main" '>main
END
SUB MM.END
  PRINT "end" '>end
END SUB
'--- END NOEND goes without MM.END
PRINT "main" '>main
END NOEND
SUB MM.END
  PRINT "never"
END SUB
'--- an error goes without MM.END
PRINT 1 / 0 '! Divide by zero
SUB MM.END
  PRINT "never"
END SUB
'--- MM.ERRNO of the program outlasts an error in the SUB of an event
ON ERROR IGNORE
KILL "nowhere.txt"
SETTICK 10, tick
PAUSE 15
PRINT MM.ERRNO '> 4
SUB tick
  a = 1 / 0
END SUB
