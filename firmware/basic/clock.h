// The time of day, counted by the board's timer from when it was set. After a start it is 00:00:00
// on the 1st of January 2000. Context: main loop.
#ifndef BASIC_CLOCK_H
#define BASIC_CLOCK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    int64_t year;
    unsigned month, day; // from 1
    unsigned hour, minute, second;
} clock_date_t;

// Seconds since 1970-01-01 00:00:00 of the clock's time zone.
int64_t clock_now(void);
void clock_set(int64_t seconds);

// The same moment as a date; `seconds` between the years 1 and 9999.
clock_date_t clock_date(int64_t seconds);

// And back. Fields beyond their range are not looked for.
int64_t clock_seconds(const clock_date_t *date);

// Reads "DD-MM-YYYY", "DD-MM-YY" (20YY) or "YYYY-MM-DD", with - or /; and "HH[:MM[:SS]]".
// False, with nothing changed, if it is none or there is no such day or time.
bool clock_read_date(const char *text, size_t length, clock_date_t *date);
bool clock_read_time(const char *text, size_t length, clock_date_t *date);

#endif
