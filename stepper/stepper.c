// The machine's state: what is allowed when, and the face's calls to planner and governor.
// Context: main loop.
#include "stepper/stepper.h"

#include <math.h>

#include "stepper/axis.h"
#include "stepper/governor.h"
#include "stepper/planner.h"
#include "stepper/step_isr.h"

#define TICKS_PER_MS (HAL_TICK_HZ / 1000.0)

static const char spindle_owner[] = "STEPPER spindle";
static const char estop_owner[] = "STEPPER E-STOP";

static struct {
    bool initialized;
    bool position_known;
    stepper_idle_t idle;
    stepper_init_t config;
    uint8_t spindle_gpio;
    bool spindle_invert;
    uint32_t drops_seen; // of governor_drops(), that the planner has followed
} machine = {.spindle_gpio = PINS_NONE, .config = {.estop_gpio = PINS_NONE}};

// ---- Following the governor ----------------------------------------------------------------------

static void planner_follow_motors(void) {
    int32_t steps[AXIS_COUNT];
    hal_governor_lock();
    governor_position(steps);
    hal_governor_unlock();
    planner_set_position(steps);
}

// After a stop the queue is gone; what is queued next starts where the machine stands.
static void follow_stops(void) {
    uint32_t drops = governor_drops();
    if (drops != machine.drops_seen && !governor_working()) {
        machine.drops_seen = drops;
        planner_follow_motors();
    }
}

static bool at_rest(void) {
    return !governor_working() && ring_used(&blocks.ring) == 0;
}

static err_t check_initialized(void) {
    if (!machine.initialized) {
        return err_raise(ERR_STEPPER_NOT_INITIALIZED, NULL);
    }
    follow_stops();
    return ERR_OK;
}

// For what must not happen while there is motion or something waits for its turn.
static err_t check_at_rest(void) {
    err_t err = check_initialized();
    if (err == ERR_OK && !at_rest()) {
        err = err_raise(ERR_STEPPER_BUSY, NULL);
    }
    return err;
}

static err_t check_axis(axis_id_t axis) {
    return axes[axis].configured ? ERR_OK : err_raise(ERR_AXIS_NOT_CONFIGURED, "%s", axis_name(axis));
}

static err_t check_queue(void) {
    err_t err = check_initialized();
    if (err != ERR_OK) {
        return err;
    }
    if (governor_stopping()) {
        return err_raise(ERR_STEPPER_STOPPING, NULL);
    }
    return ring_free(&blocks.ring) > 0 ? ERR_OK : err_raise(ERR_GCODE_BUFFER_FULL, NULL);
}

// ---- Configuration -------------------------------------------------------------------------------

static void pass_pins_on(void) {
    governor_pins_t pins = {
        .enable = axis_enable_mask(),
        .spindle = pins_mask(machine.spindle_gpio),
        .spindle_inverted = machine.spindle_invert,
        .estop_keeps_enabled = machine.config.estop_keeps_enabled,
    };
    uint32_t steps[AXIS_COUNT];
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        steps[axis] = axis_step_mask(axis);
        if (axes[axis].configured) {
            pins.dir[axis] = pins_mask(axes[axis].config.dir_gpio);
            pins.dir_inverted |= (uint32_t)axes[axis].config.dir_invert << axis;
        }
    }
    hal_governor_lock();
    step_isr_set_pins(steps);
    governor_set_pins(&pins);
    hal_governor_unlock();
}

static void reset_motion(void) {
    const int32_t zero[AXIS_COUNT] = {0};
    hal_tick_stop();
    hal_governor_lock();
    step_isr_setup(pins_mask(machine.config.estop_gpio), 0);
    governor_reset(zero);
    planner_reset(machine.config.blocks);
    hal_governor_unlock();
    machine.drops_seen = governor_drops();
    planner_set_scale();
    planner_set_position(zero);
    planner_set_junction_deviation((float)STEPPER_JUNCTION_DEVIATION_MM);
}

err_t stepper_init(const stepper_init_t *config) {
    if (machine.initialized) {
        return err_raise(ERR_STEPPER_ALREADY_INITIALIZED, NULL);
    }
    if (config->estop_gpio != PINS_NONE) {
        err_t err = pins_claim(config->estop_gpio, estop_owner);
        if (err != ERR_OK) {
            return err;
        }
        hal_pin_input(config->estop_gpio, HAL_PULL_UP);
    }
    machine.config = *config;
    machine.initialized = true;
    machine.position_known = false;
    machine.idle = STEPPER_IDLE_HOLD;
    reset_motion();
    pass_pins_on();
    return ERR_OK;
}

err_t stepper_axis(axis_id_t axis, const stepper_axis_t *config) {
    err_t err = check_at_rest();
    if (err != ERR_OK) {
        return err;
    }
    bool rescaled =
        axes[axis].configured && axes[axis].config.steps_per_unit != config->steps_per_unit;
    // Disarmed: new pins start with their driver off.
    hal_governor_lock();
    bool armed = governor_armed();
    governor_disarm();
    hal_governor_unlock();
    err = axis_configure(axis, config);
    if (err == ERR_OK) {
        machine.position_known = machine.position_known && !rescaled;
        pass_pins_on();
        planner_set_scale();
        planner_follow_motors();
    }
    if (armed) {
        stepper_run(machine.idle);
    }
    return err;
}

double stepper_step_rate_limit(axis_id_t axis) {
    return STEPPER_STEP_RATE_MAX_HZ * 60.0 / axes[axis].config.steps_per_unit;
}

err_t stepper_limits(axis_id_t axis, double min_mm, double max_mm) {
    err_t err = check_initialized();
    if (err == ERR_OK) {
        err = check_axis(axis);
    }
    if (err != ERR_OK) {
        return err;
    }
    if (!(min_mm < max_mm)) {
        return err_raise(ERR_LIMITS_ORDER, NULL);
    }
    axes[axis].min = min_mm;
    axes[axis].max = max_mm;
    axes[axis].limited = true;
    return ERR_OK;
}

err_t stepper_spindle(uint8_t gpio, bool invert) {
    err_t err = check_at_rest();
    if (err != ERR_OK) {
        return err;
    }
    if (gpio != machine.spindle_gpio) {
        if (gpio != PINS_NONE && (err = pins_claim(gpio, spindle_owner)) != ERR_OK) {
            return err;
        }
        if (machine.spindle_gpio != PINS_NONE) {
            hal_pin_release(machine.spindle_gpio);
            pins_disclaim(machine.spindle_gpio);
        }
    }
    machine.spindle_gpio = gpio;
    machine.spindle_invert = invert;
    if (gpio != PINS_NONE) {
        hal_pin_output(gpio, invert);
    }
    pass_pins_on();
    return ERR_OK;
}

err_t stepper_junction(double deviation_mm) {
    err_t err = check_initialized();
    if (err == ERR_OK) {
        planner_set_junction_deviation((float)deviation_mm);
    }
    return err;
}

// ---- Control -------------------------------------------------------------------------------------

static bool estop_asserted(void) {
    uint32_t mask = pins_mask(machine.config.estop_gpio);
    return mask != 0 && (hal_pins_read() & mask) == 0;
}

err_t stepper_run(stepper_idle_t idle) {
    err_t err = check_initialized();
    if (err != ERR_OK) {
        return err;
    }
    if (estop_asserted()) {
        return err_raise(ERR_ESTOP_ACTIVE, NULL);
    }
    machine.idle = idle;
    hal_governor_lock();
    governor_arm(idle == STEPPER_IDLE_DISABLE);
    hal_governor_request();
    hal_governor_unlock();
    return ERR_OK;
}

err_t stepper_clear(void) {
    err_t err = check_initialized();
    if (err != ERR_OK) {
        return err;
    }
    if (governor_working()) {
        return err_raise(ERR_CLEAR_WHILE_ACTIVE, NULL);
    }
    hal_governor_lock();
    planner_reset(machine.config.blocks);
    hal_governor_unlock();
    planner_follow_motors();
    return ERR_OK;
}

void stepper_stop(void) {
    if (!machine.initialized) {
        return;
    }
    hal_governor_lock();
    governor_stop();
    hal_governor_request();
    hal_governor_unlock();
}

err_t stepper_estop(void) {
    err_t err = check_initialized();
    if (err != ERR_OK) {
        return err;
    }
    hal_governor_lock();
    machine.position_known = machine.position_known && !governor_working();
    governor_emergency_stop();
    hal_governor_unlock();
    follow_stops();
    return ERR_OK;
}

err_t stepper_close(void) {
    err_t err = check_initialized();
    if (err != ERR_OK) {
        return err;
    }
    stepper_stop();
    while (governor_working()) {
        hal_idle(hal_time_us() + 1000);
    }
    hal_governor_lock();
    governor_emergency_stop(); // spindle off, drivers off, disarmed
    hal_governor_unlock();
    stepper_spindle(PINS_NONE, false);
    axis_release_all();
    if (machine.config.estop_gpio != PINS_NONE) {
        hal_pin_release(machine.config.estop_gpio);
        pins_disclaim(machine.config.estop_gpio);
        machine.config.estop_gpio = PINS_NONE;
    }
    machine.initialized = false;
    return ERR_OK;
}

// ---- Position ------------------------------------------------------------------------------------

static void stand_at(const int32_t steps[AXIS_COUNT]) {
    hal_governor_lock();
    governor_set_position(steps);
    hal_governor_unlock();
    planner_set_position(steps);
    machine.position_known = true;
}

err_t stepper_set_home(void) {
    err_t err = check_at_rest();
    if (err == ERR_OK) {
        stand_at((const int32_t[AXIS_COUNT]){0});
    }
    return err;
}

err_t stepper_set_position(axis_id_t axis, double position) {
    err_t err = check_at_rest();
    if (err == ERR_OK) {
        err = check_axis(axis);
    }
    if (err != ERR_OK) {
        return err;
    }
    int32_t steps[AXIS_COUNT];
    hal_governor_lock();
    governor_position(steps);
    hal_governor_unlock();
    if (!axis_to_steps(axis, position, &steps[axis])) {
        return err_raise(ERR_AXIS_TOO_FAR, "%s", axis_name(axis));
    }
    stand_at(steps);
    return ERR_OK;
}

int32_t stepper_position_steps(axis_id_t axis) {
    int32_t steps[AXIS_COUNT];
    hal_governor_lock();
    governor_position(steps);
    hal_governor_unlock();
    return steps[axis];
}

double stepper_position(axis_id_t axis) {
    return axis_from_steps(axis, stepper_position_steps(axis));
}

// ---- The queue -----------------------------------------------------------------------------------

static err_t check_target(const stepper_move_t *move, int32_t steps[AXIS_COUNT]) {
    double from[AXIS_COUNT];
    planner_target(from);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        double target = move->target[axis];
        steps[axis] = 0;
        if (!axes[axis].configured) {
            if (target != from[axis]) {
                return check_axis(axis);
            }
            continue;
        }
        // Half a step of tolerance: a limit that is no whole step must not refuse its own value.
        double tolerance = 0.5 / axes[axis].config.steps_per_unit;
        if (axes[axis].limited && target != from[axis] &&
            (target < axes[axis].min - tolerance || target > axes[axis].max + tolerance)) {
            return err_raise(ERR_SOFT_LIMIT, "%s", axis_name(axis));
        }
        if (!axis_to_steps(axis, target, &steps[axis])) {
            return err_raise(ERR_AXIS_TOO_FAR, "%s", axis_name(axis));
        }
    }
    return ERR_OK;
}

err_t stepper_move(const stepper_move_t *move) {
    err_t err = check_queue();
    if (err != ERR_OK) {
        return err;
    }
    if (!machine.position_known) {
        return err_raise(ERR_POSITION_UNKNOWN, NULL);
    }
    int32_t steps[AXIS_COUNT];
    err = check_target(move, steps);
    if (err == ERR_OK) {
        planner_push_move(move, steps);
        hal_governor_request();
    }
    return err;
}

err_t stepper_dwell(double milliseconds) {
    err_t err = check_queue();
    if (err == ERR_OK) {
        planner_push_dwell((uint32_t)ceil(milliseconds * TICKS_PER_MS));
        hal_governor_request();
    }
    return err;
}

err_t stepper_spindle_switch(bool on) {
    err_t err = check_queue();
    if (err != ERR_OK) {
        return err;
    }
    if (machine.spindle_gpio == PINS_NONE) {
        return err_raise(ERR_NO_SPINDLE_PIN, NULL);
    }
    uint32_t mask = pins_mask(machine.spindle_gpio);
    bool high = on != machine.spindle_invert;
    planner_push_pins(high ? mask : 0, high ? 0 : mask);
    hal_governor_request();
    return ERR_OK;
}

void stepper_target(double target[AXIS_COUNT]) {
    follow_stops();
    planner_target(target);
}

// ---- Reports -------------------------------------------------------------------------------------

void stepper_status(stepper_status_t *status) {
    uint32_t spindle = pins_mask(machine.spindle_gpio);
    bool spindle_high = spindle != 0 && (hal_pins_read() & spindle) != 0;
    *status = (stepper_status_t){
        .initialized = machine.initialized,
        .armed = governor_armed(),
        .moving = governor_working(),
        .stopping = governor_stopping(),
        .position_known = machine.position_known,
        .spindle_on = spindle != 0 && spindle_high != machine.spindle_invert,
        .idle = machine.idle,
        .blocks = machine.config.blocks,
        .blocks_free = stepper_blocks_free(),
        .executed = governor_executed(),
        .underruns = step_isr_dry_count(),
        .junction_deviation_mm = (double)planner_junction_deviation(),
        .arc_tolerance_mm = machine.config.arc_tolerance_mm,
        .estop_gpio = machine.config.estop_gpio,
        .spindle_gpio = machine.spindle_gpio,
        .estop_keeps_enabled = machine.config.estop_keeps_enabled,
        .spindle_invert = machine.spindle_invert,
    };
}

bool stepper_axis_configured(axis_id_t axis) {
    return axes[axis].configured;
}

bool stepper_axis_config(axis_id_t axis, stepper_axis_t *config) {
    *config = axes[axis].config;
    return axes[axis].configured;
}

bool stepper_axis_limits(axis_id_t axis, double *min_mm, double *max_mm) {
    *min_mm = axes[axis].min;
    *max_mm = axes[axis].max;
    return axes[axis].limited;
}

int stepper_active(void) {
    if (!machine.initialized) {
        return -1;
    }
    return governor_working() ? 1 : 0;
}

uint32_t stepper_blocks_free(void) {
    return machine.initialized ? ring_free(&blocks.ring) : 0;
}

uint32_t stepper_status_bits(void) {
    uint32_t bits = 0;
    bits |= estop_asserted() ? STEPPER_STATUS_ESTOP : 0;
    bits |= machine.initialized && machine.position_known ? STEPPER_STATUS_POSITION_KNOWN : 0;
    return bits;
}

stepper_event_t stepper_next_event(void) {
    if (governor_take_estop_event()) {
        machine.position_known = false;
        return STEPPER_EVENT_ESTOP;
    }
    return STEPPER_EVENT_NONE;
}
