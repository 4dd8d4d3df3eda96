// Rotor, friction, obstacles. Context: any.
#include "simulate_motor.h"

#include <math.h>
#include <stdlib.h>

#define QUARTER_TURN_RAD 1.57079632679489661923

void simulate_motor_init(simulate_motor_t *motor, int64_t rotor) {
    *motor = (simulate_motor_t){.stop_low = -SIMULATE_MOTOR_NO_END,
                                .stop_high = SIMULATE_MOTOR_NO_END,
                                .pole = rotor,
                                .rotor = rotor,
                                .since_slip = SIMULATE_MOTOR_PERIOD};
}

// How far the rotor lags while friction holds it, at most; more than a period if the current is not
// enough to move it at all.
static int64_t friction_lag(const simulate_motor_t *motor, uint32_t current_ma) {
    if (current_ma <= motor->load_ma) {
        return 2 * SIMULATE_MOTOR_PERIOD;
    }
    double part = (double)motor->load_ma / (double)current_ma;
    return lround(asin(part) / QUARTER_TURN_RAD * SIMULATE_MOTOR_FULL_STEP);
}

static int64_t clamp(int64_t value, int64_t low, int64_t high) {
    value = value < low ? low : value;
    return value > high ? high : value;
}

// Holds the rotor by the nearest place of rest. True if it is another than before.
static bool choose_pole(simulate_motor_t *motor) {
    int64_t before = motor->pole;
    while (motor->pole - motor->rotor > SIMULATE_MOTOR_LAG_MAX) {
        motor->pole -= SIMULATE_MOTOR_PERIOD;
    }
    while (motor->rotor - motor->pole > SIMULATE_MOTOR_LAG_MAX) {
        motor->pole += SIMULATE_MOTOR_PERIOD;
    }
    return motor->pole != before;
}

static void note_torque(simulate_motor_t *motor) {
    double lag = (double)llabs(motor->pole - motor->rotor) / SIMULATE_MOTOR_FULL_STEP;
    double torque = lag < 1.0 ? 1024.0 * sin(QUARTER_TURN_RAD * lag) : 1024.0;
    uint32_t torque_1024 = (uint32_t)lround(torque);
    motor->torque_1024 = torque_1024 > motor->torque_1024 ? torque_1024 : motor->torque_1024;
}

static void settle(simulate_motor_t *motor, uint32_t current_ma) {
    if (choose_pole(motor) && current_ma > 0) {
        motor->slips++;
        motor->since_slip = 0;
    }
    int64_t lag = friction_lag(motor, current_ma);
    int64_t rotor = clamp(motor->rotor, motor->pole - lag, motor->pole + lag);
    motor->rotor = clamp(rotor, motor->stop_low, motor->stop_high);
    note_torque(motor);
}

void simulate_motor_turn(simulate_motor_t *motor, int32_t way, uint32_t current_ma) {
    motor->pole += way;
    motor->since_slip += way < 0 ? -way : way;
    settle(motor, current_ma);
}

void simulate_motor_jump(simulate_motor_t *motor, int64_t phase, uint32_t current_ma) {
    int64_t turns = motor->rotor - phase + SIMULATE_MOTOR_PERIOD / 2;
    int64_t rest = turns % SIMULATE_MOTOR_PERIOD;
    rest += rest < 0 ? SIMULATE_MOTOR_PERIOD : 0;
    motor->pole = turns - rest + phase;
    settle(motor, current_ma);
}

uint32_t simulate_motor_take_torque(simulate_motor_t *motor) {
    uint32_t torque_1024 = motor->since_slip < SIMULATE_MOTOR_PERIOD ? 1024 : motor->torque_1024;
    motor->torque_1024 = 0;
    return torque_1024;
}
