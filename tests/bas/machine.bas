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
'--- MM.INFO about the machine
PRINT MM.INFO(BOOT) <> "" '> 1
PRINT MM.INFO(CPUSPEED) > 1000000 '> 1
PRINT MM.INFO(DEVICE) = MM.DEVICE$ '> 1
PRINT MM.INFO(VERSION) = MM.VER '> 1
PRINT MM.INFO(UPTIME) >= 0 '> 1
PRINT MM.INFO(LINE) '> 7
PRINT MM.INFO$(BOOT) = MM.INFO(BOOT) '> 1
'--- MM.INFO about memory
a = MM.INFO(HEAP)
DIM x(1000)
PRINT a - MM.INFO(HEAP) >= 8000 '> 1
PRINT MM.INFO(PROGRAM) > 100 '> 1
PRINT MM.INFO(DISK SIZE) > 500000 '> 1
PRINT MM.INFO(FREE SPACE) <= MM.INFO(DISK SIZE) '> 1
'--- MM.INFO about pins
SETPIN GP3, DOUT
PRINT MM.INFO(PIN GP2) '>Unused
PRINT MM.INFO(PIN GP3) <> "Unused" '> 1
PRINT MM.INFO(PIN 5) = MM.INFO(PIN GP3) '> 1
PRINT MM.INFO(PINNO GP3); MM.INFO(PINNO "gp28"); MM.INFO(PINNO GP25) '> 5 34 0
'--- MM.INFO about the last error
ON ERROR IGNORE
a = 1 / 0
PRINT MM.INFO(ERRNO); " "; MM.INFO(ERRMSG) '> 16 Divide by zero
'--- MM.INFO about nothing
PRINT MM.INFO(NOTHING) '! Unknown MM.INFO subcommand
'--- MM.INFO about half of something
PRINT MM.INFO(FREE BEER) '! Invalid syntax
'--- MM.INFO about no pin
PRINT MM.INFO(PIN GP99) '! Invalid pin GP99 (valid is GP0 to GP28)
'--- MM.INFO of a word that takes nothing more
PRINT MM.INFO(UPTIME 3) '! Argument count
