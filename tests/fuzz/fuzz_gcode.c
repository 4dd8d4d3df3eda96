// A session that feeds the G-code reader. A model of its own follows the lines that are right:
// every one of them must be accepted and end where the model says, whatever rubbish was refused
// before it.
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fuzz_corpus.h"
#include "fuzz_gcode_model.h"
#include "fuzz_machine.h"
#include "fuzz_random.h"
#include "fuzz_session.h"
#include "gcode/gcode.h"
#include "stepper/stepper_homing.h"
#include "stepper/stepper_outputs.h"
#include "stepper/stepper_outputs.h"

#define INPUTS 300
#define SETTLE_S 20.0 // virtual time for motion to end by itself

// ---- The machine --------------------------------------------------------------------------------

static void check_ok(err_t err, const char *what) {
    FUZZ_SESSION_CHECK(err == ERR_OK, "%s: %s", what, err_message());
}

static void configure_axis(axis_id_t axis) {
    static const double scales[] = {80, 400, 100.5, 5, 1600, 8.888889};
    static const double velocities[] = {6000, 1200, 60000, 100};
    static const double accelerations[] = {500, 100, 5000, 20};
    uint8_t first_gpio = (uint8_t)(2 + 3 * axis);
    stepper_axis_t config = {
        .step_gpio = first_gpio,
        .dir_gpio = (uint8_t)(first_gpio + 1),
        .enable_gpio = fuzz_random_percent(50) ? (uint8_t)(first_gpio + 2) : PINS_NONE,
        .dir_invert = fuzz_random_percent(30),
        .steps_per_unit = FUZZ_RANDOM_PICK(scales),
        .max_velocity = FUZZ_RANDOM_PICK(velocities),
        .max_acceleration = FUZZ_RANDOM_PICK(accelerations),
        .home_backoff_mm = 3,
    };
    check_ok(stepper_axis(axis, &config), "axis");
    if (axis != AXIS_A && fuzz_random_percent(30)) {
        check_ok(stepper_limits(axis, -200, 200), "limits");
    }
}

static void set_up_jerk(void) {
    static const double jerks[] = {500, 10000, 10000, 50000, 2e6, 1e9};
    const double none[AXIS_COUNT] = {0};
    check_ok(stepper_scurve(fuzz_random_percent(60)), "S-curve");
    check_ok(stepper_jerk(FUZZ_RANDOM_PICK(jerks), none), "jerk");
}

static void set_up(void) {
    static const uint32_t block_counts[] = {1, 2, 3, 8, 32, 32, 1024};
    stepper_init_t config = {
        .arc_tolerance_mm = 0.05,
        .blocks = FUZZ_RANDOM_PICK(block_counts),
        .estop_gpio = fuzz_random_percent(20) ? 22 : PINS_NONE,
    };
    check_ok(stepper_init(&config), "init");
    gcode_reset();
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (axis == AXIS_X || fuzz_random_percent(70)) {
            configure_axis(axis);
        }
    }
    fuzz_gcode_model.modal.spindle = fuzz_random_percent(70);
    fuzz_gcode_model.modal.fine = fuzz_random_percent(30);
    if (fuzz_gcode_model.modal.spindle) {
        stepper_spindle_t spindle = {
            .gpio = 20,
            .dir_gpio = PINS_NONE,
            .invert = fuzz_random_percent(30),
        };
        check_ok(stepper_spindle(&spindle), "spindle");
    }
    if (fuzz_random_percent(50)) {
        stepper_coolant_t coolant = {.flood_gpio = 16, .mist_gpio = 17};
        check_ok(stepper_coolant(&coolant), "coolant");
    }
    if (fuzz_random_percent(50)) {
        check_ok(stepper_probe_pin(18, fuzz_random_percent(50)), "probe");
    }
    set_up_jerk();
    if (fuzz_random_percent(30)) {
        check_ok(stepper_junction(fuzz_random_between(0, 50) / 100.0), "junction");
    }
    check_ok(stepper_set_home(), "home");
    if (fuzz_random_percent(80)) {
        check_ok(stepper_run(STEPPER_IDLE_HOLD), "run");
    }
    fuzz_machine_rebase();
}

// ---- Sending ------------------------------------------------------------------------------------

static void check_message(void) {
    char text[ERR_MESSAGE_SIZE + 8];
    snprintf(text, sizeof text, "%s%s", err_message(),
             fuzz_session_plant_now(FUZZ_PLANT_LONG_ERROR) ? "\nmore" : "");
    FUZZ_SESSION_CHECK(text[0] != '\0', "an error without a message");
    for (const char *p = text; *p != '\0'; p++) {
        FUZZ_SESSION_CHECK(isprint((unsigned char)*p), "byte %u in an error message",
                           (unsigned char)*p);
    }
}

// A line, in memory that ends with it, so that reading beyond is caught. Checks what holds for
// every line.
static err_t send(const fuzz_text_t *text) {
    fuzz_machine_t before;
    fuzz_machine_look(&before);
    fuzz_session_input(text);
    char exact[text->length + 1];
    memcpy(exact + 1, text->bytes, text->length);
    err_t err = gcode_line(exact + 1, text->length);
    if (err == ERR_OK) {
        fuzz_session->accepted++;
        return err;
    }
    if (fuzz_session_plant_now(FUZZ_PLANT_REFUSED_MOVES)) {
        stepper_dwell(1);
    }
    fuzz_session->refused++;
    check_message();
    fuzz_machine_check_unchanged(&before);
    return err;
}

// Whatever goes on ends, pauses as well.
static void settle_down(void) {
    do {
        check_ok(stepper_hold(false), "resume");
        fuzz_machine_settle(SETTLE_S);
    } while (stepper_paused());
}

// Entries of the last line may wait for room, or for the end of probing. What was accepted has to
// be carried out: only probing may fail. False: it took too long and was stopped.
static bool finish_line(bool probes) {
    uint64_t until_us = hal_time_us() + (uint64_t)(SETTLE_S * 1e6);
    gcode_background();
    while (gcode_busy() && hal_time_us() < until_us) {
        if (!gcode_must_wait()) {
            check_ok(stepper_run(STEPPER_IDLE_HOLD), "run");
        }
        check_ok(stepper_hold(false), "resume");
        hal_idle(hal_time_us() + 1000);
        stepper_background();
        gcode_background();
    }
    bool in_time = !gcode_busy();
    if (!in_time) {
        stepper_stop();
        fuzz_machine_settle(SETTLE_S);
        stepper_background();
        gcode_background();
    }
    FUZZ_SESSION_CHECK(!gcode_busy(), "a line never ends");
    err_t failure = gcode_failure();
    FUZZ_SESSION_CHECK(failure == ERR_OK || probes, "an accepted line failed: %s", err_message());
    return in_time;
}

// Time for a queue that is full, or a stop that is under way.
static void make_room(void) {
    check_ok(stepper_run(STEPPER_IDLE_HOLD), "run");
    check_ok(stepper_hold(false), "resume");
    uint64_t until_us = hal_time_us() + 10000000u;
    while ((stepper_blocks_free() == 0 || stepper_active() == 1) && hal_time_us() < until_us) {
        hal_idle(until_us);
        if (stepper_paused()) {
            check_ok(stepper_hold(false), "resume");
        }
        stepper_status_t status;
        stepper_status(&status);
        if (status.blocks_free > 0 && !status.stopping) {
            if (fuzz_gcode_model.stop_pending) {
                fuzz_gcode_model_follow_machine();
            }
            return;
        }
    }
    settle_down();
    fuzz_gcode_model_follow_machine();
}

static void send_right_line(void) {
    fuzz_text_t text = {.length = 0};
    fuzz_gcode_line_t line;
    double work_position[AXIS_COUNT];
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        work_position[axis] = fuzz_gcode_model.target[axis] - fuzz_gcode_model_offset(axis);
    }
    fuzz_gcode_right_line(&text, &line, &fuzz_gcode_model.modal, work_position);
    err_t err = send(&text);
    if (err == ERR_GCODE_BUFFER_FULL || err == ERR_STEPPER_STOPPING) {
        make_room();
        err = send(&text);
    }
    check_ok(err, "a right line was refused");
    bool in_time = finish_line(false);
    fuzz_gcode_model_follow(&line);
    if (!in_time) {
        fuzz_gcode_model_follow_machine();
    }
    fuzz_gcode_model_check();
    fuzz_session->moves += line.kind == FUZZ_GCODE_MOVE;
}

// The origin that the reader has now is taken over as G92 in the first system.
static void make_origin_known(void) {
    static const char *const zeros[] = {"G10 L2 P1 X0", "G10 L2 P1 Y0", "G10 L2 P1 Z0",
                                        "G10 L2 P1 A0"};
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (stepper_axis_configured(axis)) {
            for (char system = '1'; system <= '9'; system++) {
                char text[16];
                snprintf(text, sizeof text, "%s", zeros[axis]);
                text[8] = system;
                check_ok(gcode_line(text, strlen(text)), text);
            }
        }
    }
    fuzz_gcode_model_clear_origins();
}

// After a line the model does not understand: modes in force are made known again, and the machine
// is brought back to where right lines are in reach.
static void resynchronise(void) {
    static const char known[] = "G90 G91.1 G17 G21 G94 G54 G49 G92.1 G1 F1000";
    finish_line(true);
    if (gcode_line(known, sizeof known - 1) != ERR_OK) {
        settle_down();
        check_ok(gcode_line(known, sizeof known - 1), known);
    }
    gcode_take_end();
    fuzz_gcode_model.modal = (fuzz_gcode_modal_t){.has_motion = true,
                                                  .has_feed = true,
                                                  .spindle = fuzz_gcode_model.modal.spindle,
                                                  .fine = fuzz_gcode_model.modal.fine};
    make_origin_known();
    fuzz_gcode_model_follow_machine();
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (fuzz_gcode_model.target[axis] < -150 || fuzz_gcode_model.target[axis] > 150) {
            settle_down();
            stepper_clear();
            check_ok(stepper_set_home(), "home");
            gcode_clear_offsets();
            fuzz_gcode_model_follow_machine();
            fuzz_machine_rebase();
            return;
        }
    }
}

static void send_wild_line(void) {
    fuzz_text_t text = {.length = 0};
    switch (fuzz_random_below(8)) {
    case 0:
    case 1:
    case 2:
        fuzz_gcode_any_line(&text);
        break;
    case 3:
        fuzz_gcode_any_line(&text);
        fuzz_text_mutate(&text);
        break;
    case 4:
        fuzz_corpus_pick(FUZZ_CORPUS_GCODE, &text);
        break;
    case 5:
        fuzz_corpus_pick(FUZZ_CORPUS_GCODE, &text);
        fuzz_text_mutate(&text);
        break;
    case 6:
        fuzz_text_noise(&text, fuzz_random_below(80));
        break;
    default: // a line of 10 kB
        while (text.length < 10000) {
            fuzz_gcode_any_line(&text);
        }
        break;
    }
    if (send(&text) == ERR_OK) {
        resynchronise();
    }
}

// ---- What else happens meanwhile ----------------------------------------------------------------

static void settle(void) {
    settle_down();
    fuzz_gcode_model_follow_machine();
}

// From rest, with second thoughts.
static void jog(void) {
    settle();
    fuzz_session_note("jog");
    for (int i = fuzz_random_between(1, 4); i > 0; i--) {
        axis_id_t axis = (axis_id_t)fuzz_random_below(AXIS_COUNT);
        double distance =
            fuzz_random_percent(20) ? HUGE_VAL : fuzz_random_between(-9000, 9000) / 1e3;
        if (stepper_jog(axis, distance, fuzz_random_between(0, 5000)) != ERR_OK) {
            check_message();
        }
        uint64_t until_us = hal_time_us() + fuzz_random_below(200000);
        while (hal_time_us() < until_us) {
            hal_idle(until_us);
        }
    }
    check_ok(stepper_jog_stop(), "jog stop");
    settle();
    resynchronise();
}

static void turn_a_knob(void) {
    switch (fuzz_random_below(4)) {
    case 0:
        fuzz_session_note("hold");
        check_ok(stepper_hold(true), "hold");
        break;
    case 1:
        fuzz_session_note("resume");
        check_ok(stepper_hold(false), "resume");
        break;
    default:
        fuzz_session_note("override");
        check_ok(stepper_override(fuzz_random_between(STEPPER_OVERRIDE_MIN, STEPPER_OVERRIDE_MAX),
                                  fuzz_random_between(STEPPER_OVERRIDE_MIN, 100)),
                 "override");
        break;
    }
}

static void press_a_button(void) {
    switch (fuzz_random_below(6)) {
    case 5:
        jog();
        break;
    case 0:
        fuzz_session_note("stop");
        stepper_stop();
        break;
    case 1:
        fuzz_session_note("emergency stop, home, run");
        stepper_estop();
        check_ok(stepper_set_home(), "home after an emergency stop");
        check_ok(stepper_run(STEPPER_IDLE_DISABLE), "run");
        fuzz_machine_rebase();
        break;
    case 2:
        fuzz_session_note("clear");
        stepper_clear();
        break;
    case 3:
        fuzz_session_note("run");
        check_ok(stepper_run(fuzz_random_percent(50) ? STEPPER_IDLE_HOLD : STEPPER_IDLE_DISABLE),
                 "run");
        break;
    default:
        fuzz_session_note("set position");
        if (stepper_set_position(AXIS_X, fuzz_random_between(-50, 50)) == ERR_OK) {
            fuzz_machine_rebase();
        }
        break;
    }
    fuzz_gcode_model_follow_machine();
}

static void let_time_pass(void) {
    uint64_t until_us = hal_time_us() + fuzz_random_below(20000);
    while (hal_time_us() < until_us) {
        hal_idle(until_us);
    }
    if (fuzz_gcode_model.stop_pending) {
        fuzz_gcode_model_follow_machine();
    }
    fuzz_gcode_model_check();
}

void fuzz_gcode_session(void) {
    fuzz_machine_watch();
    set_up();
    fuzz_gcode_model_follow_machine();
    for (unsigned i = 0; i < INPUTS; i++) {
        if (fuzz_random_percent(60)) {
            send_right_line();
        } else {
            send_wild_line();
        }
        if (fuzz_random_percent(3)) {
            press_a_button();
        }
        if (fuzz_random_percent(30)) {
            let_time_pass();
            fuzz_machine_check_pulses();
        }
        if (fuzz_random_percent(5)) {
            turn_a_knob();
        }
        if (fuzz_random_percent(2)) {
            settle();
        }
    }
    settle();
}
