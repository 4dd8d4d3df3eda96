'--- SPC and TAB
PRINT "a"; SPC(3); "b"; TAB(10); "c" '>a   b    c
'--- TAB to where the cursor is
PRINT "abc"; TAB(4); "d" '>abcd
'--- TAB out of range
PRINT TAB(0) '! Number out of bounds
'--- PRINT @ puts the cursor
PRINT @(4, 2) "x" '>[3;5Hx
'--- PRINT @ sets the column for TAB
PRINT @(3, 0) TAB(6) "x" '>[1;4H  x
'--- PRINT @ out of range
PRINT @(-1, 0) "x" '! Number out of bounds
'--- PRINT of mixed types without separators
PRINT 1 2.5 "x" 3 '> 1 2.5x 3
'--- two commas are two tabs
PRINT 1,,2 '> 1		 2
'--- a comma keeps the line open
PRINT 1, : PRINT 2 '> 1	 2
'--- PRINT of a comparison
PRINT 2 > 1; "a" = "b" '> 1 0
'--- integers have no exponent, floats have from a million on
a% = 123456789012 : PRINT a%; a% * 1.0 '> 123456789012 1.23456789e+11
'--- rounding to ten digits
PRINT 123456.789012; 0.123456789012; 99999.99999999 '> 123456.789 0.123456789 100000
'--- small numbers
PRINT 0.001; 0.00012345; 0.0000999; -0.00001 '> 0.001 0.00012345 9.99e-05-1e-05
'--- the largest and the smallest float
PRINT 1.797693134e308; 2.225073859e-308; 5e-324 '> 1.797693134e+308 2.225073859e-308 4.940656458e-324
'--- minus zero is zero
a = 0 : PRINT -a; 0 * -1.0 '> 0 0
'--- sums of tenths
FOR i = 1 TO 10 : a = a + 0.1 : NEXT : PRINT a; a = 1 '> 1 0
'--- STR$ with a width for floats
PRINT "[" + STR$(1.5, 5) + "]"; "[" + STR$(-1.5, 5) + "]"; "[" + STR$(12345.5, 3) + "]" '>[    1.5][   -1.5][12345.5]
'--- STR$ always with a sign
PRINT STR$(5, -3); STR$(-5, -3); STR$(0, -2) '> +5 -5+0
'--- STR$ with decimals of an integer
PRINT STR$(7, 0, 2); STR$(-7, 0, 1) '>7.00-7.0
'--- STR$ rounds ties away from zero
PRINT STR$(0.125, 0, 2); " "; STR$(2.5, 0, 0); " "; STR$(-0.5, 0, 0); " "; STR$(1.005, 0, 2) '>0.13 3 -1 1.00
'--- STR$ of large numbers
PRINT STR$(1e15); " "; STR$(123456789012345678) '>1e+15 123456789012345678
'--- STR$ with a filler behind the sign of blanks
PRINT STR$(-2.5, 6, 1, "*"); STR$(2.5, -6, 1, "0") '>****-2.5+00002.5
'--- STR$ of too many decimals
PRINT STR$(1, 0, 17) '! 17 is invalid (valid is -16 to 16)
'--- STR$ of a text
PRINT STR$("a") '! Expected a number
'--- FORMAT$ of g, f and e
PRINT FORMAT$(1234567, "%g"); " "; FORMAT$(0.5, "%f"); " "; FORMAT$(0.5, "%e") '>1.235e+06 0.5000 5.0000e-01
'--- FORMAT$ of G and E
PRINT FORMAT$(1E6, "%G"); FORMAT$(-12.5, "%9.2E"); FORMAT$(2.5, "%Gm")  '>1E+06-1.25E+012.5m
'--- FORMAT$ with texts around
PRINT FORMAT$(2.5, "X%.1f mm") '>X2.5 mm
'--- FORMAT$ with blanks and zeros
PRINT "[" + FORMAT$(7, "%8.2f") + "][" + FORMAT$(-7, "%08.2f") + "][" + FORMAT$(7, "% .0f") + "]" '>[    7.00][-0007.00][ 7]
'--- HEX$ with a width and of negative numbers
PRINT HEX$(26, 4); " "; HEX$(-1, 4); " "; OCT$(64, 4); " "; BIN$(0) '>001A FFFFFFFFFFFFFFFF 0100 0
'--- HEX$ rounds
PRINT HEX$(15.5) '>10
'--- HEX$ wider than 64
PRINT HEX$(1, 65) '! 65 is invalid (valid is 0 to 64)
'--- VAL of what is no number, and of a sign
PRINT VAL(""); VAL("-"); VAL("+7"); VAL("7-"); VAL(".5."); VAL("1,000") '> 0 0 7 7 0.5 1
'--- VAL keeps integers exact
PRINT VAL("9223372036854775807") '> 9223372036854775807
'--- literals of many forms
PRINT 1.; .25; 1E3; 1e-2; 00012; &HaB; &b11; &o17 '> 1 0.25 1000 0.01 12 171 3 15
'--- a literal that is no number
PRINT &HG '! Invalid syntax
'--- MM.DEVICE$ and MM.VER
PRINT LEN(MM.DEVICE$) > 0; MM.VER >= 0 '> 1 1
'--- PRINT of an array
DIM a(2)
PRINT a() '! Invalid syntax
'--- an open parenthesis in PRINT
PRINT (1 '! Invalid syntax
'--- 255 characters in a string
a$ = STRING$(255, "x") : PRINT LEN(a$) '> 255
b$ = a$ + "y" '! String too long
'--- a string may hold any byte
a$ = CHR$(0) + CHR$(255) + CHR$(10)
PRINT LEN(a$); ASC(a$); ASC(MID$(a$, 2)); a$ = CHR$(0) + CHR$(255) + CHR$(10) '> 3 0 255 1
