'--- LEFT$ RIGHT$ MID$
PRINT LEFT$("stepper", 4); RIGHT$("stepper", 3); MID$("stepper", 3, 2) '>stepperep
PRINT "[" + LEFT$("ab", 9) + RIGHT$("ab", 9) + "]" '>[abab]
PRINT "[" + MID$("abc", 2) + MID$("abc", 9) + MID$("abc", 2, 0) + "]" '>[bc]
'--- MID$ from 0
PRINT MID$("abc", 0) '! 0 is invalid (valid is 1 to 255)
'--- MID$ rounds its arguments
PRINT MID$("abcdef", 2.5, 1.4) '>c
'--- LEN ASC CHR$
PRINT LEN("abc"); LEN(""); ASC("A"); ASC("") '> 3 0 65 0
PRINT CHR$(65); CHR$(66.4); LEN(CHR$(0)) '>AB 1
'--- CHR$ out of range
PRINT CHR$(256) '! 256 is invalid (valid is 0 to 255)
'--- a quote in a string
PRINT "a" + CHR$(34) + "b" '>a"b
'--- UCASE$ LCASE$
PRINT UCASE$("aBc1"); LCASE$("AbC1") '>ABC1abc1
'--- INSTR
PRINT INSTR("hello", "l"); INSTR(4, "hello", "l"); INSTR("hello", "x") '> 3 4 0
PRINT INSTR(0, "abc", "b") '> 2
'--- SPACE$ STRING$
PRINT "[" + SPACE$(3) + "]"; STRING$(3, "xy"); STRING$(2, 65) '>[   ]xxxAA
'--- VAL
PRINT VAL("12.5abc"); VAL("  -3"); VAL("x"); VAL("1e"); VAL("1e2") '> 12.5-3 0 1 100
PRINT VAL("&HFF"); VAL("0x10"); VAL("&B101"); VAL("&O17") '> 255 16 5 15
'--- HEX$ OCT$ BIN$
PRINT HEX$(255); " "; HEX$(10, 4); " "; OCT$(8); " "; BIN$(5); " "; BIN$(5, 8) '>FF 000A 10 101 00000101
PRINT HEX$(-1) '>FFFFFFFFFFFFFFFF
'--- STR$
PRINT STR$(5); STR$(-5); STR$(1.5); STR$(1/3) '>5-51.50.3333333333
PRINT "[" + STR$(5, 4) + "]"; "[" + STR$(-5, 4) + "]" '>[   5][  -5]
PRINT "[" + STR$(3.14159, 4, 2) + "]"; "[" + STR$(2.5, 0, 3) + "]" '>[   3.14][2.500]
PRINT STR$(123.456, -4, 4); STR$(-1.5, -3, 1) '>+123.4560 -1.5
PRINT STR$(0.5, 0, 0); STR$(1.5, 0, 0); STR$(2.5, 0, 0) '>123
PRINT STR$(7, 4, 0, "0"); " "; STR$(-7, 4, 0, "0") '>0007 -007
PRINT STR$(12345.678, 0, -3) '>1.235e+04
'--- FORMAT$
PRINT FORMAT$(3.14159265); " "; FORMAT$(3.14159265, "%g") '>3.142 3.142
PRINT FORMAT$(42, "%f"); FORMAT$(3.14159, "%8.3f"); FORMAT$(5, "%-6.1fmm") '>42.0000   3.1425.0   mm
PRINT FORMAT$(12345.678, "%.2e"); FORMAT$(7, "%06.1f"); FORMAT$(7, "%+.0f") '>1.23e+040007.0+7
'--- FORMAT$ without a number in it
PRINT FORMAT$(1, "x") '! Invalid syntax
'--- FIELD$
PRINT FIELD$("a, b ,c", 2); "|"; FIELD$("a,b", 5); "|"; FIELD$("x:y;z", 3, ":;") '>b||z
PRINT FIELD$("a,'b,c',d", 2, ",", "'") '>'b,c'
'--- TRIM$
PRINT "[" + TRIM$("  ab  ") + "]"; "[" + TRIM$("  ab  ", " ", "B") + "]"; "[" + TRIM$("xxaxx", "x", "R") + "]" '>[ab  ][ab][xxa]
'--- rounding functions
PRINT INT(2.7); INT(-2.1); FIX(2.7); FIX(-2.7); CINT(2.5); CINT(-2.5) '> 2-3 2-2 3-3
PRINT INT(3) / 2 '> 1.5
'--- ABS and SGN
PRINT ABS(-5); ABS(-2.5); SGN(-3); SGN(0); SGN(0.1) '> 5 2.5-1 0 1
'--- ABS keeps the type
PRINT ABS(-5000000) '> 5000000
'--- MAX and MIN give a float
PRINT MAX(1, 5, 3); MIN(4, 2, 8) '> 5 2
PRINT MAX(1000000, 2) '> 1e+06
'--- roots and logarithms
PRINT SQR(2); EXP(1); LOG(10) '> 1.414213562 2.718281828 2.302585093
'--- SQR of a negative number
PRINT SQR(-1) '! Negative argument
'--- LOG of a negative number
PRINT LOG(-1) '! Negative argument
'--- LOG of zero
PRINT LOG(0) '! Divide by zero
'--- EXP overflows
PRINT EXP(1000) '! Overflow
'--- trigonometry in radians
PRINT SIN(PI / 6); COS(PI / 3); TAN(PI / 4) '> 0.5 0.5 1
PRINT ATN(1) * 4; ATAN2(1, -1); ASIN(1); ACOS(1) '> 3.141592654 2.35619449 1.570796327 0
PRINT RAD(180); DEG(PI) '> 3.141592654 180
'--- ASIN out of range
PRINT ASIN(2) '! Number out of bounds
'--- PI
PRINT PI '> 3.141592654
'--- RND is from 0 to below 1 and repeats with its seed
RANDOMIZE 5
FOR i = 1 TO 200
  r = RND
  IF r < 0 OR r >= 1 THEN PRINT "out of range"
  s = s + r
NEXT
IF s > 80 AND s < 120 THEN PRINT "even" '>even
RANDOMIZE 5 : a = RND() : RANDOMIZE 5 : b = RND
PRINT a = b; a = RND '> 1 0
'--- CHOICE truncates its condition
PRINT CHOICE(1, "yes", "no"); CHOICE(0, "yes", "no"); CHOICE(0.9, "yes", "no") '>yesnono
'--- missing argument
PRINT LEFT$("a") '! Argument count
'--- too many arguments
PRINT SIN(1, 2) '! Argument count
'--- wrong type of argument
PRINT LEN(5) '! Expected a string
'--- a string for a number
PRINT SIN("x") '! Expected a number
'--- a function's name is no variable
LEN = 5 '! Invalid syntax
'--- digits are a minimum
PRINT BIN$(5, 2); HEX$(255, 1) '>101FF
'--- LEFT$ of less than nothing
PRINT LEFT$("abc", -1) '! -1 is invalid (valid is 0 to 255)
'--- a text longer than there are
PRINT SPACE$(256) '! 256 is invalid (valid is 0 to 255)
'--- MAX of a text
PRINT MAX("a", 1) '! Expected a number
'--- CINT beyond 64 bits
PRINT CINT(1e30) '! Number too large
