// A motor between its driver and the carriage: lag, slip, obstacles, friction.
#include <unity.h>

#include "simulate_motor.h"

#define CURRENT_MA 800u
#define STEP 16 // of the field: 16 microsteps

static simulate_motor_t motor;

void setUp(void) {
    simulate_motor_init(&motor, 5000);
}
void tearDown(void) {}

static void turn(int steps) {
    int32_t way = steps < 0 ? -STEP : STEP;
    for (int i = 0; i < (steps < 0 ? -steps : steps); i++) {
        simulate_motor_turn(&motor, way, CURRENT_MA);
    }
}

static void test_a_free_motor_follows_to_the_microstep(void) {
    turn(1000);
    TEST_ASSERT_EQUAL_INT64(5000 + 1000 * STEP, motor.rotor);
    turn(-3000);
    TEST_ASSERT_EQUAL_INT64(5000 - 2000 * STEP, motor.rotor);
    TEST_ASSERT_EQUAL_UINT64(0, motor.slips);
}

// Friction of half the torque: sin(30 degrees), a third of a full step.
static void test_friction_lets_it_lag_and_hold_on_where_it_turns(void) {
    motor.load_ma = CURRENT_MA / 2;
    turn(100);
    TEST_ASSERT_EQUAL_INT64(motor.pole - 85, motor.rotor);
    int64_t turned = motor.rotor;
    turn(-10); // 160: less than twice the lag
    TEST_ASSERT_EQUAL_INT64(turned, motor.rotor);
    turn(-10);
    TEST_ASSERT_EQUAL_INT64(motor.pole + 85, motor.rotor);
    TEST_ASSERT_UINT32_WITHIN(3, 512, simulate_motor_take_torque(&motor));
}

static void test_an_obstacle_stops_the_rotor_and_not_the_field(void) {
    motor.stop_high = 5000 + 64;
    turn(36); // 512 behind the obstacle: still held
    TEST_ASSERT_EQUAL_INT64(5064, motor.rotor);
    TEST_ASSERT_EQUAL_INT64(5000 + 36 * STEP, motor.pole);
    TEST_ASSERT_EQUAL_UINT64(0, motor.slips);
    TEST_ASSERT_EQUAL_UINT32(1024, simulate_motor_take_torque(&motor));
    turn(-30);
    TEST_ASSERT_EQUAL_INT64(5064, motor.rotor); // until the field is within reach
    turn(-10);
    TEST_ASSERT_EQUAL_INT64(5000 - 4 * STEP, motor.rotor);
}

// Beyond two full steps it falls back by four, less what it lagged, and comes again.
static void test_a_blocked_motor_slips_by_four_full_steps(void) {
    motor.stop_high = 5000;
    turn(33); // 528
    TEST_ASSERT_EQUAL_UINT64(1, motor.slips);
    TEST_ASSERT_EQUAL_INT64(5000 + 528 - 1024, motor.rotor);
    turn(31); // 1024: the place of rest is at the obstacle again
    TEST_ASSERT_EQUAL_INT64(5000, motor.rotor);
    turn(64 * 9);
    TEST_ASSERT_EQUAL_UINT64(10, motor.slips);
    turn(-640);
    TEST_ASSERT_EQUAL_INT64(5000 - 10240, motor.rotor); // wrong by what it has slipped
    TEST_ASSERT_EQUAL_UINT64(10, motor.slips);
}

static void test_it_never_passes_an_obstacle(void) {
    motor.stop_low = 4000;
    motor.stop_high = 9000;
    uint32_t random = 1;
    for (unsigned i = 0; i < 20000; i++) {
        random = random * 1664525u + 1013904223u;
        int run = (int)(random >> 20) % 300;
        turn((random >> 12 & 1) != 0 ? run : -run);
        TEST_ASSERT_GREATER_OR_EQUAL_INT64(4000, motor.rotor);
        TEST_ASSERT_LESS_OR_EQUAL_INT64(9000, motor.rotor);
        TEST_ASSERT_LESS_OR_EQUAL_INT64(512, motor.pole - motor.rotor);
        TEST_ASSERT_GREATER_OR_EQUAL_INT64(-512, motor.pole - motor.rotor);
    }
    TEST_ASSERT_GREATER_THAN_UINT64(100, motor.slips);
}

static void test_too_little_current_does_not_move_it(void) {
    motor.load_ma = CURRENT_MA;
    turn(640);
    TEST_ASSERT_EQUAL_INT64(5000, motor.rotor);
    TEST_ASSERT_EQUAL_UINT64(10, motor.slips);
}

static void test_without_current_it_is_free_and_catches_the_nearest_place(void) {
    for (int i = 0; i < 70; i++) {
        simulate_motor_turn(&motor, STEP, 0);
    }
    TEST_ASSERT_EQUAL_INT64(5000, motor.rotor);
    TEST_ASSERT_EQUAL_UINT64(0, motor.slips);
    simulate_motor_turn(&motor, 0, CURRENT_MA);
    TEST_ASSERT_EQUAL_INT64(5000 + 1120 - 1024, motor.rotor);
}

static void test_the_field_jumps_to_the_nearest_place_of_its_phase(void) {
    simulate_motor_jump(&motor, 0, CURRENT_MA);
    TEST_ASSERT_EQUAL_INT64(5120, motor.rotor);
    simulate_motor_jump(&motor, 700, CURRENT_MA);
    TEST_ASSERT_EQUAL_INT64(4 * 1024 + 700, motor.rotor);
    simulate_motor_init(&motor, -300);
    simulate_motor_jump(&motor, 0, CURRENT_MA);
    TEST_ASSERT_EQUAL_INT64(0, motor.rotor);
    simulate_motor_init(&motor, -600);
    simulate_motor_jump(&motor, 0, CURRENT_MA);
    TEST_ASSERT_EQUAL_INT64(-1024, motor.rotor);
}

static void test_a_slip_takes_all_the_torque_until_it_runs_again(void) {
    motor.stop_high = 5000;
    turn(40);
    motor.stop_high = 100000;
    simulate_motor_take_torque(&motor);
    turn(50);
    TEST_ASSERT_EQUAL_UINT32(1024, simulate_motor_take_torque(&motor));
    turn(10);
    TEST_ASSERT_EQUAL_UINT32(0, simulate_motor_take_torque(&motor));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_free_motor_follows_to_the_microstep);
    RUN_TEST(test_friction_lets_it_lag_and_hold_on_where_it_turns);
    RUN_TEST(test_an_obstacle_stops_the_rotor_and_not_the_field);
    RUN_TEST(test_a_blocked_motor_slips_by_four_full_steps);
    RUN_TEST(test_it_never_passes_an_obstacle);
    RUN_TEST(test_too_little_current_does_not_move_it);
    RUN_TEST(test_without_current_it_is_free_and_catches_the_nearest_place);
    RUN_TEST(test_the_field_jumps_to_the_nearest_place_of_its_phase);
    RUN_TEST(test_a_slip_takes_all_the_torque_until_it_runs_again);
    return UNITY_END();
}
