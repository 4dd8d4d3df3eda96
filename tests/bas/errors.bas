'--- ON ERROR SKIP goes over one error
ON ERROR SKIP
PRINT 1 / 0
PRINT MM.ERRNO; " "; MM.ERRMSG$ '> 16 Divide by zero
PRINT 1 / 0 '! Divide by zero
'--- SKIP is used up by a statement without an error
ON ERROR SKIP
PRINT 1 '> 1
PRINT 1 / 0 '! Divide by zero
'--- SKIP n
ON ERROR SKIP 3
a = 1 / 0
a = 1 / 0
a = 1 / 0
PRINT "there" '>there
a = 1 / 0 '! Divide by zero
'--- SKIP clears the last error
ON ERROR SKIP
a = 1 / 0
ON ERROR SKIP
PRINT MM.ERRNO; "[" + MM.ERRMSG$ + "]" '> 0[]
'--- IGNORE goes over all errors, in SUBs too
ON ERROR IGNORE
a = 1 / 0
s
PRINT MM.ERRMSG$
END
SUB s
  a = SQR(-1)
  PRINT "after"
END SUB
'>after
'>Negative argument
'--- ABORT again
ON ERROR IGNORE
a = 1 / 0
ON ERROR ABORT
a = 1 / 0 '! Divide by zero
'--- CLEAR
ON ERROR IGNORE
a = 1 / 0
ON ERROR CLEAR
PRINT MM.ERRNO '> 0
'--- an error in a FUNCTION under IGNORE
ON ERROR IGNORE
PRINT 5 + f(1) '> 7
FUNCTION f(x)
  f = 1 / 0
  f = 2
END FUNCTION
'--- an unknown command is skipped too
ON ERROR SKIP
frobnicate
PRINT MM.ERRMSG$ '>Unknown command
'--- a failing single-line IF is skipped as a whole
ON ERROR SKIP
IF 1 / 0 THEN PRINT "then" ELSE PRINT "else"
PRINT "next" '>next
'--- a failing part of a line goes on behind it
ON ERROR SKIP
a = 1 / 0 : PRINT "rest" '>rest
'--- no error yet
PRINT MM.ERRNO; "[" + MM.ERRMSG$ + "]" '> 0[]
'--- ERROR raises one
ERROR "door open" '! door open
'--- the temporary strings of a long loop do not use up memory
FOR i = 1 TO 3000
  a$ = LEFT$("abc" + STR$(i) + SPACE$(100), 50) + RIGHT$("xyz", 2)
NEXT
PRINT LEN(a$) '> 52
'--- thousands of errors do not use up memory
ON ERROR IGNORE
FOR i = 1 TO 3000
  a$ = STRING$(200, "x") + STRING$(200, "y")
NEXT
PRINT MM.ERRMSG$ '>String too long
'--- arrays that do not fit are an error
DIM a(1000), b(1000), c(1000)
DIM d(20000) '! Not enough memory
'--- unknown subcommands and rubbish
@#! '! Unknown command
'--- a line that is too long
PRINT "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa" '! Line too long (more than 255 characters)
'--- PAUSE with a negative time
PAUSE -1 '! Number out of bounds
'--- PAUSE lets time pass, TIMER tells
TIMER = 0
PAUSE 250.5
IF TIMER >= 250.5 AND TIMER < 252 THEN PRINT "250 ms" '>250 ms
'--- TIMER can be set
TIMER = 100000
IF TIMER >= 100000 AND TIMER < 100100 THEN PRINT "set" '>set
'--- RUN inside a program starts it again
IF TIMER > 1000 THEN END
PRINT "once" '>once
PAUSE 2000
RUN '>@@@
'--- NEW inside a program
NEW '! Only at the prompt
'--- OPTION BASE out of range
OPTION BASE 2 '! 2 is invalid (valid is 0 to 1)
'--- a FUNCTION without its end, under IGNORE
ON ERROR IGNORE
PRINT 1 '> 1
a = f(1)
PRINT 2; MM.ERRMSG$ '> 2Cannot find a matching END SUB or END FUNCTION
FUNCTION f(x)
  PRINT "never"
'--- ON ERROR ABORT keeps the last error, CLEAR forgets it
ON ERROR IGNORE
a = 1 / 0
ON ERROR ABORT
PRINT MM.ERRMSG$ '>Divide by zero
ON ERROR CLEAR
PRINT MM.ERRNO; "[" + MM.ERRMSG$ + "]" '> 0[]
'--- MM.ERRNO of files
ON ERROR IGNORE
OPEN "nowhere.txt" FOR INPUT AS #1
PRINT MM.ERRNO '> 4
KILL "nowhere.txt"
PRINT MM.ERRNO '> 4
MKDIR "errno"
MKDIR "errno"
PRINT MM.ERRNO '> 8
RMDIR "errno"
CHDIR "nowhere"
PRINT MM.ERRNO > 0 '> 1
a = 1 / 0
PRINT MM.ERRNO '> 16
'--- IGNORE keeps the last error until the next
ON ERROR IGNORE
a = 1 / 0
a = 1
PRINT MM.ERRMSG$ '>Divide by zero
a = SQR(-1)
PRINT MM.ERRMSG$ '>Negative argument
'--- SKIP counts the statements of a SUB, too
ON ERROR SKIP 3
s
PRINT "out" '>out
SUB s
  a = 1
  a = 1 / 0
END SUB
