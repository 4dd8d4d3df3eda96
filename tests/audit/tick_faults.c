// For the self-tests of tools/audit/tick.py and stack.py: one tick without a fault, and one for
// each fault that they have to find. Linked by tick_faults.ld; never run.
#include <stdint.h>

#define RAM __attribute__((noinline, section(".time_critical")))
#define FLASH __attribute__((noinline))

int tick_clean(int value);
int tick_divides(int value, int by);
float tick_float(float value);
double tick_double(double value);
int tick_in_flash(int value);
int tick_calls_flash(int value);
int tick_flash_table(int index);
int tick_pointer(int value);
int tick_recursion(int value);
int tick_allocates(int value);

volatile uint32_t pin;
int (*volatile callback)(int);
static const int table[64] = {1, 2, 3};

RAM static int helper(int value) {
    volatile uint32_t local[16];
    for (int i = 0; i < 16; i++) {
        local[i] = pin;
    }
    return value + (int)local[value & 15];
}

RAM int tick_clean(int value) {
    pin = 1;
    return helper(value) + 1;
}

RAM int tick_divides(int value, int by) {
    return value / by;
}

RAM float tick_float(float value) {
    return value * 1.5f;
}

RAM double tick_double(double value) {
    return value + 1.5;
}

FLASH int tick_in_flash(int value) {
    pin = 2;
    return value + 1;
}

RAM int tick_calls_flash(int value) {
    return tick_in_flash(value) + 1;
}

RAM int tick_flash_table(int index) {
    return table[index];
}

RAM int tick_pointer(int value) {
    return callback(value) + 1;
}

RAM int tick_recursion(int value) {
    int below = value == 0 ? 0 : tick_recursion(value - 1);
    pin = (uint32_t)below;
    return below + 1;
}

FLASH static int allocate(int value) {
    pin = 3;
    return value;
}

RAM int tick_allocates(int value) {
    return allocate(value) + 1;
}
