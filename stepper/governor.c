// The governor: what comes next, and a few milliseconds of it in advance. Moves are travel.c's
// business, jogs jog.c's; dwells, pins and drivers are switched here. Context: governor (below
// every interrupt, above the main loop), if a function says nothing else.
#include "stepper/governor.h"

#include <string.h>

#include "stepper/jog.h"
#include "stepper/outputs.h"
#include "stepper/path.h"
#include "stepper/planner.h"
#include "stepper/segment_writer.h"
#include "stepper/step_isr.h"
#include "stepper/travel.h"

#define SLICE_TICKS 100u
#define SLICE_TICKS_MIN 20u
#define DWELL_SLICE_TICKS 100u
// Time the drivers get between being enabled and the first step.
#define ENABLE_TICKS 5u
// The governor is called when a segment ends. This is left then: more rides out longer delays of
// this interrupt, less reacts faster.
#define SPARE_TICKS 60u
// No more than this is ever ahead, so that what is asked for shows at the pins within 2 ms.
#define AHEAD_TICKS 172u

static struct {
    governor_pins_t pins;
    volatile bool armed;
    volatile bool stopping;
    bool holdable;         // it stops for a latch: what comes behind it can be held
    volatile bool holding; // feed hold: brake to a standstill and wait there
    volatile bool paused;  // the front block holds
    volatile uint32_t pauses;
    volatile uint32_t tripped; // inputs that stopped the machine and were not taken yet
    bool trip_moved;
    volatile uint32_t drops;
    bool idle_off;
    bool drivers_on;

    bool begun;            // with the front block
    bool standing;         // no motion, or one that is held; false only while `begun`
    bool starting;         // what this fill writes sets off from a standstill
    uint32_t enough_ticks; // this fill ends when so many are ahead
    uint32_t dwell_left;   // ticks, of a dwell
} governor;

static void stand(void) {
    governor.begun = false;
    governor.paused = false;
    governor.standing = true;
}

static void finish_block(void) {
    stand();
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
    stand();
    governor.stopping = false;
    outputs_end_stop();
    travel_stand();
    planner_release_all();
    segment_writer_settle();
    follow_motors();
}

// A motion may begin with segments as short as a tick, behind others that end at a standstill. It
// counts as ahead only from here on.
static void set_off(void) {
    governor.starting = true;
    governor.enough_ticks += segment_writer_spare_ticks();
}

// With the front block, or goes on with it after a hold.
static void begin_block(const block_t *block) {
    if (block_is_move(block)) {
        set_off();
        governor.standing = false;
    }
    if (block_has_level(block)) {
        outputs_enter(block); // also after a hold, in which a laser is off
    }
    if (governor.begun) {
        return;
    }
    governor.begun = true;
    planner_start();
    switch (block->kind) {
    case BLOCK_LINE:
    case BLOCK_ARC:
    case BLOCK_BLEND:
        travel_begin(block);
        break;
    case BLOCK_DWELL:
        governor.dwell_left = block->dwell_ticks;
        break;
    case BLOCK_PINS:
        outputs_begin(block);
        segment_writer_wait(1, block->pins.set, block->pins.clear);
        governor.dwell_left = block->pins.dwell_ticks;
        break;
    case BLOCK_PAUSE:
        governor.paused = true;
        governor.pauses = governor.pauses + 1;
        governor.holding = true;
        break;
    }
}

static void advance_move(float ticks) {
    switch (travel_advance(ticks, governor.stopping || governor.holding)) {
    case TRAVEL_GOES_ON:
        break;
    case TRAVEL_ARRIVED:
        stand();
        break;
    case TRAVEL_STOPPED:
        governor.standing = true;
        if (governor.stopping) {
            drop_blocks();
        }
        break;
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

// ---- What is next -------------------------------------------------------------------------------

static void switch_drivers(bool on) {
    uint32_t mask = governor.pins.enable;
    segment_writer_wait(on ? ENABLE_TICKS : 1, on ? 0 : mask, on ? mask : 0);
    governor.drivers_on = on;
}

// Nothing moves: no laser burns from now on. False if there is nothing to do for that.
static bool put_out(void) {
    bool lit = outputs_put_out();
    if (lit) {
        segment_writer_wait(1, 0, 0);
    }
    return lit;
}

// Makes the next segment or two. False if there is nothing to do.
static bool advance(uint32_t slice_ticks) {
    const block_t *front = planner_front();
    if (governor.stopping && travel_speed() <= 0.0f) {
        drop_blocks();
        return true;
    }
    bool wanted = front != NULL || jog_active() || !governor.idle_off;
    if (wanted != governor.drivers_on) {
        outputs_put_out();
        switch_drivers(wanted);
        return true;
    }
    if (jog_active()) {
        if (jog_speed() <= 0.0f) {
            if (put_out()) {
                return true;
            }
            set_off();
        }
        jog_advance();
        if (!jog_active()) {
            follow_motors();
        }
        return true;
    }
    if (front == NULL || (governor.holding && travel_speed() <= 0.0f)) {
        return put_out();
    }
    if (governor.standing) {
        begin_block(front);
    }
    switch (front->kind) {
    case BLOCK_LINE:
    case BLOCK_ARC:
    case BLOCK_BLEND:
        advance_move((float)slice_ticks);
        break;
    case BLOCK_DWELL:
    case BLOCK_PINS:
        advance_dwell();
        break;
    case BLOCK_PAUSE:
        if (!governor.holding) {
            finish_block();
        }
        break;
    }
    return true;
}

// So long that what is ahead stays within AHEAD_TICKS; `spare_ticks` are, and what the tick is at.
static uint32_t slice_ticks(uint32_t spare_ticks) {
    uint32_t ahead = spare_ticks + segment_writer_oldest_ticks();
    if (ahead + SLICE_TICKS <= AHEAD_TICKS) {
        return SLICE_TICKS;
    }
    return ahead + SLICE_TICKS_MIN <= AHEAD_TICKS ? AHEAD_TICKS - ahead : SLICE_TICKS_MIN;
}

// The tick may be running although there is nothing to execute, or only what ends at a standstill.
// A motion is shown to it only when there is enough to go on with.
void governor_fill(uint32_t ticks) {
    bool reacting = ticks <= SPARE_TICKS;
    governor.enough_ticks = ticks;
    governor.starting = ring_used(&segments.ring) == 0;
    bool more = governor.armed;
    while (more) {
        uint32_t spare_ticks = segment_writer_spare_ticks();
        if (spare_ticks >= governor.enough_ticks || !segment_writer_has_room()) {
            break;
        }
        more = advance(reacting ? slice_ticks(spare_ticks) : SLICE_TICKS);
        if (!governor.starting) {
            segment_writer_publish();
        }
    }
    segment_writer_publish();
    if (ring_used(&segments.ring) > 0) {
        hal_tick_start();
    }
}

// ---- Inputs -------------------------------------------------------------------------------------

// The tick is stopped: the machine stands where that was, and nothing is ahead of it or queued.
static void drop_motion(void) {
    int32_t steps[AXIS_COUNT];
    governor_position(steps); // before the ring is emptied
    step_isr_abort();
    jog_drop();
    drop_blocks();
    governor_set_position(steps);
}

// Several at once: the drivers stay on only if each of them says so.
static void trip(uint32_t pins) {
    bool moved = governor_emergency_stop((pins & ~governor.pins.keep_enabled) == 0);
    governor.trip_moved |= moved;
    governor.tripped = governor.tripped | pins;
    step_isr_rearm();
}

// The position first: what is written from now on may take the place of what it follows from. A
// hold stays: it is the user's.
static void latch(void) {
    bool holding = governor.holding;
    if (!step_isr_latch_collect()) {
        int32_t steps[AXIS_COUNT];
        segment_writer_end_steps(steps);
        step_isr_latch_stand(steps);
    }
    if (!step_isr_stopped()) {
        governor_stop();
        governor.holding = holding;
        governor.holdable = true;
    }
}

static void watch_inputs(void) {
    if (governor.armed && step_isr_watches()) {
        hal_tick_start();
    }
}

// A latch has stopped the tick: the machine stands there and goes on being watched. The drivers are
// on, or were to be: what turns them on may have been ahead.
static void halt(void) {
    step_isr_halt();
    drop_motion();
    governor.drivers_on = false;
    watch_inputs();
}

void hal_on_governor(void) {
    if (step_isr_tripped() != 0) {
        trip(step_isr_tripped());
        return;
    }
    if (step_isr_latch_waits()) {
        latch();
    }
    if (step_isr_stopped()) {
        halt();
    }
    governor_fill(SPARE_TICKS);
}

// ---- For the main loop --------------------------------------------------------------------------

void governor_reset(const int32_t steps[AXIS_COUNT]) {
    governor_pins_t pins = governor.pins;
    memset(&governor, 0, sizeof governor);
    governor.pins = pins;
    governor.standing = true;
    blocks.executed = 0;
    travel_stand();
    jog_drop();
    governor_set_position(steps);
}

void governor_set_pins(const governor_pins_t *pins) {
    governor.pins = *pins;
    segment_writer_set_dir_pins(pins->dir, pins->dir_inverted);
}

void governor_keep_enabled(uint32_t pins) {
    governor.pins.keep_enabled = pins;
}

void governor_arm(bool idle_off) {
    governor.idle_off = idle_off;
    governor.armed = true;
    watch_inputs();
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
    governor.holdable = false;
    if (jog_active()) {
        jog_stop();
    } else {
        governor.stopping = governor_working();
        travel_choose_again();
        if (governor.stopping) {
            outputs_begin_stop();
        }
    }
}

bool governor_emergency_stop(bool keep_enabled) {
    bool moved = step_isr_halt();
    outputs_off();
    if (!keep_enabled) {
        hal_pins_set(governor.pins.enable);
    }
    drop_motion();
    governor.drivers_on = false;
    governor.armed = false;
    governor.holding = false;
    return moved;
}

governor_trip_t governor_take_trip(void) {
    governor_trip_t taken = {.pins = governor.tripped, .moved = governor.trip_moved};
    governor.tripped = 0;
    governor.trip_moved = false;
    return taken;
}

void governor_position(int32_t steps[AXIS_COUNT]) {
    if (!step_isr_position(steps)) {
        segment_writer_end_steps(steps);
    }
}

void governor_whereabouts(float *speed, float *left) {
    *speed = travel_speed();
    *left = *speed > 0.0f ? travel_left() : 0.0f;
}

void governor_hold(bool hold) {
    if (hold) {
        jog_stop();
    }
    bool stopping = governor.stopping && !governor.holdable;
    governor.holding = hold && !stopping && !jog_active();
    travel_choose_again();
}

bool governor_holding(void) {
    return governor.holding;
}

bool governor_paused(void) {
    return governor.paused && ring_used(&segments.ring) == 0;
}

uint32_t governor_pauses(void) {
    return governor.pauses;
}

bool governor_armed(void) {
    return governor.armed;
}

bool governor_stopping(void) {
    return governor.stopping;
}

float governor_speed(void) {
    return travel_speed();
}

// In this order: what is gone when it is looked for has become segments before.
bool governor_working(void) {
    return governor.armed &&
           (jog_active() || ring_used(&blocks.ring) > 0 || ring_used(&segments.ring) > 0);
}

uint32_t governor_executed(void) {
    return blocks.executed;
}

uint32_t governor_drops(void) {
    return governor.drops;
}

bool governor_tripped(void) {
    return governor.tripped != 0;
}

uint32_t governor_ends(void) {
    return blocks.executed + governor.drops + governor.pauses;
}
