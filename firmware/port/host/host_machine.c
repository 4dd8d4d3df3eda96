// Reads the description of a simulated machine. Context: main.
//
//   axis X step=2 dir=3 at=4000 stops=-80:16000
//   switch pin=10 axis=X from=-400 to=0 bounce_us=400 hysteresis=6
//   stall pin=11 axis=Y from=-400 to=0 rate=2000 hold_us=500
//   tmc2209 tx=5 address=0 axis=X diag=10
#include "host_machine.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hal/hal.h"
#include "host_machine_tmc.h"
#include "host_machine_words.h"
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
} machine;

// ---- Lines --------------------------------------------------------------------------------------

const simulate_axis_t *host_machine_axis(unsigned index, const char **name) {
    if (index >= machine.axis_count) {
        return NULL;
    }
    *name = machine.names[index];
    return &machine.axes[index];
}

static simulate_axis_t *find_axis(const char *name) {
    for (unsigned i = 0; i < machine.axis_count; i++) {
        if (strcmp(machine.names[i], name) == 0) {
            return &machine.axes[i];
        }
    }
    host_machine_complain("no axis before this line is called", name);
}

static void read_axis_word(simulate_axis_t *axis, const char *word) {
    const char *stops = host_machine_value(word, "stops");
    if (stops != NULL) {
        axis->has_stops = true;
        axis->stop_low_steps = host_machine_number(word, stops, ':', &stops);
        axis->stop_high_steps = host_machine_number(word, stops, '\0', &stops);
    } else if (strcmp(word, "inverted") == 0) {
        axis->dir_inverted = true;
    } else if (!host_machine_take_pin(word, "step", &axis->step_gpio) &&
               !host_machine_take_pin(word, "dir", &axis->dir_gpio) &&
               !host_machine_take_number(word, "at", &axis->position_steps)) {
        host_machine_complain("unknown in the line of an axis:", word);
    }
}

static void read_axis(char *rest) {
    const char *name = strtok_r(NULL, " \t", &rest);
    if (machine.axis_count == AXES_MAX || name == NULL || strlen(name) >= NAME_MAX_LENGTH) {
        host_machine_complain("too many axes, or no short name:", name != NULL ? name : "");
    }
    simulate_axis_t *axis = &machine.axes[machine.axis_count];
    *axis = (simulate_axis_t){.step_gpio = PINS_COUNT, .dir_gpio = PINS_COUNT};
    strcpy(machine.names[machine.axis_count++], name);
    for (const char *word; (word = strtok_r(NULL, " \t", &rest)) != NULL;) {
        read_axis_word(axis, word);
    }
    if (axis->step_gpio == PINS_COUNT || axis->dir_gpio == PINS_COUNT) {
        host_machine_complain("an axis needs step= and dir=:", name);
    }
    if (!simulate_axis_attach(axis)) {
        host_machine_complain("too many parts", "");
    }
}

static void read_switch_word(simulate_switch_t *limit, const char *word) {
    const char *axis = host_machine_value(word, "axis");
    if (axis != NULL) {
        limit->axis = find_axis(axis);
    } else if (strcmp(word, "high") == 0) {
        limit->pressed_level = true;
    } else if (strcmp(word, "never-closes") == 0) {
        limit->fault = SIMULATE_FAULT_NEVER_CLOSES;
    } else if (strcmp(word, "never-opens") == 0) {
        limit->fault = SIMULATE_FAULT_NEVER_OPENS;
    } else if (!host_machine_take_pin(word, "pin", &limit->gpio) &&
               !host_machine_take_number(word, "from", &limit->from_steps) &&
               !host_machine_take_number(word, "to", &limit->to_steps) &&
               !host_machine_take_unsigned(word, "hysteresis", &limit->hysteresis_steps) &&
               !host_machine_take_unsigned(word, "bounce_us", &limit->bounce_us) &&
               !host_machine_take_unsigned(word, "seed", &limit->random) &&
               !host_machine_take_unsigned(word, "rate", &limit->stall_rate_hz) &&
               !host_machine_take_unsigned(word, "hold_us", &limit->hold_us)) {
        host_machine_complain("unknown in the line of a switch:", word);
    }
}

static void read_switch(char *rest, bool stall) {
    if (machine.switch_count == SWITCHES_MAX) {
        host_machine_complain("too many switches", "");
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
        host_machine_complain("a switch needs pin= and axis=", "");
    }
    if (!simulate_switch_attach(limit)) {
        host_machine_complain("too many parts", "");
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
    } else if (strcmp(kind, "tmc2209") == 0 || strcmp(kind, "tmc2208") == 0) {
        host_machine_tmc(kind[6] == '9' ? 2209 : 2208, find_axis, rest);
    } else {
        host_machine_complain("a line begins with axis, switch, stall, tmc2209 or tmc2208, not",
                              kind);
    }
}

void host_machine_load(const char *path) {
    FILE *file = fopen(path, "re");
    if (file == NULL) {
        host_system_fail("%s: %s", path, strerror(errno));
    }
    host_machine_words_file(path);
    char *text = NULL;
    size_t size = 0;
    while (getline(&text, &size, file) >= 0) {
        host_machine_words_next_line();
        text[strcspn(text, "\r\n")] = '\0';
        read_line(text);
    }
    free(text);
    fclose(file);
}
