// Along the moves. For each slice of a millisecond profile.c or scurve.c chooses the speed at its
// end. The way made in it becomes a segment for the tick; a slice in which blocks meet becomes one
// segment for each side, so that corners are passed where they are.
//
// Speeds are float: the way through a block is a fraction in 2^-64, so that neither a slow feed nor
// a long move loses anything, and positions are steps in 2^-32. All of it is computed with single
// IEEE operations in a fixed order; host and board make the same segments to the bit. Context:
// governor, or main with the governor locked.
#include "stepper/travel.h"

#include <math.h>

#include "stepper/extremes.h"
#include "stepper/outputs.h"
#include "stepper/path.h"
#include "stepper/profile.h"
#include "stepper/scurve.h"
#include "stepper/segment_writer.h"

#define TICK_S (1.0f / (float)HAL_TICK_HZ)
// A jerk limit chooses anew in the slice after this, that is mostly after two slices.
#define CHOSEN_TICKS 150.0f
#define SLICE_TICKS_MOST 100.0f
// Ways shorter than this are joined with what follows instead of getting a segment of their own.
#define SEGMENT_TICKS_MIN 8.0f
#define CORNER_TICKS_MIN 2.0f // the same before a corner, which must not be cut
#define STANDSTILL 0.001f     // units/s
// What a corner may be reached too fast, from rounding, as the time to brake that off.
#define HAIR_S 0.0002f
#define PROGRESS_ONE 18446744073709551616.0f  // 2^64
#define PROGRESS_MOST 18446742974197923840.0f // the float below

static struct {
    const block_t *block; // being executed, NULL: none
    uint64_t progress;    // in 2^-64 of its length
    float per_length;     // 2^64 / length
    float length_part;    // length / 2^64
    float top_speed;      // allowed in it, units/s
    uint32_t overrides;   // for which that was found
    float speed;          // along the path now, units/s
    float acceleration;   // of the piece that led here, units/s^2
    float chosen_ticks;   // since a jerk limit has chosen it
    float choice_ticks;   // for which that holds
    bool choose_again;    // whatever that is
    float pending_ticks;  // computed way that has no segment yet
    float pending_from;   // speed at its beginning
} travel;

// ---- The way along a move -----------------------------------------------------------------------

static float remaining(void) {
    return (float)~travel.progress * travel.length_part;
}

// Adds a piece in which the speed changes to `end_speed` to the way that has no segment yet.
static void go_on(float ticks, float end_speed) {
    if (travel.pending_ticks <= 0.0f) {
        travel.pending_from = travel.speed;
    }
    travel.pending_ticks += ticks;
    travel.speed = end_speed;
}

// A laser's power for what is about to be written. Apart, because hardly anybody needs it.
static __attribute__((noinline)) void dim(void) {
    outputs_follow_speed(0.5f * (travel.pending_from + travel.speed));
}

static inline void write_way(const int64_t target[AXIS_COUNT], bool at_rest) {
    int32_t change = segment_writer_change(travel.pending_from, travel.speed);
    if (outputs.dims) {
        dim();
    }
    segment_writer_move(target, travel.pending_ticks, change, at_rest);
    travel.pending_ticks = 0.0f;
}

// At rest, from where any acceleration within the jerk limit may be chosen.
static void rest(void) {
    travel.block = NULL;
    travel.speed = 0.0f;
    travel.acceleration = 0.0f;
    travel.chosen_ticks = SCURVE_TICKS;
    travel.choose_again = true;
}

void travel_stand(void) {
    rest();
    travel.pending_ticks = 0.0f;
}

void travel_begin(const block_t *block) {
    travel.block = block;
    outputs_enter(block);
    travel.progress = 0;
    travel.per_length = PROGRESS_ONE / block->move.length;
    travel.length_part = block->move.length / PROGRESS_ONE;
    float top_speed = planner_top_speed(block);
    bool faster = top_speed > 1.01f * travel.top_speed && travel.choice_ticks > CHOSEN_TICKS;
    travel.top_speed = top_speed;
    travel.overrides = blocks.overrides;
    path_begin(block);
    if (faster || fabsf(travel.acceleration) > block->move.acceleration) {
        travel.choose_again = true;
    }
}

// What a way up to the end of the block has to last, in ticks, to get a segment of its own.
static float least_to_end(void) {
    const block_t *second = planner_second();
    if (second == NULL || !block_is_move(second)) {
        return CORNER_TICKS_MIN;
    }
    if (second->level != travel.block->level) {
        return 0.0f; // the level is the segment's
    }
    return second->move.corner == V2_CODE_MAX ? SEGMENT_TICKS_MIN : CORNER_TICKS_MIN;
}

// The move ends within the piece of `dt`, in which the speed would change to `v1`. Returns the
// ticks of it that are used.
static float pass_end(float left, float v1, float dt) {
    float v = travel.speed;
    float acceleration = (v1 - v) / dt;
    float exit_speed2 = planner_exit_speed2();
    float end_speed = sqrtf(greater(v * v + 2.0f * acceleration * left, 0.0f));
    if (travel.block->move.jerk <= 0.0f) {
        float excess = end_speed - sqrtf(exit_speed2);
        if (excess > 0.0f && excess < travel.block->move.acceleration * HAIR_S) {
            end_speed -= excess;
        }
    }
    float time = v + end_speed > 0.0f ? lesser(2.0f * left / (v + end_speed), dt) : dt;
    float ticks = time * (float)HAL_TICK_HZ;
    bool at_rest = exit_speed2 <= 0.0f;
    go_on(ticks, at_rest ? 0.0f : end_speed);
    if (at_rest || travel.pending_ticks >= least_to_end()) {
        int64_t target[AXIS_COUNT];
        path_end(target);
        write_way(target, at_rest);
    }
    planner_release();
    if (at_rest) {
        rest();
    } else {
        planner_start();
        travel_begin(planner_front());
    }
    return ticks;
}

static profile_t profile_here(float left, bool braking) {
    return (profile_t){
        .block = travel.block,
        .left = left,
        .top = braking ? 0.0f : travel.top_speed,
        .speed = travel.speed,
        .acceleration = travel.acceleration,
    };
}

// The speed after the next `*ticks`, which it may lessen. The jerk-limited profile looks across
// blocks, so what it chose holds behind them as well, for some slices.
static float next_speed(float left, bool braking, float *ticks) {
    if (travel.overrides != blocks.overrides) {
        travel.overrides = blocks.overrides;
        travel.top_speed = planner_top_speed(travel.block);
        travel.choose_again = true;
    }
    if (travel.block->move.jerk <= 0.0f) {
        profile_t here = profile_here(left, braking);
        float v1 = profile_next_speed(&here, ticks);
        float acceleration = travel.block->move.acceleration;
        travel.acceleration = v1 > here.speed   ? acceleration
                              : v1 < here.speed ? -acceleration
                                                : 0.0f;
        travel.choose_again = true;
        return v1;
    }
    if (travel.choose_again || travel.chosen_ticks >= travel.choice_ticks) {
        profile_t here = profile_here(left, braking);
        // A long choice does not allow a larger step of the acceleration after it.
        float elapsed = lesser(travel.chosen_ticks, CHOSEN_TICKS + SLICE_TICKS_MOST);
        travel.acceleration = scurve_acceleration(&here, elapsed * TICK_S);
        travel.chosen_ticks = 0.0f;
        travel.choice_ticks = scurve_is_quiet() ? SCURVE_QUIET_TICKS : CHOSEN_TICKS;
        travel.choose_again = false;
    }
    float v1 = scurve_speed(travel.speed, travel.acceleration, *ticks * TICK_S);
    // On the way to a standstill a slice that is shorter than planned leaves a part of the speed;
    // the next one leaves a part of that, and so on.
    return braking && v1 < STANDSTILL ? 0.0f : v1;
}

travel_t travel_advance(float ticks, bool braking) {
    while (ticks >= 1.0f && segment_writer_has_room()) {
        float piece = ticks;
        float left = remaining();
        float v1 = next_speed(left, braking, &piece);
        float dt = piece * TICK_S;
        float way = 0.5f * (travel.speed + v1) * dt;
        float advance = lesser(way * travel.per_length, PROGRESS_MOST);
        uint64_t progress = travel.progress + (uint64_t)advance;
        if (way >= left || progress < travel.progress) {
            float used = pass_end(left, v1, dt);
            if (travel.block == NULL) {
                return TRAVEL_ARRIVED;
            }
            ticks -= used;
            travel.chosen_ticks += used;
            continue;
        }
        travel.progress = progress;
        travel.chosen_ticks += piece;
        go_on(piece, v1);
        int64_t target[AXIS_COUNT];
        path_at(travel.progress, target);
        bool stopped = braking && v1 <= 0.0f;
        write_way(target, stopped);
        if (stopped) {
            travel.acceleration = 0.0f;
            travel.chosen_ticks = SCURVE_TICKS;
            travel.choose_again = true;
            return TRAVEL_STOPPED;
        }
        ticks -= piece;
    }
    return TRAVEL_GOES_ON;
}

void travel_choose_again(void) {
    travel.choose_again = true;
}

float travel_speed(void) {
    return travel.block != NULL ? travel.speed : 0.0f;
}

float travel_left(void) {
    return travel.block != NULL ? remaining() : 0.0f;
}
