// What the safety inputs have done, until it is acknowledged and told. Inside stepper/ only.
// Context: main loop.
#ifndef STEPPER_ALARM_H
#define STEPPER_ALARM_H

#include "stepper/stepper_safety.h"

// No alarm, no events.
void alarm_reset(void);

// Takes over what has happened in the tick and the governor. Cheap; at the start of every call.
void alarm_follow(void);

// What has done it: "Limit switch X_MIN, Y_MAX".
#define ALARM_NAMES_SIZE 64
const char *alarm_names(char names[ALARM_NAMES_SIZE]);

// Somebody has looked at the machine: no alarm any more. Error: E-STOP is pressed.
err_t alarm_acknowledge(void);

// stepper_next_event() follows as long as a switch is overridden.
void alarm_look(void);

// The queue has been dropped (stepper_drops).
void alarm_count_drop(void);

#endif
