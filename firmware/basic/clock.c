// The time of day. Context: main loop.
#include "clock.h"

#include "hal/hal.h"

#define START_SECONDS 946684800 // 2000-01-01
#define DAY_SECONDS 86400
#define ERA_DAYS 146097 // 400 years
#define FIELDS 3

static struct {
    int64_t seconds; // what it was set to
    uint64_t set_us; // and when
} time_of_day = {START_SECONDS, 0};

int64_t clock_now(void) {
    return time_of_day.seconds + (int64_t)((hal_time_us() - time_of_day.set_us) / 1000000u);
}

void clock_set(int64_t seconds) {
    time_of_day.seconds = seconds;
    time_of_day.set_us = hal_time_us();
}

// Years are taken to begin in March here: the leap day is their last, and each month starts
// (153 * m + 2) / 5 days behind the year's start.
static int64_t days_of(int64_t year, unsigned month, unsigned day) {
    year -= month <= 2;
    int64_t era = (year >= 0 ? year : year - 399) / 400;
    int64_t year_of_era = year - era * 400;
    int64_t month_of_year = (month + 9) % 12;
    int64_t day_of_year = (153 * month_of_year + 2) / 5 + day - 1;
    int64_t day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
    return era * ERA_DAYS + day_of_era - 719468; // 1970-01-01 is day 0
}

static void date_of(int64_t days, clock_date_t *date) {
    days += 719468;
    int64_t era = (days >= 0 ? days : days - (ERA_DAYS - 1)) / ERA_DAYS;
    int64_t day_of_era = days - era * ERA_DAYS;
    int64_t year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36524 - day_of_era / 146096) / 365;
    int64_t day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    int64_t month_of_year = (5 * day_of_year + 2) / 153;
    date->day = (unsigned)(day_of_year - (153 * month_of_year + 2) / 5 + 1);
    date->month = (unsigned)(month_of_year < 10 ? month_of_year + 3 : month_of_year - 9);
    date->year = year_of_era + era * 400 + (date->month <= 2);
}

clock_date_t clock_date(int64_t seconds) {
    int64_t days = seconds / DAY_SECONDS;
    int64_t rest = seconds % DAY_SECONDS;
    if (rest < 0) {
        rest += DAY_SECONDS;
        days--;
    }
    clock_date_t date = {.hour = (unsigned)(rest / 3600),
                         .minute = (unsigned)(rest / 60 % 60),
                         .second = (unsigned)(rest % 60)};
    date_of(days, &date);
    return date;
}

int64_t clock_seconds(const clock_date_t *date) {
    int64_t days = days_of(date->year, date->month, date->day);
    return days * DAY_SECONDS + (int64_t)date->hour * 3600 + date->minute * 60 + date->second;
}

// ---- Reading ------------------------------------------------------------------------------------

// Numbers of up to four digits with one of `separators` between. Returns how many, 0 if it is not
// that.
static unsigned read_fields(const char *text, size_t length, const char *separators,
                            unsigned fields[FIELDS]) {
    const char *end = text + length;
    unsigned count = 0;
    while (count < FIELDS) {
        const char *start = text;
        unsigned number = 0;
        for (; text < end && *text >= '0' && *text <= '9' && text - start < 4; text++) {
            number = number * 10 + (unsigned)(*text - '0');
        }
        if (text == start) {
            return 0;
        }
        fields[count++] = number;
        if (text == end) {
            return count;
        }
        if (*text != separators[0] && *text != separators[1]) {
            return 0;
        }
        text++;
    }
    return 0;
}

bool clock_read_date(const char *text, size_t length, clock_date_t *date) {
    unsigned fields[FIELDS];
    if (read_fields(text, length, "-/", fields) != FIELDS) {
        return false;
    }
    bool year_first = fields[0] > 31;
    unsigned year = fields[year_first ? 0 : 2];
    clock_date_t read = *date;
    read.year = year < 100 ? 2000 + year : year;
    read.month = fields[1];
    read.day = fields[year_first ? 2 : 0];
    if (read.month < 1 || read.month > 12 || read.day < 1 || read.day > 31) {
        return false;
    }
    clock_date_t same = clock_date(clock_seconds(&read));
    if (same.day != read.day) { // the 31st of a month of 30 days is the 1st of the next
        return false;
    }
    *date = read;
    return true;
}

bool clock_read_time(const char *text, size_t length, clock_date_t *date) {
    unsigned fields[FIELDS] = {0};
    if (read_fields(text, length, "::", fields) == 0 || fields[0] > 23 || fields[1] > 59 ||
        fields[2] > 59) {
        return false;
    }
    date->hour = fields[0];
    date->minute = fields[1];
    date->second = fields[2];
    return true;
}
