'--- integer and integer
PRINT 7 + 2; 7 - 2; 7 * 2; 7 / 2; 7 \ 2; 7 MOD 2; 7 ^ 2 '> 9 5 14 3.5 3 1 49
PRINT 7 << 2; 7 >> 1; 7 AND 2; 7 OR 8; 7 XOR 2 '> 28 3 2 15 5
PRINT 7 = 2; 7 <> 2; 7 < 2; 7 > 2; 7 <= 7; 7 >= 8 '> 0 1 0 1 1 0
'--- integer and float
PRINT 7 + 2.5; 7 - 2.5; 7 * 2.5; 7 / 2.5; 7 \ 2.5; 7 MOD 2.5; 4 ^ 0.5 '> 9.5 4.5 17.5 2.8 2 1 2
PRINT 7 << 1.5; 7 >> 0.5; 7 AND 2.5; 7 OR 7.5; 7 XOR 2.5 '> 28 3 3 15 4
PRINT 7 = 7.0; 7 <> 7.5; 7 < 7.5; 7 > 6.5; 7 <= 6.5; 7 >= 7.0 '> 1 1 1 1 0 1
'--- float and integer
PRINT 2.5 + 7; 2.5 - 7; 2.5 * 7; 3.5 / 7; 7.5 \ 2; 7.5 MOD 5; 2.5 ^ 2 '> 9.5-4.5 17.5 0.5 4 3 6.25
PRINT 2.5 << 1; 2.5 >> 1; 2.5 AND 1; 2.5 OR 4; 2.5 XOR 1 '> 6 1 1 7 2
PRINT 2.5 = 2; 2.5 <> 2; 2.5 < 3; 2.5 > 2; 2.5 <= 2; 2.5 >= 3 '> 0 1 1 1 0 0
'--- float and float
PRINT 2.5 + 0.5; 2.5 - 0.5; 2.5 * 0.5; 2.5 / 0.5; 7.5 \ 2.5; 7.5 MOD 2.5; 6.25 ^ 0.5 '> 3 2 1.25 5 2 2 2.5
PRINT 1.5 << 1.5; 8.5 >> 1.5; 3.5 AND 4.5; 3.5 OR 0.4; 3.5 XOR 0.5 '> 8 2 4 4 5
PRINT 2.5 = 2.5; 2.5 <> 2.5; 2.5 < 2.5; 2.5 > 2.5; 2.5 <= 2.5; 2.5 >= 2.5 '> 1 0 0 0 1 1
'--- sums of integers stay integers, exactly
PRINT 9007199254740993 + 0; 9007199254740993 * 1; 9007199254740993 - 0 '> 9007199254740993 9007199254740993 9007199254740993
'--- with a float the last digits go
PRINT (9007199254740993 + 0.0) = 9007199254740992 '> 1
'--- division of integers is a float even if it comes out even
PRINT 6000000 / 2; 6000000 \ 2 '> 3e+06 3000000
'--- string and string
PRINT "a" + "b"; "a" = "a"; "a" <> "a"; "a" < "b"; "a" > "b"; "a" <= "a"; "b" >= "a" '>ab 1 0 1 0 1 1
'--- string times string
PRINT "a" * "b" '! Invalid operator
'--- string divided by string
PRINT "a" / "b" '! Invalid operator
'--- string AND string
PRINT "a" AND "b" '! Invalid operator
'--- string MOD string
PRINT "a" MOD "b" '! Invalid operator
'--- number plus string
PRINT 1 + "a" '! Incompatible types in expression
'--- number compared with string
PRINT 1 = "1" '! Incompatible types in expression
'--- float and string
PRINT 1.5 * "a" '! Incompatible types in expression
'--- NOT of a string
PRINT NOT "a" '! Expected a number
'--- INV of a float rounds
PRINT INV 1.5; INV -1 '>-3 0
'--- NOT and minus of each type
PRINT NOT 3; NOT 0.0; -(2.5); -(3); +4 '> 0 1-2.5-3 4
'--- signs in a row
PRINT - - 3; NOT NOT 5; 2 - - - 3; -+2 '> 3 1-1-2
'--- a shift by a negative count
PRINT 1 << -1; 8 >> -1 '> 0 0
'--- a product that wraps
PRINT 4611686018427387904 * 2; 9223372036854775807 * 9223372036854775807 '>-9223372036854775808 1
'--- a difference that wraps
PRINT -9223372036854775807 - 2 '> 9223372036854775807
'--- an integer for AND too large
PRINT 1e19 AND 1 '! Number too large
'--- integer division of a float too large
PRINT 1e19 \ 2 '! Number too large
'--- a power of a negative number
PRINT (-2) ^ 3; (-2) ^ 0; 0 ^ 0; (-2.0) ^ 2; 2 ^ 0.5 > 1.414 '>-8 1 1 4 1
'--- a power that overflows
PRINT 10.0 ^ 400 '! Overflow
'--- MOD of negative floats rounds first
PRINT -7.5 MOD 3; 7.5 MOD -3; -7 \ 2; -7.5 \ 2 '>-2 2-3-4
'--- division by a zero that is a float
PRINT 1 / 0.0 '! Divide by zero
'--- integer division by what rounds to zero
PRINT 5 \ 0.4 '! Divide by zero
'--- MOD by what rounds to zero
PRINT 5 MOD 0.4 '! Divide by zero
'--- precedence of everything at once
PRINT 2 + 3 * 4 ^ 2 \ 5 - 1 << 1 > 3 = 1 AND 3 '> 1
PRINT 1 + 2 << 1 + 1 '> 12
PRINT 5 > 3 = 2 > 1 '> 1
PRINT NOT 1 + 1 '> 1
PRINT -3 ^ 2 + -3 MOD 2 '> 8
PRINT 100 / 5 * 2; 100 \ 7 MOD 5; 2 ^ 2 ^ 3 '> 40 4 64
'--- comparisons go left to right
PRINT 3 > 2 > 1; 1 < 2 < 3; 5 = 5 = 1 '> 0 1 1
'--- both sides of AND and OR are computed
PRINT 0 AND f(); 1 OR f(); calls '> 0 1 2
FUNCTION f()
  calls = calls + 1 : f = 0
END FUNCTION
'--- assignment of each type to each
a% = 2.5 : b! = 7 : c! = a% : d% = -2.5
PRINT a%; b! / 2; c!; d% '> 3 3.5 3-3
'--- a string for an integer
a% = "5" '! Expected a number
'--- a number for a string element
DIM t$(2)
t$(1) = 5 '! Expected a string
'--- IF of a string
IF "a" THEN PRINT 1 '! Expected a number
'--- FOR of a string
FOR a$ = 1 TO 2 '! Expected a string
NEXT
'--- WHILE of a string
DO WHILE "x" '! Expected a number
LOOP
'--- a string as a subscript
DIM a(3)
PRINT a("1") '! Expected a number
'--- SELECT CASE of number and string
SELECT CASE 5
  CASE "5" : PRINT "no" '! Incompatible types in expression
END SELECT
'--- MIN and MAX of mixed types
PRINT MIN(3, 2.5, 7); MAX(3, 7.5) '> 2.5 7.5
'--- ABS SGN INT FIX CINT of both types
PRINT ABS(-3); ABS(-3.5); SGN(-0.1); INT(-3.5); FIX(-3.5); CINT(-3.5); INT(7) '> 3 3.5-1-4-3-4 7
'--- INT of what is too large
PRINT INT(1e20) '! Number too large
'--- comparing integers beyond the precision of floats
PRINT 9007199254740993 = 9007199254740992; 9007199254740993 > 9007199254740992 '> 0 1
'--- comparing strings of different lengths
PRINT "abc" > "ab"; "" < "a"; "" = ""; "Z" < "a" '> 1 1 1 1
'--- INC of each type
a% = 5 : INC a%, 1.5 : b = 1 : INC b, -0.5 : c% = 9223372036854775807 : INC c%
PRINT a%; b; c% '> 7 0.5-9223372036854775808
'--- INC of a string without an amount
a$ = "x"
INC a$ '! Incompatible types in expression
'--- INC of an element
DIM a(2)
INC a(1), 4 : INC a(1)
PRINT a(1) '> 5
'--- INC of a constant
CONST c = 1
INC c '! Cannot change a constant
