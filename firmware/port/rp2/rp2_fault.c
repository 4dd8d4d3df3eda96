// What must never happen: processor faults, the SDK's panic, and a main loop that hangs. Each
// restarts the board at once, and the next start tells why. After a restart the pins are inputs
// with the chip's weak pull-down, so a motor driver lets go if a resistor pulls its enable pin up
// (10 kOhm is strong enough). The reason survives in the watchdog's scratch registers. Context:
// any, except where said.
#include "hal/hal.h"

#include "hardware/structs/psm.h"
#include "hardware/watchdog.h"

#include "rp2_port.h"

#define REASON_FAULT 0xFA017000u
#define REASON_PANIC 0xFA017001u
#define REASON_ASKED 0xFA017002u
#define REASON_WATCHDOG 0xFA017003u

static char report[80];
static hal_start_t start_reason;

void rp2_fault_init(void) {
    uint32_t reason = watchdog_hw->scratch[0];
    unsigned long pc = watchdog_hw->scratch[1];
    unsigned long lr = watchdog_hw->scratch[2];
    if (reason == REASON_FAULT) {
        start_reason = HAL_START_FAULT;
        format_text(report, sizeof report, "Restarted after a fault at PC=%08lX LR=%08lX\r\n", pc,
                    lr);
    } else if (reason == REASON_PANIC) {
        start_reason = HAL_START_FAULT;
        format_text(report, sizeof report, "Restarted after a panic at PC=%08lX\r\n", pc);
    } else if (reason == REASON_WATCHDOG) {
        start_reason = HAL_START_WATCHDOG;
        format_text(report, sizeof report, "Restarted by WATCHDOG\r\n");
    } else if (reason == REASON_ASKED) {
        start_reason = HAL_START_RESTART;
    } else if (watchdog_enable_caused_reboot()) {
        start_reason = HAL_START_HUNG;
        format_text(report, sizeof report, "Restarted after the main loop hung for %u s\r\n",
                    RP2_FAULT_WATCHDOG_MS / 1000);
    }
    watchdog_hw->scratch[0] = 0;
    watchdog_enable(RP2_FAULT_WATCHDOG_MS, true);
}

const char *rp2_fault_report(void) {
    return report[0] != '\0' ? report : NULL;
}

hal_start_t hal_start_reason(void) {
    return start_reason;
}

_Noreturn void hal_restart(bool watchdog) {
    rp2_fault_restart(watchdog ? REASON_WATCHDOG : REASON_ASKED, 0, 0);
}

// In RAM and by registers alone: the flash may be what failed.
_Noreturn void HAL_RAM_FUNC(rp2_fault_restart)(uint32_t reason, uint32_t pc, uint32_t lr) {
    watchdog_hw->scratch[0] = reason;
    watchdog_hw->scratch[1] = pc;
    watchdog_hw->scratch[2] = lr;
    watchdog_hw->scratch[4] = 0; // the boot ROM starts the flash image, as after power-up
    psm_hw->wdsel = PSM_WDSEL_BITS & ~(PSM_WDSEL_ROSC_BITS | PSM_WDSEL_XOSC_BITS);
    watchdog_hw->ctrl = WATCHDOG_CTRL_TRIGGER_BITS;
    for (;;) {
        __wfi();
    }
}

_Noreturn void rp2_fault_panic(const char *format, ...) {
    (void)format;
    uint32_t pc = (uint32_t)(uintptr_t)__builtin_return_address(0);
    rp2_fault_restart(REASON_PANIC, pc, 0);
}

// `frame` is where the core put r0..r3, r12, lr, pc, psr - if it could.
static _Noreturn void __attribute__((used)) HAL_RAM_FUNC(fault_at)(const uint32_t *frame) {
    uintptr_t address = (uintptr_t)frame;
    bool readable = address >= SRAM_BASE && address <= SRAM_END - 32 && address % 4 == 0;
    rp2_fault_restart(REASON_FAULT, readable ? frame[6] : 0, readable ? frame[5] : 0);
}

// Finds the stack that was in use (bit 2 of the return code) and goes on in C.
void __attribute__((naked)) HAL_RAM_FUNC(isr_hardfault)(void) {
    __asm volatile("movs r0, #4\n"
                   "mov r1, lr\n"
                   "tst r0, r1\n"
                   "beq 1f\n"
                   "mrs r0, psp\n"
                   "b 2f\n"
                   "1: mrs r0, msp\n"
                   "2: ldr r1, =fault_at\n"
                   "bx r1\n"
                   ".pool\n");
}
