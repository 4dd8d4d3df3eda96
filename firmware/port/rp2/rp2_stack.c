// Stacks. Interrupts have the core's main stack, 4 KB of memory that no one else uses; main() gets one of
// its own, large enough for the interpreter's recursion and for printf, on the process stack pointer.
// Context: start-up.
#include "hal/hal.h"

#include "hardware/structs/mpu.h"

#include "rp2_port.h"

#define MAIN_STACK_BYTES 32768
// More than any function takes at once (tools/audit/stack.py): none can step over it.
#define GUARD_BYTES 2048

// The guard takes the lowest bytes of the stack's own memory.
static uint8_t main_stack[MAIN_STACK_BYTES]
    __attribute__((used, aligned(GUARD_BYTES), section(".uninitialized_data.stack")));

int __wrap_main(void);

// The linker puts this before main() (--wrap=main), which it calls __real_main.
int __attribute__((naked)) __wrap_main(void) {
    static_assert(MAIN_STACK_BYTES == 1 << 15, "as computed here");
    __asm volatile(".syntax unified\n"
                   "movs r0, #1\n"
                   "lsls r0, r0, #15\n"
                   "ldr r1, =main_stack\n"
                   "adds r0, r0, r1\n"
                   "msr psp, r0\n"
                   "movs r0, #2\n" // SPSEL: threads use PSP
                   "msr control, r0\n"
                   "isb\n"
                   "movs r0, #0\n"
                   "movs r1, #0\n"
                   "bl __real_main\n"
                   "bl _exit\n"
                   ".pool\n");
}

#if PICO_RP2040
void rp2_stack_guard(void) {
    mpu_hw->rbar = (uintptr_t)main_stack | M0PLUS_MPU_RBAR_VALID_BITS; // region 0
    // 2^(10+1) bytes, no access.
    static_assert(GUARD_BYTES == 2 << 10, "as written here");
    mpu_hw->rasr = M0PLUS_MPU_RASR_ENABLE_BITS | (10u << M0PLUS_MPU_RASR_SIZE_LSB);
    mpu_hw->ctrl = M0PLUS_MPU_CTRL_PRIVDEFENA_BITS | M0PLUS_MPU_CTRL_ENABLE_BITS;
    __dsb();
    __isb();
}
#else
void rp2_stack_guard(void) {
    __asm volatile("msr psplim, %0" ::"r"(main_stack));
}
#endif
