// Memory that the linker gives to no variable. Interrupts have the core's main stack, 4 KB of
// memory that no one else uses; main() gets one of its own at the end of RAM, large enough for the
// compiler's recursion, on the process stack pointer. All that is left below it is BASIC's.
// rp2_memory.ld says what lies where. Context: start-up.
#include "hal/hal.h"

#include "hardware/structs/mpu.h"

#include "rp2_port.h"

// More than any function takes at once (tools/audit/stack.py): none can step over it.
#define GUARD_BYTES 2048

int __wrap_main(void);

// The linker puts this before main() (--wrap=main), which it calls __real_main.
int __attribute__((naked)) __wrap_main(void) {
    __asm volatile(".syntax unified\n"
                   "ldr r0, =rp2_main_stack_top\n"
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

void *hal_memory(size_t *size) {
    uintptr_t start = ((uintptr_t)rp2_variables_end + 7u) & ~(uintptr_t)7u;
    *size = (uintptr_t)rp2_main_stack - start;
    return (void *)start;
}

#if PICO_RP2040
// The guard takes the lowest bytes of the stack's own memory.
void rp2_stack_guard(void) {
    mpu_hw->rbar = (uintptr_t)rp2_main_stack | M0PLUS_MPU_RBAR_VALID_BITS; // region 0
    // 2^(10+1) bytes, no access.
    static_assert(GUARD_BYTES == 2 << 10, "as written here");
    mpu_hw->rasr = M0PLUS_MPU_RASR_ENABLE_BITS | (10u << M0PLUS_MPU_RASR_SIZE_LSB);
    mpu_hw->ctrl = M0PLUS_MPU_CTRL_PRIVDEFENA_BITS | M0PLUS_MPU_CTRL_ENABLE_BITS;
    __dsb();
    __isb();
}
#else
void rp2_stack_guard(void) {
    __asm volatile("msr psplim, %0" ::"r"(rp2_main_stack));
}
#endif
