// Sleep and wake-up. Each step prints how long it slept, by the 1 MHz timer. Context: main.
#include <stdio.h>

#include "hardware/irq.h"
#include "hardware/structs/scb.h"
#include "hardware/sync.h"
#include "hardware/timer.h"
#include "pico/stdlib.h"

#include "check.h"

#define SEVONPEND 16u

static uint alarm_number;
static volatile uint32_t alarms;

static void on_alarm(uint alarm) {
    (void)alarm;
    alarms++;
}

static void arm(uint32_t delay_us) {
    hardware_alarm_set_target(alarm_number, make_timeout_time_us(delay_us));
}

static struct {
    const char *what;
    uint32_t us, alarms;
} steps[16];
static unsigned step_count;

// Printed at the end: printing would bring USB interrupts.
static void slept(const char *what, uint64_t start_us) {
    steps[step_count].what = what;
    steps[step_count].us = (uint32_t)(time_us_64() - start_us);
    steps[step_count++].alarms = alarms;
}

#define NVIC(offset) (*(volatile uint32_t *)(PPB_BASE + (offset)))

// Only the alarm's interrupts, so that USB does not wake us. Returns what was enabled.
static uint32_t only_alarms(void) {
    uint32_t enabled = NVIC(0xE100);
    NVIC(0xE180) = enabled & ~0xFu;
    return enabled;
}

static void clear_event(void) {
    __sev();
    __wfe();
}

// An interrupt between looking and sleeping leaves its event behind: WFE must not wait for the next
// one.
static void lost_wakeup(void) {
    clear_event();
    uint32_t before = alarms;
    arm(20);
    while (alarms == before) {
        tight_loop_contents();
    }
    arm(500);
    uint64_t start_us = time_us_64();
    __wfe();
    slept("event left", start_us);
    while (alarms == before + 1) {
        __wfe();
    }
    slept("event waited", start_us);
}

// With SEVONPEND a pending interrupt wakes WFE even when it is masked.
static void send_event_on_pend(bool on) {
    uint32_t saved = save_and_disable_interrupts();
    uint32_t scr = scb_hw->scr;
    scb_hw->scr = on ? scr | SEVONPEND : scr & ~SEVONPEND;
    clear_event();
    arm(100);
    uint64_t start_us = time_us_64();
    if (on) {
        __wfe();
    } else {
        __wfi();
    }
    slept(on ? "sevonpend masked" : "wfi masked", start_us);
    scb_hw->scr = scr;
    restore_interrupts(saved);
}

void check_sleep(int argument) {
    (void)argument;
    static bool claimed;
    if (!claimed) {
        claimed = true;
        alarm_number = (uint)hardware_alarm_claim_unused(true);
        hardware_alarm_set_callback(alarm_number, on_alarm);
    }
    alarms = 0;
    step_count = 0;
    uint32_t enabled = only_alarms();
    uint64_t start_us = time_us_64();
    __sev();
    __wfe();
    slept("sev", start_us);
    lost_wakeup();
    send_event_on_pend(true);
    send_event_on_pend(false);
    // WFI with the interrupt already pending and masked falls through.
    uint32_t saved = save_and_disable_interrupts();
    arm(10);
    busy_wait_us(20);
    start_us = time_us_64();
    __wfi();
    slept("wfi pending", start_us);
    restore_interrupts(saved);
    NVIC(0xE100) = enabled;
    for (unsigned i = 0; i < step_count; i++) {
        printf("%s %lu us alarms %lu\n", steps[i].what, (unsigned long)steps[i].us,
               (unsigned long)steps[i].alarms);
    }
    printf("alarms %lu\n", (unsigned long)alarms);
}
