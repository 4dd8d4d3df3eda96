// The commands of the bench's test program. Each prints its results as lines of words; main.c ends
// them with "> ".
#ifndef CHECK_H
#define CHECK_H

#include <stdint.h>

// Pins a test may drive.
enum { CHECK_GPIO_TICK = 2, CHECK_GPIO_HANDLER = 3, CHECK_GPIO_MAIN = 4, CHECK_GPIO_INPUT = 16 };

void check_alu(int argument); // flags of the instructions that emulators get wrong
void check_float(
    int count); // sums, differences, products, quotients, roots of pseudo-random operands
void check_interrupts(
    int argument); // a software-pended user interrupt: pend, clear, enable, nesting below SysTick
void check_pio(int divider_times_2); // square wave and FIFOs of the PIO
void check_pio_shift(int argument);  // shift registers that fill and empty themselves
void check_pio_answer(int argument); // a pin is pulled low when another one falls, for 2 ms
void check_sleep(int argument);      // WFE, SEV, SEVONPEND, WFI with PRIMASK
void check_stack(int argument);      // main on the process stack, exceptions on the main stack
void check_storage(int argument);    // erase and program the flash by the boot ROM's functions
void check_systick(int busy); // 100 kHz tick that toggles a pin, with a busy or a sleeping main
void check_systick_stop(
    int argument); // stop, clear pending, start again; pending while interrupts are masked
void check_timing(int argument); // cycles of instructions and of hardware alarms
void check_uart(int argument);   // 100 bytes out at 115200 Bd, and what came in

#endif
