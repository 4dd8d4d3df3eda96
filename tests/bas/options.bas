'--- OPTION ESCAPE
OPTION ESCAPE
PRINT "tab[" + "\t" + "] quote\" back\\slash" '>tab[	] quote" back\slash
PRINT "\x41\x4a\&42\067"; ASC("\n"); ASC("\r"); ASC("\e"); ASC("\0010") '>AJBC 10 13 27 1
PRINT LEN("\a\b\f\v\q\'") '> 6
'--- without OPTION ESCAPE a backslash is one
PRINT "a\nb" '>a\nb
'--- OPTION ESCAPE OFF
OPTION ESCAPE
a$ = "\x41"
OPTION ESCAPE OFF
PRINT a$; "\x41" '>A\x41
'--- OPTION ESCAPE in DATA
OPTION ESCAPE
READ a$, b$, c$ : PRINT a$; "|"; b$; "|"; c$ '>a"b,c|A|\n
DATA "a\"b,c", "\x41", \n
'--- an unknown escape
OPTION ESCAPE
PRINT "\z" '! Unknown escape \z
'--- an escape that is no byte
OPTION ESCAPE
PRINT "\999" '! Unknown escape \999
'--- an escape without its digits
OPTION ESCAPE
PRINT "\x4" '! Unknown escape \x4
'--- OPTION ESCAPE in EXECUTE
OPTION ESCAPE
EXECUTE "PRINT \"a\\x41\"" '>aA
'--- a backslash at the end of an open string
OPTION ESCAPE
a$ = "ab\\
PRINT LEN(a$) '> 3
'--- OPTION ANGLE DEGREES
OPTION ANGLE DEGREES
PRINT SIN(30); COS(60); TAN(45); SIN(180); COS(90); SIN(-90) '> 0.5 0.5 1 0 0-1
PRINT ATN(1); ATAN2(1, -1); ASIN(1); ACOS(0) '> 45 135 90 90
PRINT SIN(3630); COS(-420) '> 0.5 0.5
PRINT DEG(PI); RAD(180); MATH(ATAN3 -1, 0) '> 180 3.141592654 270
'--- OPTION ANGLE RADIANS again
OPTION ANGLE DEGREES
OPTION ANGLE RADIANS
PRINT COS(PI) '>-1
'--- the tangent of a right angle
OPTION ANGLE DEGREES
PRINT TAN(90) '! Overflow
'--- OPTION CONTINUATION LINES
OPTION CONTINUATION LINES ON
PRINT 1; _
  2; _   
  3 '> 1 2 3
total = 1 + _
        2
PRINT total '> 3
'--- a continued line's error shows its first line
OPTION CONTINUATION LINES ENABLE
PRINT 1 + _
  1 / 0
'>[3] PRINT 1 + _
'>Error : Divide by zero
'--- continued IF, SUB and call
OPTION CONTINUATION LINES ON
IF 1 THEN _
  PRINT "yes" _
ELSE _
  PRINT "no"
show 1, _
     2 
SUB show(a, _
         b)
  PRINT a; b
END SUB
'>yes
'> 1 2
'--- continued DATA
OPTION CONTINUATION LINES ON
FOR i = 1 TO 5 : READ a$ : PRINT a$; "|"; : NEXT : PRINT '>1|2|3|x y|5|
DATA 1, 2, _
     3, _
     x y
DATA 5
'--- comments and strings do not continue
OPTION CONTINUATION LINES ON
PRINT 1 ' comment _
PRINT "a _
REM rest _
PRINT 2
'> 1
'>a _
'> 2
'--- an underscore without the option is a name
_ = 5
a = 3 + _
PRINT a '> 8
'--- OPTION CONTINUATION LINES OFF
OPTION CONTINUATION LINES ON
a = 1 + _
    1
OPTION CONTINUATION LINES OFF
_ = 7
b = a + _
PRINT b '> 9
'--- a chain of continued lines longer than a line may be
OPTION CONTINUATION LINES ON
a = 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + _
    1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + _
    1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1
PRINT a '> 72
'--- a SUB on a continued line is known before it
OPTION CONTINUATION LINES ON
s 5 '> 5
SUB _
  s(a)
  PRINT a
END SUB
'--- a label before a continued line
OPTION CONTINUATION LINES ON
GOTO there
there: PRINT _
  "there" '>there
'--- unknown OPTION
OPTION NONSENSE '! Unknown OPTION subcommand
'--- OPTION BASE inside arrays by reference
OPTION BASE 1
DIM a(3) = (1, 2, 3)
PRINT first(a()) '> 1
FUNCTION first(x())
  first = x(BOUND(x(), 0))
END FUNCTION
'--- OPTION DEFAULT INTEGER in parameters and results
OPTION DEFAULT INTEGER
PRINT half(7); 7 / 2 '> 4 3.5
FUNCTION half(n)
  half = n / 2
END FUNCTION
'--- OPTION DEFAULT NONE with types
OPTION DEFAULT NONE
DIM INTEGER a = 2
b% = 3 : c$ = "x"
PRINT a; b%; c$ '> 2 3x
'--- OPTION EXPLICIT OFF
OPTION EXPLICIT
OPTION EXPLICIT OFF
a = 1 : PRINT a '> 1
'--- OPTION EXPLICIT and a LOCAL
OPTION EXPLICIT
s
SUB s
  LOCAL a = 1
  PRINT a '> 1
  b = 2 '! B is not declared
END SUB
'--- OPTION EXPLICIT and a FOR variable
OPTION EXPLICIT
FOR i = 1 TO 2 '! I is not declared
NEXT
'--- OPTION EXPLICIT and an argument by reference
OPTION EXPLICIT
s x '! X is not declared
SUB s(a)
END SUB
