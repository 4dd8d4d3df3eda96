// Configuration: INIT, axes, soft limits, settings, and giving it all back. Context: main loop.
#include "hal/hal_io.h"
#include "stepper/alarm.h"
#include "stepper/axis.h"
#include "stepper/cycle.h"
#include "stepper/geometry.h"
#include "stepper/governor.h"
#include "stepper/home_config.h"
#include "stepper/limits.h"
#include "stepper/machine.h"
#include "stepper/moves.h"
#include "stepper/outputs.h"
#include "stepper/planner.h"
#include "stepper/probing.h"
#include "stepper/rules.h"
#include "stepper/step_isr.h"
#include "stepper/stepper_axes.h"
#include "stepper/stepper_check.h"

static const char estop_owner[] = "STEPPER E-STOP";

// The inputs whose trip leaves the drivers on.
static uint32_t keeping_pins(void) {
    stepper_safety_t safety;
    stepper_safety(&safety);
    uint32_t pins = safety.keep_enabled ? limits_pins(limits_assigned()) : 0;
    return machine.config.estop_keeps_enabled ? pins | pins_mask(machine.config.estop_gpio) : pins;
}

void machine_pass_keep_on(void) {
    hal_governor_lock();
    governor_keep_enabled(keeping_pins());
    hal_governor_unlock();
}

void machine_pass_pins_on(void) {
    governor_pins_t pins = {
        .enable = axis_enable_mask(),
        .keep_enabled = keeping_pins(),
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
    step_isr_setup();
    step_isr_set_pwm(hal_pwm_place(HAL_PWM_SLICES));
    governor_reset(zero);
    planner_reset(machine.config.blocks);
    hal_governor_unlock();
    machine.drops_seen = governor_drops();
    limits_reset();
    alarm_reset();
    planner_set_scale();
    moves_set_position(zero);
    geometry_settings = (geometry_settings_t){
        .deviation = (float)STEPPER_JUNCTION_DEVIATION_MM,
        .arc_tolerance = (float)machine.config.arc_tolerance_mm,
        .jerk = (float)STEPPER_JERK_DEFAULT,
    };
    stepper_override(100, 100);
    home_config_reset();
    probing_reset();
}

static void start_afresh(void) {
    machine_lose_position(MACHINE_ALL_AXES);
    machine.idle = STEPPER_IDLE_HOLD;
    reset_motion();
    machine_pass_pins_on();
}

err_t stepper_init(const stepper_init_t *config) {
    err_t err = rules_check(RULES_DO_INIT);
    if (err != ERR_OK) {
        return err;
    }
    if (config->estop_gpio != PINS_NONE) {
        err = pins_claim(config->estop_gpio, estop_owner);
        if (err != ERR_OK) {
            return err;
        }
        hal_pin_input(config->estop_gpio, HAL_PULL_UP);
    }
    machine.config = *config;
    machine.initialized = true;
    start_afresh();
    return ERR_OK;
}

// Steps of another size: the axis stands somewhere else by its count.
static void lose_if(axis_id_t axis, bool rescaled) {
    if (rescaled) {
        machine_lose_position(1u << axis);
    }
}

err_t stepper_axis(axis_id_t axis, const stepper_axis_t *config) {
    err_t err = rules_check(RULES_DO_PINS);
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
        lose_if(axis, rescaled);
        machine_pass_pins_on();
        planner_set_scale();
        machine_follow_motors();
    }
    if (armed) {
        machine_arm(machine.idle);
    }
    return err;
}

err_t stepper_tune(axis_id_t axis, const stepper_axis_t *config) {
    err_t err = rules_check(RULES_DO_PINS);
    if (err == ERR_OK) {
        err = stepper_check_axis(axis);
    }
    if (err != ERR_OK) {
        return err;
    }
    bool rescaled = axes[axis].config.steps_per_unit != config->steps_per_unit;
    axis_tune(axis, config);
    lose_if(axis, rescaled);
    machine_pass_pins_on();
    planner_set_scale();
    machine_follow_motors();
    return ERR_OK;
}

err_t stepper_enable(uint32_t wanted, bool on) {
    err_t err = rules_check(on ? RULES_DO_ENABLE : RULES_DO_DISABLE);
    if (err != ERR_OK) {
        return err;
    }
    uint32_t pins = 0;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        bool asked = ((wanted >> axis) & 1) != 0 && axes[axis].configured;
        pins |= asked ? pins_mask(axes[axis].config.enable_gpio) : 0;
    }
    if (pins == 0) {
        return err_raise(ERR_NO_ENABLE_PIN, NULL);
    }
    if (on) {
        hal_pins_clear(pins); // active low
    } else {
        hal_pins_set(pins);
    }
    return ERR_OK;
}

double stepper_step_rate_limit(axis_id_t axis) {
    return STEPPER_STEP_RATE_MAX_HZ * 60.0 / axes[axis].config.steps_per_unit;
}

err_t stepper_limits(axis_id_t axis, double min_mm, double max_mm) {
    err_t err = rules_check(RULES_DO_LIMITS);
    if (err == ERR_OK) {
        err = stepper_check_axis(axis);
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

err_t stepper_arc_tolerance(double tolerance_mm) {
    err_t err = rules_check(RULES_DO_SETTING);
    if (err == ERR_OK) {
        machine.config.arc_tolerance_mm = tolerance_mm;
        geometry_settings.arc_tolerance = (float)tolerance_mm;
    }
    return err;
}

err_t stepper_junction(double deviation_mm) {
    err_t err = rules_check(RULES_DO_SETTING);
    if (err == ERR_OK) {
        geometry_settings.deviation = (float)deviation_mm;
    }
    return err;
}

err_t stepper_scurve(bool on) {
    err_t err = rules_check(RULES_DO_SETTING);
    if (err == ERR_OK) {
        geometry_settings.scurve = on;
    }
    return err;
}

err_t stepper_jerk(double path, const double axis[AXIS_COUNT]) {
    err_t err = rules_check(RULES_DO_SETTING);
    if (err != ERR_OK) {
        return err;
    }
    geometry_settings.jerk = (float)path;
    for (axis_id_t i = 0; i < AXIS_COUNT; i++) {
        geometry_settings.axis_jerk[i] = (float)axis[i];
    }
    return ERR_OK;
}

// Everything at rest and off, all pins but the E-STOP input's given back.
static void forget_machine(void) {
    hal_governor_lock();
    governor_emergency_stop(false); // spindle, coolant and drivers off, disarmed
    hal_governor_unlock();
    machine_follow_stops();
    cycle_forget();
    probing_release();
    outputs_take_away();
    axis_release_all();
    limits_release();
}

err_t stepper_reset(void) {
    err_t err = rules_check(RULES_DO_PINS);
    if (err == ERR_OK) {
        forget_machine();
        start_afresh();
    }
    return err;
}

err_t stepper_close(void) {
    err_t err = rules_check(RULES_DO_STOP);
    if (err != ERR_OK) {
        return err;
    }
    machine_stop_and_wait();
    forget_machine();
    if (machine.config.estop_gpio != PINS_NONE) {
        hal_pin_release(machine.config.estop_gpio);
        pins_disclaim(machine.config.estop_gpio);
        machine.config.estop_gpio = PINS_NONE;
    }
    alarm_reset();
    machine.initialized = false;
    return ERR_OK;
}
