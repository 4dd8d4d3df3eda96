// The segment writer and the tick without a governor: every step against the closed form of the
// way, counted at the pins tick by tick.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

#include "stepper/segment_writer.h"
#include "stepper/step_isr.h"

#define STEP_GPIO 2u // X; the others follow
#define DIR_GPIO 10u
#define SLICE_TICKS 100.0
#define TOLERANCE_TICKS 0.6 // half a tick and a microsecond

// What a test wants to know of a step: its axis, the position behind it and the time of its pulse.
typedef void (*on_step_t)(axis_id_t axis, int32_t steps, uint64_t tick);

static struct {
    int32_t steps[AXIS_COUNT]; // counted at the pins
    uint64_t tick;             // of the next hal_on_tick()
    uint64_t step_tick[AXIS_COUNT];
    uint64_t dir_tick[AXIS_COUNT];
    uint32_t dir_levels;
    uint32_t wrong_positions; // ticks behind which step_isr_position() was not what was counted
    on_step_t on_step;
} motors;

static void start_at(const int32_t steps[AXIS_COUNT], on_step_t on_step) {
    uint32_t step_masks[AXIS_COUNT];
    uint32_t dir_masks[AXIS_COUNT];
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        step_masks[axis] = 1u << (STEP_GPIO + axis);
        dir_masks[axis] = 1u << (DIR_GPIO + axis);
        hal_pin_output(STEP_GPIO + axis, false);
        hal_pin_output(DIR_GPIO + axis, true);
    }
    step_isr_abort();
    step_isr_setup();
    step_isr_set_pins(step_masks);
    segment_writer_set_dir_pins(dir_masks, 0);
    segment_writer_reset(steps);
    memset(&motors, 0, sizeof motors);
    memcpy(motors.steps, steps, sizeof motors.steps);
    motors.tick = 1000;
    motors.dir_levels = hal_pins_read();
    motors.on_step = on_step;
}

static void count_step(axis_id_t axis) {
    motors.steps[axis] += (motors.dir_levels >> (DIR_GPIO + axis)) & 1 ? 1 : -1;
    TEST_ASSERT_TRUE_MESSAGE(motors.tick - motors.step_tick[axis] >= 2, "steps in a row");
    TEST_ASSERT_TRUE_MESSAGE(motors.tick - motors.dir_tick[axis] >= 1, "direction setup");
    motors.step_tick[axis] = motors.tick;
    if (motors.on_step != NULL) {
        motors.on_step(axis, motors.steps[axis], motors.tick);
    }
}

static void tick(void) {
    hal_on_tick();
    uint32_t pins = hal_pins_read();
    uint32_t turned = motors.dir_levels ^ pins;
    motors.dir_levels = pins;
    int32_t reported[AXIS_COUNT];
    bool known = step_isr_position(reported);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if ((turned >> (DIR_GPIO + axis)) & 1) {
            TEST_ASSERT_TRUE_MESSAGE(motors.tick - motors.step_tick[axis] >= 2, "direction hold");
            motors.dir_tick[axis] = motors.tick;
        }
        if ((pins >> (STEP_GPIO + axis)) & 1) {
            count_step(axis);
        }
        motors.wrong_positions += known && reported[axis] != motors.steps[axis];
    }
    motors.tick++;
}

static void tick_until_there_is_room(void) {
    while (!segment_writer_has_room()) {
        tick();
    }
}

static void tick_until_empty(void) {
    while (ring_used(&segments.ring) > 0) {
        tick();
    }
    TEST_ASSERT_EQUAL_UINT32(0, motors.wrong_positions);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, step_isr_dry_count(), "no segment in the middle of a way");
}

// ---- Steps against a trapezoid ------------------------------------------------------------------

// A way from rest to rest; steps and ticks. Without a cruise it is a triangle.
typedef struct {
    double length, top, acceleration;
    double ramp, cruise, end; // ticks
} trapezoid_t;

static trapezoid_t trapezoid_of(double length, double top_hz, double acceleration_hz2) {
    trapezoid_t form = {
        .length = length, .top = top_hz / 1e5, .acceleration = acceleration_hz2 / 1e10};
    form.top = fmin(form.top, sqrt(length * form.acceleration));
    form.ramp = form.top / form.acceleration;
    form.cruise = length / form.top - form.ramp;
    form.end = 2 * form.ramp + form.cruise;
    return form;
}

static double way_at(const trapezoid_t *form, double time) {
    if (time > form->end / 2) {
        return form->length - way_at(form, form->end - time);
    }
    double ramp = fmin(time, form->ramp);
    return 0.5 * form->acceleration * ramp * ramp + form->top * (time - ramp);
}

static double speed_at(const trapezoid_t *form, double time) {
    return fmin(form->top, form->acceleration * fmin(time, form->end - time));
}

static double time_at(const trapezoid_t *form, double way) {
    if (way > form->length / 2) {
        return form->end - time_at(form, form->length - way);
    }
    double of_ramp = 0.5 * form->top * form->ramp;
    return way < of_ramp ? sqrt(2 * way / form->acceleration)
                         : form->ramp + (way - of_ramp) / form->top;
}

// What the steps are compared with: axis n makes parts[n] of the way.
static struct {
    trapezoid_t form;
    double parts[AXIS_COUNT];
    uint64_t first_tick;
    double worst_ticks;
} ideal;

// A pulse comes with the first tick behind the middle between two steps, so on average half a tick
// late.
static void compare_step(axis_id_t axis, int32_t steps, uint64_t at_tick) {
    double way = (abs(steps) - 0.5) / fabs(ideal.parts[axis]);
    double late = (double)(at_tick - ideal.first_tick) + 0.5 - time_at(&ideal.form, way);
    ideal.worst_ticks = fmax(ideal.worst_ticks, fabs(late));
}

static void write_way(double time, double next, bool follow_speed) {
    double speed = speed_at(&ideal.form, time);
    double next_speed = speed_at(&ideal.form, next);
    double change = follow_speed ? (next_speed - speed) / (next_speed + speed) : 0;
    bool at_rest = next >= ideal.form.end;
    int64_t target[AXIS_COUNT];
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        double way = at_rest ? ideal.form.length : way_at(&ideal.form, next);
        target[axis] = (int64_t)(way * ideal.parts[axis] * 4294967296.0);
    }
    tick_until_there_is_room();
    segment_writer_move(target, (float)(next - time), (int32_t)(change * SEGMENT_CHANGE_ONE),
                        at_rest);
    segment_writer_publish();
}

// Goes the way in slices of a millisecond, cut where the acceleration changes. Returns by how many
// ticks the worst step of all axes is off.
static double worst_step_of(const trapezoid_t *form, const double parts[AXIS_COUNT],
                            bool follow_speed) {
    const int32_t zero[AXIS_COUNT] = {0};
    start_at(zero, compare_step);
    ideal.form = *form;
    memcpy(ideal.parts, parts, sizeof ideal.parts);
    ideal.first_tick = motors.tick;
    ideal.worst_ticks = 0;
    const double cuts[] = {form->ramp, form->ramp + form->cruise, form->end};
    double time = 0;
    for (size_t cut = 0; time < form->end; cut += time >= cuts[cut]) {
        double next = fmin(cuts[cut], SLICE_TICKS * (floor(time / SLICE_TICKS + 1e-9) + 1));
        next = cuts[cut] - next < 0.01 ? cuts[cut] : next;
        write_way(time, next, follow_speed);
        time = next;
    }
    tick_until_empty();
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        TEST_ASSERT_EQUAL_INT32(lround(form->length * parts[axis]), motors.steps[axis]);
    }
    return ideal.worst_ticks;
}

static const double ahead_and_back[AXIS_COUNT] = {1, -0.62, 0.013, -0.25};

static void test_every_step_of_a_trapezoid_is_in_time(void) {
    const double tops_hz[] = {3, 97, 1000, 12345.6, 33333, 50000};
    const double accelerations_hz2[] = {10, 800, 40000, 1e6, 2e7, 1e9};
    for (size_t t = 0; t < COUNT_OF_ARRAY(tops_hz); t++) {
        for (size_t a = 0; a < COUNT_OF_ARRAY(accelerations_hz2); a++) {
            // So long that half of it is cruise, within bounds; the others are triangles.
            double ramps = tops_hz[t] * tops_hz[t] / accelerations_hz2[a];
            double length = 1000 * round(fmin(fmax(2 * ramps, 1000), 20000) / 1000);
            length = tops_hz[t] < 10 ? 60 : length;
            trapezoid_t form = trapezoid_of(length, tops_hz[t], accelerations_hz2[a]);
            if (form.end > 6e6) {
                continue; // a minute of virtual time
            }
            char text[80];
            snprintf(text, sizeof text, "%g Hz, %g Hz/s", tops_hz[t], accelerations_hz2[a]);
            double worst = worst_step_of(&form, ahead_and_back, true);
            TEST_ASSERT_TRUE_MESSAGE(worst <= TOLERANCE_TICKS, text);
        }
    }
}

// The comparison above is one that can fail: without ramps within the segments it does.
static void test_stairs_would_be_noticed(void) {
    trapezoid_t form = trapezoid_of(1000, 5000, 40000);
    TEST_ASSERT_TRUE(worst_step_of(&form, ahead_and_back, true) <= TOLERANCE_TICKS);
    TEST_ASSERT_TRUE(worst_step_of(&form, ahead_and_back, false) > 2 * TOLERANCE_TICKS);
}

// ---- Rates --------------------------------------------------------------------------------------

static struct {
    int64_t steps;
    uint64_t first_tick, last_tick;
} counted;

static void count_first_axis(axis_id_t axis, int32_t steps, uint64_t at_tick) {
    (void)steps;
    if (axis == AXIS_X) {
        counted.first_tick = counted.steps == 0 ? at_tick : counted.first_tick;
        counted.last_tick = at_tick;
        counted.steps++;
    }
}

static void test_mean_rate_is_right_within_50_ppm(void) {
    const double rates_hz[] = {1, 1.7, 9.99, 100, 1234.5, 10007, 24999, 33333, 49999, 50000};
    for (size_t r = 0; r < COUNT_OF_ARRAY(rates_hz); r++) {
        const int32_t zero[AXIS_COUNT] = {0};
        start_at(zero, count_first_axis);
        counted.steps = 0;
        int slices = rates_hz[r] < 10 ? 20000 : 2000;
        for (int slice = 1; slice <= slices; slice++) {
            int64_t target[AXIS_COUNT] = {0};
            target[AXIS_X] = (int64_t)(rates_hz[r] * 1e-3 * slice * 4294967296.0);
            tick_until_there_is_room();
            segment_writer_move(target, 100.0f, 0, slice == slices);
            segment_writer_publish();
        }
        tick_until_empty();
        // The first and the last step are each known to a tick.
        double ticks = (double)(counted.last_tick - counted.first_tick);
        double rate_hz = (double)(counted.steps - 1) / ticks * 1e5;
        TEST_ASSERT_DOUBLE_WITHIN(rates_hz[r] * (50e-6 + 0.5 / ticks), rates_hz[r], rate_hz);
    }
}

// ---- Any way at all -----------------------------------------------------------------------------

static double uniform(double low, double high) {
    return low + (high - low) * rand() / RAND_MAX;
}

// Random targets, times, changes of speed and turns, more than can be: nothing is lost, the
// position is right in every tick, and the last segment of a motion arrives.
static void test_random_ways_arrive_exactly(void) {
    srand(3);
    const int32_t begin[AXIS_COUNT] = {0, 5, -7, 2000000000};
    start_at(begin, NULL);
    double at[AXIS_COUNT];
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        at[axis] = begin[axis];
    }
    for (int way = 0; way < 30000; way++) {
        bool at_rest = rand() % 20 == 0;
        double ticks = rand() % 4 ? uniform(8, 120) : uniform(0, 8);
        int64_t target[AXIS_COUNT];
        for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
            double reach = (double[]){0, 0.001, 0.1, 0.6}[rand() % 4] * ticks;
            at[axis] += uniform(-reach, reach);
            at[axis] = at_rest ? round(at[axis]) : at[axis];
            target[axis] = (int64_t)(at[axis] * 4294967296.0);
        }
        int32_t change = rand() % 3 ? (int32_t)(uniform(-1, 1) * SEGMENT_CHANGE_ONE) : 0;
        tick_until_there_is_room();
        segment_writer_move(target, (float)ticks, change, at_rest);
        segment_writer_publish();
        if (at_rest) {
            tick_until_empty();
            for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
                TEST_ASSERT_EQUAL_INT32(lround(at[axis]), motors.steps[axis]);
            }
        }
    }
}

static void test_waiting_moves_nothing_and_switches_pins(void) {
    const uint32_t lamp = 1u << 20;
    const int32_t begin[AXIS_COUNT] = {1, -2, 3, -4};
    start_at(begin, NULL);
    hal_pin_output(20, false);
    segment_writer_wait(1, lamp, 0);
    segment_writer_wait(70000, 0, lamp);
    TEST_ASSERT_EQUAL_UINT32(70000, segment_writer_spare_ticks());
    segment_writer_publish();
    TEST_ASSERT_EQUAL_UINT32(70000, segment_writer_spare_ticks());
    tick();
    TEST_ASSERT_TRUE(hal_pins_read() & lamp);
    tick();
    TEST_ASSERT_FALSE(hal_pins_read() & lamp);
    tick_until_empty();
    TEST_ASSERT_EQUAL_UINT64(1000 + 70002, motors.tick); // the last one finds the ring empty
    TEST_ASSERT_EQUAL_INT32_ARRAY(begin, motors.steps, AXIS_COUNT);
}

void setUp(void) {}
void tearDown(void) {}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_step_of_a_trapezoid_is_in_time);
    RUN_TEST(test_stairs_would_be_noticed);
    RUN_TEST(test_mean_rate_is_right_within_50_ppm);
    RUN_TEST(test_random_ways_arrive_exactly);
    RUN_TEST(test_waiting_moves_nothing_and_switches_pins);
    return UNITY_END();
}
