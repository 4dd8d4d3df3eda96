'--- power binds tighter than multiplication, and goes left to right
PRINT 2 * 3 ^ 2 '> 18
PRINT 2 ^ 3 ^ 2 '> 64
'--- the sign belongs to the value
PRINT -2 ^ 2 '> 4
PRINT 2 ^ -1 '> 0.5
PRINT 3 - -2 '> 5
PRINT 2 * -3 '>-6
'--- integer power stays an integer
PRINT 2 ^ 62 '> 4611686018427387904
PRINT 10 ^ 6 '> 1000000
'--- an integer power that does not fit is a float
PRINT 10 ^ 30 '> 1e+30
'--- multiplication before addition
PRINT 1 + 2 * 3 '> 7
PRINT (1 + 2) * 3 '> 9
PRINT 10 - 4 - 3 '> 3
PRINT 100 / 10 / 5 '> 2
'--- integer division truncates toward zero
PRINT 7 \ 2; -7 \ 2; 7 \ -2 '> 3-3-3
PRINT 7.5 \ 2 '> 4
'--- MOD has the sign of the left operand
PRINT 7 MOD 3; -7 MOD 3; 7 MOD -3 '> 1-1 1
PRINT 7.6 MOD 3 '> 2
'--- addition before shifts
PRINT 1 << 2 + 1 '> 8
PRINT 256 >> 4 '> 16
'--- shift right fills with zeros
PRINT -1 >> 60 '> 15
'--- shifts beyond the width
PRINT 1 << 64; 1 >> 64 '> 0 0
'--- comparisons give 1 and 0
PRINT 1 < 2; 2 < 1; 2 <= 2; 2 >= 3; 1 <> 2; 1 = 1 '> 1 0 1 0 1 1
PRINT 2 =< 2; 2 => 3 '> 1 0
'--- equality binds looser than less and greater
PRINT 1 = 2 < 3 '> 1
PRINT 5 = 2 < 3 '> 0
'--- AND OR XOR are bitwise and go left to right
PRINT 6 AND 3; 6 OR 3; 6 XOR 3 '> 2 7 5
PRINT 1 OR 1 AND 0 '> 0
'--- AND rounds floats
PRINT 2.5 AND 3 '> 3
'--- NOT is logical and binds to the next value
PRINT NOT 0; NOT 5 '> 1 0
a = 0 : b = 1
PRINT NOT a = b '> 1
'--- NOT takes 0.4 as true
PRINT NOT 0.4 '> 0
'--- INV is bitwise
PRINT INV 0; INV 5 '>-1-6
'--- divide by zero
PRINT 1 / 0 '! Divide by zero
'--- integer divide by zero
PRINT 1 \ 0 '! Divide by zero
'--- MOD by zero
PRINT 5 MOD 0 '! Divide by zero
'--- the most negative number divided by minus one does not crash
a% = -9223372036854775807 - 1
PRINT a% \ -1; a% MOD -1 '>-9223372036854775808 0
'--- strings join and compare bytewise
PRINT "ab" + "cd" '>abcd
PRINT "a" < "b"; "B" < "a"; "ab" = "ab"; "a" < "ab" '> 1 1 1 1
'--- string plus number
PRINT "a" + 1 '! Incompatible types in expression
'--- string minus string
PRINT "a" - "b" '! Invalid operator
'--- minus of a string
PRINT -"a" '! Expected a number
'--- string too long
a$ = SPACE$(200)
a$ = a$ + a$ '! String too long
'--- an expression that does not end
PRINT 1 + '! Invalid syntax
'--- an open parenthesis
PRINT (1 + 2 '! Invalid syntax
'--- nested parentheses within the limit
PRINT ((((((((((1)))))))))) '> 1
'--- nested too deep
PRINT ((((((((((((((((((((((((((((((((((((((((((1)))))))))))))))))))))))))))))))))))))))))) '! Expression too complex
'--- the most negative integer has no opposite
PRINT -&H8000000000000000; ABS(&H8000000000000000) '>-9223372036854775808-9223372036854775808
'--- no real root
PRINT (-8) ^ (1 / 3) '! Overflow
'--- zero to a negative power
PRINT 0 ^ -1 '! Divide by zero
'--- XOR, OR and AND are equal and go left to right
PRINT 1 OR 2 XOR 3 AND 1 '> 0
'--- a wrong type beside AND
PRINT "a" AND 1 '! Incompatible types in expression
'--- comparing floats of all signs
PRINT 1.5 < 2.5; -1.5 < -2.5; -1.5 < 2.5; 1.5 < -2.5 '> 1 0 1 0
PRINT 1.5 > 2.5; -1.5 > -2.5; -1.5 > 2.5; 1.5 > -2.5 '> 0 1 0 1
PRINT -0.0 = 0.0; -0.0 < 0.0; -0.0 >= 0.0; 0.0 > -0.0 '> 1 0 1 0
PRINT -1e-300 < 0.0; 0.0 < 1e-300; -1e300 < -1e-300; 1e300 > 1e-300 '> 1 1 1 1
PRINT -2.5 = -2.5; -2.5 <> -2.5; 0.1 + 0.2 > 0.3; 1 = 1.0 '> 1 0 1 1
'--- a FOR over floats ends where it should, both ways and through zero
FOR x = -0.5 TO 0.5 STEP 0.25: PRINT x; : NEXT: PRINT "!" '>-0.5-0.25 0 0.25 0.5!
FOR x = 0.5 TO -0.5 STEP -0.25: PRINT x; : NEXT: PRINT "!" '> 0.5 0.25 0-0.25-0.5!
FOR x = -3.0 TO -1.0: PRINT x; : NEXT: PRINT "!" '>-3-2-1!
FOR x = -1.0 TO -3.0 STEP -1: PRINT x; : NEXT: PRINT "!" '>-1-2-3!
