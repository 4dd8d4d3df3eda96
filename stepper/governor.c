// The governor. For each slice of a millisecond profile.c chooses the speed at its end. The way made in it
// becomes a segment for the tick; a slice in which blocks meet becomes one segment for each
// side, so that corners are passed where they are.
//
// Speeds are float: the way through a block is a fraction in 2^-64, so that neither a slow feed nor a
// long move loses anything, and positions are steps in 2^-32. All of it is computed with single IEEE
// operations in a fixed order; host and board make the same segments to the bit.
// Context: governor (below every interrupt, above the main loop), if a function says nothing else.
#include "stepper/governor.h"

#include <math.h>
#include <string.h>

#include "stepper/jog.h"
#include "stepper/path.h"
#include "stepper/planner.h"
#include "stepper/profile.h"
#include "stepper/scurve.h"
#include "stepper/segment_writer.h"
#include "stepper/step_isr.h"

#define TICK_S (1.0f / (float)HAL_TICK_HZ)
#define SLICE_TICKS 100u
#define SLICE_TICKS_MIN 20u
// A jerk limit chooses anew after this, that is mostly after two or three slices.
#define CHOSEN_TICKS 190.0f
// Ways shorter than this are joined with what follows instead of getting a segment of their own.
#define SEGMENT_TICKS_MIN 8.0f
#define CORNER_TICKS_MIN 2.0f // the same before a corner, which must not be cut
#define DWELL_SLICE_TICKS 100u
// Time the drivers get between being enabled and the first step.
#define ENABLE_TICKS 5u
// The governor is called when a segment ends. This is left then: more rides out longer delays of this
// interrupt, less reacts faster.
#define SPARE_TICKS 60u
// No more than this is ever ahead, so that what is asked for shows at the pins within 2 ms.
#define AHEAD_TICKS 172u
#define STANDSTILL 0.001f // units/s
// What a corner may be reached too fast, from rounding, as the time to brake that off.
#define HAIR_S 0.0002f
#define PROGRESS_ONE 18446744073709551616.0f  // 2^64
#define PROGRESS_MOST 18446742974197923840.0f // the float below

static struct {
    governor_pins_t pins;
    volatile bool armed;
    volatile bool stopping;
    volatile bool holding; // feed hold: brake to a standstill and wait there
    volatile bool estop_event;
    volatile uint32_t executed;
    volatile uint32_t drops;
    bool idle_off;
    bool drivers_on;

    const block_t *block; // being executed, NULL: none
    uint32_t dwell_left;  // ticks, of a dwell
    uint64_t progress;    // of a move, in 2^-64 of its length
    float per_length;     // 2^64 / length of a move
    float top_speed;      // allowed in it, units/s
    uint32_t overrides;   // for which that was found
    float speed;          // along the path now, units/s
    float acceleration;   // of the piece that led here, units/s^2
    float chosen_ticks;   // since a jerk limit has chosen it
    bool choose_again;    // whatever that is
    float pending_ticks;  // computed way that has no segment yet
    float pending_from;   // speed at its beginning
} governor;

static float lesser(float a, float b) {
    return a < b ? a : b;
}

static float greater(float a, float b) {
    return a > b ? a : b;
}

// ---- The way along a move ------------------------------------------------------------------------

static float remaining(void) {
    return (float)~governor.progress * (governor.block->move.length / PROGRESS_ONE);
}

// Adds a piece in which the speed changes to `end_speed` to the way that has no segment yet.
static void go_on(float ticks, float end_speed) {
    if (governor.pending_ticks <= 0.0f) {
        governor.pending_from = governor.speed;
    }
    governor.pending_ticks += ticks;
    governor.speed = end_speed;
}

static void write_way(const int64_t target[AXIS_COUNT], bool at_rest) {
    float sum = governor.pending_from + governor.speed;
    float rise = governor.speed - governor.pending_from;
    float change = rise != 0.0f ? rise / sum : 0.0f;
    segment_writer_move(target, governor.pending_ticks,
                        (int32_t)(change * (float)SEGMENT_CHANGE_ONE), at_rest);
    governor.pending_ticks = 0.0f;
}

static void start_block(const block_t *block) {
    governor.block = block;
    governor.progress = 0;
    governor.dwell_left = block->kind == BLOCK_DWELL ? block->dwell_ticks : 0;
    planner_start();
    if (block_is_move(block)) {
        governor.per_length = PROGRESS_ONE / block->move.length;
        governor.top_speed = planner_top_speed(block);
        governor.overrides = blocks.overrides;
        path_begin(block);
        if (fabsf(governor.acceleration) > block->move.acceleration) {
            governor.choose_again = true;
        }
    }
}

// At rest, from where any acceleration within the jerk limit may be chosen.
static void stand(void) {
    governor.acceleration = 0.0f;
    governor.chosen_ticks = SCURVE_TICKS;
    governor.choose_again = true;
}

static void finish_block(void) {
    governor.block = NULL;
    governor.executed = governor.executed + 1;
    planner_release();
}

// The motion ended elsewhere than planned: what comes next starts where the motors stand.
static void follow_motors(void) {
    int32_t steps[AXIS_COUNT];
    segment_writer_end_steps(steps);
    path_stand(steps);
    governor.drops = governor.drops + 1;
}

static void drop_blocks(void) {
    governor.block = NULL;
    governor.speed = 0.0f;
    stand();
    governor.pending_ticks = 0.0f;
    governor.stopping = false;
    planner_release_all();
    segment_writer_settle();
    follow_motors();
}

static bool goes_straight_on(void) {
    const block_t *second = planner_second();
    return second != NULL && block_is_move(second) && second->move.corner == V2_MAX;
}

// The move ends within the piece of `dt`, in which the speed would change to `v1`. Returns the ticks of
// it that are used.
static float pass_end(float left, float v1, float dt) {
    float v = governor.speed;
    float acceleration = (v1 - v) / dt;
    float exit_speed2 = planner_exit_speed2();
    float end_speed = sqrtf(greater(v * v + 2.0f * acceleration * left, 0.0f));
    if (governor.block->move.jerk <= 0.0f) {
        float excess = end_speed - sqrtf(exit_speed2);
        if (excess > 0.0f && excess < governor.block->move.acceleration * HAIR_S) {
            end_speed -= excess;
        }
    }
    float time = v + end_speed > 0.0f ? lesser(2.0f * left / (v + end_speed), dt) : dt;
    float ticks = time * (float)HAL_TICK_HZ;
    bool at_rest = exit_speed2 <= 0.0f;
    go_on(ticks, at_rest ? 0.0f : end_speed);
    if (at_rest) {
        stand();
    }

    float least = at_rest || goes_straight_on() ? SEGMENT_TICKS_MIN : CORNER_TICKS_MIN;
    if (at_rest || governor.pending_ticks >= least) {
        int64_t target[AXIS_COUNT];
        path_end(target);
        write_way(target, at_rest);
    }
    finish_block();
    if (!at_rest) {
        start_block(planner_front());
    }
    return ticks;
}

static profile_t profile_here(float left, bool braking) {
    return (profile_t){
        .block = governor.block,
        .left = left,
        .top = braking ? 0.0f : governor.top_speed,
        .speed = governor.speed,
        .acceleration = governor.acceleration,
    };
}

// The speed after the next `*ticks`, which it may lessen. The jerk-limited profile looks across blocks, so
// what it chose holds behind them as well, for some slices.
static float next_speed(float left, float *ticks) {
    bool braking = governor.stopping || governor.holding;
    if (governor.overrides != blocks.overrides) {
        governor.overrides = blocks.overrides;
        governor.top_speed = planner_top_speed(governor.block);
        governor.choose_again = true;
    }
    if (governor.block->move.jerk <= 0.0f) {
        profile_t here = profile_here(left, braking);
        float v1 = profile_next_speed(&here, ticks);
        float acceleration = governor.block->move.acceleration;
        governor.acceleration = v1 > here.speed   ? acceleration
                                : v1 < here.speed ? -acceleration
                                                  : 0.0f;
        governor.choose_again = true;
        return v1;
    }
    if (governor.choose_again || governor.chosen_ticks >= CHOSEN_TICKS) {
        profile_t here = profile_here(left, braking);
        governor.acceleration = scurve_acceleration(&here, governor.chosen_ticks * TICK_S);
        governor.chosen_ticks = 0.0f;
        governor.choose_again = false;
    }
    float v1 = scurve_speed(governor.speed, governor.acceleration, *ticks * TICK_S);
    // On the way to a standstill a slice that is shorter than planned leaves a part of the speed; the
    // next one leaves a part of that, and so on.
    return braking && v1 < STANDSTILL ? 0.0f : v1;
}

// One slice of a move, through as many blocks as it touches and the segment ring has room for.
static void advance_move(float ticks) {
    while (ticks >= 1.0f && segment_writer_has_room()) {
        float piece = ticks;
        float left = remaining();
        float v1 = next_speed(left, &piece);
        float dt = piece * TICK_S;
        float way = 0.5f * (governor.speed + v1) * dt;
        float advance = lesser(way * governor.per_length, PROGRESS_MOST);
        uint64_t progress = governor.progress + (uint64_t)advance;
        if (way >= left || progress < governor.progress) {
            float used = pass_end(left, v1, dt);
            ticks -= used;
            governor.chosen_ticks += used;
            if (governor.block == NULL) {
                return; // at rest
            }
            continue;
        }
        governor.progress = progress;
        governor.chosen_ticks += piece;
        go_on(piece, v1);
        int64_t target[AXIS_COUNT];
        path_at(governor.progress, target);
        bool stopped = (governor.stopping || governor.holding) && v1 <= 0.0f;
        write_way(target, stopped);
        if (stopped) {
            stand();
            if (governor.stopping) {
                drop_blocks();
            }
            return;
        }
        ticks -= piece;
    }
}

static void advance_dwell(void) {
    uint32_t ticks =
        governor.dwell_left < DWELL_SLICE_TICKS ? governor.dwell_left : DWELL_SLICE_TICKS;
    if (ticks > 0) {
        segment_writer_wait(ticks, 0, 0);
        governor.dwell_left -= ticks;
    }
    if (governor.dwell_left == 0) {
        finish_block();
    }
}

// ---- What is next --------------------------------------------------------------------------------

static void switch_drivers(bool on) {
    uint32_t mask = governor.pins.enable;
    segment_writer_wait(on ? ENABLE_TICKS : 1, on ? 0 : mask, on ? mask : 0);
    governor.drivers_on = on;
}

// Makes the next segment or two. False if there is nothing to do.
static bool advance(uint32_t slice_ticks) {
    const block_t *front = planner_front();
    if (governor.stopping && governor.speed <= 0.0f) {
        drop_blocks();
        return true;
    }
    bool wanted = front != NULL || jog_active() || !governor.idle_off;
    if (wanted != governor.drivers_on) {
        switch_drivers(wanted);
        return true;
    }
    if (jog_active()) {
        jog_advance();
        if (!jog_active()) {
            follow_motors();
        }
        return true;
    }
    if (front == NULL || (governor.holding && governor.speed <= 0.0f)) {
        return false;
    }
    if (governor.block == NULL) {
        start_block(front);
    }
    switch (front->kind) {
    case BLOCK_LINE:
    case BLOCK_ARC:
    case BLOCK_BLEND:
        advance_move((float)slice_ticks);
        break;
    case BLOCK_DWELL:
        advance_dwell();
        break;
    case BLOCK_PINS:
        segment_writer_wait(1, front->pins.set, front->pins.clear);
        finish_block();
        break;
    }
    return true;
}

// So long that what is ahead stays within AHEAD_TICKS.
static uint32_t slice_ticks(void) {
    uint32_t ahead = segment_writer_ahead_ticks();
    if (ahead + SLICE_TICKS <= AHEAD_TICKS) {
        return SLICE_TICKS;
    }
    return ahead + SLICE_TICKS_MIN <= AHEAD_TICKS ? AHEAD_TICKS - ahead : SLICE_TICKS_MIN;
}

// The tick may be running although there is nothing to execute. A motion is shown to it only when there is
// enough to go on with: its first segments can be as short as a tick.
void governor_fill(uint32_t ticks) {
    bool starting = ring_used(&segments.ring) == 0;
    bool more = governor.armed;
    while (more && segment_writer_spare_ticks() < ticks && segment_writer_has_room()) {
        bool reacting = ticks <= SPARE_TICKS;
        more = advance(reacting ? slice_ticks() : SLICE_TICKS);
        if (!starting) {
            segment_writer_publish();
        }
    }
    segment_writer_publish();
    if (ring_used(&segments.ring) > 0) {
        hal_tick_start();
    }
}

void hal_on_governor(void) {
    if (step_isr_tripped()) {
        governor_emergency_stop();
        step_isr_rearm();
        governor.estop_event = true;
        return;
    }
    governor_fill(SPARE_TICKS);
}

// ---- For the main loop ---------------------------------------------------------------------------

void governor_reset(const int32_t steps[AXIS_COUNT]) {
    governor_pins_t pins = governor.pins;
    memset(&governor, 0, sizeof governor);
    governor.pins = pins;
    stand();
    jog_drop();
    segment_writer_reset(steps);
    path_stand(steps);
}

void governor_set_pins(const governor_pins_t *pins) {
    governor.pins = *pins;
    segment_writer_set_dir_pins(pins->dir, pins->dir_inverted);
}

void governor_arm(bool idle_off) {
    governor.idle_off = idle_off;
    governor.armed = true;
    if (step_isr_watches()) {
        hal_tick_start();
    }
}

void governor_disarm(void) {
    governor.armed = false;
    governor.drivers_on = false;
}

void governor_set_position(const int32_t steps[AXIS_COUNT]) {
    segment_writer_reset(steps);
    path_stand(steps);
}

void governor_stop(void) {
    governor.holding = false;
    if (jog_active()) {
        jog_stop();
    } else {
        governor.stopping = governor_working();
        governor.choose_again = true;
    }
}

void governor_emergency_stop(void) {
    int32_t steps[AXIS_COUNT];
    hal_tick_stop(); // before the position is read: no step may come behind it
    governor_position(steps);
    step_isr_abort();
    jog_drop();
    drop_blocks();
    segment_writer_reset(steps);
    path_stand(steps);
    bool spindle_off_level = governor.pins.spindle_inverted;
    hal_pins_set(spindle_off_level ? governor.pins.spindle : 0);
    hal_pins_clear(spindle_off_level ? 0 : governor.pins.spindle);
    if (!governor.pins.estop_keeps_enabled) {
        hal_pins_set(governor.pins.enable);
    }
    governor.drivers_on = false;
    governor.armed = false;
    governor.holding = false;
}

void governor_position(int32_t steps[AXIS_COUNT]) {
    if (!step_isr_position(steps)) {
        segment_writer_end_steps(steps);
    }
}

void governor_whereabouts(float *speed, float *left) {
    bool moving = governor.block != NULL && governor.speed > 0.0f;
    *speed = moving ? governor.speed : 0.0f;
    *left = moving ? remaining() : 0.0f;
}

void governor_hold(bool hold) {
    jog_stop();
    governor.holding = hold && !governor.stopping && !jog_active();
    governor.choose_again = true;
}

bool governor_holding(void) {
    return governor.holding;
}

bool governor_armed(void) {
    return governor.armed;
}

bool governor_stopping(void) {
    return governor.stopping;
}

float governor_speed(void) {
    return governor.speed;
}

// In this order: what is gone when it is looked for has become segments before.
bool governor_working(void) {
    return governor.armed &&
           (jog_active() || ring_used(&blocks.ring) > 0 || ring_used(&segments.ring) > 0);
}

uint32_t governor_executed(void) {
    return governor.executed;
}

uint32_t governor_drops(void) {
    return governor.drops;
}

bool governor_estop_event(void) {
    return governor.estop_event;
}

void governor_clear_estop_event(void) {
    governor.estop_event = false;
}
