'--- SPI needs its pins
SPI OPEN 1000000, 0, 8 '! SPI has no pins (use SETPIN)
'--- SPI pins of the other bus
SETPIN GP8, GP11, GP10, SPI '! GP8 (pin 11) cannot be SPI receive
'--- SPI pins in the wrong order
SETPIN GP4, GP2, GP3, SPI '! GP2 (pin 4) cannot be SPI transmit
'--- SPI pins may be of several groups
SETPIN GP16, GP3, GP22, SPI
SPI OPEN 1000000, 0, 8
SPI CLOSE
SPI CLOSE '! SPI is not open
'--- pins of SPI are in use
SETPIN GP8, GP11, GP10, SPI2
STEPPER INIT '>Stepper initialized, buffer 32
STEPPER AXIS X, GP10, GP2 '! Pin GP10 (pin 14) is in use by SETPIN SPI
'--- SPI that is not open
SETPIN GP8, GP11, GP10, SPI2
PRINT SPI2(5) '! SPI2 is not open
'--- SETPIN takes the pins from an open SPI
SETPIN GP4, GP3, GP2, SPI
SPI OPEN 1000000, 0, 8
SETPIN GP3, DOUT
ON ERROR SKIP
SPI WRITE 1, 5
PRINT MM.ERRMSG$ '>SPI is not open
PRINT PIN(GP4) '! Pin GP4 (pin 6) is not set up (use SETPIN)
'--- SPI is open once
SETPIN GP4, GP3, GP2, SPI
SPI OPEN 1000000, 0
SPI OPEN 1000000, 0 '! SPI is open
'--- an SPI speed out of range
SETPIN GP4, GP3, GP2, SPI
SPI OPEN 100, 0, 8 '! speed: 100 is invalid (valid is 10000 to 62500000)
'--- an SPI mode out of range
SETPIN GP4, GP3, GP2, SPI
SPI OPEN 1000000, 4, 8 '! mode: 4 is invalid (valid is 0 to 3)
'--- SPI words of too many bits
SETPIN GP4, GP3, GP2, SPI
SPI OPEN 1000000, 0, 17 '! bits: 17 is invalid (valid is 4 to 16)
'--- an SPI word beyond its bits
SETPIN GP4, GP3, GP2, SPI
SPI OPEN 1000000, 0, 12
PRINT SPI(4095) '> 4095
PRINT SPI(4096) '! data: 4096 is invalid (valid is 0 to 4095)
'--- SPI data beyond the bits of a word
SETPIN GP4, GP3, GP2, SPI
SPI OPEN 1000000, 0, 8
SPI WRITE 3, 1, 2, 256 '! data: a word is out of range (valid is 0 to 255)
'--- less SPI data than said
SETPIN GP4, GP3, GP2, SPI
SPI OPEN 1000000, 0, 8
SPI WRITE 5, "abc" '! data: 3 words, nbr is 5
'--- more SPI words than the array holds
SETPIN GP4, GP3, GP2, SPI
SPI OPEN 1000000, 0, 8
DIM a(3)
SPI READ 5, a() '! array: has room for 4, nbr is 5
'--- SPI words of all widths come back from a loopback plug
SETPIN GP4, GP7, GP6, SPI
FOR b = 4 TO 16
  SPI OPEN 2000000, b MOD 4, b
  IF SPI(2 ^ b - 1) <> 2 ^ b - 1 OR SPI(1) <> 1 THEN PRINT "wrong"; b
  SPI CLOSE
NEXT
PRINT b '> 17
'--- SPI WRITE and READ
SETPIN GP8, GP11, GP10, SPI2
SPI2 OPEN 1000000, 3, 8
DIM a%(99), i
FOR i = 0 TO 99 : a%(i) = 255 - i : NEXT
SPI2 WRITE 100, a%()
SPI2 WRITE 3, 1, 2, 3
SPI2 WRITE 4, "abcdef"
PRINT SPI2(170) '> 170
SPI2 READ 50, a%()
PRINT a%(0); a%(49); a%(50) '> 0 0 205
SPI2 READ 5, s$
PRINT LEN(s$) '> 5
'--- an SPI transfer takes its time
DIM t(999)
SETPIN GP8, GP11, GP10, SPI2
SPI2 OPEN 100000, 0, 10
TIMER = 0
SPI2 READ 1000, t()
IF TIMER < 100 OR TIMER > 112 THEN PRINT TIMER
PRINT SPI2(1) '> 1
'--- interrupts of the program go on with SPI
DIM t(999)
SETPIN GP8, GP11, GP10, SPI2
SPI2 OPEN 100000, 0, 10
SETTICK 30, tick
SPI2 READ 1000, t()
PRINT n '> 1
SUB tick
  n = n + 1
END SUB
