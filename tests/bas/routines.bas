'--- SUB without arguments
hello
SUB hello
  PRINT "hello" '>hello
END SUB
'--- SUB before and after its call
SUB a : PRINT "a" : END SUB
a : b
SUB b : PRINT "b" : END SUB '>a
'>b
'--- arguments by reference
SUB double(x, s$)
  x = x * 2 : s$ = s$ + "!"
END SUB
n = 4 : t$ = "go"
double n, t$
PRINT n; t$ '> 8go!
'--- an expression is passed by value
SUB double(x)
  x = x * 2
END SUB
n = 4
double (n) + 0
double n + 0
PRINT n '> 4
'--- another type is passed by value
SUB change(x%)
  x% = 9
END SUB
n = 4
change n
PRINT n '> 4
'--- an array element by reference
SUB change(x)
  x = 9
END SUB
DIM a(3)
change a(2)
PRINT a(2) '> 9
'--- a whole array
SUB fill(x(), v)
  LOCAL i
  FOR i = 0 TO BOUND(x()) : x(i) = v : NEXT
END SUB
DIM a(3)
fill a(), 5
PRINT a(0) + a(3) '> 10
'--- parentheses around the arguments
SUB show(a, b)
  PRINT a; b
END SUB
show(1, 2) '> 1 2
show 3, 4 '> 3 4
show (1)+1, 2 '> 2 2
'--- missing arguments
SUB three(a, b$, c)
  PRINT a; "[" + b$ + "]"; c
END SUB
three 1,, 3 '> 1[] 3
three 1, "x" '> 1[x] 0
three '> 0[] 0
'--- a blank first argument
SUB two(a, b)
END SUB
two , 2 '! Argument list
'--- a comma at the end
SUB two(a, b)
END SUB
two 1, '! Argument list
'--- too many arguments
SUB one(a)
END SUB
one 1, 2 '! Argument list
'--- wrong type of argument
SUB one(a)
END SUB
one "x" '! Incompatible type: argument 1
'--- AS types
SUB typed(a AS INTEGER, b AS STRING, c AS FLOAT)
  PRINT a; b; c
END SUB
typed 1.6, "x", 2 '> 2x 2
'--- FUNCTION
PRINT area(3, 4) '> 12
FUNCTION area(w, h)
  area = w * h
END FUNCTION
'--- string and integer FUNCTION
PRINT twice$("ab"); half%(7) '>abab 4
FUNCTION twice$(s$)
  twice$ = s$ + s$
END FUNCTION
FUNCTION half%(n)
  half% = n / 2
END FUNCTION
'--- FUNCTION AS
PRINT f(2.6) '> 3
FUNCTION f(x) AS INTEGER
  f = x
END FUNCTION
'--- a FUNCTION within an expression keeps the rest of it
FUNCTION f$(s$)
  LOCAL t$ = "x" + s$ + "x"
  f$ = t$ + t$
END FUNCTION
PRINT "a" + f$("b" + f$("c")) + "d" '>axbxcxxcxxxbxcxxcxxd
'--- recursion
PRINT fact(20) '> 2.432902008e+18
FUNCTION fact(n)
  IF n < 2 THEN
    fact = 1
  ELSE
    fact = n * fact(n - 1)
  ENDIF
END FUNCTION
'--- recursion 50 deep in an expression
PRINT depth%(50) '> 50
FUNCTION depth%(n%)
  IF n% > 0 THEN depth% = 1 + (0 + depth%(n% - 1))
END FUNCTION
'--- recursion 50 deep with a local string
deep 50
PRINT total '> 50
SUB deep(n)
  LOCAL s$ = "level " + STR$(n)
  IF n = 0 THEN EXIT SUB
  total = total + 1
  deep n - 1
  IF s$ <> "level " + STR$(n) THEN PRINT "local lost"
END SUB
'--- recursion from inside FOR and DO loops
walk 3
PRINT
SUB walk(n)
  LOCAL i
  FOR i = 1 TO 2
    DO
      IF n > 1 THEN walk n - 1 ELSE PRINT i;
    LOOP UNTIL 1
  NEXT
END SUB
'> 1 2 1 2 1 2 1 2
'--- endless recursion is an error
forever
SUB forever
  forever '! Too many nested calls
END SUB
'--- a one-letter SUB alone on a line
a
PRINT "next"
SUB a : PRINT "a" : END SUB '>a
'>next
'--- LOCAL hides the global
x = 1
s
PRINT x
SUB s
  LOCAL x
  x = 5
  PRINT x
END SUB
'> 5
'> 1
'--- a global first assigned inside a SUB is visible outside
s
PRINT g '> 3
SUB s
  g = 3
END SUB
'--- LOCAL array
FOR k = 1 TO 3 : s : NEXT
SUB s
  LOCAL INTEGER a(100)
  a(k) = k : PRINT a(k); a(0); a(1)
END SUB
'> 1 0 1
'> 2 0 0
'> 3 0 0
'--- LOCAL outside a SUB
LOCAL x '! Invalid here
'--- EXIT SUB and EXIT FUNCTION
s 1 : s 0 '>in
PRINT f(1); f(0) '> 7 8
SUB s(n)
  IF n = 0 THEN EXIT SUB
  PRINT "in"
END SUB
FUNCTION f(n)
  f = 7
  IF n THEN EXIT FUNCTION
  f = 8
END FUNCTION
'--- EXIT SUB outside
EXIT SUB '! Nothing to return to
'--- END SUB missing
s
SUB s '! Cannot find a matching END SUB or END FUNCTION
PRINT 1
'--- a SUB twice
SUB s
END SUB
SUB s '! S is defined twice
END SUB
'--- labels of a SUB are its own
a
GOTO here
SUB a
  GOTO here
  PRINT "no"
  here: PRINT "sub" '>sub
END SUB
here: PRINT "main" '>main
'--- a SUB may GOSUB to the main program
s
END
SUB s
  GOSUB part
END SUB
part: PRINT "part" : RETURN '>part
'--- GOTO into a SUB
GOTO inside '! Cannot find label
SUB s
  inside: PRINT 1
END SUB
'--- name: is always a label
counter:counter
SUB counter
  PRINT "once" '>once
END SUB
'--- a FUNCTION as a statement
f 1 '! Unknown command
FUNCTION f(x)
END FUNCTION
'--- arguments whose strings are changed by the function
a$ = "abc"
PRINT a$ + f$() + a$ '>abcretxyz
FUNCTION f$()
  a$ = "xyz" : f$ = "ret"
END FUNCTION
'--- errors show the line of the SUB
s
SUB s
  PRINT 1/0 '! Divide by zero
END SUB
'--- and the line of the call afterwards
x = f(1) : PRINT x : PRINT 1/0 '! Divide by zero
FUNCTION f(n)
  f = n
END FUNCTION '> 1
'--- LOCAL array of another shape in the same memory
s
SUB s
  LOCAL k
  FOR k = 2 TO 3
    LOCAL a(k, 5 - k)
    a(k, 5 - k) = k : PRINT a(k, 5 - k); BOUND(a(), 1)
  NEXT
END SUB
'> 2 2
'> 3 3
'--- FUNCTIONs call each other 60 deep
PRINT even(60); even(59) '> 1 0
FUNCTION even(n)
  IF n = 0 THEN even = 1 ELSE even = odd(n - 1)
END FUNCTION
FUNCTION odd(n)
  IF n = 0 THEN odd = 0 ELSE odd = even(n - 1)
END FUNCTION
