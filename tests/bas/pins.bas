'--- an output reads back
SETPIN GP2, DOUT
PRINT PIN(GP2) '> 0
PIN(GP2) = 1
PRINT PIN(GP2); PIN("gp2"); PIN(4) '> 1 1 1
PIN(4) = 0
PRINT PIN(GP2) '> 0
PIN(GP2) = -0.6
PRINT PIN(GP2) '> 1
'--- an output that is set up again keeps its level
SETPIN GP2, DOUT
PIN(GP2) = 1
SETPIN GP2, DOUT
PRINT PIN(GP2) '> 1
'--- an input with its pull
SETPIN GP3, DIN, PULLUP
PRINT PIN(GP3) '> 1
SETPIN GP3, DIN, PULLDOWN
PRINT PIN(GP3) '> 0
'--- a pin in a variable, by name and by the board's number
SETPIN 5, DOUT
p = 5
PIN(p) = 1
q$ = "GP" + STR$(3)
PRINT PIN(q$) '> 1
'--- reading a pin that is not set up
PRINT PIN(GP6) '! Pin GP6 (pin 9) is not set up (use SETPIN)
'--- setting an input
SETPIN GP7, DIN
PIN(GP7) = 1 '! Pin GP7 (pin 10) is not an output (use SETPIN with DOUT)
'--- setting a pin that is not set up
PIN(GP7) = 1 '! Pin GP7 (pin 10) is not an output (use SETPIN with DOUT)
'--- OFF gives a pin back
SETPIN GP7, DOUT
SETPIN GP7, OFF
PRINT PIN(GP7) '! Pin GP7 (pin 10) is not set up (use SETPIN)
'--- a pin of STEPPER is refused by name
STEPPER INIT '>Stepper initialized, buffer 32
STEPPER AXIS X, GP2, GP3
SETPIN GP2, DOUT '! Pin GP2 (pin 4) is in use by STEPPER X step
'--- setting a pin of STEPPER
STEPPER INIT '>Stepper initialized, buffer 32
STEPPER AXIS X, GP2, GP3
PRINT PIN(GP2) '> 0
PIN(GP2) = 1 '! Pin GP2 (pin 4) is in use by STEPPER X step
'--- STEPPER does not take a pin of the program
SETPIN GP3, DOUT
STEPPER INIT '>Stepper initialized, buffer 32
STEPPER AXIS X, GP2, GP3 '! Pin GP3 (pin 5) is in use by SETPIN DOUT
'--- pins that are not there
SETPIN 3, DOUT '! Invalid pin 3 (ground)
'--- GPIO numbers that are not there
SETPIN GP23, DOUT '! Invalid pin GP23 (used by the board itself)
'--- an unknown use
SETPIN GP2, BUZZER '! use: BUZZER is invalid (valid is OFF, DIN, DOUT, AIN, ARAW, FIN, PIN, CIN, INTH, INTL, INTB, PWM, PWM0A, PWM0B, PWM1A, PWM1B, PWM...)
'--- no use at all
SETPIN GP2 '! Missing use
'--- PORT sets and reads several pins
FOR i = 10 TO 13
  SETPIN "GP" + STR$(i), DOUT
NEXT
PORT(GP10, 4) = &B1010
PRINT PIN(GP10); PIN(GP11); PIN(GP12); PIN(GP13) '> 0 1 0 1
PRINT PORT(GP10, 4); PORT(GP12, 2, GP10, 2) '> 10 10
PORT(GP12, 2, GP10, 2) = 3
PRINT BIN$(PORT(GP10, 4)) '>1100
PORT(GP10, 2) = 255
PRINT BIN$(PORT(GP10, 4)) '>1111
'--- PORT over pins that are not outputs changes nothing
SETPIN GP10, DOUT
ON ERROR SKIP
PORT(GP10, 2) = 3
PRINT PIN(GP10); " "; MM.ERRMSG$ '> 0 Pin GP11 (pin 15) is not an output (use SETPIN with DOUT)
'--- PORT over the end of the pins
PRINT PORT(GP28, 2) '! Invalid pin GP29 in PORT
'--- PORT with a pin twice
PRINT PORT(GP10, 2, GP11, 2) '! Pin GP11 (pin 15) is named twice
'--- a short pulse is over when PULSE returns
SETPIN GP2, DOUT
TIMER = 0
PULSE GP2, 2
PRINT PIN(GP2); TIMER >= 2; TIMER < 2.5 '> 0 1 1
'--- long pulses run beside the program
SETPIN GP2, DOUT
SETPIN GP3, DOUT
PIN(GP3) = 1
PULSE GP2, 20
PULSE GP3, 40
PRINT PIN(GP2); PIN(GP3) '> 1 0
PAUSE 30
PRINT PIN(GP2); PIN(GP3) '> 0 0
PAUSE 20
PRINT PIN(GP2); PIN(GP3) '> 0 1
'--- a pulse of 0 ends one
SETPIN GP2, DOUT
PULSE GP2, 1000
PULSE GP2, 0
PRINT PIN(GP2) '> 0
'--- PULSE on an input
SETPIN GP2, DIN
PULSE GP2, 5 '! Pin GP2 (pin 4) is not an output (use SETPIN with DOUT)
'--- PULSE for less than no time
SETPIN GP2, DOUT
PULSE GP2, -1 '! width: -1 is invalid (valid is 0 to 86400000)
'--- PWM all or nothing
SETPIN GP6, PWM3A
PWM 3, 1000, 100
PAUSE 2
PRINT PIN(GP6) '> 1
PWM 3, 1000, 0
PAUSE 2
PRINT PIN(GP6) '> 0
PWM 3, 1000, -100
PAUSE 2
PRINT PIN(GP6) '> 0
PWM 3, 1000, -0.0001
PWM 3, OFF
PRINT PIN(GP6) '> 0
'--- PWM half of the time
SETPIN GP6, PWM
PWM 3, 137, 50
FOR i = 1 TO 400
  n = n + PIN(GP6)
NEXT
PRINT n > 100; n < 300 '> 1 1
'--- PWM without a pin
PWM 3, 1000, 50 '! PWM3A has no pin (use SETPIN with PWM)
'--- PWM on the wrong pin
SETPIN GP6, PWM2A '! GP6 (pin 9) is PWM3A
'--- PWM output on two pins
SETPIN GP6, PWM
SETPIN GP22, PWM '! PWM3A is on GP6 (pin 9)
'--- PWM duty out of range
SETPIN GP6, PWM
PWM 3, 1000, 101 '! duty_a: 101 is invalid (valid is -100 to 100)
'--- PWM frequency out of range
SETPIN GP6, PWM
PWM 3, 5, 50 '! Frequency is out of reach (valid is 7.5 to 31250000 Hz)
'--- PWM SYNC starts what was deferred
SETPIN GP6, PWM
PWM 3, 1000, 100, , , 1
PAUSE 2
PRINT PIN(GP6) '> 0
PWM SYNC , , , 0
PAUSE 2
PRINT PIN(GP6) '> 1
'--- PWM SYNC of a slice without settings
PWM SYNC 0 '! PWM slice 0 is not set up (use PWM)
'--- SERVO out of range
SETPIN GP6, PWM
SERVO 3, 130 '! position_a: 130 is invalid (valid is -20 to 120)
'--- SERVO
SETPIN GP6, PWM
SERVO 3, 50
PAUSE 40
SERVO 3, OFF
PRINT PIN(GP6) '> 0
'--- AIN elsewhere
SETPIN GP22, AIN '! Pin GP22 (pin 29) is no analog input (valid is GP26, GP27, GP28)
'--- analog inputs have a range
SETPIN GP26, AIN
SETPIN GP27, ARAW
PRINT PIN(GP26) >= 0; PIN(GP26) <= 3.3; PIN(GP27) >= 0; PIN(GP27) <= 4095 '> 1 1 1 1
'--- FIN and CIN without a signal
SETPIN GP8, FIN, 10
SETPIN GP9, CIN
PAUSE 25
PRINT PIN(GP8); PIN(GP9) '> 0 0
PIN(GP9) = 40
PRINT PIN(GP9) '> 40
'--- four counters
SETPIN GP6, FIN
SETPIN GP7, PIN
SETPIN GP8, CIN
SETPIN GP9, CIN, 3
SETPIN GP10, FIN '! No counter left for GP10 (pin 14) (at most 4 pins with FIN, PIN or CIN)
'--- an interrupt needs its SUB
SETPIN GP8, INTH, nowhere '! Unknown user subroutine
'--- OPTION PIN NUMBERS
SETPIN 4, DOUT
PRINT PIN(GP2) '> 0
OPTION PIN NUMBERS GPIO
SETPIN 4, DOUT
PIN(4) = 1
PRINT PIN(GP2); PIN(GP4) '> 0 1
STEPPER INIT '>Stepper initialized, buffer 32
OPTION PIN NUMBERS BOARD
ON ERROR SKIP
STEPPER AXIS X, 6, 7
PRINT MM.ERRMSG$ '>Pin GP4 (pin 6) is in use by SETPIN DOUT
OPTION PIN NUMBERS MIXED
SETPIN 7, DOUT
PRINT PIN(GP5) '> 0
STEPPER AXIS X, 6, 7
'--- an unknown rule for pin numbers
OPTION PIN NUMBERS SOME '! rule: SOME is invalid (valid is GPIO, BOARD, MIXED)
'--- OPTION VCC
SETPIN GP26, AIN
OPTION VCC 1.8
PRINT PIN(GP26) <= 1.8 '> 1
OPTION VCC 5 '! volts: 5 is invalid (valid is 1.8 to 3.6)
