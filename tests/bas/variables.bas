'--- names are case-insensitive
Abc = 5
PRINT aBC '> 5
'--- default type is float
a = 7
PRINT a / 2 '> 3.5
'--- a new variable is zero or empty
PRINT a; b%; "[" + c$ + "]" '> 0 0[]
'--- suffix and bare name are one variable
a% = 3
PRINT a '> 3
'--- another suffix is an error
a% = 3
a$ = "x" '! A Different type already declared
'--- bare first, then another suffix
a = 3
a$ = "x" '! A Different type already declared
'--- underscore, digits and points in names
_x1.y = 4
PRINT _X1.Y '> 4
'--- LET
LET a = 4
PRINT a '> 4
'--- number to string
a$ = 5 '! Expected a string
'--- string to number
a = "5" '! Expected a number
'--- DIM with types
DIM INTEGER a, b
DIM c AS STRING, d AS FLOAT
a = 2.7 : c = "x" : d = 1.5
PRINT a; b; c; d '> 3 0x 1.5
'--- DIM with a value
DIM a% = 5, b$ = "q"
PRINT a%; b$ '> 5q
'--- DIM twice
DIM a
DIM a '! A already declared
'--- OPTION EXPLICIT
OPTION EXPLICIT
DIM a
a = 1
PRINT a '> 1
total = 2 '! TOTAL is not declared
'--- OPTION DEFAULT INTEGER
OPTION DEFAULT INTEGER
a = 2.6
PRINT a '> 3
'--- OPTION DEFAULT NONE
OPTION DEFAULT NONE
a = 2 '! Variable type not specified
'--- CONST
CONST speed = 100, name$ = "mill"
PRINT speed; name$ '> 100mill
speed = 5 '! Cannot change a constant
'--- CONST twice
CONST a = 1
CONST a = 2 '! A Global variable already declared
'--- INC
a = 5
INC a : INC a, 2.5
PRINT a '> 8.5
'--- INC of a string
a$ = "ab"
INC a$, "cd"
PRINT a$ '>abcd
'--- one-dimensional array
DIM a(3)
FOR i = 0 TO 3 : a(i) = i * i : NEXT
PRINT a(0); a(1); a(2); a(3) '> 0 1 4 9
'--- array with values; the first index runs fastest
DIM m(1,1) = (1,2,3,4)
PRINT m(0,0); m(1,0); m(0,1); m(1,1) '> 1 2 3 4
'--- three dimensions
DIM INTEGER t(2,3,4)
t(2,3,4) = 7 : t(0,0,0) = 1
PRINT t(2,3,4); t(0,0,0); t(1,1,1) '> 7 1 0
'--- string array with a length
DIM s$(2) LENGTH 4
s$(1) = "abcd"
PRINT s$(1) '>abcd
s$(2) = "abcde" '! String too long
'--- subscripts are rounded
DIM a(3) = (1,2,3,4)
PRINT a(1.5) '> 3
'--- over the top
DIM a(3)
a(4) = 1 '! Index out of bounds
'--- negative subscript
DIM a(3)
a(-1) = 1 '! Dimensions
'--- wrong number of subscripts
DIM a(3)
PRINT a(1,1) '! Array dimensions
'--- OPTION BASE 1
OPTION BASE 1
DIM a(2) = (5, 6)
PRINT a(1); a(2) '> 5 6
PRINT a(0) '! Dimensions
'--- BOUND
DIM a(5, 7)
PRINT BOUND(a(), 1); BOUND(a(), 2); BOUND(a(), 0) '> 5 7 0
'--- an array must be declared
b(3) = 1 '! B is not declared
'--- array too large
DIM a(10000, 10000) '! Not enough memory
'--- a scalar used as an array
a = 1
PRINT a(1) '! Array dimensions
'--- too many values
DIM a(1) = (1, 2, 3) '! Array size
'--- name too long
a123456789012345678901234567890123 = 1 '! Name too long
'--- a reserved word is no variable
THEN = 5 '! Invalid syntax
'--- the most negative subscript
OPTION BASE 1
DIM a(3)
PRINT a(&H8000000000000000) '! Dimensions
'--- six dimensions
DIM a(2,2,2,2,2,2)
a(2,1,2,1,2,1) = 5
PRINT a(2,1,2,1,2,1); a(1,2,1,2,1,2) '> 5 0
'--- seven dimensions
DIM a(2,2,2,2,2,2,2) '! Array dimensions
'--- a name of 32 characters
abcdefghijklmnopqrstuvwxyzabcdef = 5
PRINT ABCDEFGHIJKLMNOPQRSTUVWXYZABCDEF '> 5
'--- OPTION DEFAULT STRING
OPTION DEFAULT STRING
a = "x" : PRINT a '>x
'--- a CONST takes the name of a variable
DIM c = 1
CONST c = 2 '! C Global variable already declared
'--- an array without its subscripts
DIM a(3)
a = 5 '! Array dimensions
'--- EXPLICIT covers reading too
OPTION EXPLICIT
PRINT y '! Y is not declared
