// What spindle and coolant are, and switching them off. A spindle with PWM is off in two ways: in
// the queue its level becomes 0, which the slice takes up at the end of a period; in an emergency
// the pin is taken from the slice, since a period may last as long as the user wishes. The next
// switch in the queue gives it back. Contexts: see the header.
#include "stepper/outputs.h"

#include "hal/hal.h"
#include "hal/hal_io.h"
#include "stepper/segment_writer.h"

outputs_t outputs = {
    .spindle = {.gpio = PINS_NONE, .dir_gpio = PINS_NONE},
    .coolant = {.flood_gpio = PINS_NONE, .mist_gpio = PINS_NONE},
};

uint16_t outputs_level(double rpm) {
    if (outputs.counts == 0 || !(rpm > 0.0)) {
        return 0;
    }
    const stepper_spindle_t *spindle = &outputs.spindle;
    if (rpm > spindle->max_rpm) {
        outputs.limited = outputs.limited == OUTPUTS_TOLD ? OUTPUTS_TOLD : OUTPUTS_LIMITED;
        rpm = spindle->max_rpm;
    }
    rpm = rpm < spindle->min_rpm ? spindle->min_rpm : rpm;
    return (uint16_t)(rpm / spindle->max_rpm * outputs.counts + 0.5);
}

bool outputs_coolant_on(uint8_t gpio) {
    uint32_t mask = pins_mask(gpio);
    return mask != 0 && ((hal_pins_read() & mask) != 0) != outputs.coolant.invert;
}

// What a laser is to do is not known from its beam, which is off when nothing moves.
void outputs_follow(void) {
    if (!outputs.laser) {
        outputs.turn = outputs.turn_now;
        outputs.level = segment_writer_level();
    }
}

static void connect_pwm(void) {
    if (outputs.counts != 0 && !outputs.pwm_connected) {
        hal_pin_pwm(outputs.spindle.gpio);
        outputs.pwm_connected = true;
    }
}

void outputs_begin(const block_t *block) {
    outputs.turn_now = block->pins.turn;
    connect_pwm();
    segment_writer_set_level(block->level);
}

// ---- A laser's beam -----------------------------------------------------------------------------

void outputs_forget_beam(void) {
    if (outputs.laser) {
        outputs.turn = STEPPER_SPINDLE_OFF;
        outputs.level = 0;
    }
}

static __attribute__((noinline)) void enter_with_laser(const block_t *block) {
    outputs.dims = !outputs.dark && block_is_move(block) && block->dims;
    if (outputs.dims) {
        outputs.most = block->level;
        outputs.level_per_speed = (float)block->level / block->move.feed;
    }
    segment_writer_set_level(outputs.dark ? 0 : block->level);
    if (block->level > 0) {
        outputs.lit = true;
        connect_pwm();
    }
}

void outputs_enter(const block_t *block) {
    if (outputs.laser) {
        enter_with_laser(block);
    } else {
        segment_writer_set_level(block->level);
    }
}

void outputs_follow_speed(float speed) {
    float level = speed * outputs.level_per_speed + 0.5f;
    segment_writer_set_level(level < (float)outputs.most ? (uint16_t)level : outputs.most);
}

bool outputs_put_out(void) {
    if (!outputs.lit) {
        return false;
    }
    outputs.lit = false;
    outputs.dims = false;
    segment_writer_set_level(0);
    return true;
}

void outputs_begin_stop(void) {
    if (outputs.laser) {
        outputs.dark = true;
        outputs.dims = false;
        segment_writer_set_level(0);
    }
}

void outputs_end_stop(void) {
    outputs.dark = false;
}

// ---- Off at once --------------------------------------------------------------------------------

static void drive(uint32_t mask, bool high) {
    hal_pins_set(high ? mask : 0);
    hal_pins_clear(high ? 0 : mask);
}

// What is left of the period must not come when the pin is given back. A slice that stands takes a
// level up at once.
static void forget_period(unsigned slice) {
    static const uint16_t from_zero[HAL_PWM_SLICES];
    hal_pwm_stop(slice);
    hal_pwm_level(hal_pwm_place(slice), 0);
    hal_pwm_start(1u << slice, from_zero);
}

void outputs_spindle_off(void) {
    outputs.turn_now = STEPPER_SPINDLE_OFF;
    outputs.lit = false;
    outputs.dims = false;
    segment_writer_set_level(0);
    if (outputs.pwm_connected) {
        outputs.pwm_connected = false;
        hal_pin_output(outputs.spindle.gpio, outputs.spindle.invert);
        forget_period(HAL_PWM_SLICE(outputs.spindle.gpio));
    }
    drive(pins_mask(outputs.spindle.gpio), outputs.spindle.invert);
}

void outputs_coolant_off(void) {
    drive(pins_mask(outputs.coolant.flood_gpio) | pins_mask(outputs.coolant.mist_gpio),
          outputs.coolant.invert);
}

void outputs_off(void) {
    outputs_spindle_off();
    outputs_coolant_off();
}
