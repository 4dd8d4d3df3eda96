// Positions on arcs beside the C library's: radii from a tenth of a millimetre to ten metres, all
// scales.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

#include "stepper/arc.h"
#include "stepper/axis.h"
#include "stepper/path.h"
#include "stepper/segment.h"

#define TURN (2 * M_PI)

void setUp(void) {
    memset(axes, 0, sizeof axes);
}

void tearDown(void) {}

static double uniform(double low, double high) {
    return low + (high - low) * rand() / RAND_MAX;
}

static void set_scales(double x, double y) {
    axes[AXIS_X] = (axis_t){.configured = true, .config = {.steps_per_unit = x}};
    axes[AXIS_Y] = (axis_t){.configured = true, .config = {.steps_per_unit = y}};
}

typedef struct {
    double from[2], centre[2]; // machine coordinates
    double radius, angle, sweep;
    double growth; // of the radius up to the end
} shape_t;

static void place_at(const shape_t *shape, double part, double place[2]) {
    double radius = shape->radius + shape->growth * part;
    double angle = shape->angle + shape->sweep * part;
    place[0] = shape->centre[0] + radius * cos(angle);
    place[1] = shape->centre[1] + radius * sin(angle);
}

static double rounding(axis_id_t axis, double place) {
    double scale = axes[axis].config.steps_per_unit;
    return round(place * scale) - place * scale;
}

static void begin(const shape_t *shape) {
    double from[AXIS_COUNT] = {shape->from[0], shape->from[1], 0, 0};
    stepper_arc_t wanted = {
        .plane = {AXIS_X, AXIS_Y},
        .centre = {shape->centre[0] - from[0], shape->centre[1] - from[1]},
        .clockwise = shape->sweep < 0,
        .turns = 1 + (uint32_t)(fabs(shape->sweep) / TURN),
    };
    place_at(shape, 1, wanted.move.target);
    arc_t arc;
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, arc_measure(&arc, &wanted, from), err_message());
    TEST_ASSERT_DOUBLE_WITHIN(3e-9, shape->sweep / TURN, arc.turns);
    block_t block = {.kind = BLOCK_ARC};
    arc_fill(&block, &arc);
    int32_t steps[AXIS_COUNT] = {0};
    for (axis_id_t axis = AXIS_X; axis <= AXIS_Y; axis++) {
        steps[axis] = (int32_t)round(from[axis] * axes[axis].config.steps_per_unit);
        block.move.target[axis] =
            (int32_t)round(wanted.move.target[axis] * axes[axis].config.steps_per_unit);
    }
    path_stand(steps);
    path_begin(&block);
}

// The largest error of an axis, in steps, anywhere on the arc. Rounding the ends is no error.
static double worst_error(const shape_t *shape) {
    double end[2];
    place_at(shape, 1, end);
    begin(shape);
    double worst = 0;
    for (int i = 0; i <= 200; i++) {
        double part = i / 200.0;
        int64_t position[AXIS_COUNT];
        double place[2];
        path_at(i == 200 ? UINT64_MAX : (uint64_t)ldexp(part, 64), position);
        place_at(shape, part, place);
        for (axis_id_t axis = AXIS_X; axis <= AXIS_Y; axis++) {
            double ideal = place[axis] * axes[axis].config.steps_per_unit +
                           rounding(axis, shape->from[axis]) * (1 - part) +
                           rounding(axis, end[axis]) * part;
            worst = fmax(worst, fabs((double)position[axis] / (double)STEP_ONE - ideal));
        }
    }
    return worst;
}

static shape_t random_shape(double least, double most, double sweep) {
    shape_t shape = {
        .from = {uniform(-20, 20), uniform(-20, 20)},
        .radius = exp(uniform(log(least), log(most))),
        .angle = uniform(0, TURN),
        .sweep = (rand() % 2 ? 1 : -1) * exp(uniform(log(0.001), log(sweep))),
    };
    shape.centre[0] = shape.from[0] - shape.radius * cos(shape.angle);
    shape.centre[1] = shape.from[1] - shape.radius * sin(shape.angle);
    return shape;
}

static double worst_of(int count, double least, double most, double sweep) {
    double worst = 0;
    srand(1);
    for (int i = 0; i < count; i++) {
        shape_t shape = random_shape(least, most, sweep);
        worst = fmax(worst, worst_error(&shape));
    }
    return worst;
}

static void test_up_to_ten_metres(void) {
    set_scales(80, 80);
    TEST_ASSERT_TRUE(worst_of(3000, 0.1, 10000, TURN - 0.001) < 0.08);
    set_scales(80, 400);
    TEST_ASSERT_TRUE(worst_of(3000, 0.1, 2000, TURN - 0.001) < 0.08);
}

// 10^8 steps: an angle of 2^-25 turns is several steps there, only the end can say it better.
static void test_finest_steps(void) {
    set_scales(10000, 10000);
    TEST_ASSERT_TRUE(worst_of(3000, 0.1, 1000, TURN - 0.001) < 1.0);
    TEST_ASSERT_TRUE(worst_of(1000, 1000, 10000, TURN - 0.001) < 1.5);
}

static void test_many_turns(void) {
    set_scales(80, 80);
    TEST_ASSERT_TRUE(worst_of(1000, 0.1, 100, 90 * TURN) < 0.2);
    TEST_ASSERT_TRUE(worst_of(1000, 1000, 10000, 90 * TURN) < 4);
}

static void test_coarse_steps(void) {
    set_scales(0.01, 0.5);
    TEST_ASSERT_TRUE(worst_of(1000, 0.1, 10000, 3 * TURN) < 0.08);
}

// The radius grows evenly, up to a hundred steps; a growth of a step cannot be told from rounding.
static void test_growing_radius(void) {
    double worst = 0;
    srand(2);
    for (int i = 0; i < 1000; i++) {
        set_scales(400, 400);
        shape_t shape = random_shape(30, 300, TURN - 0.001);
        shape.growth = uniform(-1, 1) * 0.0009 * shape.radius;
        worst = fmax(worst, worst_error(&shape));
    }
    TEST_ASSERT_TRUE(worst < 2.2);
}

static void test_end_is_the_target_and_there_is_no_jump_to_it(void) {
    srand(3);
    for (int i = 0; i < 1000; i++) {
        set_scales(uniform(1, 500), uniform(1, 500));
        shape_t shape = random_shape(0.1, 1000, 3 * TURN);
        double end[2];
        place_at(&shape, 1, end);
        begin(&shape);
        int64_t last[AXIS_COUNT], exact[AXIS_COUNT];
        path_at(UINT64_MAX, last);
        path_end(exact);
        for (axis_id_t axis = AXIS_X; axis <= AXIS_Y; axis++) {
            int64_t target = llround(end[axis] * axes[axis].config.steps_per_unit);
            TEST_ASSERT_EQUAL_INT64(target * STEP_ONE, exact[axis]);
            TEST_ASSERT_INT64_WITHIN(STEP_ONE / 500, exact[axis], last[axis]);
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_up_to_ten_metres);
    RUN_TEST(test_finest_steps);
    RUN_TEST(test_many_turns);
    RUN_TEST(test_coarse_steps);
    RUN_TEST(test_growing_radius);
    RUN_TEST(test_end_is_the_target_and_there_is_no_jump_to_it);
    return UNITY_END();
}
