// A user interrupt that software pends, below SysTick and USB: the way the firmware runs its
// governor. Context: main and the handler.
#include <stdio.h>

#include "hardware/gpio.h"
#include "hardware/irq.h"
#include "hardware/sync.h"
#include "pico/stdlib.h"

#include "check.h"

#define IRQ FIRST_USER_IRQ
#define NVIC(offset) (*(volatile uint32_t *)(PPB_BASE + (offset)))
#define BIT (1u << IRQ)

static volatile uint32_t calls;
static volatile uint32_t depth_seen;

static void handler(void) {
    calls++;
    uint32_t ipsr;
    __asm volatile("mrs %0, ipsr" : "=r"(ipsr));
    depth_seen = ipsr;
    if (calls == 100) {
        NVIC(0xE200) = BIT; // pending itself while it runs: comes once more
    }
}

static void report(const char *what) {
    printf("%s calls %lu pending %d\n", what, (unsigned long)calls, (NVIC(0xE200) & BIT) != 0);
}

void check_interrupts(int argument) {
    static bool installed;
    if (!installed) {
        installed = true;
        irq_set_exclusive_handler(IRQ, handler);
        irq_set_priority(IRQ, 0xC0);
    }
    irq_set_enabled(IRQ, true);
    calls = (uint32_t)argument;
    NVIC(0xE200) = BIT;
    __dsb();
    __isb();
    report("pended");
    printf("ipsr %lu\n", (unsigned long)depth_seen);
    NVIC(0xE180) = BIT;
    __dsb();
    __isb();
    NVIC(0xE200) = BIT;
    report("disabled");
    NVIC(0xE280) = BIT;
    report("cleared");
    NVIC(0xE200) = BIT;
    NVIC(0xE100) = BIT;
    __dsb();
    __isb();
    report("enabled");
    uint32_t saved = save_and_disable_interrupts();
    NVIC(0xE200) = BIT;
    __dsb();
    __isb();
    report("masked");
    restore_interrupts(saved);
    __isb();
    report("unmasked");
    calls = 99;
    NVIC(0xE200) = BIT;
    __dsb();
    __isb();
    report("twice");
}
