'--- single-line IF
IF 1 THEN PRINT "yes" ELSE PRINT "no" '>yes
IF 0 THEN PRINT "yes" ELSE PRINT "no" '>no
'--- 0.4 is true
IF 0.4 THEN PRINT "true" '>true
'--- THEN a:b without ELSE makes both conditional
IF 0 THEN PRINT "a" : PRINT "b"
PRINT "end" '>end
'--- behind ELSE only the first statement is conditional
IF 1 THEN PRINT "a" ELSE PRINT "b" : PRINT "c" '>a
'>c
'--- THEN a:b ELSE c
IF 1 THEN PRINT "a" : PRINT "b" ELSE PRINT "c" '>a
'>b
IF 0 THEN PRINT "a" : PRINT "b" ELSE PRINT "c" '>c
'--- nested single-line IF
IF 1 THEN IF 0 THEN PRINT "a" ELSE PRINT "b" '>b
'--- THEN with a line number
IF 1 THEN 30
PRINT "no"
30 PRINT "there" '>there
'--- IF GOTO
IF 1 GOTO done
PRINT "no"
done: PRINT "done" '>done
'--- multi-line IF
a = 2
IF a = 1 THEN
  PRINT "one"
ELSEIF a = 2 THEN
  PRINT "two" '>two
ELSE
  PRINT "many"
ENDIF
'--- ELSE IF and END IF in two words
a = 3
IF a = 1 THEN
  PRINT "one"
ELSE IF a = 2 THEN
  PRINT "two"
ELSE
  PRINT "many" '>many
END IF
'--- nested IF
FOR a = 0 TO 1
  IF a THEN
    IF a = 1 THEN
      PRINT "inner" '>inner
    ENDIF
  ENDIF
NEXT
'--- IF without ENDIF
PRINT "a" '>a
IF 1 THEN '! Cannot find a matching ENDIF
PRINT "b"
'--- ENDIF alone
ENDIF '! ENDIF without a matching IF
'--- FOR
FOR i = 1 TO 3 : PRINT i; : NEXT : PRINT '> 1 2 3
PRINT i '> 4
'--- FOR with STEP
FOR i = 10 TO 1 STEP -4 : PRINT i; : NEXT i : PRINT '> 10 6 2
'--- FOR that does not run
FOR i = 5 TO 1 : PRINT "no" : NEXT
PRINT i '> 5
'--- float STEP
FOR x = 0 TO 1 STEP 0.25 : PRINT x; : NEXT : PRINT '> 0 0.25 0.5 0.75 1
'--- an integer variable rounds STEP
FOR i% = 0 TO 6 STEP 1.5 : PRINT i%; : NEXT : PRINT '> 0 2 4 6
'--- limit and step are fixed at the start
n = 3
FOR i = 1 TO n : n = 10 : PRINT i; : NEXT : PRINT '> 1 2 3
'--- nested FOR and NEXT with two names
FOR i = 1 TO 2 : FOR j = 1 TO 2 : PRINT i * 10 + j; : NEXT j, i : PRINT '> 11 12 21 22
'--- EXIT FOR and CONTINUE FOR
FOR i = 1 TO 9
  IF i = 2 THEN CONTINUE FOR
  IF i = 5 THEN EXIT FOR
  PRINT i;
NEXT
PRINT '> 1 3 4
'--- leaving a loop by GOTO again and again
FOR k = 1 TO 1000
  FOR i = 1 TO 3
    GOTO out
  NEXT
  out:
NEXT
PRINT "ok" '>ok
'--- NEXT alone
NEXT '! Cannot find a matching FOR
'--- NEXT of another loop
FOR i = 1 TO 2 '! Cannot find a matching NEXT
NEXT j
'--- FOR without NEXT
PRINT 1 '> 1
FOR i = 1 TO 2 '! Cannot find a matching NEXT
'--- the largest integer as limit
FOR i% = 9223372036854775806 TO 9223372036854775807 : PRINT i% : NEXT
'> 9223372036854775806
'> 9223372036854775807
'--- DO WHILE
DO WHILE a < 3 : a = a + 1 : LOOP
PRINT a '> 3
'--- DO UNTIL
DO UNTIL a = 4 : a = a + 1 : LOOP
PRINT a '> 4
'--- LOOP UNTIL
DO : a = a + 1 : LOOP UNTIL a >= 2
PRINT a '> 2
'--- LOOP WHILE
DO : a = a + 1 : LOOP WHILE a < 5
PRINT a '> 5
'--- EXIT DO and CONTINUE DO
DO
  a = a + 1
  IF a = 2 THEN CONTINUE DO
  IF a = 4 THEN EXIT DO
  PRINT a;
LOOP
PRINT '> 1 3
'--- WHILE and WEND
WHILE a < 2
  a = a + 1
WEND
PRINT a '> 2
'--- DO without LOOP
PRINT 1 '> 1
DO '! Cannot find a matching LOOP
'--- SELECT CASE without its end
SELECT CASE 5 '! Cannot find a matching END SELECT
CASE 5
  PRINT "no"
'--- LOOP alone
LOOP '! LOOP without a matching DO
'--- EXIT FOR outside
EXIT FOR '! No FOR loop is in effect
'--- EXIT DO outside
EXIT DO '! No DO loop is in effect
'--- SELECT CASE with values, ranges and IS
FOR i = 1 TO 6
SELECT CASE i
  CASE 1, 3: PRINT "a"; 
  CASE 4 TO 5: PRINT "b";
  CASE IS > 5: PRINT "c";
  CASE ELSE: PRINT "d";
END SELECT
NEXT
PRINT '>adabbc
'--- SELECT CASE of strings
a$ = "stop"
SELECT CASE a$
CASE "go"
  PRINT 1
CASE "stop"
  PRINT 2 '> 2
END SELECT
'--- SELECT CASE without a match
SELECT CASE 9
CASE 1: PRINT "no"
END SELECT
PRINT "end" '>end
'--- CASE alone
CASE 1 '! CASE without a matching SELECT CASE
'--- GOTO a label and back
GOTO b
a: PRINT "a"
END
'>b
'>a
b: PRINT "b"
GOTO a
'--- GOTO a line number
GOTO 200
100 PRINT "no"
200 PRINT "yes" '>yes
'--- GOTO a missing label
GOTO nowhere '! Cannot find label
'--- GOTO a missing line number
GOTO 99 '! Line number
'--- GOSUB
GOSUB part
PRINT "back"
END
'>in
'>back
part:
PRINT "in"
RETURN
'--- RETURN alone
RETURN '! Nothing to return to
'--- GOSUB that never returns
a: GOSUB a '! Too many nested calls
'--- ON n GOTO and GOSUB
ON 2 GOTO one, two
one: PRINT "one"
two: PRINT "two" '>two
ON 1.5 GOSUB s1, s2
ON 3 GOSUB s1, s2
END
'>s2
s1: PRINT "s1" : RETURN
s2: PRINT "s2" : RETURN
'--- a label twice
a: PRINT 1 '> 1
a: PRINT 2 '! Duplicate label A
'--- a statement that does not compile is an error only when it is reached
IF 0 THEN
  FOR : NEXT ( 5
ENDIF
PRINT "fine" '>fine
'--- unknown command
PRINT 1 '> 1
frobnicate 5 '! Unknown command
'--- garbage behind a statement
PRINT 1 2 '> 1 2
END 5 '! Invalid syntax
'--- comments
PRINT 1 ' a comment : PRINT 2
REM PRINT 3
'> 1
'--- block comments
/* PRINT 1
PRINT 2 */
PRINT 3 '> 3
'--- END ends
PRINT 1 '> 1
END
PRINT 2
'--- blocks nested too deep do not crash
FOR a=1 TO 1:FOR b=1 TO 1:FOR c=1 TO 1:FOR d=1 TO 1:FOR e=1 TO 1:FOR f=1 TO 1:FOR g=1 TO 1
FOR h=1 TO 1:FOR i=1 TO 1:FOR j=1 TO 1:FOR k=1 TO 1:FOR l=1 TO 1:FOR m=1 TO 1:FOR n=1 TO 1
FOR o=1 TO 1:FOR p=1 TO 1:FOR q=1 TO 1:FOR r=1 TO 1:FOR s=1 TO 1:FOR t=1 TO 1
PRINT "20 deep" '>20 deep
NEXT t,s,r,q,p,o,n,m,l,k,j,i,h,g,f,e,d,c,b,a
'--- SELECT CASE of a text range
FOR i = 1 TO 400
  SELECT CASE CHOICE(i MOD 2, "m", "z")
    CASE "a" TO "n"
      n = n + 1
  END SELECT
  i = i + 1
NEXT
PRINT n '> 200
'--- ON n beyond the list goes on
ON 0 GOTO a
ON 2 GOSUB a
PRINT "on" '>on
END
a: PRINT "a"
'--- EXIT FUNCTION outside
EXIT FUNCTION '! Nothing to return to
'--- END SUB alone
END SUB '! Nothing to return to
'--- ELSE alone
ELSE '! ELSE without a matching IF
