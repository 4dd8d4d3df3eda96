'--- integers print with a leading blank or a minus sign
PRINT 5 '> 5
PRINT -5 '>-5
PRINT 0 '> 0
PRINT 1;2;-3 '> 1 2-3
'--- ten significant digits
PRINT 1/3 '> 0.3333333333
PRINT 10/3 '> 3.333333333
PRINT 100/3 '> 33.33333333
PRINT 2/3 '> 0.6666666667
'--- trailing zeros go
PRINT 2.50 '> 2.5
PRINT 5.0 '> 5
PRINT 0.1+0.2 '> 0.3
'--- scientific from a million and below 0.0001
PRINT 1000000.0 '> 1e+06
PRINT 1500000.0 '> 1.5e+06
PRINT 999999.5 '> 999999.5
PRINT 0.0001 '> 0.0001
PRINT 0.00005 '> 5e-05
PRINT -1.5E+10 '>-1.5e+10
PRINT 1e-300 '> 1e-300
'--- rounding to ten digits does not make it scientific
PRINT 999999.9999999 '> 1000000
'--- integers have all their digits
PRINT 1000000 '> 1000000
PRINT 9223372036854775807 '> 9223372036854775807
PRINT -9223372036854775807 '>-9223372036854775807
'--- literals without point or exponent are integers
PRINT 1000000 * 1000000 '> 1000000000000
PRINT 1.6E+4 '> 16000
PRINT 3e2 '> 300
PRINT .5 '> 0.5
'--- hexadecimal, octal, binary
PRINT &HFF '> 255
PRINT &hff '> 255
PRINT &O17 '> 15
PRINT &B1011 '> 11
PRINT &HFFFFFFFFFFFFFFFF '>-1
'--- integer too large for 64 bits is a float
PRINT 9223372036854775808 '> 9.223372037e+18
'--- a number too large
PRINT 1e999 '! Number too large
'--- integer arithmetic wraps
a% = 9223372036854775807
a% = a% + 1
PRINT a% '>-9223372036854775808
'--- assignment to an integer rounds half away from zero
a% = 2.5 : b% = -2.5 : c% = 2.4
PRINT a%; b%; c% '> 3-3 2
'--- a float too large for an integer
a% = 1e19 '! Number too large
'--- float overflow
PRINT 1e308 * 10 '! Overflow
'--- mixed arithmetic is float
a% = 3
PRINT a% * 1.5 '> 4.5
PRINT 7 + 0.0 '> 7
'--- division is always float
PRINT 6 / 3 '> 2
PRINT 7 / 2 '> 3.5
PRINT 3000000 / 2 '> 1.5e+06
