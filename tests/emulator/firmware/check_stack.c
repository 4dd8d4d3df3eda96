// Two stacks: thread code on the process stack, exceptions on the main stack. Context: main and an
// interrupt.
#include <stdio.h>

#include "hardware/irq.h"
#include "hardware/structs/mpu.h"
#include "hardware/sync.h"
#include "pico/stdlib.h"

#include "check.h"

#define IRQ (FIRST_USER_IRQ + 2)

static uint32_t process_stack[512] __attribute__((aligned(8)));
static volatile uint32_t handler_sp, handler_lr, handler_control, thread_sp, thread_control;

static uint32_t stack_pointer(void) {
    uint32_t sp;
    __asm volatile("mov %0, sp" : "=r"(sp));
    return sp;
}

static uint32_t control_register(void) {
    uint32_t control;
    __asm volatile("mrs %0, control" : "=r"(control));
    return control;
}

static void __attribute__((noinline)) note_handler(uint32_t lr) {
    handler_lr = lr;
    handler_sp = stack_pointer();
    handler_control = control_register();
}

static void __attribute__((naked)) handler(void) {
    __asm volatile("push {r4, lr}\n"
                   "mov r0, lr\n"
                   "bl %c0\n"
                   "pop {r4, pc}\n" ::"i"(note_handler));
}

static void __attribute__((noinline, used)) on_process_stack(void) {
    thread_sp = stack_pointer();
    thread_control = control_register();
    irq_set_pending(IRQ);
    __dsb();
    __isb();
}

// Runs on_process_stack() with SPSEL = 1 and comes back to the main stack.
static void __attribute__((naked)) switch_stacks(uint32_t *top) {
    __asm volatile("push {r4, lr}\n"
                   "msr psp, %[top]\n"
                   "movs r0, #2\n"
                   "msr control, r0\n"
                   "isb\n"
                   "bl on_process_stack\n"
                   "movs r0, #0\n"
                   "msr control, r0\n"
                   "isb\n"
                   "pop {r4, pc}\n" ::[top] "r"(top));
}

static bool on_main_stack(uint32_t sp) {
    return sp >= 0x20040000 && sp < 0x20042000;
}

// The planted fault: a guard below the stack, as the firmware sets it up, and a write into it.
static void write_into_guard(void) {
    static uint32_t guarded[128] __attribute__((aligned(256)));
    mpu_hw->rbar = (uintptr_t)guarded | M0PLUS_MPU_RBAR_VALID_BITS;
    mpu_hw->rasr = M0PLUS_MPU_RASR_ENABLE_BITS | (7u << M0PLUS_MPU_RASR_SIZE_LSB);
    mpu_hw->ctrl = M0PLUS_MPU_CTRL_PRIVDEFENA_BITS | M0PLUS_MPU_CTRL_ENABLE_BITS;
    __dsb();
    __isb();
    guarded[64] = 1; // just behind it
    printf("beside\n");
    stdio_flush();
    sleep_ms(5);
    guarded[63] = 1;
}

// 0: look at the stacks; 1: write into a guard.
void check_stack(int argument) {
    if (argument == 1) {
        write_into_guard();
    }
    static bool installed;
    if (!installed) {
        installed = true;
        irq_set_exclusive_handler(IRQ, handler);
        irq_set_enabled(IRQ, true);
    }
    switch_stacks(process_stack + 512);
    bool on_process =
        thread_sp > (uint32_t)process_stack && thread_sp <= (uint32_t)(process_stack + 512);
    printf("thread process %d control %lu\n", on_process, (unsigned long)thread_control);
    printf("handler main %d control %lu lr %08lx\n", on_main_stack(handler_sp),
           (unsigned long)handler_control, (unsigned long)handler_lr);
    irq_set_pending(IRQ);
    __dsb();
    __isb();
    printf("from main lr %08lx main %d\n", (unsigned long)handler_lr,
           on_main_stack(stack_pointer()));
}
