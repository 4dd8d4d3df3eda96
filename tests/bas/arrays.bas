'--- ERASE an array and declare it anew
DIM a(3) = (1, 2, 3, 4)
ERASE a()
DIM a(1, 1)
PRINT a(1, 1); BOUND(a(), 2) '> 0 1
'--- ERASE gives the memory back
FOR i = 1 TO 500
  DIM big(1000), t$(9)
  big(1000) = i
  ERASE big, t$
NEXT
PRINT "ok" '>ok
'--- ERASE in any order leaves no holes that stay
FOR i = 1 TO 200
  DIM a(300), b(200), c(400)
  ERASE b() : DIM b(150)
  a(300) = 1 : b(150) = 2 : c(400) = 3
  ERASE a(), c(), b()
NEXT
DIM all(9000)
PRINT all(9000) '> 0
'--- ERASE a scalar and a string
a = 5 : b$ = "x"
ERASE a, b$
PRINT a; "[" + b$ + "]" '> 0[]
'--- ERASE under OPTION EXPLICIT
OPTION EXPLICIT
DIM a = 5
ERASE a
PRINT a '! A is not declared
'--- ERASE what is not there
ERASE a '! A is not declared
'--- ERASE a constant and name it anew
CONST c = 1
ERASE c
CONST c = 2 : PRINT c '> 2
'--- ERASE an array that a routine further out still names
DIM a(3)
s a(2)
SUB s(x)
  ERASE a '! Something still refers to it
END SUB
'--- ERASE inside the SUB that got the array
DIM a(3)
s a()
SUB s(x())
  ERASE a() '! Something still refers to it
END SUB
'--- REDIM
DIM a(3) = (1, 2, 3, 4)
REDIM a(5)
PRINT a(0); a(5); BOUND(a()) '> 0 0 5
REDIM a(1, 2)
PRINT BOUND(a(), 2) '> 2
'--- REDIM PRESERVE
DIM a(3) = (1, 2, 3, 4)
REDIM PRESERVE a(5)
PRINT a(0); a(3); a(4) '> 1 4 0
REDIM PRESERVE a(1)
PRINT a(0); a(1); BOUND(a()) '> 1 2 1
'--- REDIM PRESERVE in two dimensions
DIM m(1, 2) = (1, 2, 3, 4, 5, 6)
REDIM PRESERVE m(2, 1)
PRINT m(0, 0); m(1, 0); m(2, 0); m(0, 1); m(1, 1); m(2, 1) '> 1 2 0 3 4 0
'--- REDIM PRESERVE in three dimensions
DIM INTEGER m(2, 3, 4)
FOR i = 0 TO 2 : FOR j = 0 TO 3 : FOR k = 0 TO 4
  m(i, j, k) = i * 100 + j * 10 + k
NEXT : NEXT : NEXT
REDIM PRESERVE m(3, 2, 5)
PRINT m(2, 2, 4); m(1, 0, 3); m(0, 2, 0); m(3, 2, 5) '> 224 103 20 0
'--- REDIM of strings
DIM t$(2) LENGTH 8 = ("a", "b", "c")
REDIM PRESERVE t$(4)
t$(4) = "12345678"
PRINT t$(0); t$(2); t$(4) '>ac12345678
t$(3) = "123456789" '! String too long
'--- REDIM with another length
DIM t$(2) LENGTH 8
REDIM t$(2) LENGTH 20
t$(1) = "12345678901" : PRINT t$(1) '>12345678901
'--- REDIM PRESERVE with another length
DIM t$(2) LENGTH 8
REDIM PRESERVE t$(2) LENGTH 20 '! Array dimensions
'--- REDIM of another type
DIM a(3)
REDIM a%(3) '! A Different type already declared
'--- REDIM of what is no array
a = 5
REDIM a(3) '! Array dimensions
'--- REDIM of what is not there
REDIM a(3) '! A is not declared
'--- REDIM again and again
DIM a(1)
FOR i = 1 TO 300
  REDIM PRESERVE a(i + 5)
  a(i + 5) = i
NEXT
PRINT a(305); a(100) '> 300 95
'--- REDIM to what does not fit keeps the array
DIM a(3) = (1, 2, 3, 4)
ON ERROR SKIP
REDIM a(100000)
PRINT MM.ERRMSG$; a(3) '>Not enough memory 4
'--- REDIM of an array by reference
DIM a(2) = (1, 2, 3)
grow a()
PRINT a(2); a(9) '> 3 7
SUB grow(x())
  REDIM PRESERVE x(9)
  x(9) = 7
END SUB
'--- REDIM of a LOCAL
s '> 2 0 6
SUB s
  LOCAL a(3) = (1, 2, 3, 4)
  REDIM PRESERVE a(6)
  PRINT a(1); a(6); BOUND(a())
END SUB
'--- REDIM of the caller's LOCAL
s
SUB s
  LOCAL a(3)
  t a()
END SUB
SUB t(x())
  REDIM x(9) '! Only the routine that declared an array can change its size
END SUB
'--- REDIM of a STATIC
s : s '> 4 8
PRINT
SUB s
  STATIC a(3)
  REDIM PRESERVE a(BOUND(a()) * 2)
  a(0) = a(0) + 4 : PRINT a(0);
END SUB
'--- REDIM while an element is on its way
DIM a(3)
s a(1)
SUB s(x)
  REDIM a(9) '! Something still refers to it
END SUB
'--- READ a whole array
DIM a(2), b$(1)
READ a(), b$(), c
PRINT a(0); a(2); b$(1); c '> 1 3y 9
DATA 1, 2, 3, "x", y, 9
'--- READ SAVE and RESTORE
READ a
READ SAVE
READ b, c
READ RESTORE
READ d
PRINT a; b; c; d '> 1 2 3 2
DATA 1, 2, 3
'--- READ RESTORE without SAVE
READ RESTORE '! READ RESTORE without READ SAVE
'--- CAT
a$ = "ab"
CAT a$, "cd" : CAT a$, a$
PRINT a$ '>abcdabcd
'--- CAT beyond 255
a$ = SPACE$(200)
CAT a$, a$ '! String too long
'--- CAT of a number
CAT a, "x" '! Expected a string
'--- CAT to an element
DIM t$(2) LENGTH 5
CAT t$(1), "ab" : CAT t$(1), "cd"
PRINT t$(1) '>abcd
'--- SORT numbers
DIM a(4) = (5, -3, 9.5, 1, 7)
SORT a()
PRINT a(0); a(1); a(2); a(3); a(4) '>-3 1 5 7 9.5
SORT a(),, 1
PRINT a(0); a(4) '> 9.5-3
'--- SORT integers beyond the precision of a float
DIM INTEGER a(2) = (9007199254740993, 9007199254740992, 9007199254740994)
SORT a()
PRINT a(0); a(1); a(2) '> 9007199254740992 9007199254740993 9007199254740994
'--- SORT strings
DIM t$(4) LENGTH 8 = ("pear", "Fig", "", "apple", "fig")
SORT t$()
PRINT t$(0); "|"; t$(1); "|"; t$(2); "|"; t$(4) '>|Fig|apple|pear
SORT t$(),, 2
PRINT t$(1); "|"; UCASE$(t$(2)); "|"; UCASE$(t$(3)) '>apple|FIG|FIG
SORT t$(),, 4
PRINT t$(0); "|"; t$(3); "|"; t$(4) + "|" '>Fig|pear||
'--- SORT with an index
DIM a(3) = (30, 10, 40, 20), INDEX%(3)
SORT a(), index%()
PRINT index%(0); index%(1); index%(2); index%(3) '> 1 3 0 2
'--- SORT a part
DIM a(5) = (9, 8, 7, 6, 5, 4)
SORT a(),,, 2, 3
PRINT a(0); a(1); a(2); a(3); a(4); a(5) '> 9 8 5 6 7 4
SORT a(),,, 4
PRINT a(3); a(4); a(5) '> 6 4 7
'--- SORT under OPTION BASE 1
OPTION BASE 1
DIM a(3) = (3, 1, 2), i%(3)
SORT a(), i%()
PRINT a(1); a(3); i%(1); i%(3) '> 1 3 2 1
'--- SORT two thousand numbers
DIM a(1999)
FOR i = 0 TO 1999 : a(i) = (i * 7919) MOD 2003 : NEXT
SORT a()
FOR i = 1 TO 1999 : IF a(i) < a(i - 1) THEN bad = bad + 1
NEXT
PRINT bad; a(0); a(1999) '> 0 0 2002
'--- SORT with an index of another size
DIM a(3), i%(2)
SORT a(), i%() '! Array size
'--- SORT with an index of floats
DIM a(3), i(3)
SORT a(), i() '! Incompatible type: argument 2
'--- SORT from a subscript that is not there
DIM a(3)
SORT a(),,, 4 '! start: 4 is invalid (valid is 0 to 3)
'--- SORT of a table
DIM a(3, 3)
SORT a() '! Array dimensions
'--- SORT of a scalar
a = 5
SORT a() '! Array dimensions
'--- MATH of an array
DIM a(4) = (5, 3, 9, 1, 7)
PRINT MATH(SUM a()); MATH(MEAN a()); MATH(SD a()); MATH(MEDIAN a()) '> 25 5 2.828427125 5
PRINT MATH(MAX a()); MATH(MIN a()) '> 9 1
PRINT a(0) '> 5
'--- MATH MAX and MIN say where
DIM a(4) = (5, 3, 9, 1, 7)
x = MATH(MAX a(), where%) : PRINT where%; '> 2 3
x = MATH(MIN a(), where%) : PRINT where%
'--- MATH MEDIAN of an even number
DIM INTEGER a(3) = (1, 10, 2, 4)
PRINT MATH(MEDIAN a()); MATH(SUM a()) '> 3 17
'--- MATH SUM of integers is exact and wraps
DIM INTEGER a(1) = (9007199254740993, 0), b(1) = (9223372036854775807, 1)
PRINT MATH(SUM a()); MATH(SUM b()) '> 9007199254740993-9223372036854775808
'--- MATH SET, SCALE and ADD
DIM a(2), b(2)
MATH SET 2, a()
MATH SCALE a(), 1.5, b()
MATH ADD b(), 1, b()
PRINT a(0); a(2); b(0); b(2) '> 2 2 4 4
'--- MATH into integers rounds
DIM a(1) = (0.5, 1.4), n%(1)
MATH SCALE a(), 1, n%()
PRINT n%(0); n%(1) '> 1 1
'--- MATH INTERPOLATE
DIM a(1) = (0, 10), b(1) = (10, 20), c(1)
MATH INTERPOLATE a(), b(), 0.25, c()
PRINT c(0); c(1) '> 2.5 12.5
'--- MATH of arrays of different sizes
DIM a(1), b(2)
MATH SCALE a(), 2, b() '! Array size
'--- MATH of strings
DIM t$(2)
PRINT MATH(SUM t$()) '! Expected a number
'--- MATH functions
PRINT MATH(LOG10 1000); MATH(SINH 1); MATH(COSH 1); MATH(TANH 1); MATH(POWER 2, 10) '> 3 1.175201194 1.543080635 0.761594156 1024
PRINT MATH(ATAN3 -1, 0) '> 4.71238898
'--- MATH without a word of its own
PRINT MATH(NOTHING 1) '! Unknown MATH subcommand
'--- MATH statement without a word of its own
MATH NOTHING 1 '! Unknown MATH subcommand
'--- checksums
PRINT HEX$(MATH(CRC8 "123456789")); " "; HEX$(MATH(CRC16 "123456789")) '>F4 31C3
PRINT HEX$(MATH(CRC32 "123456789",, &H04C11DB7, &HFFFFFFFF, &HFFFFFFFF, 1, 1)) '>CBF43926
DIM b%(8) = (49, 50, 51, 52, 53, 54, 55, 56, 57)
PRINT HEX$(MATH(CRC16 b%(), 9, &H8005, &HFFFF, 0, 1, 1)) '>4B37
'--- numbers as bytes
PRINT LEN(BIN2STR$(INT32, -2)); ASC(BIN2STR$(INT32, -2)); STR2BIN(INT32, BIN2STR$(INT32, -2)) '> 4 254-2
PRINT STR2BIN(UINT16, "AB"); STR2BIN(UINT16, "AB", BIG); STR2BIN(INT8, CHR$(200)); STR2BIN(UINT8, CHR$(200)) '> 16961 16706-56 200
PRINT STR2BIN(DOUBLE, BIN2STR$(DOUBLE, PI, BIG), BIG); STR2BIN(SINGLE, BIN2STR$(SINGLE, -1.5)) '> 3.141592654-1.5
PRINT STR2BIN(INT64, BIN2STR$(UINT64, -1)) '>-1
'--- a number that does not fit its bytes
PRINT BIN2STR$(INT8, 200) '! 200 is invalid (valid is -128 to 127)
'--- too few bytes
PRINT STR2BIN(INT32, "abc") '! The text must have 4 bytes
'--- bytes of an unknown kind
PRINT STR2BIN(INT31, "abcd") '! type is invalid (valid is INT8, UINT8 ... UINT64, SINGLE, DOUBLE)
