'--- CALL of a SUB by its name
s$ = "go"
CALL s$, 2, "x" '> 2x
CALL "Go", 3, "y" '> 3y
SUB go(a, b$)
  PRINT a; b$
END SUB
'--- CALL passes by reference
CALL "double", n : CALL "double", n
PRINT n '> 3
SUB double(x)
  x = x * 2 + 1
END SUB
'--- CALL without arguments and with one left out
CALL "s" '> 0 0
CALL "s", 1,, 3 '> 1 3
SUB s(a, b, c)
  PRINT a; c
END SUB
'--- CALL of a FUNCTION
f$ = "area"
PRINT CALL(f$, 3, 4) + CALL("AREA", 1, 1) '> 13
FUNCTION area(w, h)
  area = w * h
END FUNCTION
'--- CALL of a string FUNCTION
PRINT "<" + CALL("twice$", "ab") + ">"; CALL("twice", "c") '><abab>cc
FUNCTION twice$(s$)
  twice$ = s$ + s$
END FUNCTION
'--- CALL of a whole array
DIM a(3) = (1, 2, 3, 4)
PRINT CALL("total", a()) '> 10
FUNCTION total(x())
  LOCAL i
  FOR i = 0 TO BOUND(x()) : total = total + x(i) : NEXT
END FUNCTION
'--- CALL of a missing name
CALL "nobody" '! Unknown user subroutine
'--- CALL of a FUNCTION as a SUB
CALL "f" '! Unknown user subroutine
FUNCTION f()
END FUNCTION
'--- CALL of a SUB as a FUNCTION
PRINT CALL("s") '! Unknown user subroutine
SUB s
END SUB
'--- CALL of a number
CALL 5 '! Expected a string
'--- CALL with too many arguments
CALL "s", 1, 2 '! Argument list
SUB s(a)
END SUB
'--- CALL deep in an expression keeps the rest of it
PRINT "a" + CALL("f$", "b") + "c" + CALL("f$", CALL("f$", "d")) '>a<b>c<<d>>
FUNCTION f$(s$)
  f$ = "<" + s$ + ">"
END FUNCTION
'--- EXECUTE a statement
EXECUTE "PRINT 1 + 1" '> 2
'--- EXECUTE several statements and blocks
EXECUTE "FOR i = 1 TO 3 : DO : PRINT i; : LOOP UNTIL 1 : NEXT" '> 1 2 3
PRINT
'--- EXECUTE assigns and declares globals
EXECUTE "a = 5 : b$ = STR$(a)"
EXECUTE "DIM c(2) = (1, 2, 3)"
PRINT a; b$; c(2) '> 55 3
'--- EXECUTE makes a variable of any name
FOR i = 1 TO 600
  EXECUTE "v" + STR$(i) + " = " + STR$(i * 2)
NEXT
PRINT v1; v300; v600 '> 2 600 1200
'--- EXECUTE sees the locals of its routine
s 4
PRINT g
SUB s(p)
  LOCAL t = 2, u$ = "x"
  EXECUTE "t = t + 1 : u$ = u$ + STR$(p)"
  EXECUTE "g = p + t : PRINT u$" '>x4
END SUB
'> 7
'--- EXECUTE sees its routine's STATIC
s : s '> 1 2
PRINT
SUB s
  STATIC n
  EXECUTE "n = n + 1 : PRINT n;"
END SUB
'--- EXECUTE sets a FUNCTION's value
PRINT f(3) '> 9
FUNCTION f(x)
  EXECUTE "f = x * x"
END FUNCTION
'--- EXECUTE calls SUBs and GOSUBs
EXECUTE "hello : GOSUB part" '>hello
'>part
END
SUB hello
  PRINT "hello"
END SUB
part: PRINT "part" : RETURN
'--- EXECUTE inside EXECUTE
q$ = CHR$(34)
EXECUTE "EXECUTE " + q$ + "a = 1 : PRINT a" + q$ + " : PRINT a + 1" '> 1
'> 2
'--- EXECUTE goes on behind itself in the line
EXECUTE "a = 1" : PRINT a '> 1
IF a THEN EXECUTE "b = 2" ELSE EXECUTE "b = 3"
PRINT b '> 2
'--- EXECUTE of nothing
EXECUTE "" : EXECUTE "' a comment" : PRINT "ok" '>ok
'--- EXECUTE EXIT SUB
s
PRINT "back" '>back
SUB s
  EXECUTE "EXIT SUB"
  PRINT "no"
END SUB
'--- an error in EXECUTE is the statement's
EXECUTE "a = 1 / 0" '! Divide by zero
'--- EXECUTE of rubbish
EXECUTE "PRINT 1 +" '! Invalid syntax
'--- EXECUTE of an open block
EXECUTE "FOR i = 1 TO 2 : PRINT i" '! Cannot find a matching NEXT
'--- EXECUTE cannot jump
EXECUTE "GOTO here" '! Invalid here
here: PRINT "here"
'--- EXECUTE cannot declare a local
s
SUB s
  EXECUTE "LOCAL x" '! Invalid here
END SUB
'--- EXECUTE cannot define a SUB
EXECUTE "SUB s" '! Invalid here
'--- EXECUTE of a number
EXECUTE 5 '! Expected a string
'--- an error in EXECUTE is skipped within its text
ON ERROR SKIP 2
EXECUTE "a = 1 / 0 : b = 7"
PRINT b; MM.ERRMSG$ '> 7Divide by zero
'--- EXECUTE under OPTION EXPLICIT
OPTION EXPLICIT
EXECUTE "x = 1" '! X is not declared
'--- EXECUTE in a loop uses up no memory
FOR i = 1 TO 3000
  EXECUTE "SELECT CASE STR$(i) : CASE STR$(1) TO STR$(9) : n = n + 1 : END SELECT"
NEXT
PRINT n > 0 '> 1
'--- EXECUTE in a recursion 30 deep
down 30
PRINT k '> 31
SUB down(n)
  k = k + 1
  IF n > 0 THEN EXECUTE "down n - 1"
END SUB
'--- EXECUTE of GOSUB without RETURN ends with the program
EXECUTE "GOSUB x"
x: PRINT "x" : END '>x
'--- RETURN inside EXECUTE has nothing to return to
GOSUB part
END
part: EXECUTE "RETURN" '! Nothing to return to
'--- EVAL of expressions
a = 5
PRINT EVAL("a * 2 + 1"); EVAL("STR$(a)") + "!"; EVAL("&HFF") '> 115! 255
'--- EVAL within an expression keeps the rest of it
a$ = "x"
PRINT "<" + EVAL("a$ + f$()") + "|" + EVAL("a$") + ">" '><xret|y>
FUNCTION f$()
  a$ = "y" : f$ = "ret"
END FUNCTION
'--- EVAL sees locals
PRINT f(4) '> 24
FUNCTION f(x)
  LOCAL y = 2
  f = EVAL("x * (y + 4)")
END FUNCTION
'--- EVAL inside EVAL
q$ = CHR$(34)
PRINT EVAL("1 + EVAL(" + q$ + "2 * 3" + q$ + ")") '> 7
'--- EVAL in a condition
FOR i = 1 TO 3
  IF EVAL("i = 2") THEN PRINT i '> 2
NEXT
'--- EVAL of rubbish
PRINT EVAL("1 +") '! Invalid syntax
'--- EVAL of two expressions
PRINT EVAL("1 : 2") '! Invalid syntax
'--- EVAL of nothing
PRINT EVAL("") '! Invalid syntax
'--- an error inside EVAL skips its statement
ON ERROR SKIP
a = 1 + EVAL("1 / 0")
PRINT a; MM.ERRMSG$ '> 0Divide by zero
'--- an error in EVAL within a FUNCTION under IGNORE
ON ERROR IGNORE
PRINT 1 + f(2) '> 6
FUNCTION f(x)
  f = 5
  f = EVAL("x / 0")
END FUNCTION
'--- thousands of EVALs with errors use up no memory
ON ERROR IGNORE
FOR i = 1 TO 3000
  a$ = EVAL("STRING$(200, 65) + STRING$(200, 66)")
NEXT
PRINT MM.ERRMSG$ '>String too long
'--- EVAL in a recursion
PRINT fact(9) '> 362880
FUNCTION fact(n)
  IF n < 2 THEN fact = 1 ELSE fact = EVAL("n * fact(n - 1)")
END FUNCTION
