// Cycles of instructions, counted by SysTick at the core clock in code that runs from RAM, and
// hardware alarms. Context: main.
#include <stdio.h>

#include "hardware/structs/sio.h"
#include "hardware/structs/systick.h"
#include "hardware/sync.h"
#include "hardware/timer.h"
#include "pico/stdlib.h"

#include "check.h"

// Cycles of the instructions between two readings of SysTick, the second reading (2) taken off.
#define COUNT(name, setup, ...)                                                                    \
    static uint32_t __not_in_flash_func(name)(void) {                                              \
        uint32_t first, second, work[4] = {0};                                                     \
        volatile uint32_t *counter = &systick_hw->cvr;                                             \
        __asm volatile(".align 2\n" setup "ldr %[a], [%[t]]\n" __VA_ARGS__ "\nldr %[b], [%[t]]\n"  \
                       : [a] "=&l"(first), [b] "=&l"(second)                                       \
                       : [t] "l"(counter), [m] "l"(work)                                           \
                       : "r0", "r1", "lr", "cc", "memory");                                        \
        return ((first - second) & 0xffffff) - 2;                                                  \
    }

COUNT(count_nops, "", "nop\nnop\nnop\nnop\n")
COUNT(count_loads, "", "ldr r0, [%[m]]\nldr r1, [%[m], #4]\n")
COUNT(count_stores, "", "str r0, [%[m]]\nstrb r0, [%[m]]\n")
COUNT(count_multiply, "movs r0, #3\n", "muls r0, r0\n")
COUNT(count_branch, "", "b 1f\nnop\n1:\n")
COUNT(count_not_taken, "movs r0, #1\ncmp r0, #1\n", "bne 1f\n1:\n")
COUNT(count_taken, "movs r0, #1\ncmp r0, #1\n", "beq 1f\nnop\n1:\n")
COUNT(count_loop, "movs r0, #100\n", "1: subs r0, #1\nbne 1b\n")
COUNT(count_push_pop, "", "push {r0, r1}\npop {r0, r1}\n")
COUNT(count_call, "", "bl 2f\nb 3f\n2: bx lr\n3:\n")
COUNT(count_call_stack, "", "bl 2f\nb 3f\n2: push {r0, lr}\npop {r0, pc}\n3:\n")
COUNT(count_barriers, "", "dsb\nisb\n")
COUNT(count_sio, "ldr r0, =0xd0000000\n", "ldr r1, [r0, #4]\n")

static const struct {
    const char *name;
    uint32_t (*count)(void);
} counts[] = {
    {"nops", count_nops},
    {"loads", count_loads},
    {"stores", count_stores},
    {"multiply", count_multiply},
    {"branch", count_branch},
    {"not_taken", count_not_taken},
    {"taken", count_taken},
    {"loop", count_loop},
    {"push_pop", count_push_pop},
    {"call", count_call},
    {"call_stack", count_call_stack},
    {"barriers", count_barriers},
    {"sio", count_sio},
};

static volatile uint64_t fired_us;

static void on_alarm(uint alarm) {
    (void)alarm;
    fired_us = time_us_64();
}

static void time_alarm(void) {
    uint alarm = (uint)hardware_alarm_claim_unused(true);
    hardware_alarm_set_callback(alarm, on_alarm);
    for (uint32_t delay_us = 50; delay_us <= 5000; delay_us *= 10) {
        fired_us = 0;
        uint64_t target_us = time_us_64() + delay_us;
        hardware_alarm_set_target(alarm, from_us_since_boot(target_us));
        while (fired_us == 0) {
            tight_loop_contents();
        }
        printf("alarm %lu late %ld us\n", (unsigned long)delay_us, (long)(fired_us - target_us));
    }
    hardware_alarm_set_callback(alarm, NULL);
    hardware_alarm_unclaim(alarm);
}

void check_timing(int argument) {
    (void)argument;
    uint32_t saved = save_and_disable_interrupts();
    systick_hw->csr = 0;
    systick_hw->rvr = 0xffffff;
    systick_hw->cvr = 0;
    systick_hw->csr = 5;
    uint32_t results[count_of(counts)];
    for (size_t i = 0; i < count_of(counts); i++) {
        results[i] = counts[i].count();
    }
    systick_hw->csr = 0;
    restore_interrupts(saved);
    for (size_t i = 0; i < count_of(counts); i++) {
        printf("%s %lu\n", counts[i].name, (unsigned long)results[i]);
    }
    time_alarm();
}
