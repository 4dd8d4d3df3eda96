'--- MID$ as a target
a$ = "abcdef"
MID$(a$, 2, 3) = "XYZ" : PRINT a$ '>aXYZef
MID$(a$, 1) = "12" : PRINT a$ '>12YZef
MID$(a$, 3, 2) = "-" : PRINT a$ '>12-ef
MID$(a$, 3, 1) = "long" : PRINT a$ '>12longef
MID$(a$, 8) = "tail" : PRINT a$ '>12longetail
MID$(a$, 1, 0) = ">" : PRINT a$ '>>12longetail
'--- MID$ as a target from behind the end
a$ = "abc"
MID$(a$, 4) = "x" '! 4 is invalid (valid is 1 to 3)
'--- MID$ as a target of an element
DIM t$(2) LENGTH 5
t$(1) = "abc" : MID$(t$(1), 2, 1) = "XYZ" : PRINT t$(1) '>aXYZc
MID$(t$(1), 1, 0) = "!" '! String too long
'--- MID$ as a target with its own text
a$ = "abcd"
MID$(a$, 2, 2) = a$ : PRINT a$ '>aabcdd
'--- MID$ as a target of a number
MID$(a, 1) = "x" '! Expected a string
'--- MID$ as a target of a constant
CONST c$ = "abc"
MID$(c$, 1) = "x" '! Expected a string
'--- BYTE
a$ = "ABC"
BYTE(a$, 2) = 98 : PRINT a$; BYTE(a$, 2) '>AbC 98
'--- BYTE beyond the text
a$ = "ABC"
PRINT BYTE(a$, 4) '! 4 is invalid (valid is 1 to 3)
'--- BYTE of more than a byte
a$ = "ABC"
BYTE(a$, 1) = 256 '! 256 is invalid (valid is 0 to 255)
'--- BIT
a% = 5
PRINT BIT(a%, 0); BIT(a%, 1); BIT(a%, 2); BIT(-1, 63) '> 1 0 1 1
BIT(a%, 1) = 1 : BIT(a%, 0) = 0 : BIT(a%, 63) = 1
PRINT HEX$(a%) '>8000000000000006
'--- BIT of a float variable
a = 5
BIT(a, 1) = 1 '! Incompatible type: argument 1
'--- BIT that is not there
PRINT BIT(1, 64) '! 64 is invalid (valid is 0 to 63)
'--- BYVAL
n = 4 : t$ = "x"
s n, t$ : PRINT n; t$ '> 4x
SUB s(BYVAL a, BYVAL b$)
  a = a + 1 : b$ = b$ + "!"
END SUB
'--- BYREF is what arguments are anyway
n = 4
s n : PRINT n '> 5
SUB s(BYREF a AS FLOAT)
  a = a + 1
END SUB
'--- BYVAL of an element, and missing
DIM a(2) = (1, 2, 3)
s a(1) : s : PRINT a(1) '> 2
SUB s(BYVAL x AS FLOAT)
  x = x * 10
END SUB
'--- BYVAL of the wrong type
s "x" '! Incompatible type: argument 1
SUB s(BYVAL x)
END SUB
'--- CLEAR
a = 5 : b$ = "x" : DIM c(3), d$(5)
CONST e = 1
CLEAR
PRINT a; "[" + b$ + "]" '> 0[]
DIM c(5), d$(5) : CONST e = 2 : PRINT BOUND(c()); e '> 5 2
'--- CLEAR gives all memory back
GOSUB part : GOSUB part : GOSUB part : GOSUB part : GOSUB part
DIM big(9000) : PRINT big(9000) '> 0
END
part: DIM a(4000), b$(20) : CLEAR : RETURN
'--- CLEAR forgets STATIC too
s : s : CLEAR : s '> 1 2 1
PRINT
SUB s
  STATIC n
  INC n : PRINT n;
END SUB
'--- CLEAR in a SUB
s
SUB s
  CLEAR '! Invalid here
END SUB
'--- CLEAR under OPTION EXPLICIT
OPTION EXPLICIT
DIM a = 1
CLEAR
a = 2 '! A is not declared
'--- CLEAR beside texts of SELECT CASE
FOR k% = 1 TO 2
  SELECT CASE "b" + STR$(k%)
    CASE "b1" TO "b9" : PRINT "between"; '>betweenbetween
  END SELECT
  IF k% = 1 THEN CLEAR : k% = 1
NEXT
PRINT
'--- CLS and POS
PRINT "abc"; POS; '>abc 4[2J[HPOS 4
CLS
PRINT "POS"; POS
'--- EXIT and CONTINUE alone mean DO
DO
  n = n + 1
  IF n = 2 THEN CONTINUE
  IF n = 4 THEN EXIT
  PRINT n; '> 1 3
LOOP
PRINT
'--- WHILE closed by LOOP
WHILE n < 3
  n = n + 1
LOOP
PRINT n '> 3
'--- rounding in arguments
PRINT SPACE$(1.5) + "|"; CHR$(65.5); LEFT$("abc", 1.5); STRING$(2.5, 65) '>  |BabAAA
'--- a label and a line number beside each other
GOTO 65000
65000 last: PRINT "there" '>there
'--- an integer FOR with a limit that is a float
FOR i% = 1 TO 2.5 : PRINT i%; : NEXT : PRINT '> 1 2 3
'--- FOR with a step of zero and an EXIT
FOR i = 1 TO 2 STEP 0
  n = n + 1 : IF n = 5 THEN EXIT FOR
NEXT
PRINT n '> 5
'--- SELECT CASE within SELECT CASE
FOR i = 1 TO 2
  SELECT CASE i
    CASE 1
      SELECT CASE i + 1
        CASE 2 : PRINT "inner"; '>innerouter
      END SELECT
    CASE ELSE : PRINT "outer";
  END SELECT
NEXT
PRINT
'--- CASE with each comparison of IS
FOR i = 1 TO 5
  SELECT CASE i
    CASE IS <= 1 : PRINT "a";
    CASE IS = 2 : PRINT "b";
    CASE IS >= 5 : PRINT "e";
    CASE IS <> 3 : PRINT "d";
    CASE IS < 9 : PRINT "c";
  END SELECT
NEXT
PRINT '>abcde
'--- ON n GOSUB rounds and returns behind itself
ON 1.5 GOSUB one, two : PRINT "back" '>two
'>back
END
one: PRINT "one" : RETURN
two: PRINT "two" : RETURN
'--- DATA as the only thing of a label
RESTORE here : READ a$ : PRINT a$ '>yes
DATA no
here: DATA yes
'--- RESTORE in a SUB to a label of the main program
s : READ a : PRINT a '> 2
DATA 1
second: DATA 2
SUB s
  RESTORE second
END SUB
'--- DATA inside a SUB is the program's
READ a, b : PRINT a; b '> 1 2
DATA 1
SUB s
  DATA 2
END SUB
