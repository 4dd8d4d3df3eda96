// The 100 kHz tick from SysTick: the core clock divided exactly, nothing to acknowledge, and the
// only interrupt at the highest priority. Its vector is hal_on_tick() itself. Context: main,
// governor.
#include "hal/hal.h"

#include "hardware/clocks.h"
#include "hardware/exception.h"

#include "rp2_port.h"

#define TICK_CYCLES (SYS_CLK_HZ / HAL_TICK_HZ)
static_assert(SYS_CLK_HZ % HAL_TICK_HZ == 0, "the tick has to divide the core clock");

void rp2_tick_init(void) {
    exception_set_exclusive_handler(SYSTICK_EXCEPTION, hal_on_tick);
    exception_set_priority(SYSTICK_EXCEPTION, RP2_PRIORITY_TICK);
}

void hal_tick_start(void) {
    if (hal_tick_running()) {
        return;
    }
    systick_hw->rvr = TICK_CYCLES - 1;
    systick_hw->cvr = 0; // any write clears it: the first tick comes a whole period later
    scb_hw->icsr = ARM_CPU_PREFIXED(ICSR_PENDSTCLR_BITS);
    systick_hw->csr = ARM_CPU_PREFIXED(SYST_CSR_CLKSOURCE_BITS) |
                      ARM_CPU_PREFIXED(SYST_CSR_TICKINT_BITS) |
                      ARM_CPU_PREFIXED(SYST_CSR_ENABLE_BITS);
}
