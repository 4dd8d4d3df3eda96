// G-code's sink: the machine. Context: main loop.
#include "gcode/gcode_sink.h"

#include <string.h>

#include "stepper/rules.h"
#include "stepper/stepper_check.h"
#include "stepper/stepper_homing.h"
#include "stepper/stepper_outputs.h"
#include "stepper/stepper_safety.h"

static void (*listener)(const char *text, size_t length);

void gcode_set_listener(void (*wanted)(const char *text, size_t length)) {
    listener = wanted;
}

static void tell(const char *text, size_t length) {
    if (listener != NULL) {
        listener(text, length);
    }
}

static err_t place(double target[AXIS_COUNT]) {
    err_t err = rules_check(RULES_DO_OFFSET);
    if (err == ERR_OK) {
        stepper_target(target);
    }
    return err;
}

static err_t check_probe(const gcode_entry_t *entry, const double from[AXIS_COUNT]) {
    bool invert;
    if (stepper_probe_config(&invert) == PINS_NONE) {
        return err_raise(ERR_NO_PROBE_PIN, NULL);
    }
    return stepper_check_line(from, &entry->arc.move);
}

static err_t check(const gcode_entry_t *entry, double from[AXIS_COUNT]) {
    err_t err = ERR_OK;
    switch (entry->kind) {
    case ENTRY_MOVE:
        err = stepper_check_line(from, &entry->arc.move);
        break;
    case ENTRY_ARC:
        err = stepper_check_arc(from, &entry->arc);
        break;
    case ENTRY_PROBE:
        err = check_probe(entry, from);
        break;
    case ENTRY_SPINDLE:
        return stepper_spindle_check(entry->spindle.turn);
    case ENTRY_COOLANT:
        return stepper_coolant_check(entry->coolant.flood, entry->coolant.mist);
    case ENTRY_HOME:
        return stepper_home_check(entry->axes);
    default:
        return ERR_OK;
    }
    memcpy(from, entry->arc.move.target, sizeof entry->arc.move.target);
    return err;
}

// ---- Pauses -------------------------------------------------------------------------------------

// What each pause is for, under the number that stepper_pauses() will have when it is reached: one
// that is over before anybody has looked must not leave its tool to the next. Of those that are
// queued the first eight are kept. A drop forgets them.
#define PAUSES_MAX 8u

static struct {
    struct {
        uint32_t number; // 0: free
        uint32_t tool;
    } kept[PAUSES_MAX]; // at number % PAUSES_MAX
    uint32_t last;      // number of the pause queued last
    uint32_t reached;
    uint32_t drops;
} pauses;

static void follow_pauses(void) {
    uint32_t reached = stepper_pauses();
    uint32_t drops = stepper_drops();
    if (pauses.drops != drops || reached < pauses.reached) {
        memset(&pauses, 0, sizeof pauses);
        pauses.drops = drops;
        pauses.last = reached;
    }
    pauses.reached = reached;
}

static err_t push_pause(uint32_t tool) {
    follow_pauses();
    err_t err = stepper_pause();
    if (err == ERR_OK) {
        uint32_t number = ++pauses.last;
        unsigned place = number % PAUSES_MAX;
        if (pauses.kept[place].number < pauses.reached || pauses.kept[place].number == 0) {
            pauses.kept[place].number = number;
            pauses.kept[place].tool = tool;
        }
    }
    return err;
}

bool gcode_take_pause(uint32_t *tool) {
    follow_pauses();
    unsigned place = pauses.reached % PAUSES_MAX;
    if (pauses.reached == 0 || pauses.kept[place].number != pauses.reached) {
        return false;
    }
    *tool = pauses.kept[place].tool;
    pauses.kept[place].number = 0;
    return true;
}

// ---- Entries ------------------------------------------------------------------------------------

static err_t push(const gcode_entry_t *entry) {
    switch (entry->kind) {
    case ENTRY_MOVE:
        return stepper_move(&entry->arc.move);
    case ENTRY_ARC:
        return stepper_arc(&entry->arc);
    case ENTRY_PROBE:
        return stepper_probe(&entry->arc.move, !entry->probe.toward, entry->probe.error_if_none);
    case ENTRY_DWELL:
        return entry->dwell.lit ? stepper_laser_dwell(entry->dwell.ms)
                                : stepper_dwell(entry->dwell.ms);
    case ENTRY_SPINDLE:
        return stepper_spindle_switch(entry->spindle.turn, entry->spindle.rpm);
    case ENTRY_COOLANT:
        return stepper_coolant_switch(entry->coolant.flood, entry->coolant.mist);
    case ENTRY_PAUSE:
        return push_pause(entry->tool);
    case ENTRY_HOME:
        return stepper_home(entry->axes);
    case ENTRY_END:
        break;
    }
    return ERR_OK;
}

static bool ended(err_t *result) {
    if (stepper_cycle() != STEPPER_CYCLE_NONE) {
        return false;
    }
    *result = stepper_cycle_result();
    return true;
}

static gcode_outputs_t outputs(void) {
    stepper_outputs_t now;
    stepper_outputs(&now);
    return (gcode_outputs_t){now.turn, now.flood, now.mist};
}

const gcode_sink_t gcode_machine = {
    .target = stepper_target,
    .place = place,
    .check = check,
    .push = push,
    .ended = ended,
    .drops = stepper_drops,
    .outputs = outputs,
    .tell = tell,
};
