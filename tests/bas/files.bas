'--- a file is written and read back by lines
OPEN "t.txt" FOR OUTPUT AS #1
PRINT #1, "one"
PRINT #1, 2; -3, "x"; 1.5
PRINT #1
PRINT #1, "open";
PRINT #1, " end"
CLOSE #1
OPEN "t.txt" FOR INPUT AS #1
DO WHILE NOT EOF(#1)
LINE INPUT #1, a$
PRINT "["; a$; "]" '>[one]
LOOP '>[ 2-3	x 1.5]
CLOSE #1 '>[]
KILL "t.txt" '>[open end]
'--- lines end with CR and LF when written
OPEN "t.txt" FOR OUTPUT AS #1
PRINT #1, "ab"
CLOSE #1
OPEN "t.txt" FOR INPUT AS #1
a$ = INPUT$(10, #1)
PRINT LEN(a$); ASC(MID$(a$, 3, 1)); ASC(MID$(a$, 4, 1)) '> 4 13 10
CLOSE
KILL "t.txt"
'--- lines end with CR, LF or both when read
OPEN "t.txt" FOR OUTPUT AS #1
PRINT #1, "a" + CHR$(13) + "b" + CHR$(10) + "c" + CHR$(13) + CHR$(10) + CHR$(10) + "d" + CHR$(13);
CLOSE #1
OPEN "t.txt" FOR INPUT AS #1
DO : LINE INPUT #1, a$ : PRINT a$; "," ; : LOOP UNTIL EOF(1)
PRINT '>a,b,c,,d,
CLOSE
KILL "t.txt"
'--- behind the last line comes an empty text
OPEN "t.txt" FOR OUTPUT AS #1 : PRINT #1, "x" : CLOSE
OPEN "t.txt" FOR INPUT AS #1
LINE INPUT #1, a$ : LINE INPUT #1, b$
PRINT "["; a$; "]["; b$; "]"; EOF(1) '>[x][] 1
PRINT "["; INPUT$(5, 1); "]" '>[]
CLOSE : KILL "t.txt"
'--- INPUT # takes fields of a line
OPEN "t.txt" FOR OUTPUT AS #3
PRINT #3, "12, "; CHR$(34); "a, b"; CHR$(34); " , &H10"
PRINT #3, " word , 2.5"
CLOSE #3
OPEN "t.txt" FOR INPUT AS #3
INPUT #3, a, b$, c
PRINT a; "["; b$; "]"; c '> 12[a, b] 16
INPUT #3, b$, d, e$
PRINT "["; b$; "]"; d; "["; e$; "]" '>[word] 2.5[]
CLOSE #3 : KILL "t.txt"
'--- INPUT # into integers, elements and a smaller string
OPEN "t.txt" FOR OUTPUT AS #1 : PRINT #1, "7.6,abc,3" : CLOSE
DIM n%, s$ LENGTH 3, m(3)
OPEN "t.txt" FOR INPUT AS #1
INPUT #1, n%, s$, m(2)
PRINT n%; s$; m(2) '> 8abc 3
CLOSE : KILL "t.txt"
'--- APPEND goes on at the end
OPEN "t.txt" FOR APPEND AS #1 : PRINT #1, "a" : CLOSE
OPEN "t.txt" FOR APPEND AS #1 : PRINT #1, "b" : CLOSE
OPEN "t.txt" FOR INPUT AS #1
LINE INPUT #1, a$ : LINE INPUT #1, b$ : PRINT a$; b$; EOF(1) '>ab 1
CLOSE : KILL "t.txt"
'--- OUTPUT starts anew
OPEN "t.txt" FOR OUTPUT AS #1 : PRINT #1, "long text" : CLOSE
OPEN "t.txt" FOR OUTPUT AS #1 : PRINT #1, "s" : CLOSE
OPEN "t.txt" FOR INPUT AS #1 : PRINT LOF(1) '> 3
CLOSE : KILL "t.txt"
'--- RANDOM reads and writes anywhere
OPEN "t.txt" FOR RANDOM AS #1
PRINT #1, "0123456789";
PRINT LOC(1); LOF(1) '> 11 10
SEEK #1, 4
PRINT INPUT$(2, 1); LOC(1) '>34 6
PRINT #1, "xy";
SEEK #1, 1
PRINT INPUT$(20, 1) '>01234xy789
CLOSE
OPEN "t.txt" FOR RANDOM AS #1
PRINT LOC(#1) '> 11
CLOSE : KILL "t.txt"
'--- SEEK outside the file
OPEN "t.txt" FOR OUTPUT AS #1 : PRINT #1, "abc"; : CLOSE
OPEN "t.txt" FOR INPUT AS #1
SEEK #1, 4
PRINT EOF(1) '> 1
KILL "u.txt" '! File not found: /u.txt
'--- SEEK names the range
OPEN "t.txt" FOR OUTPUT AS #1 : PRINT #1, "abc"; : CLOSE
OPEN "t.txt" FOR INPUT AS #1 : KILL_LATER
SEEK #1, 5 '! position: 5 is invalid (valid is 1 to 4)
SUB KILL_LATER
END SUB
'--- the number of a channel is a value
n = 4
OPEN "t.txt" FOR OUTPUT AS n
PRINT #n, "via n"
PRINT #n + 0, "twice"
CLOSE n
OPEN "t.txt" FOR INPUT AS #n
LINE INPUT #n, a$ : PRINT a$; EOF(n); LOF(#n) '>via n 0 14
CLOSE #n : KILL "t.txt"
'--- channel 0 is the console
PRINT #0, "a"; 1, "b"; '>a 1	b!
PRINT #0, "!"
'--- TAB on a channel
OPEN "t.txt" FOR OUTPUT AS #1
PRINT #1, "ab"; TAB(5); "c"; TAB(2); "d"
PRINT #1, TAB(3); 7
CLOSE
OPEN "t.txt" FOR INPUT AS #1
DO : LINE INPUT #1, a$ : PRINT "["; a$; "]"; : LOOP UNTIL EOF(1)
PRINT '>[ab  c][ d][   7]
CLOSE : KILL "t.txt"
'--- PRINT # of values of all types
OPEN "t.txt" FOR OUTPUT AS #1
PRINT #1, 1/3; -1e10; 123456789012; "s" "t"
CLOSE
OPEN "t.txt" FOR INPUT AS #1 : LINE INPUT #1, a$ : PRINT a$ '> 0.3333333333-1e+10 123456789012st
CLOSE : KILL "t.txt"
'--- an error in a value writes nothing of the line
OPEN "t.txt" FOR OUTPUT AS #1
PRINT #1, "whole"
ON ERROR SKIP
PRINT #1, "half"; 1/0
PRINT #1, "next"
CLOSE
OPEN "t.txt" FOR INPUT AS #1
LINE INPUT #1, a$ : LINE INPUT #1, b$ : PRINT a$; b$ '>wholenext
CLOSE : KILL "t.txt"
'--- a line longer than a string
OPEN "t.txt" FOR OUTPUT AS #1
PRINT #1, STRING$(200, "a"); STRING$(56, "b")
PRINT #1, STRING$(255, "c")
CLOSE
OPEN "t.txt" FOR INPUT AS #1
ON ERROR SKIP
LINE INPUT #1, a$
PRINT MM.ERRMSG$; LOC(1) '>String too long 1
a$ = INPUT$(255, 1) : b$ = INPUT$(3, 1) : PRINT LEN(a$); ASC(b$) '> 255 98
LINE INPUT #1, a$ : PRINT LEN(a$); LEFT$(a$, 1); EOF(1) '> 255c 1
CLOSE : KILL "t.txt"
'--- a program may run on with a channel open and opens it again
OPEN "t.txt" FOR OUTPUT AS #1
ON ERROR SKIP
OPEN "v.txt" FOR OUTPUT AS #1
PRINT MM.ERRMSG$ '>File number already open
CLOSE : KILL "t.txt"
'--- closed numbers
PRINT #1, "x" '! File number is not open
'--- closed numbers in CLOSE
CLOSE #2 '! File number is not open
'--- closed numbers in EOF
PRINT EOF(#9) '! File number is not open
'--- closed numbers in LINE INPUT
LINE INPUT #5, a$ '! File number is not open
'--- CLOSE alone with nothing open
CLOSE : PRINT "ok" '>ok
'--- numbers out of range
OPEN "t.txt" FOR OUTPUT AS #11 '! file number: 11 is invalid (valid is 1 to 10)
'--- channel 0 cannot be opened
OPEN "t.txt" FOR OUTPUT AS #0 '! File number already open
'--- OPEN without FOR
OPEN "t.txt" AS #1 '! Missing FOR INPUT, OUTPUT, APPEND or RANDOM
'--- OPEN for nonsense
OPEN "t.txt" FOR READING AS #1 '! Invalid syntax
'--- OPEN a number
OPEN 5 FOR INPUT AS #1 '! Expected a string
'--- no such file
OPEN "none.txt" FOR INPUT AS #1 '! File not found: /none.txt
'--- a name with characters that do not go
OPEN "a?b" FOR OUTPUT AS #1 '! Not a file name: a?b
'--- reading what is open for writing
OPEN "t.txt" FOR OUTPUT AS #1
ON ERROR SKIP
LINE INPUT #1, a$
PRINT MM.ERRMSG$ '>The file is not open for this
CLOSE : KILL "t.txt"
'--- writing what is open for reading
OPEN "t.txt" FOR OUTPUT AS #1 : PRINT #1, "x" : CLOSE
OPEN "t.txt" FOR INPUT AS #1
ON ERROR SKIP
PRINT #1, "y"
PRINT MM.ERRMSG$ '>The file is not open for this
CLOSE : KILL "t.txt"
'--- a file that is being written cannot be opened, deleted or renamed
OPEN "t.txt" FOR OUTPUT AS #1
ON ERROR IGNORE
OPEN "t.txt" FOR INPUT AS #2 : PRINT MM.ERRMSG$ '>File is open: /t.txt
KILL "t.txt" : PRINT MM.ERRMSG$ '>File is open: /t.txt
RENAME "t.txt" AS "u.txt" : PRINT MM.ERRMSG$ '>File is open: /t.txt
CLOSE : KILL "t.txt"
'--- ten files at a time
MKDIR "many"
FOR i = 1 TO 10 : OPEN "many/" + STR$(i) FOR OUTPUT AS i : PRINT #i, i * i : NEXT
FOR i = 1 TO 10 : CLOSE i : NEXT
FOR i = 1 TO 10 : OPEN "many/" + STR$(i) FOR INPUT AS i : NEXT
FOR i = 10 TO 1 STEP -1 : INPUT #i, a : PRINT a; : NEXT
PRINT '> 100 81 64 49 36 25 16 9 4 1
CLOSE : KILL "many/*", ALL : RMDIR "many"
'--- FLUSH makes it the file's content
OPEN "t.txt" FOR OUTPUT AS #1 : PRINT #1, "abc" : FLUSH #1
PRINT LOF(1) '> 5
CLOSE : KILL "t.txt"
'--- folders
MKDIR "d1" : MKDIR "d1/d2"
PRINT CWD$ '>A:/
CHDIR "d1/d2" : PRINT CWD$ '>A:/d1/d2
OPEN "f" FOR OUTPUT AS #1 : CLOSE
CHDIR ".." : PRINT CWD$; " "; DIR$("d2/*") '>A:/d1 f
ON ERROR SKIP
RMDIR "d2"
PRINT MM.ERRMSG$ '>The folder is not empty or in use: /d1/d2
KILL "A:/d1/d2/f" : RMDIR "/d1/d2" : CHDIR "/" : RMDIR "d1"
PRINT "["; DIR$("d1", DIR); "]" '>[]
'--- DIR$ gives names in order, of the kind that is asked for
MKDIR "m" : MKDIR "m/dir.nc"
FOR i = 1 TO 5
OPEN "m/" + MID$("dbeac", i, 1) + ".nc" FOR OUTPUT AS #1 : CLOSE
NEXT
OPEN "m/x.txt" FOR OUTPUT AS #1 : CLOSE
a$ = DIR$("m/*.nc")
DO WHILE a$ <> "" : PRINT a$; " "; : a$ = DIR$() : LOOP
PRINT '>a.nc b.nc c.nc d.nc e.nc
PRINT DIR$("m/*.NC", DIR); DIR$() '>dir.nc
a$ = DIR$("m/?.*", ALL)
DO WHILE a$ <> "" : PRINT a$; " "; : a$ = DIR$() : LOOP
PRINT '>a.nc b.nc c.nc d.nc e.nc x.txt
KILL "m/*", ALL : RMDIR "m/dir.nc" : RMDIR "m"
'--- DIR$ goes on while files are deleted
MKDIR "m"
FOR i = 1 TO 4 : OPEN "m/" + STR$(i) FOR OUTPUT AS #1 : CLOSE : NEXT
a$ = DIR$("m/*", FILE)
DO WHILE a$ <> "" : PRINT a$; : KILL "m/" + a$ : a$ = DIR$() : LOOP
PRINT '>1234
RMDIR "m"
'--- DIR$ of another kind
PRINT DIR$("*", LINK) '! type: LINK is invalid (valid is ALL, DIR, FILE)
'--- RENAME moves as well
MKDIR "m" : OPEN "t.txt" FOR OUTPUT AS #1 : PRINT #1, "abc" : CLOSE
RENAME "t.txt" AS "m/u.txt"
PRINT DIR$("t.txt"); "-"; DIR$("m/*") '>-u.txt
KILL "m/u.txt" : RMDIR "m"
'--- RENAME does not replace
OPEN "t.txt" FOR OUTPUT AS #1 : CLOSE : OPEN "u.txt" FOR OUTPUT AS #1 : CLOSE
ON ERROR SKIP
RENAME "t.txt" AS "u.txt"
PRINT MM.ERRMSG$ '>File exists already: /u.txt
KILL "t.txt" : KILL "u.txt"
'--- COPY replaces
OPEN "t.txt" FOR OUTPUT AS #1 : FOR i = 1 TO 300 : PRINT #1, i : NEXT : CLOSE
OPEN "u.txt" FOR OUTPUT AS #1 : PRINT #1, "old" : CLOSE
COPY "t.txt" TO "u.txt"
OPEN "u.txt" FOR INPUT AS #1 : PRINT LOF(1) '> 1692
s = 0 : FOR i = 1 TO 300 : INPUT #1, a : s = s + a : NEXT : CLOSE
PRINT s '> 45150
KILL "t.txt" : KILL "u.txt"
'--- COPY of nothing
COPY "none" TO "u.txt" '! File not found: /none
'--- COPY onto itself
OPEN "t.txt" FOR OUTPUT AS #1 : PRINT #1, "abc" : CLOSE
ON ERROR SKIP
COPY "t.txt" TO "t.txt"
PRINT MM.ERRMSG$ '>File is open: /t.txt
OPEN "t.txt" FOR INPUT AS #1 : PRINT LOF(1) '> 5
CLOSE : KILL "t.txt"
'--- KILL wants to be sure
KILL "*.txt" '! More than one file is meant: use KILL "*.txt", ALL
'--- KILL with ALL and nothing that fits
KILL "*.none", ALL '! File not found: *.none
'--- KILL a folder
MKDIR "m"
ON ERROR SKIP
KILL "m"
PRINT MM.ERRMSG$ '>It is a folder: /m
RMDIR "m"
'--- FILES lists folders, then files, then the space
MKDIR "m" : CHDIR "m" : MKDIR "sub"
OPEN "b.nc" FOR OUTPUT AS #1 : PRINT #1, "12345" : CLOSE
OPEN "a.nc" FOR OUTPUT AS #1 : CLOSE
' (what FILES prints is tested with the prompt)
CHDIR "/" : KILL "m/*", ALL : RMDIR "m/sub" : RMDIR "m"
'--- MM.INFO about files
MKDIR "m" : OPEN "m/f" FOR OUTPUT AS #1 : PRINT #1, "abc" : CLOSE
PRINT MM.INFO(EXISTS FILE "m/f"); MM.INFO(EXISTS FILE "m"); MM.INFO(EXISTS FILE "x") '> 1 0 0
n$ = "m" : PRINT MM.INFO(EXISTS DIR n$); MM.INFO(EXISTS DIR "m/f"); MM.INFO(EXISTS DIR "x") '> 1 0 0
PRINT MM.INFO(FILESIZE "m/" + "f"); MM.INFO(FILESIZE "m"); MM.INFO(FILESIZE "x") '> 5-2-1
KILL "m/f" : RMDIR "m"
'--- MM.INFO about files of another kind
PRINT MM.INFO(EXISTS LINK "m") '! Invalid syntax
'--- a folder cannot be moved into itself, nor from under the program's feet
MKDIR "m" : MKDIR "m/n" : OPEN "m/n/f" FOR OUTPUT AS #1 : CLOSE
ON ERROR IGNORE
RENAME "m" AS "m/n/o" : PRINT MM.ERRMSG$ '>The folder is not empty or in use: /m
RENAME "/" AS "r" : PRINT MM.ERRMSG$ '>The folder is not empty or in use: /
CHDIR "m/n" : RENAME "/m" AS "/r" : PRINT MM.ERRMSG$ '>The folder is not empty or in use: /m
CHDIR "/" : ON ERROR ABORT
RENAME "m" AS "mm" : RENAME "mm/n" AS "n"
PRINT DIR$("n/*") '>f
KILL "n/f" : RMDIR "n" : RMDIR "mm"
