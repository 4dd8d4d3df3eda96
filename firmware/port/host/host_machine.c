// Reads the description of a simulated machine. Context: main.
//
//   axis X step=2 dir=3 at=4000 stops=-80:16000
//   switch pin=10 axis=X from=-400 to=0 bounce_us=400 hysteresis=6
//   stall pin=11 axis=Y from=-400 to=0 rate=2000 hold_us=500
#include "host_machine.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hal/hal.h"
#include "host_system.h"
#include "simulate.h"

#define AXES_MAX 4u
#define SWITCHES_MAX 12u
#define NAME_MAX_LENGTH 8u

static struct {
    simulate_axis_t axes[AXES_MAX];
    char names[AXES_MAX][NAME_MAX_LENGTH];
    unsigned axis_count;
    simulate_switch_t switches[SWITCHES_MAX];
    unsigned switch_count;

    const char *path;
    unsigned line;
} machine;

static _Noreturn void complain(const char *what, const char *word) {
    host_system_fail("%s:%u: %s '%s'", machine.path, machine.line, what, word);
}

// ---- Values -------------------------------------------------------------------------------------

// The text behind "key=", NULL if the word is something else.
static const char *value_of(const char *word, const char *key) {
    size_t length = strlen(key);
    return strncmp(word, key, length) == 0 && word[length] == '=' ? word + length + 1 : NULL;
}

static long long read_number(const char *word, const char *text, char end_char, const char **end) {
    char *behind;
    errno = 0;
    long long value = strtoll(text, &behind, 10);
    if (behind == text || *behind != end_char || errno != 0) {
        complain("no whole number in", word);
    }
    *end = behind + 1;
    return value;
}

// True if the word is this key; then its number is taken.
static bool take_number(const char *word, const char *key, int64_t *value) {
    const char *text = value_of(word, key);
    if (text != NULL) {
        *value = read_number(word, text, '\0', &text);
    }
    return text != NULL;
}

static bool take_unsigned(const char *word, const char *key, uint32_t *value) {
    int64_t number = 0;
    if (!take_number(word, key, &number)) {
        return false;
    }
    if (number < 0 || number > 1000000000) {
        complain("out of range (0 to 1000000000):", word);
    }
    *value = (uint32_t)number;
    return true;
}

// A GPIO, with or without GP before it.
static bool take_pin(const char *word, const char *key, unsigned *gpio) {
    const char *text = value_of(word, key);
    if (text == NULL) {
        return false;
    }
    const char *end;
    long long number = read_number(word, strncmp(text, "GP", 2) == 0 ? text + 2 : text, '\0', &end);
    if (number < 0 || number >= PINS_COUNT) {
        complain("no such pin:", word);
    }
    *gpio = (unsigned)number;
    return true;
}

// ---- Lines --------------------------------------------------------------------------------------

static const simulate_axis_t *find_axis(const char *name) {
    for (unsigned i = 0; i < machine.axis_count; i++) {
        if (strcmp(machine.names[i], name) == 0) {
            return &machine.axes[i];
        }
    }
    complain("no axis before this line is called", name);
}

static void read_axis_word(simulate_axis_t *axis, const char *word) {
    const char *stops = value_of(word, "stops");
    if (stops != NULL) {
        axis->has_stops = true;
        axis->stop_low_steps = read_number(word, stops, ':', &stops);
        axis->stop_high_steps = read_number(word, stops, '\0', &stops);
    } else if (strcmp(word, "inverted") == 0) {
        axis->dir_inverted = true;
    } else if (!take_pin(word, "step", &axis->step_gpio) &&
               !take_pin(word, "dir", &axis->dir_gpio) &&
               !take_number(word, "at", &axis->position_steps)) {
        complain("unknown in the line of an axis:", word);
    }
}

static void read_axis(char *rest) {
    const char *name = strtok_r(NULL, " \t", &rest);
    if (machine.axis_count == AXES_MAX || name == NULL || strlen(name) >= NAME_MAX_LENGTH) {
        complain("too many axes, or no short name:", name != NULL ? name : "");
    }
    simulate_axis_t *axis = &machine.axes[machine.axis_count];
    *axis = (simulate_axis_t){.step_gpio = PINS_COUNT, .dir_gpio = PINS_COUNT};
    strcpy(machine.names[machine.axis_count++], name);
    for (const char *word; (word = strtok_r(NULL, " \t", &rest)) != NULL;) {
        read_axis_word(axis, word);
    }
    if (axis->step_gpio == PINS_COUNT || axis->dir_gpio == PINS_COUNT) {
        complain("an axis needs step= and dir=:", name);
    }
    if (!simulate_axis_attach(axis)) {
        complain("too many parts", "");
    }
}

static void read_switch_word(simulate_switch_t *limit, const char *word) {
    const char *axis = value_of(word, "axis");
    if (axis != NULL) {
        limit->axis = find_axis(axis);
    } else if (strcmp(word, "high") == 0) {
        limit->pressed_level = true;
    } else if (strcmp(word, "never-closes") == 0) {
        limit->fault = SIMULATE_FAULT_NEVER_CLOSES;
    } else if (strcmp(word, "never-opens") == 0) {
        limit->fault = SIMULATE_FAULT_NEVER_OPENS;
    } else if (!take_pin(word, "pin", &limit->gpio) &&
               !take_number(word, "from", &limit->from_steps) &&
               !take_number(word, "to", &limit->to_steps) &&
               !take_unsigned(word, "hysteresis", &limit->hysteresis_steps) &&
               !take_unsigned(word, "bounce_us", &limit->bounce_us) &&
               !take_unsigned(word, "seed", &limit->random) &&
               !take_unsigned(word, "rate", &limit->stall_rate_hz) &&
               !take_unsigned(word, "hold_us", &limit->hold_us)) {
        complain("unknown in the line of a switch:", word);
    }
}

static void read_switch(char *rest, bool stall) {
    if (machine.switch_count == SWITCHES_MAX) {
        complain("too many switches", "");
    }
    simulate_switch_t *limit = &machine.switches[machine.switch_count++];
    *limit = (simulate_switch_t){.gpio = PINS_COUNT,
                                 .from_steps = INT32_MIN,
                                 .to_steps = INT32_MAX,
                                 .pressed_level = stall,
                                 .stall_rate_hz = stall ? 1 : 0,
                                 .hold_us = stall ? 500 : 0};
    for (const char *word; (word = strtok_r(NULL, " \t", &rest)) != NULL;) {
        read_switch_word(limit, word);
    }
    if (limit->gpio == PINS_COUNT || limit->axis == NULL) {
        complain("a switch needs pin= and axis=", "");
    }
    if (!simulate_switch_attach(limit)) {
        complain("too many parts", "");
    }
}

static void read_line(char *text) {
    char *rest;
    const char *kind = strtok_r(text, " \t", &rest);
    if (kind == NULL || kind[0] == '#') {
        return;
    }
    if (strcmp(kind, "axis") == 0) {
        read_axis(rest);
    } else if (strcmp(kind, "switch") == 0 || strcmp(kind, "stall") == 0) {
        read_switch(rest, kind[1] == 't');
    } else {
        complain("a line begins with axis, switch or stall, not", kind);
    }
}

void host_machine_load(const char *path) {
    FILE *file = fopen(path, "re");
    if (file == NULL) {
        host_system_fail("%s: %s", path, strerror(errno));
    }
    machine.path = path;
    char *text = NULL;
    size_t size = 0;
    while (getline(&text, &size, file) >= 0) {
        machine.line++;
        text[strcspn(text, "\r\n")] = '\0';
        read_line(text);
    }
    free(text);
    fclose(file);
}
