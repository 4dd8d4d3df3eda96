'--- the clock starts at the turn of the century
PRINT DATE$; " "; LEN(TIME$) '>01-01-2000  8
'--- DATE$ and TIME$ can be set, and the time goes on
DATE$ = "28-02-2024"
TIME$ = "23:59:58"
PAUSE 3000
PRINT DATE$; " "; TIME$ '>29-02-2024 00:00:01
'--- the forms of dates and times
DATE$ = "5/6/27": PRINT DATE$ '>05-06-2027
DATE$ = "2031-12-30": PRINT DATE$ '>30-12-2031
TIME$ = "7": PRINT TIME$ '>07:00:00
TIME$ = "7:08": PRINT TIME$ '>07:08:00
'--- setting the date keeps the time and the other way round
TIME$ = "12:34:56"
DATE$ = "01-02-2030"
PRINT DATE$; " "; TIME$ '>01-02-2030 12:34:56
'--- there is no such day
DATE$ = "29-02-2023" '! Invalid date or time (DD-MM-YYYY, HH:MM:SS)
'--- there is no such month
DATE$ = "01-13-2023" '! Invalid date or time (DD-MM-YYYY, HH:MM:SS)
'--- there is no such time
TIME$ = "24:00:00" '! Invalid date or time (DD-MM-YYYY, HH:MM:SS)
'--- no date at all
DATE$ = "tomorrow" '! Invalid date or time (DD-MM-YYYY, HH:MM:SS)
'--- a date is a text
DATE$ = 5 '! Expected a string
'--- EPOCH and DATETIME$ undo each other
PRINT EPOCH("01-01-1970 00:00:00") '> 0
PRINT EPOCH("22-11-2026 08:30:15") '> 1795336215
PRINT DATETIME$(1795336215) '>22-11-2026 08:30:15
PRINT DATETIME$(-1) '>31-12-1969 23:59:59
PRINT EPOCH("2000-02-29") '> 951782400
'--- NOW
DATE$ = "22-11-2026"
PRINT DATETIME$(NOW) = DATE$ + " " + TIME$ '> 1
PRINT EPOCH(NOW) = EPOCH() '> 1
PRINT DAY$(NOW); " "; DAY$("24-12-2026") '>Sunday Thursday
'--- a variable may still be called now
now = 5
PRINT now '> 5
'--- seconds beyond the years that have four digits
PRINT DATETIME$(253402300800) '! Number out of bounds
'--- days of the week over a leap century
PRINT DAY$("28-02-1900"); " "; DAY$("01-03-1900"); " "; DAY$("01-01-0001") '>Wednesday Thursday Monday
