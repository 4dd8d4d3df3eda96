'--- STATIC keeps its value from call to call
n = 7
count : count : count
PRINT n '> 1 2 3 7
SUB count
  STATIC n
  n = n + 1
  PRINT n;
END SUB
'--- STATIC starts at its value once
s : s '>a1a2
PRINT
SUB s
  STATIC INTEGER n = 0
  STATIC t$ = "a"
  n = n + 1 : PRINT t$; STR$(n);
END SUB
'--- STATIC array
push 5 : push 6 : push 7
PRINT '> 5 5 6 5 6 7
SUB push(v)
  STATIC depth, stack(10)
  LOCAL i
  stack(depth) = v : depth = depth + 1
  FOR i = 0 TO depth - 1 : PRINT stack(i); : NEXT
END SUB
'--- STATIC array with values and a string array with a length
s : s '> 2x 4x
PRINT
SUB s
  STATIC a(2) = (1, 2, 3), b$(1) LENGTH 3 = ("x", "y")
  PRINT a(1); b$(0);
  a(1) = a(1) * 2
END SUB
'--- STATIC in a FUNCTION
PRINT ticket%(); ticket%(); ticket%() '> 101 102 103
FUNCTION ticket%()
  STATIC last% = 100
  last% = last% + 1
  ticket% = last%
END FUNCTION
'--- two routines have each their own STATIC
a : b : a : b '> 1 1 2 2
PRINT
SUB a
  STATIC n
  n = n + 1 : PRINT n;
END SUB
SUB b
  STATIC n
  n = n + 1 : PRINT n;
END SUB
'--- STATIC is one for all levels of a recursion
down 3
PRINT calls '> 4
SUB down(n)
  STATIC k
  k = k + 1 : calls = k
  IF n > 0 THEN down n - 1
END SUB
'--- STATIC outside a routine
STATIC n '! Invalid here
'--- STATIC and LOCAL of one name
s
SUB s
  LOCAL n
  STATIC n '! N already declared
END SUB
'--- STATIC twice
s
SUB s
  STATIC n
  STATIC n '! N already declared
END SUB
'--- STATIC counts as declared
OPTION EXPLICIT
s : s '> 1 2
PRINT
SUB s
  STATIC n
  n = n + 1 : PRINT n;
END SUB
'--- STATIC of another suffix
s
SUB s
  STATIC n%
  n% = 1
  n$ = "x" '! N Different type already declared
END SUB
'--- STATIC starts afresh with RUN
IF TIMER > 1000 THEN s : PRINT calls : END
s : s : PAUSE 2000
RUN
SUB s
  STATIC n
  n = n + 1 : calls = n
END SUB
'>@@@
'> 1
'--- STATIC passed by reference
s : s '> 2 4
PRINT
SUB s
  STATIC n = 1
  double n
  PRINT n;
END SUB
SUB double(x)
  x = x * 2
END SUB
'--- a LOCAL that was jumped over is named in the error
s
SUB s
  IF 0 THEN LOCAL speed
  PRINT speed '! SPEED is not declared
END SUB
'--- a LOCAL with another suffix
s
SUB s
  LOCAL n%
  n$ = "x" '! N Different type already declared
END SUB
'--- LOCAL twice
s
SUB s
  LOCAL a
  LOCAL a '! A already declared
END SUB
'--- a FUNCTION without its parentheses
PRINT f '! F is a FUNCTION: it needs ()
FUNCTION f()
  f = 5
END FUNCTION
'--- assigning to the name of a FUNCTION
f = 5 '! F is a FUNCTION: it needs ()
FUNCTION f()
END FUNCTION
'--- the name of a FUNCTION is its value inside it
PRINT f() '> 6
FUNCTION f()
  f = 5
  f = f + 1
END FUNCTION
'--- the name of a SUB as a variable
s
PRINT s '! S is a SUB, no variable
SUB s
END SUB
'--- a LOCAL and a parameter may have the name of a SUB
t 4
SUB t(s)
  LOCAL u = 5
  PRINT s; u '> 4 5
END SUB
SUB s
END SUB
SUB u
END SUB
'--- a word of a command may be the name of a SUB
STEPPER INIT '>Stepper initialized, buffer 32
STEPPER AXIS X,GP2,GP3,,,80,6000,500
STEPPER POSITION HOME
STEPPER RUN '>Stepper armed
STEPPER GCODE G1, X, 2, F, 6000
PAUSE 300 : PRINT PEEK(STEPPER X) '> 2
STEPPER CLOSE
SUB x
END SUB
'--- DIM of the name of a FUNCTION
DIM f '! F is a FUNCTION: it needs ()
FUNCTION f()
END FUNCTION
'--- an unknown MM. name
PRINT MM.NOTHING '! Unknown function MM.NOTHING
'--- BOUND of a LOCAL array through two levels
outer
SUB outer
  LOCAL a(4)
  middle a()
  PRINT a(4) '> 9
END SUB
SUB middle(x())
  inner x()
END SUB
SUB inner(y())
  y(BOUND(y())) = 9
END SUB
'--- a string array through two levels
DIM names$(2) LENGTH 10 = ("x", "y", "z")
shout names$()
PRINT names$(2) '>Z
SUB shout(a$())
  LOCAL i
  FOR i = 0 TO BOUND(a$()) : up a$(i) : NEXT
END SUB
SUB up(s$)
  s$ = UCASE$(s$)
END SUB
'--- a string argument keeps to the length of its variable
DIM s$ LENGTH 3 = "abc"
grow s$
SUB grow(t$)
  t$ = t$ + "d" '! String too long
END SUB
'--- an array for a scalar and a scalar for an array
DIM a(2)
ON ERROR SKIP
one a()
PRINT MM.ERRMSG$ '>Incompatible type: argument 1
ON ERROR SKIP
all b
PRINT MM.ERRMSG$ '>Incompatible type: argument 1
SUB one(x)
END SUB
SUB all(x())
END SUB
'--- an array of another type
DIM INTEGER a(2)
all a() '! Incompatible type: argument 1
SUB all(x!())
END SUB
'--- recursion 60 deep out of FOR and DO loops
depth 60
PRINT turns '> 61
SUB depth(n)
  LOCAL i
  FOR i = 1 TO 1
    DO
      turns = turns + 1
      IF n > 0 THEN depth n - 1
    LOOP UNTIL 1
  NEXT
END SUB
'--- sixteen parameters
s 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16 '> 136
SUB s(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p)
  PRINT a + b + c + d + e + f + g + h + i + j + k + l + m + n + o + p
END SUB
'--- GOSUB inside a SUB, left by EXIT SUB
FOR i = 1 TO 200 : s : NEXT
PRINT "done" '>done
SUB s
  GOSUB inner
inner:
  EXIT SUB
END SUB
'--- GOSUB 100 deep
n = 0
GOSUB deeper
PRINT n '> 100
END
deeper:
n = n + 1
IF n < 100 THEN GOSUB deeper
RETURN
'--- a LOCAL string array is given back
FOR i = 1 TO 300 : s : NEXT
PRINT "ok" '>ok
SUB s
  LOCAL a$(50)
  a$(50) = "x"
END SUB
'--- LOCAL array with values
s '> 6
SUB s
  LOCAL a(2) = (1, 2, 3)
  PRINT a(0) + a(1) + a(2)
END SUB
'--- FUNCTION of a string with AS
PRINT pad("ab") '>[ab]
FUNCTION pad(s$) AS STRING
  pad = "[" + s$ + "]"
END FUNCTION
'--- parameters AS types
s 2.6, 7, "x" '> 3 7x
SUB s(a AS INTEGER, b AS FLOAT, c AS STRING)
  PRINT a; b; c
END SUB
'--- LENGTH from a variable, and a value behind it
n = 3
DIM STRING a LENGTH n = "abc"
PRINT a '>abc
'--- LENGTH out of range
DIM a$ LENGTH 300 '! Array size
