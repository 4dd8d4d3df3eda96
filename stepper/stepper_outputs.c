// Spindle, coolant, pauses and line numbers: setting them up, and their entries of the queue.
// Context: main loop.
#include "stepper/stepper_outputs.h"

#include "hal/hal_io.h"
#include "hal/slices.h"
#include "stepper/alarm.h"
#include "stepper/governor.h"
#include "stepper/lines.h"
#include "stepper/moves.h"
#include "stepper/outputs.h"
#include "stepper/rules.h"
#include "stepper/segment_writer.h"
#include "stepper/step_isr.h"

static const char spindle_owner[] = "STEPPER spindle";
static const char coolant_owner[] = "STEPPER coolant";

// ---- Pins ---------------------------------------------------------------------------------------

// Claims both pins, of which the owner may have some already; all or none.
static err_t claim(const uint8_t gpio[2], const char *owner) {
    if (gpio[0] != PINS_NONE && gpio[0] == gpio[1]) {
        return err_raise(ERR_PIN_TWICE, "%s", pins_name(gpio[0]));
    }
    bool had_first = gpio[0] == PINS_NONE || pins_owner(gpio[0]) == owner;
    err_t err = had_first ? ERR_OK : pins_claim(gpio[0], owner);
    if (err == ERR_OK && gpio[1] != PINS_NONE && pins_owner(gpio[1]) != owner) {
        err = pins_claim(gpio[1], owner);
        if (err != ERR_OK && !had_first) {
            pins_disclaim(gpio[0]);
        }
    }
    return err;
}

// Gives those of the pins back that are not among `kept`.
static void give_back(const uint8_t gpio[2], const uint8_t kept[2]) {
    for (unsigned n = 0; n < 2; n++) {
        if (gpio[n] != PINS_NONE && gpio[n] != kept[0] && gpio[n] != kept[1]) {
            hal_pin_release(gpio[n]);
            pins_disclaim(gpio[n]);
        }
    }
}

static void make_output(uint8_t gpio, bool level) {
    if (gpio != PINS_NONE) {
        hal_pin_output(gpio, level);
    }
}

// ---- Spindle ------------------------------------------------------------------------------------

// The slice of a spindle; HAL_PWM_SLICES: it has none.
static unsigned slice_of(const stepper_spindle_t *spindle) {
    return spindle->gpio != PINS_NONE && spindle->max_rpm > 0.0 ? HAL_PWM_SLICE(spindle->gpio)
                                                                : HAL_PWM_SLICES;
}

static err_t check_spindle(const stepper_spindle_t *config, hal_pwm_t *pwm) {
    if (config->gpio == PINS_NONE) {
        return ERR_OK;
    }
    if (outputs.laser && config->max_rpm <= 0.0) {
        return err_raise(ERR_LASER_PWM, NULL);
    }
    if (config->min_rpm > config->max_rpm) {
        return err_raise(ERR_SPINDLE_RANGE, NULL);
    }
    if (config->max_rpm > 0.0 && slices_divide(hal_clock_hz(), config->pwm_hz, false, pwm) == 0.0) {
        return err_raise(ERR_PWM_FREQUENCY, "%.1f to %.0f Hz", slices_lowest_hz(hal_clock_hz()),
                         slices_highest_hz(hal_clock_hz()));
    }
    return ERR_OK;
}

static void start_slice(unsigned slice, hal_pwm_t *pwm, const stepper_spindle_t *config) {
    static const uint16_t from_zero[HAL_PWM_SLICES];
    pwm->inverted[HAL_PWM_CHANNEL(config->gpio)] = config->invert;
    hal_pwm_set(slice, pwm);
    hal_pwm_start(1u << slice, from_zero);
}

// Pins and slice are claimed.
static void use_spindle(const stepper_spindle_t *config, hal_pwm_t *pwm) {
    unsigned before = slice_of(&outputs.spindle);
    unsigned slice = slice_of(config);
    hal_governor_lock();
    outputs_spindle_off();
    hal_governor_unlock();
    give_back((const uint8_t[]){outputs.spindle.gpio, outputs.spindle.dir_gpio},
              (const uint8_t[]){config->gpio, config->dir_gpio});
    if (before < HAL_PWM_SLICES) {
        hal_pwm_stop(before);
    }
    if (before < HAL_PWM_SLICES && before != slice) {
        slices_disclaim(before);
    }
    make_output(config->gpio, config->invert);
    make_output(config->dir_gpio, false);
    hal_governor_lock();
    outputs.spindle = *config;
    outputs.laser = outputs.laser && slice < HAL_PWM_SLICES;
    outputs.counts = 0;
    hal_governor_unlock();
    outputs_forget_beam();
    outputs.limited = OUTPUTS_NOT_LIMITED;
    if (slice < HAL_PWM_SLICES) {
        start_slice(slice, pwm, config);
        outputs.counts = pwm->top + 1u;
    }
    step_isr_set_pwm(hal_pwm_place(slice));
    outputs_follow();
}

err_t stepper_spindle(const stepper_spindle_t *config) {
    err_t err = rules_check(RULES_DO_PINS);
    if (err != ERR_OK) {
        return err;
    }
    stepper_spindle_t wanted = *config;
    if (wanted.gpio == PINS_NONE) {
        wanted.dir_gpio = PINS_NONE;
    }
    hal_pwm_t pwm = {0};
    const uint8_t pins[2] = {wanted.gpio, wanted.dir_gpio};
    err = check_spindle(&wanted, &pwm);
    if (err == ERR_OK) {
        err = claim(pins, spindle_owner);
    }
    if (err == ERR_OK && slice_of(&wanted) < HAL_PWM_SLICES) {
        err = slices_claim(slice_of(&wanted), spindle_owner);
        if (err != ERR_OK) {
            give_back(pins, (const uint8_t[]){outputs.spindle.gpio, outputs.spindle.dir_gpio});
        }
    }
    if (err != ERR_OK) {
        return err;
    }
    use_spindle(&wanted, &pwm);
    return ERR_OK;
}

err_t stepper_spindle_check(stepper_turn_t turn) {
    if (outputs.spindle.gpio == PINS_NONE) {
        return err_raise(ERR_NO_SPINDLE_PIN, NULL);
    }
    if (turn == STEPPER_SPINDLE_CCW && !outputs.laser && outputs.spindle.dir_gpio == PINS_NONE) {
        return err_raise(ERR_NO_SPINDLE_DIR, NULL);
    }
    return ERR_OK;
}

static bool turns(stepper_turn_t turn, uint16_t level) {
    return turn != STEPPER_SPINDLE_OFF && (outputs.counts == 0 || level > 0);
}

static void add_pin(block_pins_t *pins, uint8_t gpio, bool high) {
    pins->set |= high ? pins_mask(gpio) : 0;
    pins->clear |= high ? 0 : pins_mask(gpio);
}

err_t stepper_spindle_switch(stepper_turn_t turn, double rpm) {
    err_t err = rules_check(RULES_DO_ENTRY);
    if (err == ERR_OK) {
        err = stepper_spindle_check(turn);
    }
    if (err != ERR_OK) {
        return err;
    }
    const stepper_spindle_t *spindle = &outputs.spindle;
    bool on = turn != STEPPER_SPINDLE_OFF;
    uint16_t level = on ? outputs_level(rpm) : 0;
    if (outputs.laser) { // each move says for itself what the beam does
        outputs.turn = (uint8_t)turn;
        outputs.level = level;
        return ERR_OK;
    }
    bool starts =
        turns(turn, level) && (turn != outputs.turn || !turns(outputs.turn, outputs.level));
    block_pins_t pins = {
        .turn = (uint8_t)turn,
        .dwell_ticks = starts ? spindle->spinup_ms * (HAL_TICK_HZ / 1000u) : 0,
    };
    if (outputs.counts == 0) {
        add_pin(&pins, spindle->gpio, on != spindle->invert);
    }
    if (on) {
        add_pin(&pins, spindle->dir_gpio, turn == STEPPER_SPINDLE_CCW);
    }
    outputs.turn = (uint8_t)turn;
    outputs.level = level;
    moves_push_pins(&pins);
    hal_governor_request();
    return ERR_OK;
}

err_t stepper_laser(bool on) {
    err_t err = rules_check(RULES_DO_PINS);
    if (err == ERR_OK && on && outputs.counts == 0) {
        err = err_raise(ERR_LASER_PWM, NULL);
    }
    if (err != ERR_OK) {
        return err;
    }
    hal_governor_lock();
    outputs_spindle_off();
    outputs.laser = on;
    outputs.turn = STEPPER_SPINDLE_OFF;
    outputs.level = 0;
    hal_governor_unlock();
    alarm_count_drop(); // G-code follows what is off now
    return ERR_OK;
}

bool stepper_is_laser(void) {
    return outputs.laser;
}

void stepper_laser_off(void) {
    outputs_forget_beam();
}

bool stepper_spindle_limited(void) {
    bool limited = outputs.limited == OUTPUTS_LIMITED;
    outputs.limited = limited ? OUTPUTS_TOLD : outputs.limited;
    return limited;
}

// ---- Coolant ------------------------------------------------------------------------------------

// The pins are claimed.
static void use_coolant(const stepper_coolant_t *config) {
    outputs_coolant_off();
    give_back((const uint8_t[]){outputs.coolant.flood_gpio, outputs.coolant.mist_gpio},
              (const uint8_t[]){config->flood_gpio, config->mist_gpio});
    hal_governor_lock();
    outputs.coolant = *config;
    hal_governor_unlock();
    make_output(config->flood_gpio, config->invert);
    make_output(config->mist_gpio, config->invert);
    outputs_follow();
}

err_t stepper_coolant(const stepper_coolant_t *config) {
    err_t err = rules_check(RULES_DO_PINS);
    if (err == ERR_OK) {
        err = claim((const uint8_t[]){config->flood_gpio, config->mist_gpio}, coolant_owner);
    }
    if (err == ERR_OK) {
        use_coolant(config);
    }
    return err;
}

err_t stepper_coolant_check(bool flood, bool mist) {
    bool missing = (flood && outputs.coolant.flood_gpio == PINS_NONE) ||
                   (mist && outputs.coolant.mist_gpio == PINS_NONE);
    return missing ? err_raise(ERR_NO_COOLANT_PIN, NULL) : ERR_OK;
}

err_t stepper_coolant_switch(bool flood, bool mist) {
    err_t err = rules_check(RULES_DO_ENTRY);
    if (err == ERR_OK) {
        err = stepper_coolant_check(flood, mist);
    }
    if (err == ERR_OK) {
        block_pins_t pins = {.turn = outputs.turn};
        add_pin(&pins, outputs.coolant.flood_gpio, flood != outputs.coolant.invert);
        add_pin(&pins, outputs.coolant.mist_gpio, mist != outputs.coolant.invert);
        moves_push_pins(&pins);
        hal_governor_request();
    }
    return err;
}

void outputs_take_away(void) {
    use_spindle(&(stepper_spindle_t){.gpio = PINS_NONE, .dir_gpio = PINS_NONE}, NULL);
    use_coolant(&(stepper_coolant_t){.flood_gpio = PINS_NONE, .mist_gpio = PINS_NONE});
}

// ---- Pause and line numbers ---------------------------------------------------------------------

err_t stepper_pause(void) {
    err_t err = rules_check(RULES_DO_ENTRY);
    if (err == ERR_OK) {
        moves_push_pause();
        hal_governor_request();
    }
    return err;
}

bool stepper_paused(void) {
    return governor_paused();
}

uint32_t stepper_pauses(void) {
    return governor_pauses();
}

void stepper_set_line(uint32_t line) {
    lines_set(line);
}

uint32_t stepper_line(void) {
    hal_governor_lock();
    const block_t *front = governor_working() ? planner_front() : NULL;
    uint32_t line = front != NULL ? lines_number(blocks.ring.read, front->line) : 0;
    hal_governor_unlock();
    return line;
}

// ---- Reports ------------------------------------------------------------------------------------

void stepper_outputs(stepper_outputs_t *report) {
    const stepper_spindle_t *spindle = &outputs.spindle;
    uint32_t mask = pins_mask(spindle->gpio);
    uint16_t level = segment_writer_level();
    bool high = (hal_pins_read() & mask) != 0;
    *report = (stepper_outputs_t){
        .spindle = *spindle,
        .laser = outputs.laser,
        .turn = (stepper_turn_t)(outputs.laser ? outputs.turn : outputs.turn_now),
        .rpm = outputs.counts > 0 ? level * spindle->max_rpm / outputs.counts : 0.0,
        .spindle_on = outputs.counts > 0 ? level > 0 : mask != 0 && high != spindle->invert,
        .coolant = outputs.coolant,
        .flood = outputs_coolant_on(outputs.coolant.flood_gpio),
        .mist = outputs_coolant_on(outputs.coolant.mist_gpio),
    };
}
