'--- a port needs its pins
OPEN "COM1:9600" AS #1 '! COM1 has no pins (use SETPIN)
'--- pins that a port cannot have
SETPIN GP1, GP4, COM1 '! GP4 (pin 6) cannot be COM1 transmit
'--- a pin that sends cannot receive
SETPIN GP4, GP5, COM2 '! GP4 (pin 6) cannot be COM2 receive
'--- pins of a port are in use
SETPIN GP9, GP8, COM2
ON ERROR SKIP
SETPIN GP8, GP9, COM1
PRINT MM.ERRMSG$ '>GP8 (pin 11) cannot be COM1 receive
STEPPER INIT '>Stepper initialized, buffer 32
STEPPER AXIS X, GP8, GP2 '! Pin GP8 (pin 11) is in use by SETPIN COM
'--- unknown ports
OPEN "COM3:9600" AS #1 '! COM3:9600 is no port (valid is COM1, COM2)
'--- baud rates out of range
SETPIN GP5, GP4, COM2
OPEN "COM2:100" AS #1 '! baud: 100 is invalid (valid is 120 to 921600)
'--- buffers out of range
SETPIN GP5, GP4, COM2
OPEN "COM2:9600, 513" AS #1 '! buffer: 513 is invalid (valid is 1 to 512)
'--- a SUB that is not there
SETPIN GP5, GP4, COM2
OPEN "COM2:9600, 100, nowhere" AS #1 '! Unknown user subroutine
'--- a word that is not known
SETPIN GP5, GP4, COM2
OPEN "COM2:9600,,,,FAST" AS #1 '! FAST is not known in OPEN "COMn:"
'--- a port is open once
SETPIN GP5, GP4, COM2
OPEN "COM2:19200,,,, EVEN, 7BIT, S2" AS #1
PRINT LOC(#1); LOF(#1); EOF(#1) '> 0 128 1
ON ERROR SKIP
OPEN "COM2:19200" AS #2
PRINT MM.ERRMSG$ '>COM2 is open
CLOSE #1
OPEN "COM2:19200" AS #2
SETPIN GP5, GP4, COM2 '! COM2 is open
'--- SETPIN takes the pins from an open port
SETPIN GP5, GP4, COM2
OPEN "COM2:9600" AS #1
SETPIN GP4, DOUT
ON ERROR SKIP
PRINT #1, "x"
PRINT MM.ERRMSG$ '>COM2 has lost its pins
CLOSE #1
PRINT PIN(GP5) '! Pin GP5 (pin 7) is not set up (use SETPIN)
