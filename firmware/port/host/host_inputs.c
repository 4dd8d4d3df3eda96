// Reads input events and applies them. Context: main.
#include "host_inputs.h"

#include <errno.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hal/hal.h"
#include "host_analog.h"
#include "host_clock.h"
#include "host_pads.h"
#include "host_system.h"

#define TIME_DIGITS_MAX 18 // 31 years in nanoseconds; more would not fit 64 bits for sure

typedef struct {
    uint64_t time_ns;
    uint32_t line;
    uint8_t gpio; // or TEMPERATURE
    bool is_analog;
    bool level;
    double value; // volts, or degrees Celsius
} event_t;

#define TEMPERATURE 0xFFu

static struct {
    event_t *events;
    size_t count;
    size_t capacity;
    size_t next;
} inputs;

// Reads digits up to `end_char`, at most `digits_max`. Returns the place behind `end_char`, or
// NULL.
static const char *read_number(const char *text, char end_char, int digits_max, uint64_t *value) {
    int digits = 0;
    *value = 0;
    for (; *text >= '0' && *text <= '9'; text++) {
        if (++digits > digits_max) {
            return NULL;
        }
        *value = *value * 10 + (uint64_t)(*text - '0');
    }
    return digits > 0 && *text == end_char ? text + 1 : NULL;
}

// A number with its unit behind it. False: it is something else.
static bool read_quantity(const char *text, char unit, event_t *event) {
    char *end;
    event->value = strtod(text, &end);
    event->is_analog = end != text && end[0] == unit && end[1] == '\0';
    return event->is_analog;
}

// Returns what is wrong with the line, or NULL.
static const char *parse_line(const char *line, event_t *event) {
    uint64_t gpio;
    uint64_t level;
    const char *rest = read_number(line, ',', TIME_DIGITS_MAX, &event->time_ns);
    if (rest == NULL) {
        return "time_ns must be a whole number of nanoseconds, followed by a comma";
    }
    event->is_analog = false;
    if (strncmp(rest, "TEMP,", 5) == 0) {
        event->gpio = TEMPERATURE;
        return read_quantity(rest + 5, 'C', event) ? NULL : "a temperature is for instance 25.5C";
    }
    rest = read_number(rest, ',', 3, &gpio);
    if (rest == NULL || gpio >= PINS_COUNT) {
        return "gpio must be 0 to 29 or TEMP, followed by a comma";
    }
    event->gpio = (uint8_t)gpio;
    if (read_quantity(rest, 'V', event)) {
        return NULL;
    }
    rest = read_number(rest, '\0', 1, &level);
    if (rest == NULL || level > 1) {
        return "level must be 0 or 1, or a voltage, for instance 1.65V";
    }
    event->level = level == 1;
    return NULL;
}

static void append(const event_t *event) {
    if (inputs.count == inputs.capacity) {
        inputs.capacity = inputs.capacity * 2 + 64;
        inputs.events = realloc(inputs.events, inputs.capacity * sizeof *inputs.events);
        if (inputs.events == NULL) {
            host_system_fail("out of memory for input events");
        }
    }
    inputs.events[inputs.count++] = *event;
}

// By time, then by place in the file: qsort() alone does not keep the order of equals.
static int compare_events(const void *left, const void *right) {
    const event_t *a = left;
    const event_t *b = right;
    if (a->time_ns != b->time_ns) {
        return a->time_ns < b->time_ns ? -1 : 1;
    }
    return a->line < b->line ? -1 : 1;
}

void host_inputs_load(const char *path) {
    FILE *file = fopen(path, "re");
    if (file == NULL) {
        host_system_fail("%s: %s", path, strerror(errno));
    }
    char *line = NULL;
    size_t size = 0;
    ssize_t length;
    errno = 0;
    for (event_t event = {.line = 1}; (length = getline(&line, &size, file)) >= 0; event.line++) {
        if (memchr(line, '\0', (size_t)length) != NULL) {
            host_system_fail("%s:%" PRIu32 ": not a text file", path, event.line);
        }
        line[strcspn(line, "\r\n")] = '\0';
        if (line[0] == '\0' || (event.line == 1 && strcmp(line, "time_ns,gpio,level") == 0)) {
            continue;
        }
        const char *fault = parse_line(line, &event);
        if (fault != NULL) {
            host_system_fail("%s:%" PRIu32 ": %s", path, event.line, fault);
        }
        append(&event);
    }
    if (ferror(file)) {
        host_system_fail("%s: %s", path, strerror(errno));
    }
    free(line);
    fclose(file);
    if (inputs.count > 0) {
        qsort(inputs.events, inputs.count, sizeof *inputs.events, compare_events);
    }
}

uint64_t host_inputs_next_ns(void) {
    return inputs.next < inputs.count ? inputs.events[inputs.next].time_ns : HOST_CLOCK_NEVER;
}

static void apply(const event_t *event) {
    if (!event->is_analog) {
        host_pads_drive(event->gpio, event->level);
    } else if (event->gpio == TEMPERATURE) {
        host_analog_set_temperature(event->value);
    } else {
        host_analog_set_volts(event->gpio, event->value);
    }
}

void host_inputs_apply(uint64_t now_ns) {
    for (; host_inputs_next_ns() <= now_ns && inputs.next < inputs.count; inputs.next++) {
        apply(&inputs.events[inputs.next]);
    }
}
