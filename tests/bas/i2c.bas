'--- I2C needs its pins
I2C OPEN 100, 1000 '! I2C has no pins (use SETPIN)
'--- I2C pins that cannot be data
SETPIN GP1, GP5, I2C '! GP1 (pin 2) cannot be I2C data
'--- I2C pins of the other bus
SETPIN GP4, GP7, I2C '! GP7 (pin 10) cannot be I2C clock
'--- I2C2 has other pins
SETPIN GP4, GP5, I2C2 '! GP4 (pin 6) cannot be I2C2 data
'--- pins of I2C are in use
SETPIN GP6, GP7, I2C2
STEPPER INIT '>Stepper initialized, buffer 32
STEPPER AXIS X, GP6, GP2 '! Pin GP6 (pin 9) is in use by SETPIN I2C
'--- I2C that is not open
SETPIN GP6, GP7, I2C2
I2C2 WRITE &H50, 0, 1, 0 '! I2C2 is not open
'--- I2C is open once, and keeps its pins meanwhile
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
ON ERROR SKIP 2
I2C OPEN 400, 100
SETPIN GP8, GP9, I2C
PRINT MM.ERRMSG$ '>I2C is open
I2C CLOSE
SETPIN GP8, GP9, I2C
SETPIN GP4, DOUT
I2C CLOSE '! I2C is not open
'--- SETPIN takes the pins from an open I2C
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
SETPIN GP5, DIN
ON ERROR SKIP
I2C CHECK &H50
PRINT MM.ERRMSG$ '>I2C is not open
PRINT PIN(GP4) '! Pin GP4 (pin 6) is not set up (use SETPIN)
'--- an I2C speed out of range
SETPIN GP4, GP5, I2C
I2C OPEN 2000, 100 '! speed: 2000 is invalid (valid is 10 to 1000)
'--- an I2C address with too many bits
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
I2C WRITE 128, 0, 1, 0 '! addr: 128 is invalid (valid is 0 to 127, with option 2 or 3 to 1023)
'--- less I2C data than sendlen
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
I2C WRITE &H50, 0, 4, 0, 0, 1 '! data: 3 bytes, sendlen is 4
'--- more I2C data than sendlen
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
I2C WRITE &H50, 0, 2, 0, 0, 1 '! data: 3 bytes, sendlen is 2
'--- I2C data that are no bytes
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
I2C WRITE &H50, 0, 2, 0, 256 '! data: a byte is out of range (valid is 0 to 255)
'--- I2C data of several kinds
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
I2C WRITE &H50, 0, 3, 0, "ab" '! data: expected numbers, one string or one array
'--- I2C data left out
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
I2C WRITE &H50, 0, 3, 0,,1 '! Missing data
'--- I2C bytes for an array of strings
DIM s$(4)
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
I2C READ &H50, 0, 3, s$() '! rcvbuf: expected an array of numbers
'--- more I2C bytes than the variable holds
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
I2C READ &H50, 0, 2, x '! rcvbuf: has room for 1, rcvlen is 2
'--- more I2C bytes than the string holds
DIM t$ LENGTH 4
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
I2C READ &H50, 0, 5, t$ '! rcvbuf: has room for 4, rcvlen is 5
'--- I2C bytes for what is no variable
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
I2C READ &H50, 0, 2, 5 '! Invalid syntax
'--- I2C bytes for a constant
CONST c = 5
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
I2C READ &H50, 0, 1, c '! Cannot change a constant
'--- no device at an I2C address
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
x = 7 : s$ = "kept"
I2C CHECK &H20
PRINT MM.I2C '> 1
I2C WRITE &H20, 0, 1, 5
PRINT MM.I2C '> 1
I2C READ &H20, 0, 1, x
PRINT MM.I2C; x '> 1 7
I2C READ &H20, 0, 4, s$
PRINT s$ '>kept
I2C CLOSE
PRINT MM.I2C '> 1
'--- I2C devices: a thermometer
SETPIN GP4, GP5, I2C
I2C OPEN 100, 100
I2C CHECK &H48 : PRINT MM.I2C '> 0
I2C WRITE &H48, 1, 1, 0
DIM t%(1)
I2C READ &H48, 0, 2, t%()
PRINT (t%(0) * 256 + t%(1)) / 256; MM.I2C '> 25.5 0
I2C WRITE &H48, 0, 3, 2, 75, 128
I2C READ &H48, 0, 1, x
PRINT x '> 75
I2C WRITE &H48, 0, 4, 2, 75, 128, 9
PRINT MM.I2C '> 1
'--- I2C devices: a memory, written from numbers, strings and arrays
SETPIN GP6, GP7, I2C2
I2C2 OPEN 400, 100
DIM d(5) = (1, 0, 11, 22, 33, 44)
I2C2 WRITE &H50, 0, 6, 0, 64, 72, 101, ASC("l"), 108
I2C2 CHECK &H50 : PRINT MM.I2C '> 1
PAUSE 5
I2C2 CHECK &H50 : PRINT MM.I2C '> 0
I2C2 WRITE &H50, 0, 5, CHR$(0) + CHR$(68) + "o, wide"
PAUSE 5
I2C2 WRITE &H50, 0, 5, d()
PAUSE 5
I2C2 WRITE &H50, 1, 2, 0, 64
I2C2 READ &H50, 0, 7, s$
PRINT s$; LEN(s$); MM.I2C '>Hello,  7 0
DIM f(6)
I2C2 WRITE &H50, 1, 2, 1, 0
I2C2 READ &H50, 0, 4, f()
PRINT f(0); f(1); f(2); f(3); f(4) '> 11 22 33 0 0
I2C2 WRITE &H50, 1, 2, 1, 1
I2C2 READ &H50, 0, 1, f(6)
PRINT f(6) '> 22
'--- I2C devices: addresses of ten bits
SETPIN GP4, GP5, I2C
I2C OPEN 400, 100
I2C WRITE &H148, 3, 1, 0
I2C READ &H148, 2, 2, s$
PRINT ASC(s$); MM.I2C '> 25 0
I2C READ &H149, 2, 2, s$
PRINT MM.I2C '> 1
'--- I2C devices: a timeout
SETPIN GP4, GP5, I2C
I2C OPEN 400, 120
TIMER = 0
I2C CHECK &H4F
PRINT MM.I2C; INT(TIMER) '> 2 120
I2C CHECK &H48
PRINT MM.I2C '> 0
'--- I2C devices: the program's interrupts go on
SETPIN GP4, GP5, I2C
I2C OPEN 400, 120
SETTICK 50, tick
I2C CHECK &H4F
PRINT MM.I2C; n '> 2 1
SUB tick
  n = n + 1
END SUB
'--- I2C devices: a program starts with a good result
PRINT MM.I2C '> 0
