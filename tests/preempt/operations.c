// Context: main loop.
#include "operations.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "gcode/gcode.h"
#include "host_clock.h"
#include "host_pads.h"
#include "model.h"
#include "preempt.h"
#include "probes.h"
#include "stepper/stepper_safety.h"
#include "tests/fuzz/fuzz_random.h"
#include "tests/unit/stepper/watch.h"

#define REACH 300 // hundredths of a unit from zero

operations_counts_t operations_counts;

void operations_resume(void) {
    if (model.held) {
        must("STEPPER RESUME");
        model.held = false;
    }
}

void operations_arm(void) {
    if (!model.armed) {
        must(fuzz_random_percent(50) ? "STEPPER RUN" : "STEPPER RUN 1");
        model.armed = true;
    }
}

// A line that the machine must take as soon as there is room.
static void queue_line(const char *line) {
    bool from_program = fuzz_random_percent(30);
    uint64_t until_us = hal_time_us() + MODEL_WAIT_US;
    for (;;) {
        err_t err = from_program ? command("STEPPER GC %s", line) : gcode_line(line, strlen(line));
        commands_count += !from_program;
        if (err == ERR_OK) {
            model.entries++;
            return;
        }
        operations_counts.refused++;
        if (!refused_for(ERR_GCODE_BUFFER_FULL) && !refused_for(ERR_STEPPER_STOPPING)) {
            fail("%s: %s", line, err_message());
        }
        check(hal_time_us() < until_us, "there is no room in the queue for ever");
        operations_resume();
        operations_arm();
        wait_us(500);
    }
}

static void choose_place(int place[AXIS_COUNT]) {
    int along = fuzz_random_between(-REACH, REACH) / 4;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (model.straight) {
            place[axis] = model.direction[axis] * along;
        } else {
            place[axis] =
                fuzz_random_percent(40) ? model.place[axis] : fuzz_random_between(0, REACH);
        }
    }
}

static void move_to(const int place[AXIS_COUNT], int feed) {
    char line[120];
    int32_t steps[AXIS_COUNT];
    int length = 0;
    bool moves = false;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        steps[axis] = place[axis] * (int32_t)model_axes[axis].steps_per_unit / 100;
        moves |= steps[axis] != model.steps[axis];
    }
    if (!moves) {
        return;
    }
    length = snprintf(line, sizeof line, feed > 0 ? "G1 F%d " : "G0 ", feed);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        length += snprintf(line + length, sizeof line - (size_t)length, "%c%.2f ",
                           STEPPER_AXIS_LETTERS[axis], place[axis] / 100.0);
        model.pulses[axis] += (uint64_t)abs(steps[axis] - model.steps[axis]);
    }
    if (model.pwm && model.spindle && fuzz_random_percent(30)) {
        model.rpm = fuzz_random_between(0, 10) * (MODEL_RPM_MAX / 10);
        snprintf(line + length, sizeof line - (size_t)length, "S%d", model.rpm);
    }
    memcpy(model.steps, steps, sizeof steps);
    memcpy(model.place, place, sizeof model.place);
    model.place_known = true;
    operations_counts.moves++;
    queue_line(line);
}

// mm/min; 0: rapid
static int choose_feed(void) {
    return fuzz_random_percent(20) ? 0 : fuzz_random_between(5, 80) * 100;
}

// One move, or the same way in many short pieces.
static void do_move(void) {
    int from[AXIS_COUNT], to[AXIS_COUNT], place[AXIS_COUNT];
    int feed = choose_feed();
    memcpy(from, model.place, sizeof from);
    choose_place(to);
    int pieces = fuzz_random_percent(50) && model.place_known ? fuzz_random_between(2, 12) : 1;
    for (int i = 1; i <= pieces; i++) {
        for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
            place[axis] = from[axis] + (to[axis] - from[axis]) * i / pieces;
        }
        if (model.straight) { // on the line to the hundredth
            int along = from[0] / model.direction[0];
            along += (to[0] / model.direction[0] - along) * i / pieces;
            for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
                place[axis] = model.direction[axis] * along;
            }
        }
        move_to(i == pieces ? to : place, feed);
        feed = fuzz_random_percent(30) ? choose_feed() : feed;
    }
}

// Quarter turns about a centre in hundredths end in hundredths.
static void do_arc(void) {
    static const axis_id_t planes[3][2] = {{AXIS_X, AXIS_Y}, {AXIS_Z, AXIS_X}, {AXIS_Y, AXIS_Z}};
    static const char letters[AXIS_COUNT] = "IJK";
    if (!model.place_known) {
        return;
    }
    unsigned plane = fuzz_random_below(3);
    axis_id_t first = planes[plane][0];
    axis_id_t second = planes[plane][1];
    int centre[2] = {fuzz_random_between(5, 60), fuzz_random_between(5, 60)};
    bool clockwise = fuzz_random_percent(50);
    int quarters = fuzz_random_between(1, 4);
    int turned[2] = {-centre[0], -centre[1]};
    for (int i = 0; i < (clockwise ? 4 - quarters : quarters); i++) {
        int x = turned[0];
        turned[0] = -turned[1];
        turned[1] = x;
    }
    model.place[first] += centre[0] + turned[0];
    model.place[second] += centre[1] + turned[1];
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        model.steps[axis] = model.place[axis] * (int32_t)model_axes[axis].steps_per_unit / 100;
    }
    char line[120];
    snprintf(line, sizeof line, "G%u G%d F%d %c%.2f %c%.2f %c%.2f %c%.2f", 17 + plane,
             clockwise ? 2 : 3, fuzz_random_between(5, 80) * 100, STEPPER_AXIS_LETTERS[first],
             model.place[first] / 100.0, STEPPER_AXIS_LETTERS[second], model.place[second] / 100.0,
             letters[first], centre[0] / 100.0, letters[second], centre[1] / 100.0);
    operations_counts.moves++;
    queue_line(line);
}

// What a curved session has more of: arcs, and corners in all the ways there are.
static void do_curve(void) {
    static const char *const modes[] = {"G64 P0.05", "G64 P0.005", "G61", "G61.1", "G64"};
    if (fuzz_random_percent(20)) {
        const char *mode = FUZZ_RANDOM_PICK(modes);
        check(gcode_line(mode, strlen(mode)) == ERR_OK, err_message());
    } else {
        do_arc();
    }
}

static void do_other_entry(void) {
    char line[32];
    if (fuzz_random_percent(50)) {
        snprintf(line, sizeof line, "G4 P%d", fuzz_random_between(0, 20));
    } else {
        model.spindle = !model.spindle;
        model.rpm = fuzz_random_between(0, 10) * (MODEL_RPM_MAX / 10);
        snprintf(line, sizeof line, model.spindle ? "M3 S%d" : "M5", model.rpm);
    }
    queue_line(line);
}

static void do_hold(void) {
    must(model.held ? "STEPPER RESUME" : "STEPPER HOLD");
    model.held = !model.held;
    operations_counts.holds++;
}

static void do_override(void) {
    bool rapid = fuzz_random_percent(30);
    int percent = fuzz_random_between(STEPPER_OVERRIDE_MIN, rapid ? 100 : STEPPER_OVERRIDE_MAX);
    if (command("STEPPER OVERRIDE %s,%d", rapid ? "RAPID" : "FEED", percent) != ERR_OK) {
        fail("override: %s", err_message());
    }
}

static void do_look(void) {
    stepper_status_t status;
    stepper_status(&status);
    check_status(&status);
    check_position();
    if (fuzz_random_percent(30)) {
        must("STEPPER STATUS");
    }
    if (fuzz_random_percent(30)) {
        must("a = PEEK(STEPPER X) + PEEK(STEPPER BUFFER) + PEEK(STEPPER STATUS)");
    }
}

// Refused while anything moves or waits; nothing may change then.
static void do_what_is_refused(void) {
    static const char *const lines[] = {"STEPPER POSITION X,1", "STEPPER POSITION HOME",
                                        "STEPPER AXIS Y,GP5,GP6,0,0,400,3000,1500,3",
                                        "STEPPER SPINDLE GP14", "STEPPER INIT"};
    unsigned which = fuzz_random_below(COUNT_OF_ARRAY(lines));
    if (!model.held && model.armed) {
        return; // the queue may drain at any moment
    }
    wait_us(model.held ? 200000 : 0); // to stand
    stepper_status_t status;
    stepper_status(&status);
    if (status.blocks_free < status.blocks) {
        check(command("%s", lines[which]) != ERR_OK, "accepted while moves wait");
        operations_counts.refused++;
    }
}

static void stand_at_home(void) {
    must("STEPPER POSITION HOME");
    watch_set_position((const int32_t[AXIS_COUNT]){0});
    memset(model.steps, 0, sizeof model.steps);
    memset(model.place, 0, sizeof model.place);
    model.place_known = true;
}

static void do_stop(void) {
    must("STEPPER STOP");
    operations_counts.stops++;
    model.held = false;
    if (fuzz_random_percent(50)) {
        do_look();
    }
    wait_for_rest();
    follow_machine();
}

static void do_clear(void) {
    err_t err = command("STEPPER CLEAR");
    if (err == ERR_OK) {
        check(stepper_active() == 0, "cleared while something moves");
        operations_counts.stops++;
        follow_machine();
    } else {
        check(refused_for(ERR_CLEAR_WHILE_ACTIVE), err_message());
        operations_counts.refused++;
    }
}

static void after_emergency_stop(void) {
    uint64_t stopped_ns = host_clock_now_ns();
    model.held = model.armed = model.spindle = false;
    check_position();
    wait_us(3000);
    check(watch_last_step_ns() <= stopped_ns, "a step after an emergency stop");
    check_position();
    follow_machine();
    stand_at_home();
    operations_arm();
    operations_counts.stops++;
}

static void do_emergency_stop(void) {
    must("STEPPER ESTOP");
    after_emergency_stop();
}

static void press_estop(void) {
    host_pads_drive(MODEL_ESTOP_GPIO, false);
}

// The input is pulled low while a line is on its way.
static void do_estop_input(void) {
    operations_arm(); // or nobody looks at the input
    preempt_do_soon(press_estop);
    for (int i = 0; i < 4; i++) {
        static const char line[] = "G1 F600 X1 Y1 Z1 A1";
        gcode_line(line, sizeof line - 1);
        do_look();
    }
    preempt_do_soon(NULL);
    press_estop();
    wait_us(20);
    stepper_status_t status;
    stepper_status(&status);
    check(stepper_alarm() == STEPPER_ALARM_ESTOP && !status.armed, "the E-STOP input was not seen");
    host_pads_drive(MODEL_ESTOP_GPIO, true);
    command("STEPPER CLEAR"); // which tells what has happened
    after_emergency_stop();
}

static void press_limit(void) {
    host_pads_drive(MODEL_LIMIT_GPIO, false);
}

// The switch closes while the tick is told to count further, or while a line is on its way.
static void do_limit_input(void) {
    operations_arm();
    unsigned samples = 1;
    preempt_do_soon(press_limit);
    for (int i = 0; i < 4; i++) {
        static const char line[] = "G1 F600 X1 Y1 Z1 A1";
        samples = fuzz_random_below(6) + 1;
        if (command("STEPPER HWLIMITS FILTER %u", samples) != ERR_OK) {
            fail("filter: %s", err_message());
        }
        gcode_line(line, sizeof line - 1);
        do_look();
    }
    preempt_do_soon(NULL);
    press_limit();
    wait_us(10 * samples + 20);
    stepper_status_t status;
    stepper_status(&status);
    check(stepper_alarm() == STEPPER_ALARM_LIMIT && !status.armed, "the switch was not seen");
    check_position();
    host_pads_drive(MODEL_LIMIT_GPIO, true);
    must("STEPPER RECOVER");
    after_emergency_stop();
}

// Jogs from rest, changes its mind on the way, and brakes.
static void do_jog(void) {
    operations_resume();
    operations_arm();
    wait_for_rest();
    for (unsigned i = fuzz_random_below(4) + 1; i > 0; i--) {
        char distance[16];
        snprintf(distance, sizeof distance, "%.2f", fuzz_random_between(-REACH, REACH) / 100.0);
        err_t err =
            command("STEPPER JOG %c,%s", STEPPER_AXIS_LETTERS[fuzz_random_below(AXIS_COUNT)],
                    fuzz_random_percent(30) ? "+" : distance);
        // In the last moments of a jog the next one has to wait.
        check(err == ERR_OK || refused_for(ERR_STEPPER_STOPPING), err_message());
        wait_us(fuzz_random_below(30000));
        check_position();
    }
    stepper_status_t status;
    static const char line[] = "G1 F600 X1";
    bool queued = fuzz_random_percent(30) && gcode_line(line, sizeof line - 1) == ERR_OK;
    stepper_status(&status);
    check(!queued || !status.jogging, "a move was queued while jogging");
    must("STEPPER JOG STOP");
    wait_for_rest();
    follow_machine();
}

static void do_probe(void) {
    operations_resume();
    operations_arm();
    wait_for_rest();
    probes_do_one();
    wait_for_rest();
    follow_machine();
}

static void do_home(void) {
    operations_resume();
    operations_arm();
    wait_for_rest();
    probes_home_one();
    wait_for_rest();
    stand_at_home();
    follow_machine();
}

static void let_time_pass(void) {
    wait_us(fuzz_random_below(fuzz_random_percent(70) ? 3000 : 40000));
}

void operations_do_one(void) {
    switch (fuzz_random_below(model.calm ? 14 : 23)) {
    case 0:
        if (model.curved) {
            do_curve();
        }
        do_move();
        break;
    case 4:
    case 1:
    case 2:
    case 3:
        do_move();
        break;
    case 5:
        if (model.curved) {
            do_curve();
        }
        do_other_entry();
        break;
    case 6:
    case 7:
        do_hold();
        break;
    case 8:
        do_override();
        break;
    case 9:
    case 10:
        do_look();
        break;
    case 11:
        do_what_is_refused();
        break;
    case 12:
        operations_arm();
        break;
    case 13:
        let_time_pass();
        break;
    case 14:
        do_stop();
        break;
    case 15:
        do_clear();
        break;
    case 16:
        do_jog();
        break;
    case 17:
    case 18:
        do_probe();
        break;
    case 19:
        do_home();
        break;
    default:
        operations_resume();
        do_move(); // to have something to stop
        switch (fuzz_random_below(3)) {
        case 0:
            do_emergency_stop();
            break;
        case 1:
            do_estop_input();
            break;
        default:
            do_limit_input();
            break;
        }
        break;
    }
}
