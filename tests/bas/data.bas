'--- READ numbers and strings
READ a, b$, c%
PRINT a; b$; c% '> 1.5two 3
DATA 1.5, "two", 3
'--- unquoted words are trimmed
READ a$, b$
PRINT "[" + a$ + "]"; "[" + b$ + "]" '>[hello world][x]
DATA  hello world , x
'--- several DATA lines in order, wherever they stand
DATA 1, 2
FOR i = 1 TO 4 : READ a : PRINT a; : NEXT : PRINT '> 1 2 3 4
DATA 3
DATA 4
'--- negative numbers and hexadecimal
READ a, b : PRINT a; b '>-2.5 255
DATA -2.5, &HFF
'--- READ into an array
DIM a(2)
FOR i = 0 TO 2 : READ a(i) : NEXT
PRINT a(0) + a(1) + a(2) '> 6
DATA 1, 2, 3
'--- commas and colons in quotes
READ a$ : PRINT a$ '>a,b:c
DATA "a,b:c"
'--- no more DATA
READ a : PRINT a '> 1
READ a '! No DATA to read
DATA 1
'--- no DATA at all
READ a '! No DATA to read
'--- RESTORE
READ a, b : RESTORE : READ c : PRINT a; b; c '> 1 2 1
DATA 1, 2
'--- RESTORE to a label
RESTORE second : READ a : PRINT a '> 3
first: DATA 1, 2
second: DATA 3
'--- RESTORE to a line number
RESTORE 20 : READ a$ : PRINT a$ '>b
10 DATA a
20 DATA b
'--- RESTORE to a missing label
RESTORE nowhere '! Cannot find label
'--- a word for a number
READ a '! Expected a number
DATA word
'--- PRINT with commas and an open line
PRINT "a", "b" '>a	b
PRINT "a";
PRINT "b" '>ab
'--- PRINT alone
PRINT '>
PRINT "x" '>x
'--- PRINT without separators
PRINT "a" "b" 1 '>ab 1
'--- PRINT TAB
PRINT "ab"; TAB(5); "c" '>ab  c
PRINT "abcdef"; TAB(3); "x" '>abcdef
'>  x
'--- ? is PRINT
? 1; 2 '> 1 2
'--- a string without its closing quote
PRINT "open
'>open
'--- several statements in a line
a = 1 : b = 2 : PRINT a + b '> 3
'--- empty statements
: : PRINT 1 : : PRINT 2 : '> 1
'> 2
