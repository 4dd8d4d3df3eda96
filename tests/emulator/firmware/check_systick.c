// SysTick as a 100 kHz tick, the way the firmware uses it. Context: main, and on_tick() at the
// highest priority.
#include <stdio.h>

#include "hardware/exception.h"
#include "hardware/gpio.h"
#include "hardware/irq.h"
#include "hardware/structs/scb.h"
#include "hardware/structs/sio.h"
#include "hardware/structs/systick.h"
#include "hardware/sync.h"
#include "pico/stdlib.h"

#include "check.h"

#define TICK_CYCLES 1250u
#define PENDSTCLR (1u << 25)
#define PENDSTSET (1u << 26)

static volatile uint32_t ticks;

static void __not_in_flash_func(on_tick)(void) {
    sio_hw->gpio_set = 1u << CHECK_GPIO_TICK;
    ticks++;
    sio_hw->gpio_clr = 1u << CHECK_GPIO_TICK;
}

static void set_up(void) {
    static bool installed;
    if (!installed) {
        installed = true;
        exception_set_exclusive_handler(SYSTICK_EXCEPTION, on_tick);
        exception_set_priority(SYSTICK_EXCEPTION, 0);
        for (uint irq = 0; irq < 26; irq++) {
            irq_set_priority(irq, 0x80);
        }
        gpio_init(CHECK_GPIO_TICK);
        gpio_set_dir(CHECK_GPIO_TICK, GPIO_OUT);
        gpio_init(CHECK_GPIO_MAIN);
        gpio_set_dir(CHECK_GPIO_MAIN, GPIO_OUT);
    }
}

static void start(void) {
    systick_hw->rvr = TICK_CYCLES - 1;
    systick_hw->cvr = 0;
    scb_hw->icsr = PENDSTCLR;
    systick_hw->csr = 7;
}

static void stop(void) {
    systick_hw->csr = 0;
    scb_hw->icsr = PENDSTCLR;
}

// 0: main sleeps in WFI; 1: main computes; 2: main divides and prints (USB under load).
void check_systick(int busy) {
    ticks = 0;
    set_up();
    start();
    uint32_t rounds = 0;
    while (ticks < 2000) {
        if (busy == 0) {
            __wfi();
        } else if (busy == 2) {
            printf("round %lu\n", (unsigned long)rounds);
        }
        rounds++;
    }
    stop();
    printf("ticks %lu\n", (unsigned long)ticks);
}

void check_systick_stop(int argument) {
    (void)argument;
    ticks = 0;
    set_up();
    uint32_t saved = save_and_disable_interrupts();
    gpio_put(CHECK_GPIO_MAIN, true);
    start();
    busy_wait_us(35); // three ticks late: they pend once
    printf("masked %lu pending %d\n", (unsigned long)ticks, (scb_hw->icsr & PENDSTSET) != 0);
    restore_interrupts(saved);
    gpio_put(CHECK_GPIO_MAIN, false);
    while (ticks < 5) {
        tight_loop_contents();
    }
    saved = save_and_disable_interrupts();
    busy_wait_us(11);
    stop(); // the pending one must not come any more
    restore_interrupts(saved);
    uint32_t stopped = ticks;
    busy_wait_us(50);
    printf("stopped %lu later %lu\n", (unsigned long)stopped, (unsigned long)ticks);
}
