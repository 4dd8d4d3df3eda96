// E-STOP or a limit switch at every seventh tick of a program of two seconds in which four axes
// move, with spindle and coolant on: no step after the next tick (the last sample of the filter),
// outputs off in their order, the position exact, everything refused until it is acknowledged, and
// the recovery exact. This process goes along the program, with noise on the inputs; at each moment
// a child process pulls the input and judges.
// usage: trip_sweep estop|limit [EVERY_TICKS]
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include <unity.h>

#include "bench.h"
#include "host_clock.h"
#include "host_pads.h"
#include "host_tick.h"
#include "stepper/stepper_safety.h"

#define TICK_US 10u
#define FLOOD_GPIO 16u
#define LIMIT_GPIO 20u
#define FILTER 3u
#define RECOVER_EVERY 10u // so many children go on to the end of the recovery
#define EDGES_MAX 64u

// What the pins of the outputs did since the input was pulled, one after another.
static struct {
    uint32_t changed[EDGES_MAX];
    unsigned count;
    bool records;
} edges;

static struct {
    bool limit; // else E-STOP
    bool keeps; // drivers
    unsigned every_ticks;
    unsigned cases;
    uint64_t start_ns;
} sweep;

static _Noreturn void __attribute__((format(printf, 1, 2))) fail(const char *format, ...) {
    va_list args;
    va_start(args, format);
    printf("FAILED: trip at %.3f ms: ", (double)(host_clock_now_ns() - sweep.start_ns) * 1e-6);
    vprintf(format, args);
    va_end(args);
    printf("\n");
    fflush(stdout);
    _exit(1);
}

static void must(err_t err, err_t wanted, const char *what) {
    if (err != wanted) {
        fail("%s: %s", what, err == ERR_OK ? "was not refused" : err_message());
    }
}

static uint32_t step_pins(void) {
    uint32_t pins = 0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        pins |= pins_mask(bench_axes[axis].step_gpio);
    }
    return pins;
}

static uint32_t enable_pins(void) {
    uint32_t pins = 0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        pins |= pins_mask(bench_axes[axis].enable_gpio);
    }
    return pins;
}

static void record(void *state, uint64_t time_ns, uint32_t changed, uint32_t levels) {
    (void)state;
    (void)time_ns;
    (void)levels;
    if (edges.records && edges.count < EDGES_MAX) {
        edges.changed[edges.count++] = changed;
    }
}

// ---- The program --------------------------------------------------------------------------------

static void queue_program(void) {
    const stepper_arc_t circle = {
        .move = {.target = {20, 10, 1, 60}, .feed = 5000},
        .plane = {AXIS_X, AXIS_Y},
        .centre = {-5, 0},
        .turns = 1,
    };
    stepper_spindle_switch(STEPPER_SPINDLE_CW, 0);
    stepper_coolant_switch(true, false);
    bench_move(20, 10, 1, 60, 6000);
    stepper_arc(&circle);
    for (int i = 1; i <= 12; i++) {
        bench_move(20 - i, 10 + i % 2, 1 - 0.1 * i, 60 - 10 * i, 4000);
    }
    stepper_dwell(120);
    bench_move(8.2, 10, -0.2, -60, 0);
    bench_move(30, -5, 0.5, 90, 0);
    bench_move(29.5, -5, 0.5, 90, 100); // slow: some steps in a hundred ticks
    bench_move(0, 0, 0, 0, 6000);
}

static void start_program(void) {
    bench_start_with(NULL, 64, sweep.keeps);
    const stepper_coolant_t coolant = {.flood_gpio = FLOOD_GPIO, .mist_gpio = PINS_NONE};
    stepper_hwlimits_t limits = {.active_high = 1u << STEPPER_Z_MAX};
    memset(limits.gpio, PINS_NONE, sizeof limits.gpio);
    limits.gpio[STEPPER_Z_MAX] = LIMIT_GPIO;
    must(stepper_coolant(&coolant), ERR_OK, "COOLANT");
    must(stepper_hwlimits(&limits), ERR_OK, "HWLIMITS");
    must(stepper_filter(FILTER, 1), ERR_OK, "FILTER");
    must(stepper_limit_keep(sweep.keeps), ERR_OK, "KEEP");
    stepper_hold(true);
    queue_program();
    stepper_hold(false);
    sweep.start_ns = host_clock_now_ns();
}

// ---- What must hold -----------------------------------------------------------------------------

static void press(bool pressed) {
    if (sweep.limit) {
        host_pads_drive(LIMIT_GPIO, pressed);
    } else {
        host_pads_drive(BENCH_ESTOP_GPIO, !pressed);
    }
}

static void check_position(void) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (bench.motors[axis].position_steps != stepper_position_steps(axis)) {
            fail("%c says it is at %d steps, its pins say %lld", STEPPER_AXIS_LETTERS[axis],
                 (int)stepper_position_steps(axis), (long long)bench.motors[axis].position_steps);
        }
    }
}

// Step pins fall, then the spindle goes off, then the coolant, then the drivers.
static void check_order(void) {
    const uint32_t groups[] = {step_pins(), pins_mask(BENCH_SPINDLE_GPIO), pins_mask(FLOOD_GPIO),
                               enable_pins()};
    unsigned group = 0;
    for (unsigned i = 0; i < edges.count; i++) {
        while (group < COUNT_OF_ARRAY(groups) && (edges.changed[i] & groups[group]) == 0) {
            group++;
        }
        if (group == COUNT_OF_ARRAY(groups)) {
            fail("edge %u of the outputs is out of order", i);
        }
    }
}

static void check_outputs(void) {
    uint32_t pins = hal_pins_read();
    if ((pins & pins_mask(BENCH_SPINDLE_GPIO)) != 0 || (pins & pins_mask(FLOOD_GPIO)) != 0) {
        fail("spindle or coolant is on");
    }
    if ((pins & enable_pins()) != (sweep.keeps ? 0 : enable_pins())) {
        fail("the drivers are %s", sweep.keeps ? "off" : "on");
    }
    if ((pins & step_pins()) != 0) {
        fail("a step pin is high");
    }
}

// The speed of the fastest motor says whether the position may have been lost. `pause_ns`: since
// the last step before the input was pulled.
static void check_knowledge(uint64_t pause_ns) {
    bool known = (stepper_status_bits() & STEPPER_STATUS_POSITION_KNOWN) != 0;
    if (known && pause_ns < 300000) {
        fail("the position is known, though a motor was at speed");
    }
    if (!known && pause_ns > 60000000 && pause_ns < 110000000) { // in the dwell of 120 ms
        fail("the position is unknown, though nothing moved");
    }
}

static void check_refusals(void) {
    const stepper_move_t move = {.target = {1, 2, 3, 4}, .feed = 600};
    if (!sweep.limit) {
        must(stepper_run(STEPPER_IDLE_HOLD), ERR_ESTOP_ACTIVE, "RUN under E-STOP");
        must(stepper_recover(), ERR_ESTOP_ACTIVE, "RECOVER under E-STOP");
        must(stepper_set_home(), ERR_ESTOP_ACTIVE, "POSITION under E-STOP");
        press(false);
    }
    must(stepper_run(STEPPER_IDLE_HOLD), ERR_ALARM, "RUN");
    must(stepper_move(&move), ERR_ALARM, "a move");
    must(stepper_jog(AXIS_X, 1, 0), ERR_ALARM, "a jog");
    must(stepper_dwell(1), ERR_ALARM, "a dwell");
}

static void check_events(void) {
    stepper_event_t wanted = sweep.limit ? STEPPER_EVENT_LIMIT : STEPPER_EVENT_ESTOP;
    if (stepper_next_event() != wanted || stepper_next_event() != STEPPER_EVENT_NONE) {
        fail("the event was not told once");
    }
    stepper_trip_t trip;
    stepper_last_trip(&trip);
    if (trip.estop == sweep.limit || trip.switches != (sweep.limit ? 1u << STEPPER_Z_MAX : 0)) {
        fail("the wrong input is told");
    }
}

static void pull_and_judge(void) {
    stepper_next_event(); // what was before is none of it
    uint64_t pause_ns = host_clock_now_ns() - bench.last_step_ns;
    uint32_t drops = stepper_drops();
    edges.records = true;
    press(true);
    edges.count = 0;
    uint64_t last_ns = host_clock_now_ns() + (sweep.limit ? FILTER - 1 : 0) * TICK_US * 1000u;
    bench_wait_us((sweep.limit ? FILTER : 1) * TICK_US);
    if (bench.last_step_ns > last_ns) {
        fail("a step %.3f ms too late", (double)(bench.last_step_ns - last_ns) * 1e-6);
    }
    check_outputs(); // all of it has been done already
    edges.records = false;
    if (!sweep.limit) {
        check_order();
    }
    uint64_t last_step_ns = bench.last_step_ns;
    bench_wait_us(1500);
    if (bench.last_step_ns != last_step_ns) {
        fail("a step after the stop");
    }
    check_position();
    stepper_status_t status;
    stepper_status(&status);
    if (status.armed || status.moving || status.blocks_free != status.blocks ||
        stepper_alarm() != (sweep.limit ? STEPPER_ALARM_LIMIT : STEPPER_ALARM_ESTOP)) {
        fail("armed, moving, queued or without alarm");
    }
    if (stepper_drops() == drops) {
        fail("the drop of the queue is not counted");
    }
    check_knowledge(pause_ns);
    check_events();
    check_refusals();
}

// RECOVER, then a move that ends exactly; on a pressed limit switch only a jog off it.
static void recover(void) {
    const stepper_move_t move = {.target = {1, 1, 1, 1}, .feed = 6000};
    must(stepper_recover(), ERR_OK, "RECOVER");
    must(stepper_run(STEPPER_IDLE_HOLD), ERR_OK, "RUN");
    must(stepper_set_home(), ERR_OK, "POSITION HOME");
    int64_t start[AXIS_COUNT];
    if (sweep.limit) {
        must(stepper_move(&move), ERR_LIMIT_ACTIVE, "a move on a switch");
        must(stepper_jog(AXIS_Z, 1, 0), ERR_LIMIT_ACTIVE, "a jog towards the switch");
        must(stepper_jog(AXIS_Z, -0.1, 0), ERR_OK, "a jog off the switch");
        bench_finish(2);
        press(false);
        bench_wait_us(1000);
        stepper_overridden();
        bench_wait_us(30000);
        must(stepper_set_home(), ERR_OK, "POSITION HOME");
    }
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        start[axis] = bench.motors[axis].position_steps;
    }
    must(stepper_move(&move), ERR_OK, "a move");
    bench_finish(3);
    bench_wait_us(3000);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        int64_t made = bench.motors[axis].position_steps - start[axis];
        if (made != (int64_t)bench_axes[axis].steps_per_unit) {
            fail("behind the recovery %c has made %lld steps", STEPPER_AXIS_LETTERS[axis],
                 (long long)made);
        }
    }
    if (stepper_alarm() != STEPPER_ALARM_NONE) {
        fail("an alarm is left");
    }
}

static bool judge_in_a_child(bool with_recovery) {
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        pull_and_judge();
        if (with_recovery) {
            recover();
        }
        _exit(0);
    }
    int status = 1;
    waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) {
        printf("FAILED: trip at %.3f ms: signal %d\n",
               (double)(host_clock_now_ns() - sweep.start_ns) * 1e-6, WTERMSIG(status));
    }
    return child > 0 && status == 0;
}

void setUp(void) {} // bench.c asks for Unity
void tearDown(void) {}

// Within the time of one case: one sample less than the filter wants.
static void make_noise(void) {
    host_pads_drive(LIMIT_GPIO, true);
    bench_wait_us((FILTER - 1) * TICK_US);
    host_pads_drive(LIMIT_GPIO, false);
}

int main(int argc, char **argv) {
    sweep.limit = argc > 1 && strcmp(argv[1], "limit") == 0;
    sweep.every_ticks = argc > 2 ? (unsigned)atoi(argv[2]) : 7;
    host_pads_drive(BENCH_ESTOP_GPIO, true);
    host_pads_drive(LIMIT_GPIO, false);
    simulate_observe(record, NULL);
    start_program();
    bench_wait_us((host_tick_next_ns() - host_clock_now_ns()) / 1000 + TICK_US / 2);
    while (stepper_active() > 0) {
        if (!judge_in_a_child(sweep.cases % RECOVER_EVERY == 0)) {
            return 1;
        }
        sweep.cases++;
        make_noise();
        bench_wait_us((sweep.every_ticks - FILTER + 1) * TICK_US);
    }
    double program_s = (double)(host_clock_now_ns() - sweep.start_ns) * 1e-9;
    check_position();
    if (stepper_alarm() != STEPPER_ALARM_NONE) {
        fail("noise has stopped the machine");
    }
    if (stepper_position_steps(AXIS_X) != 0 || program_s < 2.0) {
        fail("the program did not come to its end");
    }
    printf("%u trips in %.2f s of program\n", sweep.cases, program_s);
    return 0;
}
