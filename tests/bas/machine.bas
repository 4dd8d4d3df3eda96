'--- TRACE ON shows the lines, not each statement of a line
x = 1
TRACE ON
x = 2: x = 3
TRACE OFF
PRINT x '>[4][5] 3
'--- TRACE LIST
FOR i = 1 TO 2
  x = i
NEXT
TRACE LIST 4 '>[4][3][4][5]
'--- TRACE LIST needs a number of lines
TRACE LIST 0 '! Number out of bounds
'--- TRACE alone
TRACE '! Invalid syntax
'--- CPU alone
CPU '! Invalid syntax
'--- UPDATE alone
UPDATE '! Invalid syntax
'--- WATCHDOG fed in time
WATCHDOG 20
FOR i = 1 TO 10
  PAUSE 10
  WATCHDOG 20
NEXT
WATCHDOG OFF
PAUSE 50
PRINT "alive"; MM.WATCHDOG '>alive 0
'--- WATCHDOG: out of range
WATCHDOG -1 '! timeout: -1 is invalid (valid is 1 to 2147483647 milliseconds)
