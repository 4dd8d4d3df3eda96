// Feed hold and resume at every tenth tick of a program of three seconds, jerk-limited or not:
// nothing is lost, limits are kept, the end is exact. This process goes along the program; at each
// moment a child process holds, resumes and judges.  usage: hold_sweep trapezoid|scurve
// [EVERY_TICKS [hard|stop]], where the last is a fault to plant: it brakes too hard, or stops
// instead of holding.
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include <unity.h>

#include "bench.h"
#include "host_clock.h"
#include "watch.h"

#define TICK_US 10u
#define SCALE 200.0 // steps per unit, all axes
#define SPEED 100.0 // units/s
#define ACCELERATION 2000.0
#define JERK 50000.0
#define JUNCTION_MM 0.002
// Speed of Y that the corners of the zigzag change at once: 100.4 degrees, so r = 1.78 times the
// deviation and v^2 = ACCELERATION * r, twice v * sin(50.2 degrees).
#define CORNER_JUMP 4.1
#define PARTS_MAX 16
#define LOOK_BACK_NS                                                                               \
    10000000u           // limits are judged from that long before the hold: no longer than a dwell
#define WHOLE_EVERY 40u // so many children go on to the end of the program

// The program is made of parts that begin and end at rest. Behind one the machine is as it would
// have been without a hold, so most children end there.
typedef struct {
    uint32_t entries; // of the queue, up to the end of the part
    uint64_t pulses[AXIS_COUNT];
    int32_t steps[AXIS_COUNT];
    bool straight; // along one line: no corners
} part_t;

static struct {
    bool scurve;
    bool plant_hard, plant_stop;
    unsigned every_ticks;
    part_t parts[PARTS_MAX];
    unsigned count;
    double place[AXIS_COUNT];
    uint32_t entries;
    uint64_t start_ns;
} sweep;

static _Noreturn void __attribute__((format(printf, 1, 2))) fail(const char *format, ...) {
    va_list args;
    va_start(args, format);
    printf("FAILED: hold at %.2f ms: ", (double)(host_clock_now_ns() - sweep.start_ns) * 1e-6);
    vprintf(format, args);
    va_end(args);
    printf("\n");
    fflush(stdout);
    _exit(1);
}

// ---- The program --------------------------------------------------------------------------------

static void go(double x, double y, double z, double a, double feed) {
    const double place[AXIS_COUNT] = {x, y, z, a};
    bench_move(x, y, z, a, feed);
    memcpy(sweep.place, place, sizeof place);
    sweep.entries++;
}

static void end_part(bool straight, double dwell_ms) {
    part_t *part = &sweep.parts[sweep.count++];
    part->entries = sweep.entries;
    part->straight = straight;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        part->steps[axis] = (int32_t)lround(sweep.place[axis] * SCALE);
    }
    stepper_dwell(dwell_ms);
    sweep.entries++;
}

static void queue_short_pieces(void) {
    for (int i = 1; i <= 130; i++) {
        go(40 - 15.0 / 130 * i, 10 - 3.0 / 130 * i, 1.5 / 130 * i, 0, 5000);
    }
    end_part(true, 15);
}

static void queue_arc(void) {
    for (int i = 1; i <= 60; i++) {
        double angle = M_PI * i / 60;
        go(25 - 5 * sin(angle), 7 + 5 - 5 * cos(angle), 1.5 - 0.01 * i, i, 3000);
    }
    end_part(false, 50);
}

static void queue_corners(void) {
    for (int i = 1; i <= 8; i++) {
        go(25 - 2.5 * i, 17 + i % 2 * 3, 0.9, 60, 4000);
    }
    end_part(false, 25);
}

static void queue_program(void) {
    sweep.count = 0;
    sweep.entries = 0;
    go(40, 0, 0, 0, 6000);
    end_part(true, 20);
    go(40, 10, 0, 0, 0);
    end_part(true, 10);
    queue_short_pieces();
    queue_arc();
    queue_corners();
    go(4.7, 17, 0.9, 60, 200); // slow: some steps in a hundred ticks
    end_part(true, 10);
    go(2, 12, 1.9, 30, 6000);
    end_part(true, 10);
    go(0, 0, 0, 0, 0);
    end_part(true, 10);
}

static void start_program(void) {
    const stepper_axis_t axis = {.steps_per_unit = SCALE,
                                 .max_velocity = SPEED * 60,
                                 .max_acceleration = ACCELERATION * (sweep.plant_hard ? 1.2 : 1),
                                 .home_backoff_mm = 3};
    const double no_limits[AXIS_COUNT] = {0};
    bench_start_with(&axis, 512, false);
    stepper_junction(JUNCTION_MM);
    stepper_scurve(sweep.scurve);
    stepper_jerk(JERK, no_limits);
    stepper_hold(true);
    queue_program();
    watch_reset();
    sweep.start_ns = host_clock_now_ns();
    stepper_hold(false);
}

// ---- What must hold -----------------------------------------------------------------------------

static uint32_t executed(void) {
    stepper_status_t status;
    stepper_status(&status);
    if (status.underruns != 0) {
        fail("the tick ran dry at speed");
    }
    return status.executed;
}

static void check_place(const part_t *part) {
    int32_t steps[AXIS_COUNT];
    watch_position(steps);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (steps[axis] != part->steps[axis]) {
            fail("%c is at %d steps instead of %d", STEPPER_AXIS_LETTERS[axis], (int)steps[axis],
                 (int)part->steps[axis]);
        }
        if (watch_pulses(axis) != part->pulses[axis]) {
            fail("%c has made %llu steps instead of %llu", STEPPER_AXIS_LETTERS[axis],
                 (unsigned long long)watch_pulses(axis), (unsigned long long)part->pulses[axis]);
        }
    }
}

static void check_limits(const part_t *part, uint64_t from_ns) {
    double jump = part->straight ? 0.0 : CORNER_JUMP;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        double speed = watch_excess(axis, 1, SPEED, 0.0, from_ns);
        double acceleration = watch_excess(axis, 2, ACCELERATION, jump, from_ns);
        double jerk =
            part->straight && sweep.scurve ? watch_excess(axis, 3, JERK * 1.05, 0.0, from_ns) : 0.0;
        if (speed > 0.0 || acceleration > 0.0 || jerk > 0.0) {
            fail("%c is beyond its limits by %.2f units/s, %.0f units/s^2, %.0f units/s^3",
                 STEPPER_AXIS_LETTERS[axis], speed, acceleration, jerk);
        }
    }
    if (watch_fault() != NULL) {
        fail("%s", watch_fault());
    }
}

static void check_reported_position(void) {
    int32_t steps[AXIS_COUNT];
    watch_position(steps);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (steps[axis] != stepper_position_steps(axis)) {
            fail("%c says it is at %d steps, its pins say %d", STEPPER_AXIS_LETTERS[axis],
                 (int)stepper_position_steps(axis), (int)steps[axis]);
        }
    }
}

static void wait_for(uint32_t entries) {
    for (unsigned ms = 0; executed() < entries; ms++) {
        if (ms > 4000) {
            fail("%u of %u entries are executed, no more", (unsigned)executed(), (unsigned)entries);
        }
        bench_wait_us(1000);
    }
    bench_wait_us(4000); // what the tick has been given already
}

// ---- Holds --------------------------------------------------------------------------------------

static void hold_and_resume(bool to_the_end) {
    double braking_s = SPEED / ACCELERATION + (sweep.scurve ? 2 * ACCELERATION / JERK : 0.0);
    uint64_t hold_ns = host_clock_now_ns();
    if (sweep.plant_stop) {
        stepper_stop();
    } else {
        stepper_hold(true);
    }
    bench_wait_us((uint64_t)(braking_s * 1e6) + 5000);
    uint64_t standing_ns = host_clock_now_ns();
    bench_wait_us(20000);
    if (watch_last_step_ns() > standing_ns) {
        fail("no standstill after %.1f ms", (double)(standing_ns - hold_ns) * 1e-6);
    }
    check_reported_position();
    uint64_t from_ns = hold_ns - LOOK_BACK_NS;
    unsigned next = 0;
    for (uint32_t done = executed(); next < sweep.count - 1 && sweep.parts[next].entries <= done;) {
        next++;
    }
    stepper_hold(false);
    for (bool more = true; more && next < sweep.count; next++) {
        const part_t *part = &sweep.parts[next];
        wait_for(part->entries);
        check_reported_position();
        check_place(part);
        check_limits(part, from_ns);
        from_ns = host_clock_now_ns();
        more = to_the_end;
    }
}

static bool hold_in_a_child(bool to_the_end) {
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        hold_and_resume(to_the_end);
        _exit(0);
    }
    int status = 1;
    waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) {
        printf("FAILED: hold at %.2f ms: signal %d\n",
               (double)(host_clock_now_ns() - sweep.start_ns) * 1e-6, WTERMSIG(status));
    }
    return child > 0 && status == 0;
}

// The program without a hold: how many steps each part has.
static void take_measure(void) {
    start_program();
    uint64_t from_ns = sweep.start_ns;
    for (unsigned i = 0; i < sweep.count; i++) {
        part_t *part = &sweep.parts[i];
        wait_for(part->entries);
        for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
            part->pulses[axis] = watch_pulses(axis);
        }
        check_place(part);
        check_limits(part, from_ns);
        from_ns = host_clock_now_ns();
    }
    bench_finish(1);
    bench_end();
}

static void attach(void) {
    stepper_axis_t axes[AXIS_COUNT];
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        axes[axis] = bench_axes[axis];
        axes[axis].steps_per_unit = SCALE;
    }
    watch_attach(axes);
}

void setUp(void) {} // bench.c asks for Unity
void tearDown(void) {}

int main(int argc, char **argv) {
    sweep.scurve = argc > 1 && strcmp(argv[1], "scurve") == 0;
    sweep.every_ticks = argc > 2 ? (unsigned)atoi(argv[2]) : 10;
    sweep.plant_hard = argc > 3 && strcmp(argv[3], "hard") == 0;
    sweep.plant_stop = argc > 3 && strcmp(argv[3], "stop") == 0;
    attach();
    take_measure();
    part_t measured[PARTS_MAX];
    memcpy(measured, sweep.parts, sizeof measured);
    start_program();
    memcpy(sweep.parts, measured, sizeof measured);
    unsigned holds = 0;
    while (stepper_active() > 0) {
        if (!hold_in_a_child(holds % WHOLE_EVERY == 0)) {
            return 1;
        }
        holds++;
        bench_wait_us(sweep.every_ticks * TICK_US);
    }
    double program_s = (double)(host_clock_now_ns() - sweep.start_ns) * 1e-9;
    check_place(&measured[sweep.count - 1]);
    printf("%u holds in %.2f s of program\n", holds, program_s);
    return program_s >= 3.0 ? 0 : 1;
}
