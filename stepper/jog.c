// Jogging. The axis follows the same speed profiles as a block: towards a target far enough away it
// is a line that ends there; with a target behind, or too near to stop at, the axis brakes first
// and then turns round. Context: governor, if a function says nothing else.
#include "stepper/jog.h"

#include <string.h>

#include "stepper/profile.h"
#include "stepper/ramp.h"
#include "stepper/scurve.h"
#include "stepper/segment_writer.h"

#define SLICE_TICKS 100.0f
#define TICK_S (1.0f / (float)HAL_TICK_HZ)
#define STEP_UNIT (1.0f / 4294967296.0f) // one 2^-32 step in steps

static struct {
    volatile bool active;
    bool stopping;
    bool changing_axis; // to that of `next`, from a standstill
    jog_request_t now, next;
    block_t line; // the limits, as profile.c reads them
    int64_t position[AXIS_COUNT];
    bool negative;      // direction of the motion
    float speed;        // units/s, >= 0
    float acceleration; // units/s^2, of the last slice
    float chosen_ticks; // since a jerk limit has chosen it
    bool choose_again;  // whatever that is
} jog;

static void take(const jog_request_t *request) {
    jog.now = *request;
    jog.line = (block_t){.kind = BLOCK_LINE,
                         .move = {.axes_speed = request->speed,
                                  .acceleration = request->acceleration,
                                  .jerk = request->jerk}};
}

void jog_start(const jog_request_t *request) {
    if (!jog.active) {
        int32_t steps[AXIS_COUNT];
        segment_writer_settle();
        segment_writer_end_steps(steps);
        for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
            jog.position[axis] = steps[axis] * STEP_ONE;
        }
        jog.speed = 0.0f;
        jog.acceleration = 0.0f;
        jog.chosen_ticks = SCURVE_TICKS;
        planner_release_all();
    }
    jog.choose_again = true;
    jog.changing_axis = jog.active && request->axis != jog.now.axis;
    jog.stopping = jog.changing_axis;
    if (jog.changing_axis) {
        jog.next = *request;
    } else {
        take(request);
    }
    jog.active = true;
}

void jog_stop(void) {
    jog.choose_again = true;
    jog.stopping = true;
    jog.changing_axis = false;
}

void jog_drop(void) {
    jog.active = false;
}

bool jog_active(void) {
    return jog.active;
}

float jog_speed(void) {
    return jog.speed;
}

// Units to the target in the direction of the motion; below 0: it lies behind.
static float left(void) {
    int64_t distance = jog.now.target * STEP_ONE - jog.position[jog.now.axis];
    float units = (float)distance * STEP_UNIT * jog.now.units;
    return jog.negative ? -units : units;
}

// The way that a standstill takes from here.
static float braking_distance(void) {
    if (jog.now.jerk <= 0.0f) {
        return 0.5f * jog.speed * jog.speed / jog.now.acceleration;
    }
    ramp_t ramp;
    ramp_set(&ramp, jog.now.acceleration, jog.now.jerk);
    return ramp_braking_distance(&ramp, jog.speed, jog.acceleration, 0.0f);
}

static void stand(void) {
    jog.speed = 0.0f;
    jog.acceleration = 0.0f;
    jog.chosen_ticks = SCURVE_TICKS;
    if (jog.stopping && !jog.changing_axis) {
        segment_writer_settle();
        jog.active = false;
    } else if (jog.changing_axis) {
        take(&jog.next);
        jog.changing_axis = false;
        jog.stopping = false;
    }
}

static void write(float way, float ticks, float end_speed) {
    int64_t moved = (int64_t)(way / jog.now.units * (1.0f / STEP_UNIT));
    jog.position[jog.now.axis] += jog.negative ? -moved : moved;
    int32_t change = segment_writer_change(jog.speed, end_speed);
    segment_writer_move(jog.position, ticks, change, end_speed <= 0.0f);
    jog.speed = end_speed;
}

// The target is within this slice.
static void arrive(float distance) {
    float time = jog.speed > 0.0f ? 2.0f * distance / jog.speed : 0.0f;
    float ticks = time * (float)HAL_TICK_HZ;
    jog.position[jog.now.axis] = jog.now.target * STEP_ONE;
    write(0.0f, ticks < SLICE_TICKS ? ticks + 1.0f : SLICE_TICKS, 0.0f);
    jog.stopping = !jog.changing_axis;
    stand();
}

static float next_speed(const profile_t *now, float *ticks) {
    if (jog.now.jerk <= 0.0f) {
        return profile_next_speed(now, ticks);
    }
    if (jog.choose_again || jog.chosen_ticks >= SCURVE_TICKS) {
        jog.acceleration = scurve_acceleration(now, jog.chosen_ticks * TICK_S);
        jog.chosen_ticks = 0.0f;
        jog.choose_again = false;
    }
    jog.chosen_ticks += *ticks;
    return scurve_speed(jog.speed, jog.acceleration, *ticks * TICK_S);
}

void jog_advance(void) {
    if (jog.speed <= 0.0f) {
        if (jog.stopping) {
            stand();
            return;
        }
        jog.negative = false;
        jog.negative = left() < 0.0f;
    }
    float distance = left();
    // A hair of slack: the profile itself brakes at the last moment.
    bool too_near = distance * 1.001f + jog.now.units * 0.5f < braking_distance();
    profile_t now = {
        .block = &jog.line,
        .left = distance,
        .top = jog.stopping || too_near ? 0.0f : jog.now.speed,
        .speed = jog.speed,
        .acceleration = jog.acceleration,
    };
    if (now.top <= 0.0f) {
        now.left = 1e9f; // just brake
    }
    float ticks = SLICE_TICKS;
    float v1 = next_speed(&now, &ticks);
    float way = 0.5f * (jog.speed + v1) * ticks * TICK_S;
    if (now.top > 0.0f && (way >= distance || distance <= 0.0f)) {
        arrive(distance);
        return;
    }
    write(way, ticks, v1);
    if (v1 <= 0.0f) {
        stand();
    }
}
