'--- a SUB calls itself fifty times
depth 50
SUB depth(n)
  LOCAL a = n, b$ = STR$(n), c%(2)
  c%(1) = a
  IF n > 1 THEN depth n - 1 ELSE PRINT "down"; c%(1); b$ '>down 11
END SUB
'--- a FUNCTION calls itself fifty times inside an expression
PRINT sum(50) '> 1275
FUNCTION sum(n)
  IF n > 0 THEN sum = 0 + (((n + sum(n - 1))))
END FUNCTION
'--- a hundred GOSUBs inside each other
n = 100
GOSUB down
PRINT n '> 0
END
down: n = n - 1
IF n > 0 THEN GOSUB down
RETURN
'--- endless GOSUB is an error
forever: GOSUB forever '! Too many nested calls
'--- an error in endless recursion can be ignored and the program goes on
ON ERROR IGNORE
forever
PRINT MM.ERRMSG$ '>Too many nested calls
SUB forever
  IF MM.ERRNO = 0 THEN forever
END SUB
'--- EXECUTE of itself is an error
s$ = "EXECUTE s$"
EXECUTE s$ '! Too many nested calls
'--- EVAL of itself is an error
PRINT f(1)
FUNCTION f(x)
  f = EVAL("f(1)") + 1 '! Too many nested calls
END FUNCTION
'--- large local texts use up the memory, and give it back
ON ERROR IGNORE
large
PRINT MM.ERRMSG$ '>Not enough memory
ON ERROR ABORT
DIM a%(8000)
a%(8000) = 7 : PRINT a%(8000) '> 7
SUB large
  LOCAL t$(50), u$(50)
  IF MM.ERRNO = 0 THEN large
END SUB
'--- sixty locals
many
SUB many
  LOCAL a0, a1, a2, a3, a4, a5, a6, a7, a8, a9, b0, b1, b2, b3, b4, b5, b6, b7, b8, b9
  LOCAL c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, d0, d1, d2, d3, d4, d5, d6, d7, d8, d9
  LOCAL e0, e1, e2, e3, e4, e5, e6, e7, e8, e9, f0, f1, f2, f3, f4, f5, f6, f7, f8, f9
  f9 = 7 : PRINT f9; e0 '> 7 0
END SUB
'--- too many locals
many
SUB many
  LOCAL a0, a1, a2, a3, a4, a5, a6, a7, a8, a9, b0, b1, b2, b3, b4, b5, b6, b7, b8, b9
  LOCAL c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, d0, d1, d2, d3, d4, d5, d6, d7, d8, d9
  LOCAL e0, e1, e2, e3, e4, e5, e6, e7, e8, e9, f0, f1, f2, f3, f4, f5, f6, f7, f8, f9
  LOCAL g0, g1, g2, g3 '! Too many local variables
END SUB
'--- texts of 255 characters, and of one more
a$ = STRING$(255, "x")
PRINT LEN(a$ + ""); LEN(LEFT$(a$, 255)) '> 255 255
ON ERROR SKIP 6
a$ = a$ + "y"
PRINT LEN(a$); MM.ERRMSG$ '> 255String too long
b$ = "y" + a$
CAT a$, "y"
b$ = SPACE$(256)
PRINT LEN(a$); LEN(b$) '> 255 0
'--- integers wrap as they do in 64 bits
a% = 9223372036854775807
PRINT a% + 1 '>-9223372036854775808
PRINT -a% - 2 '> 9223372036854775807
PRINT a% * 2 '>-2
'--- thirty-two parentheses
PRINT ((((((((((((((((((((((((((((((((7)))))))))))))))))))))))))))))))) '> 7
'--- parentheses without end
PRINT ((((((((((((((((((((((((((((((((((((((7)))))))))))))))))))))))))))))))))))))) '! Expression too complex
'--- operators that bind more tightly each time
PRINT 0 OR 1=2<3<<4+5*6^(0 OR 1=2<3<<4+5*6^(0 OR 1=2<3<<4+5*6^(0 OR 1=2<3<<4+5*6^(2)))) '> 1
'--- a dozen nested blocks
EXECUTE "t = 0"
FOR a = 1 TO 1 : FOR b = 1 TO 1 : FOR c = 1 TO 1 : FOR d = 1 TO 1 : FOR e = 1 TO 1
DO : DO : DO : DO : DO : IF 1 THEN
SELECT CASE 1
CASE 1
t = t + 1
END SELECT
ENDIF
LOOP UNTIL 1 : LOOP UNTIL 1 : LOOP UNTIL 1 : LOOP UNTIL 1 : LOOP UNTIL 1
NEXT e, d, c, b, a
PRINT t '> 1
