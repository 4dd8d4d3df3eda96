// DATE$, TIME$, DATETIME$, EPOCH and DAY$, read and set. Context: main loop.
#include <string.h>

#include "actions.h"
#include "base/base.h"
#include "clock.h"
#include "errors.h"
#include "functions.h"
#include "memory.h"

#define FUNCTION(name) void functions_##name(value_t *arguments, unsigned count, value_t *result)
#define TEXT_SIZE 48
#define SECONDS_MIN (-62135596800) // 0001-01-01
#define SECONDS_MAX 253402300799   // 9999-12-31 23:59:59

static void set_text(value_t *result, const char *text, size_t length) {
    char *copy = memory_text(length);
    memcpy(copy, text, length);
    value_set_text(result, copy, length);
}

static void set_date(value_t *result, const clock_date_t *date, bool with_time) {
    char text[TEXT_SIZE];
    size_t length = format_text(text, sizeof text, "%02u-%02u-%04u", date->day, date->month,
                                (unsigned)date->year);
    if (with_time) {
        length += format_text(text + length, sizeof text - length, " %02u:%02u:%02u", date->hour,
                              date->minute, date->second);
    }
    set_text(result, text, length);
}

// "date", "date time", "time" (of today), seconds, or nothing for now.
static int64_t moment_of(const value_t *arguments, unsigned count) {
    if (count == 0 || arguments->type == VALUE_NONE) {
        return clock_now();
    }
    if (value_is_numeric(arguments)) {
        int64_t seconds = value_to_integer(arguments);
        if (seconds < SECONDS_MIN || seconds > SECONDS_MAX) {
            errors_fail(ERR_NUMBER_OUT_OF_BOUNDS);
        }
        return seconds;
    }
    const char *text = arguments->text;
    const char *blank = memchr(text, ' ', arguments->length);
    size_t first = blank != NULL ? (size_t)(blank - text) : arguments->length;
    clock_date_t date = clock_date(clock_now());
    date.hour = date.minute = date.second = 0;
    bool right = clock_read_date(text, first, &date);
    if (right && blank != NULL) {
        right = clock_read_time(blank + 1, arguments->length - first - 1, &date);
    } else if (!right && blank == NULL) {
        right = clock_read_time(text, first, &date);
    }
    if (!right) {
        errors_fail(ERR_DATE);
    }
    return clock_seconds(&date);
}

FUNCTION(date) {
    (void)arguments;
    (void)count;
    clock_date_t date = clock_date(clock_now());
    set_date(result, &date, false);
}

FUNCTION(time) {
    (void)arguments;
    (void)count;
    clock_date_t date = clock_date(clock_now());
    char text[TEXT_SIZE];
    set_text(result, text,
             format_text(text, sizeof text, "%02u:%02u:%02u", date.hour, date.minute, date.second));
}

FUNCTION(datetime) {
    clock_date_t date = clock_date(moment_of(arguments, count));
    set_date(result, &date, true);
}

FUNCTION(epoch) {
    value_set_integer(result, moment_of(arguments, count));
}

FUNCTION(day) {
    static const char *const names[] = {"Thursday", "Friday",  "Saturday", "Sunday",
                                        "Monday",   "Tuesday", "Wednesday"};
    int64_t days = moment_of(arguments, count);
    days = (days >= 0 ? days : days - 86399) / 86400;
    const char *name = names[(days % 7 + 7) % 7];
    set_text(result, name, strlen(name));
}

// ---- Setting ------------------------------------------------------------------------------------

static void set_clock(const value_t *value,
                      bool (*read)(const char *text, size_t length, clock_date_t *date)) {
    if (value->type != VALUE_STRING) {
        errors_fail(ERR_EXPECTED_STRING);
    }
    clock_date_t date = clock_date(clock_now());
    if (!read(value->text, value->length, &date)) {
        errors_fail(ERR_DATE);
    }
    clock_set(clock_seconds(&date));
}

void actions_set_date(value_t *arguments, unsigned count) {
    (void)count;
    set_clock(arguments, clock_read_date);
}

void actions_set_time(value_t *arguments, unsigned count) {
    (void)count;
    set_clock(arguments, clock_read_time);
}
